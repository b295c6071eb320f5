"""Assembling a program: the built-in encodings or a replacement, and what the user adds."""

import hashlib
from collections.abc import Callable, Sequence
from enum import Enum, auto
from pathlib import Path
from typing import TYPE_CHECKING

from foon_asp.asp.program import Program
from foon_asp.asp.settings import Settings
from foon_asp.encoding.own_encodings import ENCODING_FILES, USED_UP, exact_success, is_own
from foon_asp.errors import UserError
from foon_asp.grounding.stated import Loaded, Stated
from foon_asp.problem import Problem
from foon_asp.resources import encodings_folder
from foon_asp.rules.constraint import Constraint, LibraryUse, find_constraint
from foon_asp.text.json_value import json_line

if TYPE_CHECKING:  # clingo, which is not needed where no rule is added
    from foon_asp.encoding.encoding import Encoding
    from foon_asp.rules.ready_made import ReadyMade
    from foon_asp.rules.rules import Rules

# Core-guided search with shrunk cores did best on every objective measured; see docs/dev/measured.md.
SHRINKING = "--opt-usc-shrink=min"
CLINGO_OPTIONS = ("--opt-strategy=usc,oll,4", SHRINKING)

_SMALL = 10_000  # units, to look through which takes less time than to import clingo

GREATEST_WEIGHT = 1_000_000  # of a constraint that may be broken or dropped

# Options that would change what an answer means, or whether it is a proof; the solver sets them itself.
_RESERVED = (
    "--const",
    "--enum-mode",
    "--help",
    "--mode",
    "--models",
    "--number",
    "--opt-mode",
    "--opt-stop",
    "--outf",
    "--project",
    "--supp-models",
    "--text",
    "--version",
    "--warn",  # what clingo leaves out, it says so in a warning
)

# Facts that are there where rates are known, and of costs by what is asked.
_OF_SOME_QUESTIONS = {("rate", 2), ("risk", 2), ("cost", 3)}


def assemble(
    settings: Settings,
    warn: Callable[[str], None],
    used_up: bool = False,
    problem: Problem | None = None,
) -> Program:
    """Find and check the encodings that the settings ask for.

    ``used_up`` asks for those of plans in which items are used up. ``problem`` is the question, whose network
    has the names that rules look for: what nothing in it matches is warned of.
    Raises :class:`UserError` for files that are missing or at fault, for ``#script``, for constants that
    no encoding has and for clingo options that would change what an answer means.
    """
    ours = encodings_folder() / USED_UP if used_up else encodings_folder()
    folder = _find_encodings(settings.encodings, ours)
    base = tuple(folder / name if (folder / name).is_file() else ours / name for name in ENCODING_FILES)
    added = tuple(dict.fromkeys(map(find_constraint, settings.constraints)))
    relaxed, bounded = settings.relaxed, settings.bounded
    kept, rules = added, ""
    questions: tuple[Path, ...] = ()
    if relaxed is not None:
        kept = tuple(each for each in added if each not in relaxed.constraints)
        added = tuple(dict.fromkeys((*added, *relaxed.constraints)))
        questions = (relaxed.encoding,)
        rules = relaxed.rules
    if bounded is not None:
        questions += bounded.files
        rules += bounded.rules
    looked_at: frozenset[tuple[str, int]] = frozenset()
    text, named = "", frozenset[str]()
    understood: Rules | None = None
    replaced = not all(map(is_own, base))
    endless = replaced or not all(map(_is_own, added))
    files: dict[Constraint, Loaded] = {}
    extra, theirs, constants = list["Encoding"](), list["Encoding"](), list[str]()
    encodings = folder if settings.encodings is None and replaced else settings.encodings
    if added or encodings or settings.constants:
        # parsing takes some milliseconds, so it is left out for what every file of ours agrees with
        from foon_asp.encoding import encoding  # noqa: PLC0415
        from foon_asp.rules import stating  # noqa: PLC0415

        if endless:
            from foon_asp.grounding.worker_process import prepare  # noqa: PLC0415

            prepare()  # while files are parsed

        parsed = [encoding.read_encoding(file) for file in base if endless]
        asked = [encoding.read_encoding(file) for file in questions]
        files = stating.loaded(added)
        extra = [encoding.read_encoding(files[each]) for each in added]
        faults = map(str, encoding.check_encodings(extra, parsed, asked))
        for message in (*faults, *encoding.unset_constants(extra, settings.constants)):
            warn(message)
        constants = encoding.constant_arguments(settings.constants, [*parsed, *extra])
        theirs = [*extra, *(each for file, each in zip(base, parsed, strict=False) if not is_own(file))]
        looked_at = frozenset(signature for each in theirs for signature in each.used)
        named = frozenset(name for each in (*parsed, *extra) for name in each.constants)
        text = "\n".join(each.text for each in (*parsed, *asked, *extra))
        if extra and not encodings and relaxed is None:
            from foon_asp.rules import rules as user_rules  # noqa: PLC0415

            understood = user_rules.Rules(extra, constants[1::2])
    _warn_of_names(problem, settings, extra, constants[1::2], warn)
    arguments = (*constants, *_clingo_options(settings.clingo_options))
    if settings.clingo_options:  # looked at now, since clingo may have nothing to do
        from foon_asp.encoding.search import check  # noqa: PLC0415

        check(arguments)
    return Program(
        (*base, *(files[each] for each in kept), *questions, *_checks(theirs)),
        exact_success(),
        arguments,
        replaced=replaced,
        own=not added and encodings is None,
        rules=rules,
        bounded=bounded is not None,
        looked_at=looked_at,
        text=text,
        endless=endless,
        constants=tuple(constants),
        encodings=encodings,
        ours=(*base, *questions),
        understood=understood,
        named=named,
        reads=_reads([each for each in theirs if each.rules not in base]),
    )


