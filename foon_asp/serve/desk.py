"""Where questions are handed in: one is answered at a time, and a later one ends the one before."""

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
from foon_asp.questions.arguments import chosen_objectives
from foon_asp.questions.caller import Caller, asked_by
from foon_asp.questions.regret import regret_of
from foon_asp.questions.view import PagePart, View, pages
from foon_asp.results.figure_text import bound_text, costs_text
from foon_asp.rules.constraint import Constraint, RuleText, find_constraint
from foon_asp.serve.form import Form, Without
from foon_asp.text.diagnostics import InputError
from foon_asp.text.goal_name import entry_names, nodes_beginning
from foon_asp.text.json_value import Json

_KEPT = 4  # pages
_NAMES = 30  # completions

Tell = Callable[[Json], object]
Rules = tuple[Constraint, ...]


class _Told(Reporter):
    """Tells of what is found until there is an answer; what other questions find later is not about it."""

    def __init__(self, tell: Tell) -> None:
        self._tell, self._answered = tell, False

    def event(self, event: Json) -> None:
        """Tell of anything; of progress only before there is a page."""
        self._answered = self._answered or event["kind"] == "page"
        if event["kind"] != "progress" or not self._answered:
            self._tell(event)

    def warning(self, message: str) -> None:
        """Tell of a warning."""
        self.event({"kind": "warning", "text": message})

    def tree(self, costs: Costs) -> None:
        """Tell of a tree."""
        self.event({"kind": "progress", "text": f"found a tree: {costs_text(costs)}"})

    def bound(self, objective: Objective, bound: int | Fraction) -> None:
        """Tell of a bound."""
        self.event({"kind": "progress", "text": bound_text(objective, bound)})

    def step(self, word: str, done: int, total: int) -> None:
        """Tell of an answer of several."""
        self.event({"kind": "progress", "text": f"{word}: {done} of {total}"})


