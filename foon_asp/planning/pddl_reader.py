"""Reading PDDL: what is beyond STRIPS with costs and ADL is refused by name, at its place."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from decimal import Decimal, InvalidOperation
from fractions import Fraction
from pathlib import Path

from foon_asp.planning.formula import (
    TRUE,
    All,
    AnyOf,
    Atom,
    Equal,
    Formula,
    Literal,
    Quantified,
    Variable,
    negated,
)
from foon_asp.planning.pddl_form import Form, PddlText, Word, shown
from foon_asp.planning.pddl_task import Effect, PddlDomain, PddlTask, Schema
from foon_asp.text.plain_file import read_plain_text

_BEYOND = {
    ":derived": "axioms (derived predicates)",
    ":durative-action": "actions that take time (:durative-action)",
    ":process": "processes (PDDL+)",
    ":event": "events (PDDL+)",
    ":constraints": "constraints on trajectories (:constraints)",
    ":method": "hierarchies of tasks (:method)",
    ":task": "hierarchies of tasks (:task)",
    "assign": "numeric fluents (assign)",
    "decrease": "numeric fluents (decrease)",
    "scale-up": "numeric fluents (scale-up)",
    "scale-down": "numeric fluents (scale-down)",
    "probabilistic": "effects that may not happen (probabilistic)",
    "oneof": "effects that may not happen (oneof)",
    "preference": "preferences",
}
_HELD = "relax takes STRIPS, action costs, negation, equality, quantifiers and disjunctions"
_COMPARED = ("<", ">", "<=", ">=")
_TOTAL = "total-cost"
_EVERY = ("object",)

Scope = frozenset[str]
"""The variables that are bound where something stands."""


def read_pddl(domain: Path, problem: Path) -> PddlTask:
    """Read a task from two files.

    Raises :class:`InputError` with the place of what is not understood, or beyond what is taken.
    """
    return parse_pddl(
        PddlText(str(domain), read_plain_text(domain)), PddlText(str(problem), read_plain_text(problem))
    )


def parse_pddl(domain: PddlText, problem: PddlText) -> PddlTask:
    """Read a task from two texts; raises as :func:`read_pddl`."""
    return _ProblemReader(_DomainReader(domain).read(), problem).read()


class _Reader:
    """What domains and problems have in common: types, objects, atoms and conditions."""

    def __init__(self, text: PddlText, domain: PddlDomain, objects: dict[str, set[str]]) -> None:
        self.text, self.domain, self.objects = text, domain, objects

    def sections(self, kind: str) -> Iterator[tuple[str, Form]]:
        """Give the name of each part of the file with the part."""
        whole = self.text.read()
        named = whole.items[1] if len(whole.items) > 1 else whole
        if whole.head != "define" or not isinstance(named, Form) or named.head != kind:
            self.text.fault(whole, f"found {shown(whole)}, expected (define ({kind} NAME) ...)")
        for part in whole.items[2:]:
            if not isinstance(part, Form) or not part.head.startswith(":"):
                self.text.fault(part, f"found {shown(part)}, expected a part such as (:requirements ...)")
            yield part.head, part

    def word(self, part: Word | Form, what: str) -> str:
        if isinstance(part, Form):
            self.text.fault(part, f"found {shown(part)}, expected {what}")
        return part.text

    def form(self, part: Word | Form, what: str) -> Form:
        if isinstance(part, Word):
            self.text.fault(part, f"found {shown(part)}, expected {what}")
        return part

    def beyond(self, part: Form | Word, name: str) -> None:
        if name in _BEYOND:
            self.text.fault(part, f"found {_BEYOND[name]}, which is beyond a delete relaxation here: {_HELD}")

    def typed(self, parts: Sequence[Word | Form]) -> Iterator[tuple[Word, tuple[str, ...]]]:
        """Give names with their types, from a list such as ``?a ?b - block ?c``."""
        waiting: list[Word] = []
        rest = iter(parts)
        for part in rest:
            name = self.word(part, "a name")
            if name != "-":
                waiting.append(Word(name, part.at))
                continue
            kind = next(rest, None)
            if kind is None:
                self.text.fault(part, "found - at the end of a list, expected a type after it")
            types = self._types(kind)
            yield from ((each, types) for each in waiting)
            waiting = []
        yield from ((each, _EVERY) for each in waiting)

    def _types(self, kind: Word | Form) -> tuple[str, ...]:
        if isinstance(kind, Word):
            return (kind.text,)
        if kind.head != "either":
            self.text.fault(kind, f"found {shown(kind)}, expected a type, or (either TYPE ...)")
        return tuple(self.word(each, "a type") for each in kind.items[1:])

    def variables(self, part: Word | Form) -> tuple[Variable, ...]:
        listed: list[Variable] = []
        for name, types in self.typed(self.form(part, "a list of variables").items):
            if not name.text.startswith("?"):
                self.text.fault(name, f"found {shown(name)}, expected a variable, which begins with ?")
            for kind in types:
                if kind not in self.domain.supertypes:
                    self.text.fault(name, f"found the type {kind!r}, which the domain does not declare")
            listed.append(Variable(name.text, types))
        return tuple(listed)

    def declare_objects(self, parts: Sequence[Word | Form]) -> None:
        for name, types in self.typed(parts):
            for kind in types:
                if kind not in self.domain.supertypes:
                    self.text.fault(name, f"found the type {kind!r}, which the domain does not declare")
                self.objects.setdefault(name.text, set()).update(self.domain.supertypes[kind])

    def terms(self, parts: Sequence[Word | Form], scope: Scope) -> tuple[str, ...]:
        terms = []
        for part in parts:
            term = self.word(part, "an object or a variable")
            if term not in scope and term not in self.objects:
                what = "variable" if term.startswith("?") else "object"
                self.text.fault(part, f"found {shown(part)}, which is no {what} known here")
            terms.append(term)
        return tuple(terms)

    def atom(self, form: Form, scope: Scope, declared: Mapping[str, int], what: str) -> Atom:
        name = form.head
        if name not in declared:
            self.beyond(form, name)
            if name in _COMPARED:
                self.text.fault(form, f"found numeric fluents ({name}), which are beyond this: {_HELD}")
            self.text.fault(form, f"found {shown(form)}, expected {what} that the domain declares")
        terms = self.terms(form.items[1:], scope)
        if len(terms) != declared[name]:
            self.text.fault(form, f"found {shown(form)} with {len(terms)} terms, expected {declared[name]}")
        return Atom(name, terms)

    def condition(self, part: Word | Form, scope: Scope) -> Formula:
        form = self.form(part, "a condition in parentheses")
        if not form.items:
            return TRUE
        head, rest = form.head, form.items[1:]
        if head in {"and", "or"} and head not in self.domain.predicates:
            parts = tuple(self.condition(each, scope) for each in rest)
            return All(parts) if head == "and" else AnyOf(parts)
        if head in {"not", "imply", "forall", "exists", "="}:
            count = 1 if head == "not" else 2
            if len(rest) != count:
                self.text.fault(form, f"found ({head} ...) with {len(rest)} parts, expected {count}")
        if head in {"not", "imply"}:
            unless = negated(self.condition(rest[0], scope))
            return unless if head == "not" else AnyOf((unless, self.condition(rest[1], scope)))
        if head in {"forall", "exists"}:
            variables = self.variables(rest[0])
            inner = self.condition(rest[1], scope | {each.name for each in variables})
            return Quantified(head == "exists", variables, inner)
        if head == "=":
            if any(isinstance(each, Form) for each in rest):
                self.text.fault(form, f"found numeric fluents (=), which are beyond this: {_HELD}")
            left, right = self.terms(rest, scope)
            return Equal(left, right, holds=True)
        return Literal(self.atom(form, scope, self.domain.predicates, "a predicate"), holds=True)

    def number(self, part: Word | Form) -> Fraction:
        word = self.word(part, "a number")
        try:
            number = Decimal(word)
        except InvalidOperation:
            self.text.fault(part, f"found {shown(part)}, expected a number")
        if not number.is_finite() or number < 0 or abs(number.adjusted()) > 30:
            self.text.fault(part, f"found {shown(part)}, expected a cost: a number from 0")
        return Fraction(number)


class _DomainReader(_Reader):
    def __init__(self, text: PddlText) -> None:
        domain = PddlDomain(text)
        super().__init__(text, domain, domain.constants)
        self._parts: dict[str, Callable[[Form], None]] = {
            ":requirements": lambda _: None,
            ":types": self._read_types,
            ":constants": lambda form: self.declare_objects(form.items[1:]),
            ":predicates": lambda form: self._declare(form.items[1:], domain.predicates),
            ":functions": lambda form: self._declare(self._untyped(form.items[1:]), domain.functions),
            ":action": self._read_action,
        }

    def read(self) -> PddlDomain:
        sections = list(self.sections("domain"))
        self.domain.supertypes["object"] = {"object"}
        for wanted in self._parts:  # whatever their order in the file
            for name, form in sections:
                if name == wanted:
                    self._parts[name](form)
        for name, form in sections:
            if name not in self._parts:
                self.beyond(form, name)
                self.text.fault(form, f"found {shown(form)}, expected one of {', '.join(self._parts)}")
        return self.domain

    def _read_types(self, form: Form) -> None:
        parents: dict[str, set[str]] = {}
        for name, types in self.typed(form.items[1:]):
            parents.setdefault(name.text, set()).update(types)
            for each in types:
                parents.setdefault(each, set())
        for kind in parents:
            found, left = {kind, *_EVERY}, [kind]
            while left:
                more = parents.get(left.pop(), set()) - found
                found |= more
                left += more
            self.domain.supertypes[kind] = found

    def _untyped(self, parts: Sequence[Word | Form]) -> Iterator[Form]:
        """Give functions without the types of their values, which are numbers."""
        rest = iter(parts)
        for part in rest:
            if isinstance(part, Word) and part.text == "-":
                kind = next(rest, part)
                if not isinstance(kind, Word) or kind.text != "number":
                    self.text.fault(kind, f"found {shown(kind)}, expected functions with values - number")
            else:
                yield self.form(part, "a function in parentheses")

    def _declare(self, parts: Sequence[Word | Form] | Iterator[Form], into: dict[str, int]) -> None:
        for part in parts:
            form = self.form(part, "a declaration in parentheses")
            if not form.head:
                self.text.fault(form, f"found {shown(form)}, expected (NAME ?variable ...)")
            into[form.head] = len(self.variables(Form(form.items[1:], form.at)))

    def _read_action(self, form: Form) -> None:
        name = self.word(form.items[1], "the name of an action") if len(form.items) > 1 else ""
        given: dict[str, Word | Form] = {}
        rest = iter(form.items[2:])
        for key in rest:
            known = self.word(key, ":parameters, :precondition or :effect")
            if known not in {":parameters", ":precondition", ":effect"} or known in given:
                self.text.fault(
                    key, f"found {shown(key)}, expected :parameters, :precondition and :effect once each"
                )
            value = next(rest, None)
            if value is None:
                self.text.fault(key, f"found nothing after {known}")
            given[known] = value
        nothing = Form((), form.at)
        parameters = self.variables(given.get(":parameters", nothing))
        scope = frozenset(each.name for each in parameters)
        condition = self.condition(given.get(":precondition", nothing), scope)
        costs: list[Fraction | Atom] = []
        effects = list(self._effects(given.get(":effect", nothing), scope, (), TRUE, costs))
        self.domain.schemas.append(Schema(name, parameters, condition, tuple(effects), tuple(costs), form.at))

    def _effects(
        self,
        part: Word | Form,
        scope: Scope,
        variables: tuple[Variable, ...],
        condition: Formula,
        costs: list[Fraction | Atom],
    ) -> Iterator[Effect]:
        form = self.form(part, "an effect in parentheses")
        head, rest = form.head, form.items[1:]
        if head == "and" or not form.items:
            for each in rest:
                yield from self._effects(each, scope, variables, condition, costs)
            return
        if head in {"forall", "when", "not", "increase"}:
            count = 1 if head == "not" else 2
            if len(rest) != count:
                self.text.fault(form, f"found ({head} ...) with {len(rest)} parts, expected {count}")
        if head == "forall":
            more = self.variables(rest[0])
            inner = scope | {each.name for each in more}
            yield from self._effects(rest[1], inner, (*variables, *more), condition, costs)
        elif head == "when":
            both = All((condition, self.condition(rest[0], scope)))
            yield from self._effects(rest[1], scope, variables, both, costs)
        elif head == "increase":
            if variables or condition != TRUE:
                self.text.fault(form, "found a cost under a condition, expected one that always counts")
            costs.append(self._cost(form, scope))
        else:
            what = self.form(rest[0], "an atom") if head == "not" else form
            atom = self.atom(what, scope, self.domain.predicates, "a predicate")
            yield Effect(variables, condition, atom, head != "not", form.at)

    def _cost(self, form: Form, scope: Scope) -> Fraction | Atom:
        total, cost = form.items[1:]
        if not isinstance(total, Form) or total.head != _TOTAL or len(total.items) > 1:
            self.text.fault(total, f"found numeric fluents (increase {shown(total)}), which are beyond this")
        if isinstance(cost, Word):
            return self.number(cost)
        return self.atom(cost, scope, self.domain.functions, "a function")


class _ProblemReader(_Reader):
    def __init__(self, domain: PddlDomain, text: PddlText) -> None:
        objects = {name: set(types) for name, types in domain.constants.items()}
        super().__init__(text, domain, objects)
        self._start: set[Atom] = set()
        self._values: dict[tuple[str, tuple[str, ...]], Fraction] = {}
        self._goal: Formula | None = None
        self._costed = False

    def read(self) -> PddlTask:
        sections = list(self.sections("problem"))
        for name, form in sections:
            if name == ":objects":
                self.declare_objects(form.items[1:])
        for name, form in sections:
            if name == ":init":
                for part in form.items[1:]:
                    self._read_initial(self.form(part, "an atom"))
            elif name == ":goal":
                if len(form.items) != 2:
                    self.text.fault(form, "found a goal of several parts, expected one: (:goal (and ...))")
                self._goal = self.condition(form.items[1], frozenset())
            elif name == ":metric":
                self._read_metric(form)
            elif name not in {":domain", ":objects", ":requirements", ":length"}:
                self.beyond(form, name)
                self.text.fault(form, f"found {shown(form)}, expected :objects, :init, :goal or :metric")
        if self._goal is None:
            self.text.fault(0, "found no (:goal ...) in the problem")
        return PddlTask(
            self.domain,
            self.text,
            self.objects,
            frozenset(self._start),
            self._values,
            self._goal,
            self._costed,
        )

    def _read_initial(self, form: Form) -> None:
        if form.head == "=" and len(form.items) == 3:
            function = self.form(form.items[1], "a function in parentheses")
            atom = self.atom(function, frozenset(), self.domain.functions, "a function")
            self._values[atom.predicate, atom.terms] = self.number(form.items[2])
        elif form.head == "at" and len(form.items) == 3 and isinstance(form.items[2], Form):
            self.text.fault(form, f"found something that happens at a time (at ...), beyond this: {_HELD}")
        elif form.head == "not" and len(form.items) == 2:  # what is not listed does not hold anyway
            self.atom(self.form(form.items[1], "an atom"), frozenset(), self.domain.predicates, "a predicate")
        else:
            self._start.add(self.atom(form, frozenset(), self.domain.predicates, "a predicate"))

    def _read_metric(self, form: Form) -> None:
        words = [each.text if isinstance(each, Word) else each.head for each in form.items[1:]]
        simple = all(isinstance(each, Word) or len(each.items) == 1 for each in form.items)
        if words != ["minimize", _TOTAL] or not simple:
            self.text.fault(form, f"found another metric, expected (:metric minimize ({_TOTAL}))")
        self._costed = True
