"""What callers write, turned into what the rooms take; faults are said in the words of Python."""

from collections.abc import Iterable, Mapping
from decimal import Decimal
from fractions import Fraction
from os import PathLike
from pathlib import Path

from foon_asp.asp import Settings
from foon_asp.asp.program import find_constraint
from foon_asp.asp.soft import GREATEST_WEIGHT
from foon_asp.deadline import memory_size, seconds
from foon_asp.errors import UserError
from foon_asp.problem import ContainerRule, Objective, Problem, parse_objectives

File = str | PathLike[str]
"""A path; for a constraint also the name of one of ours, such as ``forbid_motion``."""

Files = File | Iterable[File]
Objectives = str | Iterable[str]
"""An objective, a list by commas, or several: the first counts most."""

Constants = Mapping[str, object]
"""Values of ``#const`` by name."""

Number = int | str | float | Decimal | Fraction
"""An exact number; a float is taken as it is printed, so 0.9 is nine tenths."""


def chosen_objectives(problem: Problem, given: Objectives) -> tuple[Objective, ...]:
    """Read objectives; ``success`` needs rates."""
    objectives = parse_objectives([given] if isinstance(given, str) else given)
    if Objective.SUCCESS in objectives and problem.rates is None:
        raise UserError("the objective success needs the success rates of the motions: load(..., rates=FILE)")
    return objectives


def container_rule(given: str) -> ContainerRule:
    """Read the name of a container rule."""
    try:
        return ContainerRule(given)
    except ValueError:
        raise UserError(
            f"found the containers {given!r}, expected one of {', '.join(ContainerRule)}"
        ) from None


def settings(
    constraints: Files = (),
    constants: Constants | None = None,
    encodings: File | None = None,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
) -> Settings:
    """Put together how to solve; ``time_limit`` is in seconds, ``memory_limit`` in bytes or as ``"2G"``."""
    return Settings(
        files(constraints),
        None if encodings is None else Path(encodings),
        tuple(f"{name}={value}" for name, value in (constants or {}).items()),
        time_limit=None if time_limit is None else seconds(time_limit),
        memory_limit=None if memory_limit is None else memory_size(memory_limit),
    )


def files(given: Files) -> tuple[Path, ...]:
    """Read one path or several."""
    one = isinstance(given, str | PathLike)
    return tuple(map(Path, [given] if one else given))  # type: ignore[arg-type]


def file_weights(given: Mapping[File, int]) -> dict[Path, int]:
    """Read the weights of constraint files, whole numbers from 1."""
    weights: dict[Path, int] = {}
    for name, weight in given.items():
        if not isinstance(weight, int) or not 1 <= weight <= GREATEST_WEIGHT:
            raise UserError(
                f"found the weight {weight!r} of {name}, expected a whole number from 1 to {GREATEST_WEIGHT}"
            )
        file = find_constraint(Path(name))
        if file in weights:
            raise UserError(f"{name} has two weights")
        weights[file] = weight
    return weights


def exact(given: Number, what: str) -> Fraction:
    """Read an exact number."""
    try:
        return Fraction(repr(given) if isinstance(given, float) else given)
    except (ValueError, ZeroDivisionError, OverflowError):
        raise UserError(f"found {given!r} for {what}, expected a number such as '0.85'") from None


def success_rate(given: Number, what: str) -> Fraction:
    """Read an exact success rate."""
    rate = exact(given, what)
    if not 0 < rate <= 1:
        raise UserError(f"found {given} for {what}, expected a number above 0 and at most 1")
    return rate


def at_least(number: int, least: int, what: str) -> int:
    """Hold that a number is large enough."""
    if number < least:
        raise UserError(f"found {what}={number}, expected a whole number from {least}")
    return number
