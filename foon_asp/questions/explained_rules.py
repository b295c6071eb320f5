"""The effect of rules, one by one and together."""

from collections.abc import Iterator, Sequence
from itertools import groupby

from foon_asp.asp import Settings
from foon_asp.asp.assembly import assemble
from foon_asp.asp.reporter import Reporter
from foon_asp.errors import UserError
from foon_asp.json_layout import schema_name
from foon_asp.network import Source
from foon_asp.results.document import Document
from foon_asp.results.table import Block
from foon_asp.results.values import Value
from foon_asp.rules.passed_constraint import Constraint
from foon_asp.rules.rule_analysis import Kind
from foon_asp.rules.rules import ShownRule, Together

_KINDS = {
    Kind.FACT: "no unit decides it: it holds for every tree, or for none",
    Kind.DELETING: "it removes the units that match it, whatever else the tree has",
    Kind.SHRINKING: "a tree that keeps to it still does without some of its units",
    Kind.REQUIRING: "a tree that keeps to it still does with more units",
    Kind.OTHER: "nothing more is known of it",
    Kind.HELPER: "other rules look at what it derives",
}
_ASKS_FOR_ONE = "it asks for a unit of a set"

_TOGETHER = {
    Together.REDUCED: "what rules remove is left out before the search; all reductions stay",
    Together.REQUIRED: "what rules remove is left out before the search, and what is required is one more "
    "goal; all reductions stay",
    Together.CUT: "the relevance cut stays, and bounds leave out what no better tree can have",
    Together.BOUNDED: "bounds leave out what no better tree can have; the relevance cut does not hold, since "
    "a rule may ask for units that lead to no goal",
    Together.PLAIN: "plain search over all units that can be made, since a rule looks beyond the tree: {}",
}


class Remark(Value, frozen=True):
    """A remark on a rule, and the file and line that it is about."""

    text: str
    file: str
    line: int


class ExplainedRule(Value, frozen=True):
    """A rule and its effect.

    Attributes:
        constraint: For a ready-made constraint with constants of its own, how it was named; null for others.
        kind: What it does to trees.
        one_of_a_set: Whether all that it requires is a unit of a set, or a unit of each of several sets.
        reason: Why nothing more is known of it, or why it has no effect; null for other rules.
        local: Whether it looks at nothing beyond the tree.
        looks_beyond: What it looks at beyond the tree; null if it is local.
    """

    text: str
    file: str
    line: int
    constraint: str | None
    kind: Kind
    one_of_a_set: bool
    reason: Remark | None
    local: bool
    looks_beyond: Remark | None

    @classmethod
    def of(cls, explained: ShownRule) -> "ExplainedRule":
        """Return an analysed rule as a value for the result."""
        rule, (file, line, *_) = explained.rule, explained.source
        reason = _remark(rule.reason, explained.reason_source)
        beyond = _remark(rule.nonlocality, explained.nonlocality_source)
        constraint_name = explained.use or None
        return cls(
            explained.text, file, line, constraint_name, rule.kind, rule.one_of, reason, rule.local, beyond
        )

    def lines(self, similar: int) -> Iterator[str]:
        """Yield lines with the place, text and effect of a rule, and whether it looks beyond the tree.

        For a helper rule and for a rule without effect, nothing is said of looking beyond the tree.
        ``similar`` is the number of further facts like this one, which are only counted.
        """
        yield str(Source(self.file, self.line))
        if self.constraint:
            yield f"  {self.constraint}"
        yield f"    {self.text}"
        if similar:
            yield f"    ... and {similar} more of these facts"
        if self.one_of_a_set:
            yield f"  {self.kind}: {_ASKS_FOR_ONE}"
        else:
            effect = _KINDS[self.kind] if self.reason is None else self._remark_text(self.reason)
            yield f"  {self.kind}: {effect}"
        if self.kind is Kind.HELPER or (self.reason is not None and self.kind is not Kind.OTHER):
            return
        if self.looks_beyond is None:
            yield "  local: it looks at nothing beyond the tree"
        else:
            yield f"  not local: {self._remark_text(self.looks_beyond)}"

    def _remark_text(self, remark: Remark) -> str:
        """Return a remark, with its file and line unless they are those of the rule."""
        in_same_place = (remark.file, remark.line) == (self.file, self.line)
        return remark.text + ("" if in_same_place else f" ({Source(remark.file, remark.line)})")

    @property
    def grouping_key(self) -> tuple[bool, str]:
        """The key by which facts are grouped: whether the rule is a fact, and its file and predicate.

        All rules that are no facts have the key ``(False, "")``.
        """
        is_fact = self.kind is Kind.HELPER and ":-" not in self.text
        return is_fact, f"{self.file} {self.text.partition('(')[0]}" if is_fact else ""


class ExplainedRules(Document, frozen=True, kw_only=True, tag=schema_name("rules")):
    """The effect of rules, one by one and together.

    Attributes:
        rules: Each rule, in order.
        together: Which reductions of the problem stay valid under all of them.
        meaning: ``together`` in words.
    """

    ROWS = "rules"

    rules: tuple[ExplainedRule, ...]
    together: Together
    meaning: str

    def show(self) -> Iterator[Block]:
        """Yield the effect of each rule, and of all rules together.

        Of similar facts that follow each other, the first is shown and the others are counted.
        """
        for (is_fact, _), group in groupby(self.rules, lambda rule: rule.grouping_key):
            alike = list(group)
            shown = [(alike[0], len(alike) - 1)] if is_fact else [(rule, 0) for rule in alike]
            for rule, similar in shown:
                yield from (*rule.lines(similar), "")
        yield f"together: {self.meaning}"


def explain_rules(
    constraints: Sequence[Constraint], constants: Sequence[str], reporter: Reporter
) -> ExplainedRules:
    """Return the effect of each rule, and of all rules together; warnings go to the ``reporter``.

    Raises :class:`UserError` where the built-in encodings were changed, so that nothing is known of rules.
    """
    settings = Settings(tuple(constraints), constants=tuple(constants))
    rules = assemble(settings, reporter.warning).understood
    if rules is None:
        raise UserError("the built-in encodings were changed, so nothing is known of rules beside them")
    nonlocal_rule = next(
        (str(explained.source) for explained in rules.shown_rules if not explained.rule.local), ""
    )
    return ExplainedRules(
        rules=tuple(map(ExplainedRule.of, rules.shown_rules)),
        together=rules.reductions_kept,
        meaning=_TOGETHER[rules.reductions_kept].format(nonlocal_rule),
    )


def _remark(text: str, source: Source | None) -> Remark | None:
    """Return a remark with the place that it is about; ``None`` without a place."""
    return None if source is None else Remark(text, source.file, source.line)
