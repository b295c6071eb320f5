"""Assembly of a clingo program: the built-in encodings or their replacement, and user rules."""

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
from foon_asp.json_layout import json_line
from foon_asp.problem import Problem
from foon_asp.resources import encodings_folder
from foon_asp.rules.passed_constraint import Constraint, LibraryUse, find_constraint

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
    """Return the program of a question: the encodings and constraints of settings, read and checked.

    ``used_up`` selects the encodings of plans, in which items are used up. ``warn`` receives warnings. With a
    ``problem``, it is also warned of names in rules that the network of the problem lacks. If grounding user
    rules may not terminate, a worker process is started in advance.

    A folder that replaces the built-in encodings may lack files; the built-in ones are loaded in their place.
    A constraint that is passed twice is loaded once. Relaxed constraints are checked, but only their
    rewritten rules are loaded.

    Raises :class:`UserError` for files that are missing or at fault, for ``#script``, for constants that no
    encoding has, and for clingo options that would change what an answer means.
    """
    built_in_folder = encodings_folder() / USED_UP if used_up else encodings_folder()
    folder = _encodings_folder_for(settings.encodings, built_in_folder)
    is_replaced = folder != built_in_folder
    base = tuple(
        folder / name if is_replaced and (folder / name).is_file() else built_in_folder / name
        for name in ENCODING_FILES
    )
    added = tuple(dict.fromkeys(map(find_constraint, settings.constraints)))
    relaxed, bounded = settings.relaxed, settings.bounded
    unrelaxed, rules = added, ""
    question_files: tuple[Path, ...] = ()
    if relaxed is not None:
        unrelaxed = tuple(constraint for constraint in added if constraint not in relaxed.constraints)
        added = tuple(dict.fromkeys((*added, *relaxed.constraints)))
        question_files = (relaxed.encoding,)
        rules = relaxed.rules
    if bounded is not None:
        question_files += bounded.files
        rules += bounded.rules
    looked_at: frozenset[tuple[str, int]] = frozenset()
    text, named = "", frozenset[str]()
    understood: Rules | None = None
    replaced = not all(map(is_own, base))
    endless = replaced or not all(map(_is_ready_made, added))
    files: dict[Constraint, Loaded] = {}
    added_encodings, user_encodings, constants = list["Encoding"](), list["Encoding"](), list[str]()
    encodings = folder if settings.encodings is None and replaced else settings.encodings
    if added or encodings or settings.constants:
        # parsing takes some milliseconds, so it is skipped where all files are built-in ones
        from foon_asp.encoding import encoding  # noqa: PLC0415
        from foon_asp.rules import stating  # noqa: PLC0415

        if endless:
            from foon_asp.encoding.program_client import start_in_advance  # noqa: PLC0415

            start_in_advance()  # while files are parsed

        parsed = [encoding.read_encoding(file) for file in base if endless]
        question_encodings = [encoding.read_encoding(file) for file in question_files]
        files = stating.load_constraints(added)
        added_encodings = [encoding.read_encoding(files[constraint]) for constraint in added]
        faults = map(str, encoding.check_encodings(added_encodings, parsed, question_encodings))
        for message in (*faults, *encoding.unset_constant_warnings(added_encodings, settings.constants)):
            warn(message)
        constants = encoding.constant_arguments(settings.constants, [*parsed, *added_encodings])
        user_encodings = [
            *added_encodings,
            *(read for file, read in zip(base, parsed, strict=False) if not is_own(file)),
        ]
        looked_at = frozenset(signature for read in user_encodings for signature in read.used)
        named = frozenset(name for read in (*parsed, *added_encodings) for name in read.constants)
        text = "\n".join(read.text for read in (*parsed, *question_encodings, *added_encodings))
        if added_encodings and not encodings and relaxed is None:
            from foon_asp.rules import rules as user_rules  # noqa: PLC0415

            understood = user_rules.Rules(added_encodings, constants[1::2], endless=endless)
    _warn_of_names(problem, settings, added_encodings, constants[1::2], warn)
    arguments = (*constants, *_clingo_options(settings.clingo_options))
    if settings.clingo_options:  # checked now, since clingo may not run
        from foon_asp.encoding.clingo_run import check_options  # noqa: PLC0415

        check_options(arguments)
    return Program(
        (
            *base,
            *(files[constraint] for constraint in unrelaxed),
            *question_files,
            *_overflow_checks(user_encodings),
        ),
        exact_success(),
        arguments,
        replaced=replaced,
        is_built_in=not added and encodings is None,
        rules=rules,
        bounded=bounded is not None,
        looked_at=looked_at,
        text=text,
        endless=endless,
        constants=tuple(constants),
        encodings=encodings,
        ours=(*base, *question_files),
        understood=understood,
        named=named,
        reads=_optional_predicates([read for read in user_encodings if read.rules not in base]),
    )


