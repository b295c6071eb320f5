"""Assembly of a program: the built-in encodings or a replacement, and user rules."""

import hashlib
from collections.abc import Callable, Sequence
from enum import Enum, auto
from pathlib import Path
from typing import TYPE_CHECKING

from foon_asp.asp.program import Program
from foon_asp.asp.search_tuning import SEARCH
from foon_asp.asp.settings import Settings
from foon_asp.encoding.own_encodings import ENCODING_FILES, USED_UP, exact_success, is_own
from foon_asp.encoding.stated import Loaded, Stated
from foon_asp.errors import UserError
from foon_asp.problem import Problem
from foon_asp.resources import encodings_folder
from foon_asp.rules.passed_constraint import Constraint, LibraryUse, find_constraint
from foon_asp.text.json_value import json_line

if TYPE_CHECKING:  # clingo, which is not needed where no rule is added
    from foon_asp.encoding.encoding import Encoding
    from foon_asp.rules.ready_made import ReadyMade
    from foon_asp.rules.rules import Rules

# Core-guided search with shrunk cores did best on every objective measured; see docs/dev/measured.md.
SHRINKING = "--opt-usc-shrink=min"
CLINGO_OPTIONS = ("--opt-strategy=usc,oll,4", SHRINKING)

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

# Facts that exist only where rates are known, or for the objectives of the question.
_OF_SOME_QUESTIONS = {("rate", 2), ("risk", 2), ("cost", 3)}


def assemble(
    settings: Settings,
    warn: Callable[[str], None],
    used_up: bool = False,
    problem: Problem | None = None,
) -> Program:
    """Find, read and check the encodings and constraints of settings, and return them as a program.

    With ``used_up``, the encodings are those of plans in which items are used up. ``warn`` receives warnings;
    with a ``problem``, also about names in rules that do not occur in its network. Raises :class:`UserError`
    for files that are missing or at fault, for ``#script``, for constants that no encoding has and for clingo
    options that would change what an answer means.
    """
    ours = encodings_folder() / USED_UP if used_up else encodings_folder()
    folder = _find_encodings(settings.encodings, ours)
    is_replaced = folder != ours
    base = tuple(
        folder / name if is_replaced and (folder / name).is_file() else ours / name for name in ENCODING_FILES
    )
    added = tuple(dict.fromkeys(map(find_constraint, settings.constraints)))
    relaxed, bounded = settings.relaxed, settings.bounded
    kept, rules = added, ""
    questions: tuple[Path, ...] = ()
    if relaxed is not None:
        kept = tuple(constraint for constraint in added if constraint not in relaxed.constraints)
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
        # parsing takes some milliseconds, so it is skipped where all files are built-in ones
        from foon_asp.encoding import encoding  # noqa: PLC0415
        from foon_asp.rules import stating  # noqa: PLC0415

        if endless:
            from foon_asp.encoding.worker_process import start_in_advance  # noqa: PLC0415

            start_in_advance()  # while files are parsed

        parsed = [encoding.read_encoding(file) for file in base if endless]
        question_encodings = [encoding.read_encoding(file) for file in questions]
        files = stating.load_constraints(added)
        extra = [encoding.read_encoding(files[constraint]) for constraint in added]
        faults = map(str, encoding.check_encodings(extra, parsed, question_encodings))
        for message in (*faults, *encoding.unset_constant_warnings(extra, settings.constants)):
            warn(message)
        constants = encoding.constant_arguments(settings.constants, [*parsed, *extra])
        theirs = [*extra, *(read for file, read in zip(base, parsed, strict=False) if not is_own(file))]
        looked_at = frozenset(signature for read in theirs for signature in read.used)
        named = frozenset(name for read in (*parsed, *extra) for name in read.constants)
        text = "\n".join(read.text for read in (*parsed, *question_encodings, *extra))
        if extra and not encodings and relaxed is None:
            from foon_asp.rules import rules as user_rules  # noqa: PLC0415

            understood = user_rules.Rules(extra, constants[1::2], endless=endless)
    _warn_of_names(problem, settings, extra, constants[1::2], warn)
    arguments = (*constants, *_clingo_options(settings.clingo_options))
    if settings.clingo_options:  # checked now, since clingo may not run
        from foon_asp.encoding.clingo_run import check_options  # noqa: PLC0415

        check_options(arguments)
    return Program(
        (*base, *(files[constraint] for constraint in kept), *questions, *_checks(theirs)),
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
        reads=_reads([read for read in theirs if read.rules not in base]),
    )


