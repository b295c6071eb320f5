"""An answer with additional lines about its proof."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

from foon_asp.questions.result import Ending, Result
from foon_asp.report.drawing import Drawing
from foon_asp.text.json_value import Json

A = TypeVar("A", bound=Result)


@dataclass(frozen=True, repr=False)
class AnswerAndMore(Result, Generic[A]):
    """An ``answer``, and additional lines about it."""

    answer: A

    def __bool__(self) -> bool:
        """Whether there is a tree."""
        return bool(self.answer)

    def lines(self) -> Sequence[str]:
        """Give the additional lines."""
        raise NotImplementedError

    @property
    def ending(self) -> Ending:
        """Done when the tree is proved to be the best."""
        return self.answer.ending

    def text(self) -> str:
        """Give the answer, and the additional lines."""
        return self.answer.text() + "".join(f"{line}\n" for line in self.lines())

    def json_dict(self) -> Json:
        """Give the answer."""
        found = self.answer.json_dict()
        assert isinstance(found, dict)
        return found

    def foon(self) -> str:
        """Give the tree as FOON text; empty where there is none."""
        return self.answer.foon()

    def steps(self) -> str:
        """Give the plan for a robot's program, as JSON; empty where there is none."""
        return self.answer.steps()

    def remark(self, format_: str) -> str:
        """Give what a format cannot tell, and the additional lines."""
        said = self.answer.remark(format_)
        return "\n".join([*([said] if said else []), *self.lines()])

    def drawing(self) -> Drawing | None:
        """Give what the picture shows."""
        return self.answer.drawing()
