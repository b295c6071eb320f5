"""Provably optimal task trees for FOON, by answer set programming.

>>> import foon_asp
>>> foon = foon_asp.load("data/kitchen")
>>> problem = foon.problem("ice")
>>> answer = foon_asp.solve(problem, "success")
>>> str(answer.status), answer.costs.units
('optimal', 3)

docs/api.md has a function for each question, with examples.
"""

__version__ = "0.1.0"

# The modules of all public names except questions; each is imported at the first access to one of its names.
_ROOMS = {
    "questions.all_goals": ("Optima", "solve_all_goals"),
    "questions.answer": ("Answer",),
    "questions.clash": ("Clash",),
    "questions.lint": ("Linted", "lint"),
    "questions.merge": ("Merged", "merge"),
    "foon": ("Foon", "build", "load"),
    "questions.repair": ("Repaired", "repair"),
    "questions.search": ("Retrieved", "search"),
    "questions.export": ("to_unified_planning",),
    "questions.tree": ("Tree",),
    "questions.ways_on": ("WaysOn", "ways_on"),
    "questions.unit_union": ("UnitUnion", "unit_union"),
    "asp": ("Outcome", "Reporter", "Status"),
    "deadline": ("Cancel", "StoppedError"),
    "errors": ("BugError", "FoonWarning", "UserError"),
    "network": ("FunctionalUnit", "Network", "NetworkBuilder", "ObjectNode", "Source", "TaskTree"),
    "network.stand_in_table": ("StandInTable",),
    "planning.py_trees_root": ("Execution", "py_trees_root"),
    "planning.unified": ("register_engine",),
    "problem": ("ContainerRule", "Costs", "Fate", "Objective", "Problem", "UsedUp"),
    "problem.progress": ("Progress",),
    "proof.simulation": ("Simulation", "Verdict"),
    "proof.refusal": ("RefusedError",),
    "results.timed_step": ("TimedStep", "Tool"),
    "text.tables": ("Duration",),
    "text.line_parser": ("parse_node",),
    "text.reader": ("FoonReader",),
    "text.writer": ("write_units",),
}
_names: dict[str, str] = {}  # the modules of all public names, filled at the first access


def modules_of_names() -> dict[str, str]:
    """Return the module of each public name, relative to this package: ``questions.answer`` for ``Answer``.

    The dictionary is made at the first call, and shared by all callers.
    """
    if not _names:
        from foon_asp.questions.index import INDEX, module_name  # noqa: PLC0415 (importing it delays ctrl-C)

        modules = {name: room for room, names in _ROOMS.items() for name in names}
        for verb, entry in INDEX.items():
            modules |= dict.fromkeys(entry.python, f"questions.{module_name(verb)}")
        _names.update(modules)  # in one operation: an interrupt leaves it empty or complete
    return _names


def __getattr__(name: str) -> object:
    """Return the object with a public name, after importing its module.

    For ``__all__``, return the public names. Raises ``AttributeError`` for any other name.
    """
    if name == "__all__":
        return [*modules_of_names()]
    if name not in modules_of_names():
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    import importlib  # noqa: PLC0415

    return getattr(importlib.import_module(f"foon_asp.{modules_of_names()[name]}"), name)


def __dir__() -> list[str]:
    """Return the public names, for completion."""
    return [*modules_of_names(), "__version__"]
