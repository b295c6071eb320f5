"""One question asked of several goals, one after the other."""

from collections.abc import Iterator
from typing import Annotated, Any

from msgspec import Meta

from foon_asp.dataset.paths import File
from foon_asp.errors import UserError
from foon_asp.questions.result import Ending, NothingToDrawError, Result
from foon_asp.results.table import Part
from foon_asp.text.json_value import Json, schema_name

_ANY_DOCUMENT = Meta(
    extra_json_schema={
        "type": "object",
        "properties": {"schema": {"type": "string"}},
        "required": ["schema"],
    }
)


class Each(Result, frozen=True, kw_only=True, tag=schema_name("each")):
    """A question asked of several goals, each by itself.

    Attributes:
        answers: The documents of the question, one for each goal in order; their own schema says what they
            are.
    """

    answers: Annotated[tuple[Annotated[Any, _ANY_DOCUMENT], ...], Meta(min_length=2)]

    @property
    def ending(self) -> Ending:
        """Stopped at a limit if one was, and negative if one is."""
        endings = {result.ending for result in self.answers}
        return next(each for each in (Ending.LIMIT, Ending.NEGATIVE, Ending.DONE) if each in endings)

    def show(self) -> Iterator[Part]:
        """Return one after the other; goals that are made by the same tree have it once."""
        from foon_asp.questions.answer import Answer  # noqa: PLC0415 (takes the solver along)

        for number, (first, *others) in enumerate(self._same_trees()):
            if number:
                yield ""
            if isinstance(first, Answer):
                yield from (line for answer in (first, *others) for line in answer.goal_lines())
                yield from first.findings()
            else:
                yield from first.show()

    def _same_trees(self) -> list[list[Any]]:
        """Return the answers in groups: those with one tree, and others alone."""
        from foon_asp.questions.answer import Answer  # noqa: PLC0415

        groups: dict[object, list[Any]] = {}
        for number, answer in enumerate(self.answers):
            ids = answer.ids if isinstance(answer, Answer) else None
            groups.setdefault(frozenset(ids) if ids else number, []).append(answer)
        return list(groups.values())

    def table_rows(self) -> Iterator[Json]:
        """Return the rows of all answers, each behind its goals."""
        for answer in self.answers:
            goals = " + ".join(map(str, answer.goals))
            yield from ({"goals": goals, **row} for row in answer.table_rows())

    def foon(self) -> str:
        """Return one tree after the other."""
        return "".join(answer.foon() for answer in self.answers)

    def steps(self) -> str:
        """Refuse: a program has to know which goal it works for."""
        raise UserError("these are steps for several goals: name one with --goal")

    def remark(self, format_: str) -> str:
        """Return what a format cannot tell, goal by goal."""
        return "\n".join(filter(None, (answer.remark(format_) for answer in self.answers)))

    def write_chart(self, file: File) -> None:
        """Refuse: a chart is of one goal."""
        raise NothingToDrawError("a chart is of one goal: name it with --goal")
