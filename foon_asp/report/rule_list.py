"""What rules do, one by one, and what that means together: for people and for programs."""

import textwrap
from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby

from foon_asp.document.json_document import document
from foon_asp.network import Source
from foon_asp.rules.rule_kind import Kind
from foon_asp.rules.rules import Rules, Together, Told
from foon_asp.text.json_value import Json

_WIDTH = 60

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
    Together.PLAIN: "plain search over all units that can be made, since {}",
}


def rules_text(rules: Rules) -> str:
    """Give of each rule its text, its place, what it does and how far it sees, and then what follows."""
    blocks = ["\n".join(_rule_lines(told, more)) for told, more in _without_facts_alike(rules.told)]
    blocks.append("\n".join(_wrapped(f"together: {_together(rules)}")))
    return "\n\n".join(blocks) + "\n"


def _without_facts_alike(rules: Iterable[Told]) -> Iterator[tuple[Told, int]]:
    """Give rules without those facts that follow one of the same predicate, and how many each stands for."""
    for (alike, _), group in groupby(rules, _likeness):
        together = list(group)
        yield from [(together[0], len(together) - 1)] if alike else [(told, 0) for told in together]


def _likeness(told: Told) -> tuple[bool, str]:
    is_fact = told.rule.kind is Kind.HELPER and ":-" not in told.text
    return is_fact, f"{told.source.file} {told.text.partition('(')[0]}" if is_fact else ""


def _rule_lines(told: Told, more: int) -> Iterator[str]:
    rule = told.rule
    yield str(told.source)
    if told.use:
        yield f"  {told.use}"
    yield from _wrapped(told.text, "    ")
    if more:
        yield f"    ... and {more} more of these facts"
    says = _ASKS_FOR_ONE if rule.one_of else rule.reason or _KINDS[rule.kind]
    yield from _wrapped(f"{rule.kind}: {says}{_elsewhere(told, told.reason_source)}", "  ")
    if rule.kind is Kind.HELPER or rule.without_effect:
        return
    if rule.local:
        yield "  local: it looks at nothing beyond the tree"
    else:
        yield from _wrapped(f"not local: {rule.further}{_elsewhere(told, told.further_source)}", "  ")


def _elsewhere(told: Told, source: Source | None) -> str:
    return "" if source is None or source == told.source else f" ({source})"


def _together(rules: Rules) -> str:
    why = ""
    if rules.together is Together.PLAIN:
        far = next(told for told in rules.told if not told.rule.local)
        why = f"a rule looks beyond the tree: {far.source}"
    return _TOGETHER[rules.together].format(why)


def _wrapped(text: str, indent: str = "") -> Sequence[str]:
    return textwrap.wrap(
        text,
        _WIDTH,
        initial_indent=indent,
        subsequent_indent=indent if indent == "  " else f"{indent}  ",
        break_long_words=False,
        break_on_hyphens=False,
    )


def rules_json(rules: Rules) -> Json:
    """Give each rule with what is known of it, and what that means together."""
    return document(
        "constraints",
        rules=list(map(_rule_json, rules.told)),
        together=str(rules.together),
        meaning=_together(rules),
    )


def _rule_json(told: Told) -> Json:
    rule = told.rule
    return {
        "text": told.text,
        **_place_json(told.source),
        "constraint": told.use or None,
        "kind": str(rule.kind),
        "one_of_a_set": rule.one_of,
        "reason": _reason_json(rule.reason, told.reason_source),
        "local": rule.local,
        "looks_beyond": _reason_json(rule.further, told.further_source),
    }


def _reason_json(text: str, source: Source | None) -> Json | None:
    return None if source is None else {"text": text, **_place_json(source)}


def _place_json(source: Source) -> Json:
    return {"file": source.file, "line": source.line}