def program_of(problem: Problem, settings: Settings, warn: Callable[[str], None]) -> Program:
    """Return the program of :func:`ready_made_program`; if it is ``None``, that of :func:`assemble`."""
    return ready_made_program(problem, settings, warn) or assemble(settings, warn, problem=problem)


def ready_made_program(problem: Problem, settings: Settings, warn: Callable[[str], None]) -> Program | None:
    """Return the program of a question whose user rules are all ready-made constraints, without clingo.

    Ready-made constraints come with this program, so their effect is computed without their text. Therefore
    ``files`` of the result has no constraints; ``ready_made`` has them. ``warn`` receives warnings about
    their parameters.

    Returns ``None`` in any other case:

    - there are no user rules, or other rules than ready-made constraints;
    - there are rewritten rules or bounds, replaced encodings or no reductions;
    - items are used up;
    - the rules mean something else for clingo in this problem;
    - the network is large, unless it is a part of a store or the rules require units.
    """
    rules = _ready_made_rules(settings)
    if rules is None or problem.items is not None:
        return None
    from foon_asp.rules.fact_values import FactValues  # noqa: PLC0415 (only of use with constraints)
    from foon_asp.rules.parameter_names import unknown_parameters  # noqa: PLC0415

    network = problem.network  # reading a part of a store takes longer than searching it
    is_large = len(network) > SEARCH.units_without_clingo and not network.object_numbers
    if (is_large and rules.shrinking) or not rules.has_same_meaning(problem):
        return None
    for message in unknown_parameters(settings.constraints, settings.constants, FactValues(problem)):
        warn(message)
    without_rules = assemble(settings._replace(constraints=(), constants=()), warn, problem=problem)
    constants = [word for setting in rules.constants.items() for word in ("-c", "=".join(setting))]
    whole_program = without_rules._replace(
        files=(*without_rules.files, *rules.files),
        arguments=(*constants, *without_rules.arguments),
        is_built_in=False,
        looked_at=rules.looked_at,
    )
    return without_rules._replace(is_built_in=False, ready_made=rules, whole=whole_program)


def _warn_of_names(
    problem: Problem | None,
    settings: Settings,
    added: "Sequence[Encoding]",
    constants: Sequence[str],
    warn: Callable[[str], None],
) -> None:
    """Warn of names in rules, measures and parameters that the network of a problem does not have.

    Parameters are the constants of ready-made constraints. ``added`` are the encodings of all constraints.
    ``constants`` are the constants that are set, as ``NAME=VALUE``. Without a problem, nothing is checked.
    """
    if problem is None:
        return
    measures = {(measure.place, measure.text): None for measure in problem.measures.values() if measure.text}
    if not (added or measures):
        return
    from foon_asp.encoding.encoding import read_encoding  # noqa: PLC0415 (which takes clingo along)
    from foon_asp.rules.fact_values import FactValues  # noqa: PLC0415 (only of use with constraints)
    from foon_asp.rules.unmatched import unmatched_warnings  # noqa: PLC0415

    values = FactValues(problem)
    user_encodings = [encoding for encoding in added if not _is_built_in(encoding)]
    built_in = [encoding for encoding in added if _is_built_in(encoding)]
    if built_in:
        from foon_asp.rules.parameter_names import unknown_parameters  # noqa: PLC0415

        relaxed = settings.relaxed.constraints if settings.relaxed is not None else ()
        for message in unknown_parameters((*settings.constraints, *relaxed), settings.constants, values):
            warn(message)
    for diagnostic in unmatched_warnings(user_encodings, built_in, constants, values):
        warn(str(diagnostic))
    for origin, text in measures:
        for diagnostic in unmatched_warnings([read_encoding(Stated(origin, text))], [], (), values):
            warn(str(diagnostic))


