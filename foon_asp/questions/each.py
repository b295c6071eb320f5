"""One question asked of several goals, one after the other."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from foon_asp.dataset.paths import File
from foon_asp.document.json_document import document
from foon_asp.errors import UserError
from foon_asp.questions.result import Document, Ending, NothingToDrawError, Result
from foon_asp.results.table import Part, rendered


@dataclass(frozen=True, repr=False)
class Each(Result):
    """The ``results`` of a question that was asked of each goal by itself, in the order of the goals."""

    results: Sequence[Result]

    @property
    def ending(self) -> Ending:
        """Stopped at a limit if one was, and negative if one is."""
        endings = {result.ending for result in self.results}
        return next(each for each in (Ending.LIMIT, Ending.NEGATIVE, Ending.DONE) if each in endings)

    def text(self, **how: object) -> str:
        """Return one text after the other; goals that are made by the same tree have one."""
        return rendered(self.show(**how))

    def show(self, **how: object) -> Iterator[Part]:
        """Return the same as lines and tables."""
        from foon_asp.questions.answer import Answer  # noqa: PLC0415 (takes the solver along)

        for number, group in enumerate(self._same_trees()):
            if number:
                yield ""
            first = group[0]
            if isinstance(first, Answer):
                yield from (
                    line for answer in group if isinstance(answer, Answer) for line in answer.goal_lines()
                )
                yield from first.findings()
            elif isinstance(first, Document):
                yield from first.show(**how)
            else:
                yield first.text(**how).rstrip("\n")

    def _same_trees(self) -> list[list[Result]]:
        """Return the results in groups: answers with one tree, and others alone."""
        from foon_asp.questions.answer import Answer  # noqa: PLC0415

        groups: dict[object, list[Result]] = {}
        for number, result in enumerate(self.results):
            ids = result.ids if isinstance(result, Answer) else None
            groups.setdefault(frozenset(ids) if ids else number, []).append(result)
        return list(groups.values())

    def json_dict(self) -> object:
        """Give all documents in one."""
        return document("each", answers=[result.json_dict() for result in self.results])

    def foon(self) -> str:
        """Give one tree after the other."""
        return "".join(result.foon() for result in self.results)

    def steps(self) -> str:
        """Refuse: a program has to know which goal it works for."""
        raise UserError("these are steps for several goals: name one with --goal")

    def remark(self, format_: str) -> str:
        """Give what a format cannot tell, goal by goal."""
        return "\n".join(filter(None, (result.remark(format_) for result in self.results)))

    def write_chart(self, file: File) -> None:
        """Refuse: a chart is of one goal."""
        raise NothingToDrawError("a chart is of one goal: name it with --goal")
