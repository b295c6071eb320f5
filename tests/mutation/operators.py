"""The changes that are tried, fixed before the first run; docs/dev/testing.md lists them."""

import ast
import itertools
from collections import Counter
from collections.abc import Callable

from tests.mutation.mutant import Mutant

_COMPARISONS: dict[type[ast.cmpop], type[ast.cmpop]] = {
    ast.Lt: ast.LtE,
    ast.LtE: ast.Lt,
    ast.Gt: ast.GtE,
    ast.GtE: ast.Gt,
    ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq,
    ast.In: ast.NotIn,
    ast.NotIn: ast.In,
    ast.Is: ast.IsNot,
    ast.IsNot: ast.Is,
}
_ARITHMETIC: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Add,
    ast.Div: ast.Mult,
    ast.Mod: ast.FloorDiv,
    ast.Pow: ast.Mult,
    ast.LShift: ast.RShift,
    ast.RShift: ast.LShift,
    ast.BitOr: ast.BitAnd,
    ast.BitAnd: ast.BitOr,
}
_SETS = (ast.BitOr, ast.BitAnd, ast.Sub, ast.BitXor)
_NAMES = {"min": "max", "max": "min", "floor": "ceil", "ceil": "floor", "any": "all", "all": "any"}


def mutants(file: str, text: str) -> list[Mutant]:
    """Give every mutant of a file, in the order of its text."""
    found = _Finder(file, text).found
    counted: Counter[tuple[str, str]] = Counter()
    numbered = []
    for mutant in sorted(found, key=lambda m: (m.start, m.end, m.new)):
        place = (mutant.function, mutant.change)
        numbered.append(mutant._replace(occurrence=counted[place]))
        counted[place] += 1
    return numbered


