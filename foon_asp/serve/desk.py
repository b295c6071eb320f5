"""Desk: it answers the questions of the page, one at a time; a new question cancels the current one."""

import threading
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path

import msgspec

from foon_asp.asp import Reporter, Settings, Status
from foon_asp.deadline import Cancel, Deadline, StoppedError, stoppable
from foon_asp.errors import UserError
from foon_asp.foon import Foon
from foon_asp.problem import Costs, Objective, Problem, UsedUp
from foon_asp.questions.caller import Caller, asked_by
from foon_asp.questions.python_arguments import chosen_objectives
from foon_asp.questions.regret import regret_of
from foon_asp.questions.view import PagePart, View, pages
from foon_asp.results.figure_text import bound_text, costs_text
from foon_asp.rules.passed_constraint import Constraint, RuleText, find_constraint
from foon_asp.serve.form import Form, Without
from foon_asp.text.diagnostics import InputError
from foon_asp.text.json_value import Json
from foon_asp.text.node_lookup import entry_names, nodes_beginning

Tell = Callable[[Json], object]
"""Sends an event to the browser."""
Rules = tuple[Constraint, ...]


class _EventReporter(Reporter):
    """A reporter that sends events to the browser; it stops reporting progress after the first page.

    The progress of further answers, such as alternatives, would be taken for that of the first.
    """

    def __init__(self, tell: Tell) -> None:
        self._tell, self._answered = tell, False

    def event(self, event: Json) -> None:
        """Send an event; of kind ``progress`` only before the first page."""
        self._answered = self._answered or event["kind"] == "page"
        if event["kind"] != "progress" or not self._answered:
            self._tell(event)

    def warning(self, message: str) -> None:
        """Send a warning."""
        self.event({"kind": "warning", "text": message})

    def tree(self, costs: Costs) -> None:
        """Send the costs of a new incumbent."""
        self.event({"kind": "progress", "text": f"found a tree: {costs_text(costs)}"})

    def bound(self, objective: Objective, bound: int | Fraction) -> None:
        """Send a new lower bound."""
        self.event({"kind": "progress", "text": bound_text(objective, bound)})

    def step(self, word: str, done: int, total: int) -> None:
        """Send the number of finished parts of a question."""
        self.event({"kind": "progress", "text": f"{word}: {done} of {total}"})


