"""The desk: it answers the questions of the page, one at a time; a new question cancels the current one."""

import threading
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path

import msgspec

from foon_asp.asp import Reporter, Settings, Status
from foon_asp.deadline import Cancel, Deadline, StoppedError, stoppable
from foon_asp.errors import UserError
from foon_asp.foon import Foon
from foon_asp.json_layout import Json
from foon_asp.problem import Costs, Objective, Problem, UsedUp
from foon_asp.questions.caller import Caller, asked_by
from foon_asp.questions.python_arguments import chosen_objectives
from foon_asp.questions.regret import regret_of
from foon_asp.questions.view import PagePart, View, pages
from foon_asp.results.figure_text import bound_text, costs_text
from foon_asp.rules.passed_constraint import Constraint, RuleText, find_constraint
from foon_asp.serve.form import Form, RegretForm
from foon_asp.text.diagnostics import InputError
from foon_asp.text.node_lookup import entry_names, nodes_beginning

SendEvent = Callable[[Json], object]
"""Sends an event to the browser."""
Rules = tuple[Constraint, ...]


class _EventReporter(Reporter):
    """A reporter that sends events to the browser.

    It sends no progress after the first page. The browser would take the progress of further answers, such as
    alternatives, for that of the first.
    """

    def __init__(self, send_event: SendEvent) -> None:
        self._send_event, self._answered = send_event, False

    def event(self, event: Json) -> None:
        """Send an event, unless its kind is ``progress`` and a page was sent."""
        self._answered = self._answered or event["kind"] == "page"
        if event["kind"] != "progress" or not self._answered:
            self._send_event(event)

    def warning(self, message: str) -> None:
        """Send a warning."""
        self.event({"kind": "warning", "text": message})

    def tree(self, costs: Costs) -> None:
        """Send the costs of a new incumbent as progress."""
        self.event({"kind": "progress", "text": f"found a tree: {costs_text(costs)}"})

    def bound(self, objective: Objective, bound: int | Fraction) -> None:
        """Send a new bound on the optimum as progress."""
        self.event({"kind": "progress", "text": bound_text(objective, bound)})

    def step(self, word: str, done: int, total: int) -> None:
        """Send as progress that ``done`` of ``total`` parts of a question are finished."""
        self.event({"kind": "progress", "text": f"{word}: {done} of {total}"})