class _Finder(ast.NodeVisitor):
    """Walks through a file; annotations, docstrings, imports and assert statements are left alone."""

    def __init__(self, file: str, text: str) -> None:
        self.found: list[Mutant] = []
        self._file = file
        self._text = text
        lines = text.encode().splitlines(keepends=True)
        self._line_starts = list(itertools.accumulate(map(len, lines), initial=0))
        self._bytes = text.encode()
        self._names: list[str] = []  # of classes and functions around a node
        self._outermost = ""  # the function around a node that has no function around it
        self._returns: list[ast.expr | None] = []
        self.visit(ast.parse(text))

    # What is changed.

    def visit_Compare(self, node: ast.Compare) -> None:
        for place, operator in enumerate(node.ops):
            ops = [*node.ops[:place], _COMPARISONS[type(operator)](), *node.ops[place + 1 :]]
            self._expression("comparison", node, ast.Compare(node.left, ops, node.comparators))
        self.generic_visit(node)

    def visit_BinOp(self, node: ast.BinOp) -> None:
        other = _ARITHMETIC.get(type(node.op))
        if isinstance(node.op, ast.Mod) and _is_text(node.left):
            other = None
        if isinstance(node.op, ast.Add) and (_is_text(node.left) or _is_text(node.right)):
            other = None
        if other:
            self._expression("arithmetic", node, ast.BinOp(node.left, other(), node.right))
        if isinstance(node.op, ast.FloorDiv):
            negative = ast.UnaryOp(ast.USub(), node.left)
            rounded_up = ast.UnaryOp(ast.USub(), ast.BinOp(negative, ast.FloorDiv(), node.right))
            self._expression("rounding", node, rounded_up)
        if isinstance(node.op, _SETS):
            self._expression("set operation", node, node.left)
        self.generic_visit(node)

    def visit_BoolOp(self, node: ast.BoolOp) -> None:
        other = ast.Or() if isinstance(node.op, ast.And) else ast.And()
        self._expression("boolean", node, ast.BoolOp(other, node.values))
        self.generic_visit(node)

    def visit_UnaryOp(self, node: ast.UnaryOp) -> None:
        if isinstance(node.op, ast.Not | ast.USub | ast.Invert):
            name = "boolean" if isinstance(node.op, ast.Not) else "arithmetic"
            self._expression(name, node, node.operand)
        self.generic_visit(node)

    def visit_Constant(self, node: ast.Constant) -> None:
        if isinstance(node.value, bool):
            self._expression("constant", node, ast.Constant(not node.value))
        elif isinstance(node.value, int):
            self._expression("constant", node, ast.Constant(node.value + 1))
            if node.value == 1:
                self._expression("constant", node, ast.Constant(0))

    def visit_Call(self, node: ast.Call) -> None:
        self._name(node.func)
        for argument in node.args:  # key=max and the like, too
            self._name(argument)
        for keyword in node.keywords:
            self._name(keyword.value)
        self.generic_visit(node)

    def visit_Slice(self, node: ast.Slice) -> None:
        for bound in (node.lower, node.upper):
            if bound is not None and not isinstance(bound, ast.Constant | ast.UnaryOp):
                self._expression("slice", bound, ast.BinOp(bound, ast.Add(), ast.Constant(1)))
        self.generic_visit(node)

    def visit_If(self, node: ast.If) -> None:
        if not (isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"):
            self._condition(node.test, True, False)
            self.generic_visit(node)

    def visit_IfExp(self, node: ast.IfExp) -> None:
        self._condition(node.test, True, False)
        self.generic_visit(node)

    def visit_While(self, node: ast.While) -> None:
        self._condition(node.test, False)
        self.generic_visit(node)

    def visit_comprehension(self, node: ast.comprehension) -> None:
        for test in node.ifs:
            self._condition(test, True)
        self.generic_visit(node)

    def visit_Return(self, node: ast.Return) -> None:
        if node.value is not None and not (isinstance(node.value, ast.Constant) and node.value.value is None):
            self._expression("return", node.value, ast.Constant(None))
            returns = self._returns[-1]
            if isinstance(returns, ast.Name) and returns.id == "bool":
                self._expression("return", node.value, ast.UnaryOp(ast.Not(), node.value))
        self.generic_visit(node)

    def visit_Break(self, node: ast.Break) -> None:
        self._statement("loop", node, "continue")

    def visit_Continue(self, node: ast.Continue) -> None:
        self._statement("loop", node, "break")

    def visit_Expr(self, node: ast.Expr) -> None:
        if isinstance(node.value, ast.Constant):
            return
        self._statement("statement", node, "pass")
        self.generic_visit(node)

    def visit_Raise(self, node: ast.Raise) -> None:
        self._statement("statement", node, "pass")
        self.generic_visit(node)

    def visit_Delete(self, node: ast.Delete) -> None:
        self._statement("statement", node, "pass")

    def visit_AugAssign(self, node: ast.AugAssign) -> None:
        self._statement("statement", node, "pass")
        other = _ARITHMETIC.get(type(node.op))
        if other and not _is_text(node.value):
            changed = ast.AugAssign(node.target, other(), node.value)
            self._statement("arithmetic", node, ast.unparse(changed))
        self.generic_visit(node)

    def visit_Assign(self, node: ast.Assign) -> None:
        if all(isinstance(target, ast.Attribute | ast.Subscript) for target in node.targets):
            self._statement("statement", node, "pass")
        self.generic_visit(node)

    # What is left alone.

    def visit_Assert(self, node: ast.Assert) -> None:
        """Leave it: it is a check of ours and no behaviour."""

    def visit_JoinedStr(self, node: ast.JoinedStr) -> None:
        """Leave it: Python 3.11 does not say where its parts are."""

    def visit_AnnAssign(self, node: ast.AnnAssign) -> None:
        if node.value is not None:
            if isinstance(node.target, ast.Attribute | ast.Subscript):
                self._statement("statement", node, "pass")
            self.visit(node.value)

    def visit_arguments(self, node: ast.arguments) -> None:
        for default in (*node.defaults, *node.kw_defaults):
            if default is not None:
                self.visit(default)

    def visit_FunctionDef(self, node: ast.FunctionDef | ast.AsyncFunctionDef) -> None:
        # decorators and defaults are worked out where the function is defined
        self.visit(node.args)
        self._returns.append(node.returns)
        self._named(node.name, lambda: [self.visit(child) for child in node.body], function=True)
        self._returns.pop()

    def visit_AsyncFunctionDef(self, node: ast.AsyncFunctionDef) -> None:
        self.visit_FunctionDef(node)

    def visit_Lambda(self, node: ast.Lambda) -> None:
        self.visit(node.args)
        # the outermost of a file has no name to find it by
        self._named("<lambda>", lambda: self.visit(node.body), function=bool(self._outermost))

    def visit_ClassDef(self, node: ast.ClassDef) -> None:
        self._named(node.name, lambda: [self.visit(child) for child in node.body], function=False)

    # How a change is noted.

    def _named(self, name: str, visit: Callable[[], object], *, function: bool) -> None:
        before = self._outermost
        self._names.append(name)
        if function and not before:
            self._outermost = ".".join(self._names)
        visit()
        self._outermost = before
        self._names.pop()

    def _name(self, node: ast.expr) -> None:
        if isinstance(node, ast.Name) and node.id in _NAMES:
            self._expression("function", node, ast.Name(_NAMES[node.id]))
        if isinstance(node, ast.Attribute) and node.attr in {"floor", "ceil"}:
            self._expression("rounding", node, ast.Attribute(node.value, _NAMES[node.attr]))

    def _condition(self, test: ast.expr, *values: bool) -> None:
        for value in values:
            if not (isinstance(test, ast.Constant) and test.value is value):
                self._expression("condition", test, ast.Constant(value))

    def _expression(self, operator: str, node: ast.expr, new: ast.expr) -> None:
        text = ast.unparse(new)
        self._note(operator, node, f"({text})" if not isinstance(new, ast.Constant | ast.Name) else text)

    def _statement(self, operator: str, node: ast.stmt, new: str) -> None:
        self._note(operator, node, new)

    def _note(self, operator: str, node: ast.expr | ast.stmt, new: str) -> None:
        assert node.end_lineno is not None
        assert node.end_col_offset is not None
        start = self._offset(node.lineno, node.col_offset)
        end = self._offset(node.end_lineno, node.end_col_offset)
        self.found.append(
            Mutant(
                self._file,
                ".".join(self._names),
                self._outermost,
                operator,
                node.lineno,
                node.end_lineno,
                start,
                end,
                self._text[start:end],
                new,
            )
        )

    def _offset(self, line: int, column: int) -> int:
        """Give the offset in letters; Python's columns are bytes."""
        return len(self._bytes[: self._line_starts[line - 1] + column].decode())


def _is_text(node: ast.expr) -> bool:
    if isinstance(node, ast.BinOp):
        return _is_text(node.left) or _is_text(node.right)
    return isinstance(node, ast.JoinedStr) or (
        isinstance(node, ast.Constant) and isinstance(node.value, str | bytes)
    )