class Desk:
    """The questions about one set of data; ``first`` is the question that the page opens with.

    Limits (seconds, bytes) are for each question. Rules and encodings of ``settings`` hold for all questions,
    and the stock of ``used_up`` for those in which items are used up. Answers are sent as events:
    ``progress`` and ``warning`` with a text, ``page`` with the number of a page, ``without`` with a text,
    ``error`` with a text and, for rules, positions in their text.
    """

    def __init__(
        self,
        foon: Foon,
        first: Form,
        time_limit: float | None = None,
        memory_limit: int | None = None,
        settings: Settings | None = None,
        used_up: UsedUp | None = None,
    ) -> None:
        self._foon, self._first = foon, first
        self._limits = time_limit, memory_limit
        settings = settings or Settings()
        self._settings = settings._replace(constraints=tuple(map(find_constraint, settings.constraints)))
        rule_texts = sum(isinstance(rule, RuleText) for rule in set(self._settings.constraints))
        self._page_rules = f"rule {rule_texts + 1}"  # the name of the page's rules in messages
        self._used_up = used_up or UsedUp()
        self._lock = threading.Lock()
        self._token = Cancel()
        self._pages: dict[int, tuple[View, Rules]] = {}
        self._number = 0

    def start(self) -> Json:
        """Return the data of the page when it opens: names to complete, objectives, and fixed conditions."""
        dataset = self._foon.dataset
        return {
            "goals": [*entry_names(dataset.listed, dataset.names)],
            "kitchen": sorted(str(dataset.names.node(o)) for o in dataset.kitchen),
            "objectives": [*Objective, *dataset.measures],
            "beside": [*PagePart],
            "always": self._always(),
            "first": msgspec.to_builtins(self._first),
        }

    def _always(self) -> list[str]:
        """Return the conditions of all questions in words; files by their names, without folders."""
        settings, stays_of, stock = self._settings, self._used_up.told, self._used_up.stock
        rules = (rule.name if isinstance(rule, Path) else str(rule) for rule in settings.constraints)
        encodings = [] if settings.encodings is None else [f"encodings: {settings.encodings.name}"]
        counts = [f"stock: {node} {count}" for node, count in stock.items()]
        return [*rules, *settings.constants, *encodings, *counts] + [
            f"{'stays' if stays else 'goes'}: {name}" for name, stays in stays_of.items()
        ]

    def names(self, start: str) -> list[str]:
        """Return up to 30 object nodes whose names begin with ``start``, in one-line notation."""
        names = self._foon.dataset.names
        return [str(names.node(o)) for o in nodes_beginning(start, names, 30)]

    def page(self, number: int) -> str | None:
        """Return the HTML of a page by its number; ``None`` where it is no longer kept."""
        entry = self._pages.get(number)
        return None if entry is None else entry[0].html()

    def cancel(self) -> None:
        """Cancel the current question; it ends with its incumbent."""
        self._token.cancel()

    def next(self) -> Cancel:
        """Cancel the current question, and return the token that cancels the next one."""
        self._token.cancel()
        self._token = Cancel()
        return self._token

    def ask(self, form: Form, token: Cancel, tell: Tell) -> None:
        """Answer a question with pages; ``tell`` receives an event for each, and for progress and errors."""

        def answer(deadline: Deadline, _: _EventReporter) -> None:
            if not form.goals:
                raise UserError("name a goal")
            if not form.objectives:
                raise UserError("name an objective: what is best")
            with deadline.watched("reading", late=True):
                problem = self._problem(form)
            chosen = chosen_objectives(problem, form.objectives)
            rules = (*self._settings.constraints, *([RuleText(form.rules)] if form.rules.strip() else []))
            settings = self._settings._replace(constraints=rules, deadline=deadline)
            named = {"constraints": rules, "constants": settings.constants, "encodings": settings.encodings}
            for page in pages(problem, chosen, settings, form.beside, named):
                assert page.answer is not None
                tell({"kind": "page", "number": self._keep(page, rules), "text": page.answer.claim})

        self._run(answer, token, tell)

    def _problem(self, form: Form) -> Problem:
        """Return the problem of a form, over the data with its changes to the kitchen."""
        foon = self._foon.vary(adding=form.adding, without=form.without)
        stock = stays = None
        if form.items != "lasting":
            kitchen = set(foon.kitchen)  # an item that the form removes is not in stock
            stock = {node: count for node, count in self._used_up.stock.items() if node in kitchen}
            stays = self._used_up.told
        return foon.problem(
            *form.goals, containers=form.containers, items=form.items, stock=stock, stays=stays
        )

    def without(self, form: Without, token: Cancel, tell: Tell) -> None:
        """Send the regret of a unit or kitchen item: how much worse the optimum is without it."""

        def answer(deadline: Deadline, reporter: _EventReporter) -> None:
            view, rules = self._pages.get(form.page, (None, ()))
            if view is None or view.answer is None:
                raise UserError("this page is no longer kept: ask again")
            best, network = view.answer, view.answer.problem.network
            if best.status is not Status.OPTIMAL:
                raise UserError("the tree is not proved best")
            unit = None if form.unit is None else network.unit_of_number(form.unit)
            named = (o for o in best.problem.kitchen if str(network.objects[o]) == form.item)
            item = next(named, None)
            if unit is None and item is None:
                raise UserError("the tree has nothing of that kind")
            settings = self._settings._replace(constraints=rules, deadline=deadline)
            regret = regret_of(best, settings, unit, item)
            text = regret.loss_text(best.objectives[0])
            if regret.costs is not None:
                text += f"; the best is then {costs_text(regret.costs, best.objectives)}"
            reporter.event({"kind": "without", "text": text})

        self._run(answer, token, tell)

    def _keep(self, page: View, rules: Rules) -> int:
        """Keep a page, and its problem in memory, instead of the fourth before it; return its number."""
        self._number += 1
        self._pages[self._number] = page, rules
        self._pages.pop(self._number - 4, None)
        return self._number

    def _run(self, answer: Callable[[Deadline, _EventReporter], None], token: Cancel, tell: Tell) -> None:
        """Answer a question once the one before has ended; any error becomes an event."""
        positions, reporter = [], _EventReporter(tell)
        try:
            with self._lock, stoppable(None, token, "asking") as cancelled:
                deadline = Deadline(*self._limits, within=cancelled)
                with asked_by(Caller(reporter, deadline=deadline)):
                    answer(deadline, reporter)
            return
        except StoppedError as stopped:
            text = str(stopped)
        except InputError as error:
            text = str(error)
            positions = [
                {"line": fault.source.line, "column": fault.source.column, "text": fault.message}
                for fault in error.diagnostics
                if fault.source.file == self._page_rules
            ]
        except UserError as error:
            text = str(error)
        except MemoryError:
            text = "out of memory; --memory-limit stops before that"
        except Exception as error:
            text = f"foon-asp has a bug: {type(error).__name__}: {error}"
        reporter.event({"kind": "error", "text": text, "places": positions})