def program_of(problem: Problem, settings: Settings, warn: Callable[[str], None]) -> Program:
    """Return the program of a question as :func:`assemble` does, without clingo where possible."""
    return ready_made(problem, settings, warn) or assemble(settings, warn, problem=problem)


def ready_made(problem: Problem, settings: Settings, warn: Callable[[str], None]) -> Program | None:
    """Return the program of a question whose user rules are all ready-made constraints, without clingo.

    ``None`` for other rules, for items that are used up, and for large networks, unless these are parts of a
    store or the rules require units.
    """
    rules = _ready_made_rules(settings)
    if rules is None or problem.items is not None:
        return None
    from foon_asp.rules.fact_values import FactValues  # noqa: PLC0415 (only of use with constraints)
    from foon_asp.rules.parameter_names import unknown_parameters  # noqa: PLC0415

    network = problem.network  # reading a part of a store takes longer than searching it
    large = len(network) > SEARCH.units_without_clingo and not network.object_numbers
    if (large and rules.shrinking) or not rules.has_same_meaning(problem):
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
    """Warn of names in rules, measures and parameters that do not occur in the network of a problem."""
    if problem is None:
        return
    measures = {(measure.place, measure.text): None for measure in problem.measures.values() if measure.text}
    if not (added or measures):
        return
    from foon_asp.encoding.encoding import read_encoding  # noqa: PLC0415 (which takes clingo along)
    from foon_asp.rules.fact_values import FactValues  # noqa: PLC0415 (only of use with constraints)
    from foon_asp.rules.unmatched import unmatched_warnings  # noqa: PLC0415

    values = FactValues(problem)
    theirs = [encoding for encoding in added if not _is_ours(encoding)]
    ours = [encoding for encoding in added if _is_ours(encoding)]
    if ours:
        from foon_asp.rules.parameter_names import unknown_parameters  # noqa: PLC0415

        relaxed = settings.relaxed.constraints if settings.relaxed is not None else ()
        for message in unknown_parameters((*settings.constraints, *relaxed), settings.constants, values):
            warn(message)
    for diagnostic in unmatched_warnings(theirs, ours, constants, values):
        warn(str(diagnostic))
    for origin, text in measures:
        for diagnostic in unmatched_warnings([read_encoding(Stated(origin, text))], [], (), values):
            warn(str(diagnostic))


def _is_ours(encoding: "Encoding") -> bool:
    rules = encoding.rules
    file = rules.file if isinstance(rules, Stated) else rules
    return file is not None and is_own(file)


def _ready_made_rules(settings: Settings) -> "ReadyMade | None":
    """Return the added rules if all are ready-made constraints, else ``None``.

    Also ``None`` without reductions, with other encodings, and with rewritten constraints or bounds.
    """
    if not settings.constraints or not settings.reductions or settings.replaced is not None:
        return None
    if settings.relaxed is not None or settings.bounded is not None:
        return None
    from foon_asp.rules.ready_made import ready_made as known  # noqa: PLC0415 (only of use with constraints)

    return known(settings.constraints, settings.constants)


def _reads(encodings: "Sequence[Encoding]") -> frozenset[tuple[str, str]]:
    """Return the predicates that user rules read and that have no facts in some questions.

    Pairs of the name and its first argument, which is empty if it is no name.
    """
    predicates: set[tuple[str, str]] = set()
    for encoding in encodings:
        if not _is_ours(encoding) and not _OF_SOME_QUESTIONS.isdisjoint(encoding.used):
            predicates.update(encoding.first_argument_names(_OF_SOME_QUESTIONS))
    return frozenset(predicates)


def _checks(encodings: "Sequence[Encoding]") -> list[Stated]:
    """Return the rules that detect overflow of numbers in user encodings."""
    if not encodings:
        return []
    from foon_asp.encoding.number_checks import CHECKS_FILE  # noqa: PLC0415
    from foon_asp.rules.number_limits import number_checks  # noqa: PLC0415

    checks = number_checks(statement for encoding in encodings for statement in encoding.statements)
    return [Stated(CHECKS_FILE, checks)] if checks else []


def _understood(settings: Settings) -> "Rules | None":
    """Return the added rules as analysed, ``None`` without any; raises as :func:`assemble` does."""
    return assemble(settings, lambda _: None).understood