def _is_built_in(encoding: "Encoding") -> bool:
    """Whether an encoding is an unchanged file of this program, or such a file with constants set."""
    rules = encoding.rules
    file = rules.file if isinstance(rules, Stated) else rules
    return file is not None and is_own(file)


def _ready_made_rules(settings: Settings) -> "ReadyMade | None":
    """Return the user rules if all are ready-made constraints, else ``None``.

    Also return ``None`` without rules, without reductions, with replaced encodings, with rewritten rules and
    with bounds.
    """
    if not settings.constraints or not settings.reductions or settings.replaced is not None:
        return None
    if settings.relaxed is not None or settings.bounded is not None:
        return None
    from foon_asp.rules.ready_made import ready_made  # noqa: PLC0415 (only of use with constraints)

    return ready_made(settings.constraints, settings.constants)


def _optional_predicates(encodings: "Sequence[Encoding]") -> frozenset[tuple[str, str]]:
    """Return the predicates that user rules read and that have facts only in some questions.

    Each is a pair of the predicate's name and its first argument, such as ``("cost", "price")``. If the first
    argument is no name, the pair has an empty text.
    """
    predicates: set[tuple[str, str]] = set()
    for encoding in encodings:
        if not _is_built_in(encoding) and not _OF_SOME_QUESTIONS.isdisjoint(encoding.used):
            predicates.update(encoding.first_argument_names(_OF_SOME_QUESTIONS))
    return frozenset(predicates)


def _overflow_checks(encodings: "Sequence[Encoding]") -> list[Stated]:
    """Return rules that detect numbers beyond clingo's integers in user encodings.

    The list has one text with all rules, or is empty if there is nothing to check.
    """
    if not encodings:
        return []
    from foon_asp.encoding.number_checks import CHECKS_FILE  # noqa: PLC0415
    from foon_asp.rules.number_limits import number_checks  # noqa: PLC0415

    checks = number_checks(statement for encoding in encodings for statement in encoding.statements)
    return [Stated(CHECKS_FILE, checks)] if checks else []


def _analysed_rules(settings: Settings) -> "Rules | None":
    """Return the user rules, analysed.

    Return ``None`` without rules, with other encodings, and if rules are rewritten. Warnings are dropped.
    Raises as :func:`assemble` does.
    """
    return assemble(settings, lambda _: None).understood


class ReachOfRules(Enum):
    """The units that user rules can depend on or require.

    ``NEEDED``: units that a goal can need.
    ``TREE``: units of the tree. Rules read facts about the tree alone, and may require units that no goal
    needs.
    ``ALL``: all units of the network.
    """

    NEEDED = auto()
    TREE = auto()
    ALL = auto()


def reach_of_rules(settings: Settings) -> ReachOfRules:
    """Return which units the user rules can depend on or require.

    Rules that are not local, or that cannot be analysed, can depend on all units. The result is ``ALL`` also
    without rules. Raises as :func:`assemble` does.
    """
    rules = _ready_made_rules(settings) or _analysed_rules(settings)
    if rules is None or not rules.local:
        return ReachOfRules.ALL
    return ReachOfRules.NEEDED if rules.shrinking else ReachOfRules.TREE


def hold_for_subtrees(settings: Settings) -> bool:
    """Whether the user rules are antimonotone: if a tree keeps to them, each of its subtrees does, too.

    ``True`` means that they are so in every part of the network, and also if more object nodes are available
    than the kitchen has. The result is true without rules. It is false with replaced encodings, for rules
    that are not local, and for rules beside rewritten rules. Rewritten rules themselves are ignored. Raises
    as :func:`assemble` does.
    """
    if settings.replaced is not None:
        return False
    rules = _ready_made_rules(settings) or rules_for_varying_kitchens(settings)
    if rules is None:
        return not settings.constraints
    return rules.local and rules.shrinking


