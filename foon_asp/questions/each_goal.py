"""One question asked of several goals, one after the other."""

from collections.abc import Iterator
from typing import Annotated, Any, NoReturn

from msgspec import Meta

from foon_asp.dataset.paths import File
from foon_asp.errors import UserError
from foon_asp.json_layout import Json, schema_name
from foon_asp.questions.ending import Ending
from foon_asp.questions.result import NothingToDrawError, Result
from foon_asp.results.table import Block

_ANY_DOCUMENT = Meta(
    extra_json_schema={
        "type": "object",
        "properties": {"schema": {"type": "string"}},
        "required": ["schema"],
    }
)


class EachGoal(Result, frozen=True, kw_only=True, tag=schema_name("each")):
    """A question asked of several goals, each by itself.

    Attributes:
        answers: The documents of the question, one for each goal in order; each names its own schema.
    """

    answers: Annotated[tuple[Annotated[Any, _ANY_DOCUMENT], ...], Meta(min_length=2)]

    @property
    def ending(self) -> Ending:
        """``LIMIT`` if any answer stopped at a limit, else ``NEGATIVE`` if any is negative, else ``DONE``."""
        endings = {result.ending for result in self.answers}
        return next(ending for ending in (Ending.LIMIT, Ending.NEGATIVE, Ending.DONE) if ending in endings)

    def show(self) -> Iterator[Block]:
        """Yield the answers one after the other; answers with the same tree are shown together."""
        from foon_asp.questions.answer import Answer  # noqa: PLC0415 (takes the solver along)

        for number, (first, *others) in enumerate(self._groups_by_tree()):
            if number:
                yield ""
            if isinstance(first, Answer):
                yield from (line for answer in (first, *others) for line in answer.goal_lines())
                yield from first.findings()
            else:
                yield from first.show()

    def _groups_by_tree(self) -> list[list[Any]]:
        """Return the answers in groups whose trees have the same units, in order of their first answers.

        An answer without a step, and an answer to another question than ``solve``, is a group by itself.
        """
        from foon_asp.questions.answer import Answer  # noqa: PLC0415

        groups: dict[object, list[Any]] = {}
        for number, answer in enumerate(self.answers):
            ids = answer.ids if isinstance(answer, Answer) else None
            groups.setdefault(frozenset(ids) if ids else number, []).append(answer)
        return list(groups.values())

    def table_rows(self) -> Iterator[Json]:
        """Yield the rows of all answers, each with the goals of its answer as the first column."""
        for answer in self.answers:
            goals = " + ".join(map(str, answer.goals))
            yield from ({"goals": goals, **row} for row in answer.table_rows())

    def foon(self) -> str:
        """Return the trees of all answers as FOON text, one after the other."""
        return "".join(answer.foon() for answer in self.answers)

    def robot_plan(self) -> NoReturn:
        """Raise :class:`UserError`: a robot's plan is for one goal."""
        raise UserError("these are steps for several goals: name one with --goal")

    def remark(self, format_: str) -> str:
        """Return remarks on what a format cannot hold, answer by answer."""
        return "\n".join(filter(None, (answer.remark(format_) for answer in self.answers)))

    def write_chart(self, file: File) -> None:
        """Raise :class:`NothingToDrawError`: a chart is of one goal."""
        raise NothingToDrawError("a chart is of one goal: name it with --goal")
