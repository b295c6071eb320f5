"""The settings of a session (goals, kitchen, rule, constraints, objectives) and words that change them."""

import textwrap
from collections.abc import Callable, Mapping, Sequence
from difflib import get_close_matches
from pathlib import Path
from typing import NamedTuple

import click

from foon_asp.asp import Settings
from foon_asp.asp.assembly import assemble
from foon_asp.asp.session import Session
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.held import Held
from foon_asp.cli.named_path import NamedPath
from foon_asp.cli.shell_kitchen import ShellKitchen, find_nodes
from foon_asp.cli.shell_line import quoted, take_apart
from foon_asp.cli.verbs import verb_command
from foon_asp.dataset import Dataset
from foon_asp.deadline import Deadline, memory_size, seconds, size_text
from foon_asp.encoding.encoding import read_encoding
from foon_asp.errors import UserError
from foon_asp.problem import ContainerRule, Objective, parse_objectives
from foon_asp.questions.index import INDEX
from foon_asp.rules.constraint import Constraint, RuleText, find_constraint, named_constraint
from foon_asp.rules.constraint_library import library_constraints
from foon_asp.rules.stating import loaded
from foon_asp.text.data_folder import STARTING
from foon_asp.text.goal_name import Wording, notation

# The verbs that ask something of a network and a kitchen.
QUESTIONS = (*INDEX, "facts", "constraints")

# Those that ask for no tree under rules: diff asks by solve, which has them.
_WITHOUT_RULES = {"diff", "verify", "constraints"}

_GOAL = Wording("goal", "", "goal")


class Usage(NamedTuple):
    """How to use a word, and what it does."""

    usage: str
    purpose: str


WORDS = {
    "goal": Usage("goal NAME...", "make this, or all of these with one tree"),
    "have": Usage("have NAME...", "put object nodes into the kitchen"),
    "lack": Usage("lack NAME...", "take object nodes out of the kitchen"),
    "kitchen": Usage("kitchen [FILE|@starting]", "list what is at hand, or take another kitchen"),
    "containers": Usage("containers strict|implied", "whether a unit needs every input"),
    "objective": Usage("objective LIST", "what is best, most important first"),
    "constraint": Usage(
        "constraint NAME|FILE.lp [CONSTANT=VALUE...]", "add a constraint, or set its constants"
    ),
    "rule": Usage("rule 'RULE'", "add a rule, such as ':- use(U), motion(U,\"fry\").'"),
    "drop": Usage("drop NAME|FILE.lp|'RULE'...", "take constraints and rules away"),
    "time-limit": Usage("time-limit SECONDS|none", "stop each question after this many seconds"),
    "memory-limit": Usage("memory-limit SIZE|none", "stop each question at this much memory: 500M, 2G"),
    "show": Usage("show", "show what is set"),
    "help": Usage("help [WORD]", "list the words, or explain one"),
    "quit": Usage("quit", "leave, as ctrl-D does"),
}


class Leave(Exception):  # noqa: N818 (no error: the session is over)
    """Raised by a line that asks to leave."""