def need_clingo(settings: Settings) -> bool:
    """Whether user rules do more than remove and require units, so that clingo has to enforce them.

    Return ``False`` without rules, and for rules that are not analysed. Rules are not analysed if they are
    rewritten, or if encodings are replaced. Raises as :func:`assemble` does.
    """
    rules = _ready_made_rules(settings) or _analysed_rules(settings)
    return rules is not None and bool(rules.unsettled)


def rules_for_varying_kitchens(settings: Settings) -> "Rules | None":
    """Return the user rules, analysed for questions that differ in which object nodes are available.

    Returns ``None`` without rules, with other encodings, and if rules are rewritten. Raises as
    :func:`assemble` does.
    """
    rules = _analysed_rules(settings)
    return None if rules is None else rules.varying({("available", 1)})


def need_whole_network(problem: Problem, settings: Settings) -> bool:
    """Whether user rules may be about units beyond those that the goals can need.

    If so, a part of a store is not enough for the question. Return ``False`` without user rules and replaced
    encodings. Also return ``False`` for rules over a part of a store if each rule is local, and none requires
    units that no goal needs. Otherwise return ``True``, also with replaced encodings and if items are used
    up.
    """
    if not settings.constraints and settings.replaced is None:
        return False
    is_partial = problem.network.object_numbers and problem.items is None and settings.replaced is None
    return not is_partial or reach_of_rules(settings) is not ReachOfRules.NEEDED


def rules_digest(
    settings: Settings, warn: Callable[[str], None] = lambda _: None, problem: Problem | None = None
) -> dict[str, str]:
    """Return ``{"rules": DIGEST}`` with a digest of the user rules, constants and encodings.

    The digest has 16 hexadecimal digits; every row of results has it. Without user rules, constants and
    replaced encodings, the result is empty. Warns and raises as :func:`assemble` does.
    """
    if not (settings.constraints or settings.constants or settings.encodings):
        return {}
    program = assemble(settings, warn, problem=problem)
    content = json_line([program.text, program.constants])
    return {"rules": hashlib.sha256(content.encode()).hexdigest()[:16]}


def _encodings_folder_for(path: Path | None, built_in_folder: Path) -> Path:
    """Return the folder of encodings: ``path``, or ``built_in_folder`` if it is ``None``.

    If ``path`` is a mere name and no folder, it is a folder in ``built_in_folder``. Raises :class:`UserError`
    if the folder has no encodings.
    """
    if path is None:
        return built_in_folder
    folder = built_in_folder / path.name if not path.is_dir() and path.name == str(path) else path
    if any((folder / name).is_file() for name in ENCODING_FILES):
        return folder
    names = ", ".join(ENCODING_FILES)
    raise UserError(f"{path}: expected a folder with encodings to use instead of the built-in ones: {names}")


def _is_ready_made(constraint: Constraint) -> bool:
    """Whether a constraint is an unchanged ready-made one, under any constants."""
    file = constraint.file if isinstance(constraint, LibraryUse) else constraint
    return isinstance(file, Path) and is_own(file)


def _clingo_options(options: tuple[str, ...]) -> tuple[str, ...]:
    """Return clingo's options: the defaults that the user did not set, then the user's ``options``.

    Raises :class:`UserError` for a word that is no option. Also raises it for an option, perhaps abbreviated,
    that would change what an answer means.
    """
    names = [option.partition("=")[0] for option in options]
    for option, name in zip(options, names, strict=True):
        if not (name.startswith("--") and len(name) > 2) and not name.startswith("-t"):
            raise UserError(f"found {option!r} after --, expected options of clingo, --NAME=VALUE")
        if any(reserved.startswith(name) for reserved in _RESERVED):
            raise UserError(f"the option {option!r} would change what an answer means, so it cannot be set")
    return (*(default for default in CLINGO_OPTIONS if default.partition("=")[0] not in names), *options)