class Desk:
    """What is asked of data, under limits for each question, ``first`` the question that the page opens with.

    Rules and encodings of ``how`` hold for all questions, and the stock of ``used_up`` where items are.
    What happens is told as it happens, in plain values: ``progress`` and ``warning`` with a text, ``page``
    with the number of a page, ``error`` with a text and, for rules, places in their text.
    """

    def __init__(
        self,
        foon: Foon,
        first: Form,
        time_limit: float | None = None,
        memory_limit: int | None = None,
        how: Settings | None = None,
        used_up: UsedUp | None = None,
    ) -> None:
        self._foon, self._first = foon, first
        self._limits = time_limit, memory_limit
        how = how or Settings()
        self._how = how._replace(constraints=tuple(map(find_constraint, how.constraints)))
        before = sum(isinstance(each, RuleText) for each in set(self._how.constraints))
        self._box = f"rule {before + 1}"  # what the rules of the page are called in messages
        self._used_up = used_up or UsedUp()
        self._turn = threading.Lock()
        self._token = Cancel()
        self._pages: dict[int, tuple[View, Rules]] = {}
        self._number = 0

    def start(self) -> Json:
        """Give what the page knows when it opens."""
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
        """Say what holds for every question, files by their names alone."""
        how, told, stock = self._how, self._used_up.told, self._used_up.stock
        rules = (each.name if isinstance(each, Path) else str(each) for each in how.constraints)
        encodings = [] if how.encodings is None else [f"encodings: {how.encodings.name}"]
        counts = [f"stock: {node} {count}" for node, count in stock.items()]
        return [*rules, *how.constants, *encodings, *counts] + [
            f"{'stays' if stays else 'goes'}: {name}" for name, stays in told.items()
        ]

    def names(self, start: str) -> list[str]:
        """Give object nodes whose names begin so, in the notation by which they are asked for."""
        names = self._foon.dataset.names
        return [str(names.node(o)) for o in nodes_beginning(start, names, _NAMES)]

    def page(self, number: int) -> str | None:
        """Give a page by its number, ``None`` where it is no longer kept."""
        kept = self._pages.get(number)
        return None if kept is None else kept[0].html()

    def cancel(self) -> None:
        """End what is being answered, with what was found by then."""
        self._token.cancel()

    def next(self) -> Cancel:
        """End what is being answered, and give a token for the next question."""
        self._token.cancel()
        self._token = Cancel()
        return self._token

    def ask(self, form: Form, token: Cancel, tell: Tell) -> None:
        """Answer a question with pages, and tell of all that happens."""

        def answer(deadline: Deadline, told: _Told) -> None:
            if not form.goals:
                raise UserError("name a goal")
            if not form.objectives:
                raise UserError("name an objective: what is best")
            with deadline.watched("reading", late=True):
                problem = self._problem(form)
            chosen = chosen_objectives(problem, form.objectives)
            rules = (*self._how.constraints, *([RuleText(form.rules)] if form.rules.strip() else []))
            how = self._how._replace(constraints=rules, deadline=deadline)
            named = {"constraints": rules, "constants": how.constants, "encodings": how.encodings}
            for page in pages(problem, chosen, how, form.beside, named):
                assert page.answer is not None
                tell({"kind": "page", "number": self._kept(page, rules), "text": page.answer.claim})

        self._run(answer, token, tell)

    def _problem(self, form: Form) -> Problem:
        foon = self._foon.vary(adding=form.adding, without=form.without)
        stock = stays = None
        if form.items != "lasting":
            there = set(foon.kitchen)  # what was taken from the kitchen is not in stock
            stock = {node: count for node, count in self._used_up.stock.items() if node in there}
            stays = self._used_up.told
        return foon.problem(
            *form.goals, containers=form.containers, items=form.items, stock=stock, stays=stays
        )

    def without(self, asked: Without, token: Cancel, tell: Tell) -> None:
        """Tell what the optimum of an answer is without one part of it."""

        def answer(deadline: Deadline, told: _Told) -> None:
            view, rules = self._pages.get(asked.page, (None, ()))
            if view is None or view.answer is None:
                raise UserError("this page is no longer kept: ask again")
            best, network = view.answer, view.answer.problem.network
            if best.status is not Status.OPTIMAL:
                raise UserError("the tree is not proved best")
            unit = None if asked.unit is None else network.unit_of_number(asked.unit)
            of_item = (o for o in best.problem.kitchen if str(network.objects[o]) == asked.item)
            item = next(of_item, None)
            if unit is None and item is None:
                raise UserError("the tree has nothing of that kind")
            how = self._how._replace(constraints=rules, deadline=deadline)
            regret = regret_of(best, how, unit, item)
            text = regret.loss_text(best.objectives[0])
            if regret.costs is not None:
                text += f"; the best is then {costs_text(regret.costs, best.objectives)}"
            told.event({"kind": "without", "text": text})

        self._run(answer, token, tell)

    def _kept(self, page: View, rules: Rules) -> int:
        self._number += 1
        self._pages[self._number] = page, rules
        self._pages.pop(self._number - _KEPT, None)
        return self._number

    def _run(self, answer: Callable[[Deadline, _Told], None], token: Cancel, tell: Tell) -> None:
        """Answer when it is its turn; whatever goes wrong is told."""
        places, told = [], _Told(tell)
        try:
            with self._turn, stoppable(None, token, "asking") as within:
                deadline = Deadline(*self._limits, within=within)
                with asked_by(Caller(told, deadline=deadline)):
                    answer(deadline, told)
            return
        except StoppedError as stopped:
            text = str(stopped)
        except InputError as error:
            text = str(error)
            places = [
                {"line": each.source.line, "column": each.source.column, "text": each.message}
                for each in error.diagnostics
                if each.source.file == self._box
            ]
        except UserError as error:
            text = str(error)
        except MemoryError:
            text = "out of memory; --memory-limit stops before that"
        except Exception as error:
            text = f"foon-asp has a bug: {type(error).__name__}: {error}"
        told.event({"kind": "error", "text": text, "places": places})