class Desk:
    """The side of the server that answers the questions of the page, one after the other.

    All questions are about the data of ``foon``. Answers are sent as events. Events of kind ``progress``,
    ``warning`` and ``without`` have a text, and those of kind ``page`` have a text and the number of a page.
    Those of kind ``error`` have a text and, for rules, positions in their text.

    ``opening_form``: the question that the page shows when it opens.
    ``time_limit``, ``memory_limit``: the limits of each question, in seconds and bytes; ``None`` for no
    limit.
    ``settings``: rules, constants and encodings that hold for all questions.
    ``used_up``: the stock, and the items that stay, in questions in which items are used up.
    """

    def __init__(
        self,
        foon: Foon,
        opening_form: Form,
        time_limit: float | None = None,
        memory_limit: int | None = None,
        settings: Settings | None = None,
        used_up: UsedUp | None = None,
    ) -> None:
        self._foon, self._opening_form = foon, opening_form
        self._limits = time_limit, memory_limit
        settings = settings or Settings()
        self._settings = settings._replace(constraints=tuple(map(find_constraint, settings.constraints)))
        rule_texts = sum(isinstance(rule, RuleText) for rule in set(self._settings.constraints))
        self._page_rules = f"rule {rule_texts + 1}"  # the name of the page's rules in messages
        self._used_up = used_up or UsedUp()
        self._lock = threading.Lock()
        self._current_token = Cancel()
        self._kept_pages: dict[int, tuple[View, Rules]] = {}
        self._last_page_number = 0

    def opening_data(self) -> Json:
        """Return the data with which the page opens, by the names that its script reads.

        These are
        - the goals of the goals file, the kitchen and the objectives,
        - the further answers to choose from,
        - the conditions that are fixed, and
        - the opening form.
        """
        dataset = self._foon.dataset
        return {
            "goals": [*entry_names(dataset.goal_entries, dataset.names)],
            "kitchen": sorted(str(dataset.names.node(o)) for o in dataset.kitchen),
            "objectives": [*Objective, *dataset.measures],
            "beside": [*PagePart],
            "always": self._fixed_conditions(),
            "first": msgspec.to_builtins(self._opening_form),
        }

    def _fixed_conditions(self) -> list[str]:
        """Return in words the conditions that hold for all questions; of files, only the names."""
        settings, stays_of, stock = self._settings, self._used_up.told, self._used_up.stock
        rules = (rule.name if isinstance(rule, Path) else str(rule) for rule in settings.constraints)
        encodings = [] if settings.encodings is None else [f"encodings: {settings.encodings.name}"]
        stock_texts = [f"stock: {node} {count}" for node, count in stock.items()]
        return [*rules, *settings.constants, *encodings, *stock_texts] + [
            f"{'stays' if stays else 'goes'}: {name}" for name, stays in stays_of.items()
        ]

    def names_beginning(self, start: str) -> list[str]:
        """Return up to 30 object nodes in one-line notation whose notation or label begins with ``start``."""
        names = self._foon.dataset.names
        return [str(names.node(o)) for o in nodes_beginning(start, names, 30)]

    def page(self, number: int) -> str | None:
        """Return the HTML of the page with a number, or ``None`` if the page is no longer kept."""
        entry = self._kept_pages.get(number)
        return None if entry is None else entry[0].html()

    def cancel(self) -> None:
        """Cancel the current question; if it has an incumbent, that is its answer."""
        self._current_token.cancel()

    def next_token(self) -> Cancel:
        """Cancel the current question, and return the token by which :meth:`cancel` cancels the next one."""
        self._current_token.cancel()
        self._current_token = Cancel()
        return self._current_token

    def answer_form(self, form: Form, token: Cancel, send_event: SendEvent) -> None:
        """Answer the question of a form with pages, once the question before it has ended.

        ``token`` cancels the question. ``send_event`` receives an event for each page, for progress, for
        warnings and for an error. Each page is kept. It is an error if the form has no goals or no
        objectives. An error is sent, and not raised.
        """

        def answer(deadline: Deadline, _: _EventReporter) -> None:
            """Compute the pages, keep each, and send its number."""
            if not form.goals:
                raise UserError("name a goal")
            if not form.objectives:
                raise UserError("name an objective: what is best")
            with deadline.watched("reading", late=True):
                problem = self._problem_of(form)
            chosen = chosen_objectives(problem, form.objectives)
            rules = (*self._settings.constraints, *([RuleText(form.rules)] if form.rules.strip() else []))
            settings = self._settings._replace(constraints=rules, deadline=deadline)
            named = {"constraints": rules, "constants": settings.constants, "encodings": settings.encodings}
            for page in pages(problem, chosen, settings, form.beside, named):
                assert page.answer is not None
                send_event(
                    {"kind": "page", "number": self._keep_page(page, rules), "text": page.answer.claim}
                )

        self._run_question(answer, token, send_event)

    def _problem_of(self, form: Form) -> Problem:
        """Return the problem of a form, with the changes that the form makes to the kitchen.

        If items are used up, the stock and the items that stay are those of the desk. Items that the form
        removes are not in the stock.
        """
        foon = self._foon.vary(adding=form.adding, without=form.without)
        stock = stays = None
        if form.items != "lasting":
            kitchen = set(foon.kitchen)  # an item that the form removes is not in stock
            stock = {node: count for node, count in self._used_up.stock.items() if node in kitchen}
            stays = self._used_up.told
        return foon.problem(
            *form.goals, containers=form.containers, items=form.items, stock=stock, stays=stays
        )

    def answer_regret(self, form: RegretForm, token: Cancel, send_event: SendEvent) -> None:
        """Send the regret of a unit or kitchen item: how much worse the optimum is without it.

        The rules are those of the page of the form. The regret is sent as an event of kind ``without``, once
        the question before it has ended.

        Errors are sent, and not raised:
        - if the page of the form is no longer kept,
        - if the tree of the page is not proved optimal, or
        - if the problem has no such unit or item.

        ``token`` and ``send_event`` are as for :meth:`answer_form`.
        """

        def answer(deadline: Deadline, reporter: _EventReporter) -> None:
            """Compute the regret, and send it as a text."""
            view, rules = self._kept_pages.get(form.page, (None, ()))
            if view is None or view.answer is None:
                raise UserError("this page is no longer kept: ask again")
            best_answer, network = view.answer, view.answer.problem.network
            if best_answer.status is not Status.OPTIMAL:
                raise UserError("the tree is not proved best")
            unit = None if form.unit is None else network.unit_of_number(form.unit)
            matching_items = (o for o in best_answer.problem.kitchen if str(network.objects[o]) == form.item)
            item = next(matching_items, None)
            if unit is None and item is None:
                raise UserError("the tree has nothing of that kind")
            settings = self._settings._replace(constraints=rules, deadline=deadline)
            regret = regret_of(best_answer, settings, unit, item)
            text = regret.loss_text(best_answer.objectives[0])
            if regret.costs is not None:
                text += f"; the best is then {costs_text(regret.costs, best_answer.objectives)}"
            reporter.event({"kind": "without", "text": text})

        self._run_question(answer, token, send_event)

    def _keep_page(self, page: View, rules: Rules) -> int:
        """Keep a page with its rules, and return its number.

        Only the last four pages are kept, since each holds its problem in memory.
        """
        self._last_page_number += 1
        self._kept_pages[self._last_page_number] = page, rules
        self._kept_pages.pop(self._last_page_number - 4, None)
        return self._last_page_number

    def _run_question(
        self, answer: Callable[[Deadline, _EventReporter], None], token: Cancel, send_event: SendEvent
    ) -> None:
        """Call ``answer`` with a deadline and a reporter, once the question before it has ended.

        Errors are sent as events and not raised. A stop before any answer is such an error. Positions in the
        event are those in the rules of the page.
        """
        positions, reporter = [], _EventReporter(send_event)
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