class ShellSession:
    """A session: data that was read once, and settings that hold until a line changes them.

    ``code`` is that of the last question. ``lenient`` and ``level`` are how the data was read, ``encodings``
    the folder with encodings to use instead of ours. Remarks about the session go to stderr, answers to
    stdout.
    """

    def __init__(self, dataset: Dataset, lenient: bool, level: int, encodings: Path | None) -> None:
        self.code = ExitCode.DONE
        self.goals: tuple[str, ...] = ()
        self.containers = ContainerRule.STRICT
        self.objectives: tuple[str, ...] = ()
        self.constraints: dict[Constraint, frozenset[str]] = {}  # with the names of their constants
        self.constants: dict[str, str] = {}
        self.time_limit: float | None = None
        self.memory_limit: int | None = None
        self.kitchen = ShellKitchen(dataset)
        self.files: list[Path] = []  # what was read, which no question writes over
        self._encodings = encodings
        self._lenient, self._level = lenient, level
        self._session = Session()
        self._words: dict[str, Callable[[list[str]], None]] = {
            "goal": self.set_goals,
            "have": self.kitchen.have,
            "lack": self.kitchen.lack,
            "kitchen": self._kitchen,
            "containers": self._containers,
            "objective": self._objective,
            "constraint": self._constraint,
            "rule": self._rule,
            "drop": self._drop,
            "time-limit": self._time_limit,
            "memory-limit": self._memory_limit,
            "show": self._show,
            "help": self._help,
            "quit": self._quit,
            "exit": self._quit,
        }

    def run(self, line: str) -> None:
        """Run a line. Raises :class:`UserError`, exceptions of click, and :class:`Leave`."""
        words = take_apart(line).texts
        if words[:1] == ["foon-asp"]:  # pasted from a page or a message
            del words[0]
        if not words:
            return
        word, *rest = words
        if word in self._words:
            self._words[word](rest)
        elif word in QUESTIONS:
            self._ask(word, rest)
        else:
            known = [*WORDS, *QUESTIONS]
            near = [each for each in known if each.startswith(word)] or get_close_matches(word, known, n=1)
            hint = f"did you mean {near[0]}?" if near else "help lists the words"
            if any(f"--{word}" in option.opts for option in verb_command("solve").params):
                hint = f"it is an option, for one line only: solve --{line.strip()}"
            raise UserError(f"found {word!r}, expected a word of the session or a question; {hint}")

    def _ask(self, verb: str, words: list[str]) -> None:
        """Ask a question by its verb; the settings are used for options that are not given."""
        self._refuse_without_rules(verb, words)
        dataset = self.kitchen.dataset
        given: dict[str, object] = {
            "goals_named": self.goals,
            "objectives": self._objectives_for(verb),
            "containers": str(self.containers),
            "time_limit": self.time_limit,
            "memory_limit": self.memory_limit,
            "lenient": self._lenient,
            "level": self._level,
        }
        ended = verb_command(verb).main(
            words,
            prog_name=verb,
            standalone_mode=False,
            default_map={name: value for name, value in given.items() if value not in {None, ()}},
            obj=Held(
                dataset,
                self._lenient,
                self._level,
                self._session,
                (*self.files, *(each for each in self.constraints if isinstance(each, Path))),
                tuple(self.constraints),
                _settings(self.constants),
                self._encodings,
            ),
            help_option_names=["-h", "--help"],
        )
        self.code = ExitCode(ended or 0)

    def _refuse_without_rules(self, verb: str, words: list[str]) -> None:
        """Raise :class:`UserError` if the session has rules that a verb does not accept."""
        standing = [*map(str, self.constraints), *(["--encodings"] if self._encodings else [])]
        knows = any(parameter.name == "constraints" for parameter in verb_command(verb).params)
        if standing and not knows and verb not in _WITHOUT_RULES and not _asks_for_help(words):
            raise UserError(
                f"{verb} takes no constraints, and this session has {', '.join(standing)}: drop them first, "
                "or ask in a session without them"
            )

    def _objectives_for(self, verb: str) -> tuple[str, ...]:
        """Give the objectives of the session, or nothing if the verb cannot use them and has its own."""
        alone = len(self._chosen(self.objectives)) == 1
        return () if verb == "optima" or (verb == "pareto" and alone) else self.objectives

    # --- The words.

    def set_goals(self, names: Sequence[str]) -> None:
        """Make these the goals."""
        dataset = self.kitchen.dataset
        if not names:
            labels = "".join(f"\n  goal {quoted(entry.pattern.label)}" for entry in dataset.listed)
            raise UserError("name a goal" + (f"; the goals file has{labels}" if labels else ""))
        known = self.kitchen.names
        nodes = [known.node(o) for o in find_nodes(names, known, _GOAL, dataset.listed)]
        self.goals = tuple(map(notation, nodes))
        for node in nodes:
            _say(f"goal: {node}")

    def _kitchen(self, files: list[str]) -> None:
        if files:
            file = NamedPath(_only(files, "kitchen"))
            self.kitchen.take(file)
            if file != STARTING:
                self.files.append(file)
        else:
            for node in self.kitchen.nodes():
                click.echo(node)

    def _containers(self, rules: list[str]) -> None:
        rule = _only(rules, "containers")
        if rule not in list(ContainerRule):
            raise UserError(f"found the container rule {rule!r}, expected {' or '.join(ContainerRule)}")
        self.containers = ContainerRule(rule)
        _say(f"containers: {rule}")

    def _objective(self, lists: list[str]) -> None:
        if not lists:
            known = ", ".join((*Objective, *self.kitchen.dataset.measures))
            raise UserError(f"expected {WORDS['objective'].usage}, of {known}")
        self.choose(lists)
        _say(f"objective: {', '.join(self._chosen(self.objectives))}")

    def choose(self, objectives: Sequence[str]) -> None:
        """Choose what is best, as ``--objective`` does."""
        self.objectives = (",".join(self._chosen(objectives)),)

    def _chosen(self, objectives: Sequence[str]) -> tuple[Objective, ...]:
        return parse_objectives(objectives, self.kitchen.dataset.measures)

    def _constraint(self, words: list[str]) -> None:
        if not words:
            raise UserError(f"name a constraint: {WORDS['constraint'].usage}; ours are {', '.join(_ours())}")
        name, *constants = words
        before = dict(self.constants)
        self.constrain((named_constraint(name, NamedPath),), constants)
        for constant, value in before.items():
            if self.constants[constant] != value:
                _say(f"replaced: {constant}={value}")
        _say(f"constraint: {' '.join(words)}")

    def _rule(self, rules: list[str]) -> None:
        if len(rules) != 1:
            raise UserError(f"expected {WORDS['rule'].usage}, with the rule in quotes")
        self.constrain((RuleText(rules[0]),), ())
        _say(f"rule: {rules[0]}")

    def constrain(self, constraints: Sequence[Constraint], constants: Sequence[str]) -> None:
        """Add constraints and set constants, if these are valid."""
        named = {find_constraint(each): each for each in (*constraints, *self.constraints)}
        known = dict(self.constants)
        for constant in constants:
            name, equals, value = constant.partition("=")
            if not equals:
                raise UserError(f"found the constant {constant!r}, expected NAME=VALUE")
            known[name] = value
        found = {each: constraint for constraint, each in named.items()}
        found = {each: found[each] for each in (*self.constraints, *constraints) if each in found}
        assemble(Settings(tuple(found), self._encodings, _settings(known)), _say)
        rules = loaded(tuple(found.values()))
        self.constraints = {
            each: frozenset(read_encoding(rules[constraint]).constants) for each, constraint in found.items()
        }
        self.constants = known

    def _drop(self, names: list[str]) -> None:
        standing = {str(path): path for path in self.constraints}
        if not names or not standing.keys() >= set(names):
            stand = ", ".join(standing) or "none"
            wrong = next((name for name in names if name not in standing), None)
            found = "name a constraint" if wrong is None else f"this session has no constraint {wrong!r}"
            raise UserError(f"{found}; the session has: {stand}")
        gone = [self.constraints.pop(standing[name]) for name in dict.fromkeys(names)]
        for constant in frozenset().union(*gone).difference(*self.constraints.values()):
            self.constants.pop(constant, None)
        for name in names:
            _say(f"dropped: {name}")

    def _time_limit(self, limits: list[str]) -> None:
        limit = _only(limits, "time-limit")
        try:
            self.time_limit = None if limit == "none" else seconds(limit)
        except UserError:
            raise UserError(f"found the time limit {limit!r}, expected seconds, or none") from None
        _say(f"time-limit: {limit}")

    def _memory_limit(self, limits: list[str]) -> None:
        limit = _only(limits, "memory-limit")
        size = None if limit == "none" else memory_size(limit)
        Deadline(None, size)  # where it cannot be held that is said now
        self.memory_limit = size
        _say(f"memory-limit: {limit}")

    def _show(self, words: list[str]) -> None:
        _none(words, "show")
        for goal in self.goals or ("(none)",):
            click.echo(f"goal: {goal}")
        click.echo(f"objective: {', '.join(self._chosen(self.objectives or ('units',)))}")
        click.echo(f"containers: {self.containers}")
        for path, has in self.constraints.items():
            constants = [f"{n}={v}" for n, v in self.constants.items() if n in has]
            kind = "rule" if isinstance(path, RuleText) else "constraint"
            click.echo(" ".join([f"{kind}:", str(path), *map(quoted, constants)]))
        if self._encodings:
            click.echo(f"encodings: {self._encodings}")
        click.echo(f"time-limit: {'none' if self.time_limit is None else f'{self.time_limit:g}'}")
        if self.memory_limit is not None:
            click.echo(f"memory-limit: {size_text(self.memory_limit)}")
        click.echo(f"kitchen: {self.kitchen.size}")
        for change in self.kitchen.changes():
            click.echo(f"  {change}")

    def _help(self, words: list[str]) -> None:
        if words:
            word = _only(words, "help")
            if word in QUESTIONS:
                command = verb_command(word)
                click.echo(command.get_help(click.Context(command, info_name=word)))
            elif word in WORDS:
                click.echo(f"{WORDS[word].usage}\n    {WORDS[word].purpose}")
            else:
                raise UserError(f"found {word!r}, expected a word of the session or a question")
            return
        for each in WORDS.values():
            click.echo(f"  {each.usage:<46}{each.purpose}")
        questions = textwrap.fill(
            ", ".join(QUESTIONS), 76, initial_indent="  ", subsequent_indent="  ", break_on_hyphens=False
        )
        click.echo(f"\nQuestions, with the options they have on the command line:\n{questions}")
        click.echo(
            "\nOptions on a line are for that line only. Its --constraint and -c are added to the rules of\n"
            "the session, which only constraint and drop change. A NAME is a label, a node in one-line\n"
            "notation, or the beginning of one; names with blanks are in quotes: goal 'greek salad'"
        )

    def _quit(self, words: list[str]) -> None:
        _none(words, "quit")
        raise Leave


def _asks_for_help(words: Sequence[str]) -> bool:
    return bool({"-h", "--help"} & {*words})


def _settings(constants: Mapping[str, str]) -> tuple[str, ...]:
    return tuple(f"{name}={value}" for name, value in constants.items())


def _say(text: str) -> None:
    click.echo(text, err=True)


def _only(words: Sequence[str], word: str) -> str:
    if len(words) != 1:
        raise UserError(f"expected {WORDS[word].usage}")
    return words[0]


def _none(words: Sequence[str], word: str) -> None:
    if words:
        raise UserError(f"found {words[0]!r} after {word}, expected nothing")


def _ours() -> list[str]:
    return [constraint.name for constraint in library_constraints()]