def program_of(problem: Problem, settings: Settings, warn: Callable[[str], None]) -> Program:
    """Assemble the encodings of a question as :func:`assemble` does, without clingo where that can be."""
    return ready_made(problem, settings, warn) or assemble(settings, warn, problem=problem)


def ready_made(problem: Problem, settings: Settings, warn: Callable[[str], None]) -> Program | None:
    """Return the program of a small question, or to a store, whose rules are all ready-made, without clingo.

    ``None`` for other questions.
    """
    rules = _known(settings)
    if rules is None or problem.items is not None:
        return None
    from foon_asp.rules.fact_values import FactValues  # noqa: PLC0415 (only of use with constraints)
    from foon_asp.rules.parameter_names import unknown_parameters  # noqa: PLC0415

    network = problem.network  # to read a part of a store takes longer than to look through it
    if (len(network) > _SMALL and not network.object_numbers) or not rules.fit(problem):
        return None
    for message in unknown_parameters(settings.constraints, settings.constants, FactValues(problem)):
        warn(message)
    plain = assemble(settings._replace(constraints=(), constants=()), warn, problem=problem)
    constants = [word for setting in rules.constants.items() for word in ("-c", "=".join(setting))]
    whole = plain._replace(
        files=(*plain.files, *rules.files),
        arguments=(*constants, *plain.arguments),
        own=False,
        looked_at=rules.looked_at,
    )
    return plain._replace(own=False, ready_made=rules, whole=whole)


def _warn_of_names(
    problem: Problem | None,
    settings: Settings,
    added: "Sequence[Encoding]",
    constants: Sequence[str],
    warn: Callable[[str], None],
) -> None:
    """Warn of names in rules, measures and parameters that nothing in the network of a problem has."""
    if problem is None or not (added or problem.measures):
        return
    from foon_asp.encoding.encoding import read_encoding  # noqa: PLC0415 (which takes clingo along)
    from foon_asp.rules.fact_values import FactValues  # noqa: PLC0415 (only of use with constraints)
    from foon_asp.rules.unmatched import unmatched  # noqa: PLC0415

    values = FactValues(problem)
    theirs = [each for each in added if not _is_ours(each)]
    ours = [each for each in added if _is_ours(each)]
    if ours:
        from foon_asp.rules.parameter_names import unknown_parameters  # noqa: PLC0415

        relaxed = settings.relaxed.constraints if settings.relaxed is not None else ()
        for message in unknown_parameters((*settings.constraints, *relaxed), settings.constants, values):
            warn(message)
    for diagnostic in unmatched(theirs, ours, constants, values):
        warn(str(diagnostic))
    for place, text in {(each.place, each.text): None for each in problem.measures.values()}:
        for diagnostic in unmatched([read_encoding(Stated(place, text))], [], (), values):
            warn(str(diagnostic))


def _is_ours(encoding: "Encoding") -> bool:
    rules = encoding.rules
    file = rules.file if isinstance(rules, Stated) else rules
    return file is not None and is_own(file)


def _known(settings: Settings) -> "ReadyMade | None":
    """Return the rules that are added where all are ready-made constraints; ``None`` for others."""
    if not settings.constraints or not settings.reductions or settings.replaced is not None:
        return None
    if settings.relaxed is not None or settings.bounded is not None:
        return None
    from foon_asp.rules.ready_made import ready_made as known  # noqa: PLC0415 (only of use with constraints)

    return known(settings.constraints, settings.constants)


def _reads(encodings: "Sequence[Encoding]") -> frozenset[tuple[str, str]]:
    """Give what rules of the user's own read and not every question has facts of, with the first argument."""
    found: set[tuple[str, str]] = set()
    for encoding in encodings:
        if not _is_ours(encoding) and not _OF_SOME_QUESTIONS.isdisjoint(encoding.used):
            found.update(encoding.first_names(_OF_SOME_QUESTIONS))
    return frozenset(found)


