"""What the options say that all questions around the optimum share."""

import functools
from collections.abc import Callable, Sequence
from functools import cached_property
from pathlib import Path

from foon_asp.asp import Settings
from foon_asp.cli import options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.dataset import Dataset
from foon_asp.deadline import Deadline
from foon_asp.problem import Objective, Problem, parse_objectives

Option = Callable[[Callable[..., ExitCode]], Callable[..., ExitCode]]
_HOW = ("goals_named", "objectives", "containers", "constraints", "encodings", "constants", "deadline")
_DATA = ("folder", "network", "kitchen", "rates", "utensils", "goals", "lenient", "level")
_SHARED = {*_HOW, "format_", *_DATA}


class Asked:
    """The data, the goals in it, and how to solve; the data is read when something of it is looked at.

    ``format_`` is ``text`` or ``json``.
    """

    def __init__(
        self,
        goals_named: tuple[str, ...],
        containers: str,
        constraints: tuple[Path, ...],
        encodings: Path | None,
        constants: tuple[str, ...],
        deadline: Deadline,
        format_: str,
        objectives: tuple[str, ...] = ("units",),
        **data: object,
    ) -> None:
        self.format_ = format_
        self.objectives: tuple[Objective, ...] = parse_objectives(objectives)
        self.settings = Settings(
            constraints, encodings, constants, session=options.session_here(), deadline=deadline
        )
        self._names, self._containers = goals_named, containers
        self._data = data

    @property
    def by_users_rules(self) -> bool:
        """Whether rules of the user's have a say, which may ask for units that no goal needs."""
        return bool(self.settings.constraints or self.settings.replaced)

    @cached_property
    def dataset(self) -> Dataset:
        """The data."""
        return options.read_dataset(**self._data)  # type: ignore[arg-type]

    @cached_property
    def goals(self) -> Sequence[int]:
        """The goals that are named."""
        return self.dataset.goals(self._names)

    def problem(self, everything: bool = False) -> Problem:
        """Ask for the goals; with ``everything``, and under rules of the user's, all units are there."""
        dataset = self.dataset
        with options.reading():
            return dataset.problem(self.goals, self._containers, everything or self.by_users_rules)


def asking(*own: Option, objective: Option | None = options.objective_option) -> Option:
    """Give a verb the options that questions share, as one :class:`Asked`, and its ``own`` among them.

    ``objective`` is the option for objectives, ``None`` for a verb without.
    """

    def decorate(command: Callable[..., ExitCode]) -> Callable[..., ExitCode]:
        @functools.wraps(command)
        def asked(**given: object) -> ExitCode:
            shared = {name: value for name, value in given.items() if name in _SHARED}
            mine = {name: value for name, value in given.items() if name not in _SHARED}
            return command(Asked(**shared), **mine)  # type: ignore[arg-type]

        wrapped: Callable[..., ExitCode] = asked
        added: tuple[Option, ...] = (
            options.goal_option,
            *([objective] if objective else []),
            options.containers_option,
            *own,
            options.constraint_options,
            options.constant_option,
            options.limit_options,
            options.format_option("text", "json"),
            options.data_options,
        )
        for option in reversed(added):
            wrapped = option(wrapped)
        return wrapped

    return decorate