class ReachOfRules(Enum):
    """The units that rules may be about.

    ``NEEDED``: units that a goal can need.
    ``TREE``: units of the tree. Rules read facts about the tree alone, and may require units that no goal
    needs.
    ``ALL``: all units of the network.
    """

    NEEDED = auto()
    TREE = auto()
    ALL = auto()


def reach_of_rules(settings: Settings) -> ReachOfRules:
    """Return the units that the added rules are about; raises as :func:`assemble` does."""
    rules = _ready_made_rules(settings) or _understood(settings)
    if rules is None or not rules.local:
        return ReachOfRules.ALL
    return ReachOfRules.NEEDED if rules.shrinking else ReachOfRules.TREE


def hold_for_parts(settings: Settings) -> bool:
    """Whether the added rules are antimonotone, so that they hold for every subtree as well.

    They have to be so in every part of the network, and also if more object nodes are available than the
    kitchen has. ``True`` without rules. Raises as :func:`assemble` does.
    """
    if settings.replaced is not None:
        return False
    rules = _ready_made_rules(settings) or varying_available(settings)
    if rules is None:
        return not settings.constraints
    return rules.local and rules.shrinking


def leave_unsettled(settings: Settings) -> bool:
    """Whether clingo has to enforce added rules, since they do more than remove and require units.

    Raises as :func:`assemble` does.
    """
    rules = _ready_made_rules(settings) or _understood(settings)
    return rules is not None and bool(rules.unsettled)


def varying_available(settings: Settings) -> "Rules | None":
    """Return the added rules, analysed for questions that differ in which object nodes are available.

    ``None`` without rules. Raises as :func:`assemble` does.
    """
    rules = _understood(settings)
    return None if rules is None else rules.varying({("available", 1)})


def need_whole_network(problem: Problem, settings: Settings) -> bool:
    """Whether added rules may be about units beyond those that the goals can need.

    Then a part of a store is not enough for the question. It is enough if every rule is local and none
    requires units that no goal needs.
    """
    if not settings.constraints and settings.replaced is None:
        return False
    is_partial = problem.network.object_numbers and problem.items is None and settings.replaced is None
    return not is_partial or reach_of_rules(settings) is not ReachOfRules.NEEDED


def rules_digest(
    settings: Settings, warn: Callable[[str], None] = lambda _: None, problem: Problem | None = None
) -> dict[str, str]:
    """Return a digest of the added rules under the key ``rules``; empty without rules.

    Every row of results has it. Warns and raises as :func:`assemble` does.
    """
    if not (settings.constraints or settings.constants or settings.encodings):
        return {}
    program = assemble(settings, warn, problem=problem)
    content = json_line([program.text, program.constants])
    return {"rules": hashlib.sha256(content.encode()).hexdigest()[:16]}


def _find_encodings(path: Path | None, ours: Path) -> Path:
    """Return the folder of encodings: ``path``, a built-in folder of that name, or ``ours`` without a path.

    Raises :class:`UserError` if it has no encodings.
    """
    if path is None:
        return ours
    folder = ours / path.name if not path.is_dir() and path.name == str(path) else path
    if any((folder / name).is_file() for name in ENCODING_FILES):
        return folder
    names = ", ".join(ENCODING_FILES)
    raise UserError(f"{path}: expected a folder with encodings to use instead of the built-in ones: {names}")


def _is_own(constraint: Constraint) -> bool:
    """Whether a constraint is an unchanged ready-made one, under any constants."""
    file = constraint.file if isinstance(constraint, LibraryUse) else constraint
    return isinstance(file, Path) and is_own(file)


def _clingo_options(options: tuple[str, ...]) -> tuple[str, ...]:
    """Return the options of clingo: the user's, and each default whose name the user did not set."""
    names = [option.partition("=")[0] for option in options]
    for option, name in zip(options, names, strict=True):
        if not (name.startswith("--") and len(name) > 2) and not name.startswith("-t"):
            raise UserError(f"found {option!r} after --, expected options of clingo, --NAME=VALUE")
        if any(reserved.startswith(name) for reserved in _RESERVED):
            raise UserError(f"the option {option!r} would change what an answer means, so it cannot be set")
    return (*(ours for ours in CLINGO_OPTIONS if ours.partition("=")[0] not in names), *options)