def _checks(encodings: "Sequence[Encoding]") -> list[Stated]:
    """Return what finds numbers beyond clingo's in encodings of the user."""
    if not encodings:
        return []
    from foon_asp.grounding.number_checks import PLACE  # noqa: PLC0415
    from foon_asp.rules.number_limits import number_checks  # noqa: PLC0415

    found = number_checks(statement for each in encodings for statement in each.statements)
    return [Stated(PLACE, found)] if found else []


def _understood(settings: Settings) -> "Rules | None":
    """Return the rules that are added, as far as they are understood; raises as :func:`assemble` does."""
    return assemble(settings, lambda _: None).understood


class ReachOfRules(Enum):
    """Which units rules are about, beside those of a tree: ``NEEDED`` ones, which lead to a goal.

    Under ``TREE`` they look at no others than those of the tree, and may ask for units that no goal needs.
    """

    NEEDED = auto()
    TREE = auto()
    ALL = auto()


def reach_of_rules(settings: Settings) -> ReachOfRules:
    """Return which units the rules that are added are about; raises as :func:`assemble` does."""
    rules = _known(settings) or _understood(settings)
    if rules is None or not rules.local:
        return ReachOfRules.ALL
    return ReachOfRules.NEEDED if rules.shrinking else ReachOfRules.TREE


def hold_for_parts(settings: Settings) -> bool:
    """Whether any part of a tree that keeps to the rules that are added keeps to them, too.

    Also where there are no units but those of a part of the network, and where more is available, which they
    do not see in the kitchen. Raises as :func:`assemble` does.
    """
    if settings.replaced is not None:
        return False
    rules = _known(settings) or varying_available(settings)
    if rules is None:
        return not settings.constraints
    return rules.local and rules.shrinking


def leave_a_rest(settings: Settings) -> bool:
    """Whether rules that are added say more than which units there are; raises as :func:`assemble` does."""
    rules = _known(settings) or _understood(settings)
    return rules is not None and bool(rules.rest)


def varying_available(settings: Settings) -> "Rules | None":
    """Return the rules that are added, for questions where more is available; raises as above."""
    rules = _understood(settings)
    return None if rules is None else rules.varying({("available", 1)})


def asks_of_all(problem: Problem, settings: Settings) -> bool:
    """Whether rules that are added may be about units beyond what the goals can need.

    Of a store, the part that the goals can need is enough where no rule looks beyond the tree or asks for
    units that no goal needs.
    """
    if not settings.constraints and settings.replaced is None:
        return False
    part = problem.network.object_numbers and problem.items is None and settings.replaced is None
    return not part or reach_of_rules(settings) is not ReachOfRules.NEEDED


def rules_digest(
    settings: Settings, warn: Callable[[str], None] = lambda _: None, problem: Problem | None = None
) -> dict[str, str]:
    """Return a digest of the rules that are added, if there are any, under ``rules``.

    Rows of results have it in common. Warns and raises as :func:`assemble` does.
    """
    if not (settings.constraints or settings.constants or settings.encodings):
        return {}
    program = assemble(settings, warn, problem=problem)
    said = json_line([program.text, program.constants])
    return {"rules": hashlib.sha256(said.encode()).hexdigest()[:16]}


def _find_encodings(path: Path | None, ours: Path) -> Path:
    """Return a folder of encodings: the path itself, or a built-in one by name (``by_need``)."""
    if path is None:
        return ours
    folder = ours / path.name if not path.is_dir() and path.name == str(path) else path
    if any((folder / name).is_file() for name in ENCODING_FILES):
        return folder
    names = ", ".join(ENCODING_FILES)
    raise UserError(f"{path}: expected a folder with encodings to use instead of the built-in ones: {names}")


def _is_own(constraint: Constraint) -> bool:
    """Whether a constraint says what a ready-made one does, under whichever constants."""
    file = constraint.file if isinstance(constraint, LibraryUse) else constraint
    return isinstance(file, Path) and is_own(file)


def _clingo_options(options: tuple[str, ...]) -> tuple[str, ...]:
    """Check the user's options, which replace ours of the same name."""
    names = [option.partition("=")[0] for option in options]
    for option, name in zip(options, names, strict=True):
        if not (name.startswith("--") and len(name) > 2) and not name.startswith("-t"):
            raise UserError(f"found {option!r} after --, expected options of clingo, --NAME=VALUE")
        if any(reserved.startswith(name) for reserved in _RESERVED):
            raise UserError(f"the option {option!r} would change what an answer means, so it cannot be set")
    return (*(ours for ours in CLINGO_OPTIONS if ours.partition("=")[0] not in names), *options)
