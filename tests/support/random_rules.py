"""Random rules over random problems: helpers, negation, aggregates, conditions, pools, seeded."""

import random

from foon_asp.problem import Problem

_OPERATORS = ("<", "<=", ">", ">=", "=", "!=")
_HELPERS = {"about_unit": "U", "about_object": "O", "about_name": "N", "about_all": ""}


class RandomRules:
    """Draws rules in which every variable is bound; ``odd`` ones have choices, loops and arithmetic, too."""

    def __init__(self, seed: int, problem: Problem, odd: bool = False) -> None:
        self._rng = random.Random(f"rules {seed}")
        self._odd = odd
        network = problem.network
        self._names = {
            "motion": sorted(set(network.motions)),
            "label": sorted({node.label for node in network.objects}),
            "state": sorted({state for node in network.objects for state in node.states}) or ["empty"],
        }
        self._helpers: list[tuple[str, str]] = []
        self._count = 0
        self._near = False

    def text(self) -> str:
        """Give a few helper rules, and then a few constraints."""
        rng = self._rng
        lines = []
        for number in range(rng.choice((0, 0, 1, 1, 2, 3))):
            name, sort = f"helper{number}", rng.choice(("U", "O", "N", ""))
            new = (name, sort)
            if rng.random() < 0.15:
                self._helpers.append(new)  # so that it may be derived from itself
            lines += [self._helper_rule(name, sort) for _ in range(rng.choice((1, 1, 2)))]
            if new not in self._helpers:
                self._helpers.append(new)
        lines += [f":- {self._body([])}." for _ in range(rng.choice((1, 2, 2)))]
        return "\n".join(lines) + "\n"

    def of_one_unit(self) -> str:
        """Give a constraint that is about one unit, and what it is made of; some have helpers."""
        rng = self._rng
        self._near = True
        bound, parts = ["U0"], ["use(U0)"]
        lines = [f"helper0({self._name('label')})." for _ in range(rng.choice((0, 1, 3)))]
        self._helpers += [("helper0", "N")] if lines else []
        if rng.random() < 0.4:
            own, within = ["O0"], [f"label(O0,{self._name('label')})"]
            within = rng.choice((within, ["label(O0,N0)", self._part([*own, "N0"], within)]))
            lines.append(f"helper1(O0) :- {'; '.join(within)}.")
            self._helpers.append(("helper1", "O"))
        for _ in range(rng.choice((1, 2, 2, 3))):
            parts.append(self._part(bound, parts))
        if rng.random() < 0.7:
            return "\n".join([*lines, f":- {'; '.join(parts)}."]) + "\n"
        if rng.random() < 0.5:
            return "\n".join([*lines, f"done :- {'; '.join(parts)}.", ":- not done."]) + "\n"
        simple = [part for part in parts[1:] if ":" not in part and "#" not in part]
        return "\n".join([*lines, f":- not use(U0) : {', '.join(['unit(U0)', *simple])}."]) + "\n"

    def _helper_rule(self, name: str, sort: str) -> str:
        if sort == "N" and self._rng.random() < 0.3:
            return f"{name}({self._name('label')})."
        bound: list[str] = []
        body = self._body(bound)
        fitting = [variable for variable in bound if variable[0] == sort]
        if sort and not fitting:
            body, fitting = f"{body}; {self._binding(sort, [], bound)}", [bound[-1]]
        head = f"{name}({self._rng.choice(fitting)})" if sort else name
        if self._odd and self._rng.random() < 0.15:
            head = self._rng.choice((f"{{ {head} }}", f"{head} ; other", f"-{head}", f"not {head}"))
        return f"{head} :- {body}."

    def _variable(self, sort: str, bound: list[str]) -> str:
        self._count += 1
        bound.append(f"{sort}{self._count}")
        return bound[-1]

    def _name(self, kind: str) -> str:
        rng = self._rng
        drawn = rng.choice(self._names[kind])
        if rng.random() < 0.1:
            return f'("{drawn}";"{rng.choice(self._names[kind])}")'
        return f'"{drawn}"'

    def _known(self, sort: str, bound: list[str], parts: list[str]) -> str:
        """Give a variable that is bound, or bind one."""
        fitting = [variable for variable in bound if variable[0] == sort]
        if fitting and (self._rng.random() < 0.85 or (self._near and sort == "U")):
            return self._rng.choice(fitting)
        parts.append(self._binding(sort, parts, bound))
        return bound[-1]

    def _binding(self, sort: str, parts: list[str], bound: list[str]) -> str:
        """Give a positive literal that binds a new variable, the last one of those bound."""
        rng = self._rng
        helpers = [name for name, of in self._helpers if of == sort]
        if self._near and sort != "N":
            unit = next((variable for variable in bound if variable[0] == "U"), None)
            side = rng.choice(("input", "output", "needs", "gives"))
            way = "goal({})" if unit is None or rng.random() < 0.1 else f"{side}({unit},{{}})"
            return way.format(self._variable("O", bound))
        if sort == "U":
            near = [variable for variable in bound if variable[0] == "O"]
            ways = ["use({})"] * 12 + ["times({},_)"] + ["unit({})", f"motion({{}},{self._name('motion')})"]
            ways += [f"{rng.choice(('input', 'gives'))}({{}},{rng.choice(near)})"] if near else []
        elif sort == "O":
            unit = self._known("U", bound, parts) if rng.random() < 0.95 else "_"
            side = rng.choice(("input", "output", "needs", "gives"))
            ways = [f"{side}({unit},{{}})"] * 9 + ["goal({})", "kitchen({})", "object({})", "available({})"]
            ways += [f"label({{}},{self._name('label')})"]
        else:
            o = self._known("O", bound, parts) if rng.random() < 0.95 else "_"
            ways = [f"label({o},{{}})"] * 3 + ["utensil({})", f"located({o},_,{{}})", f"ingredient({o},{{}})"]
        ways += [f"{name}({{}})" for name in helpers] * 3
        way = rng.choice(ways)
        return way.format(self._variable(sort, bound))

    def _atom(self, bound: list[str], parts: list[str]) -> str:
        """Give an atom whose variables are bound by parts that come before it."""
        rng = self._rng
        u = self._known("U", bound, parts)
        choices = [f"use({u})", f"use({u})", f"motion({u},{self._name('motion')})"]
        if rng.random() < 0.6:
            o = self._known("O", bound, parts)
            choices += [
                f"{rng.choice(('input', 'output', 'needs', 'gives'))}({u},{o})",
                f"label({o},{self._name('label')})",
                f"state({o},{self._name('state')})",
                f"{rng.choice(('kitchen', 'goal', 'available', 'available'))}({o})",
                f"input({u},_)",
            ]
        if rng.random() < 0.3:
            n = self._known("N", bound, parts)
            choices += [f"utensil({n})", f"label(_,{n})"]
        for name, sort in self._helpers:
            choices += [f"{name}({self._known(sort, bound, parts)})" if sort else name] * 2
        return rng.choice(choices)

    def _test(self, bound: list[str], parts: list[str]) -> str:
        rng = self._rng
        operator = rng.choice(_OPERATORS)
        if rng.random() < 0.5:
            u, number = self._known("U", bound, parts), self._variable("I", [])
            predicate, bound_by = rng.choice((("inputs", 2), ("ingredients", 1), ("rate", 300000)))
            parts.append(f"{predicate}({u},{number})")
            plus = rng.choice(("", "+1")) if self._odd else ""
            return f"{number}{plus} {operator} {bound_by}"
        sort = rng.choice("UON")
        one, other = self._known(sort, bound, parts), self._known(sort, bound, parts)
        return f"{one} {operator} {other}"

    def _body(self, bound: list[str]) -> str:
        rng = self._rng
        parts: list[str] = []
        for _ in range(rng.choice((1, 2, 2, 3, 3, 4))):
            part = self._part(bound, parts)
            parts.append(part)
        return "; ".join(parts)

    def _part(self, bound: list[str], parts: list[str]) -> str:
        rng = self._rng
        kind = rng.random()
        if kind < 0.35:
            return self._binding(rng.choice("UUON"), parts, bound)
        if kind < 0.5:
            return self._atom(bound, parts)
        if kind < 0.68:
            return f"{rng.choice(('not', 'not', 'not', 'not not'))} {self._atom(bound, parts)}"
        if kind < 0.76:
            return self._test(bound, parts)
        inner, within = list(bound), list[str]()
        atom = self._atom(inner, within)
        if kind < 0.88:
            within = [*within, self._binding("U", within, inner)]
            sign = rng.choice(("", "not ", "not "))
            return f"{sign}{atom} : {', '.join(within)}"
        new = [variable for variable in inner if variable not in bound] or ["1"]
        operator = rng.choice((*_OPERATORS, "<", "<", ">", ">"))
        if rng.random() < 0.3 and any(variable[0] == "U" for variable in inner):
            unit = next(variable for variable in inner if variable[0] == "U")
            weight = rng.choice(("inputs", "ingredients"))
            elements = f"W,{new[0]} : {', '.join([*within, atom, f'{weight}({unit},W)'])}"
            function = rng.choice(("#sum", "#sum", "#sum+", "#max", "#min"))
        else:
            weight = rng.choice(("", "", "", "1,", "-1,")) if self._odd else ""
            elements = f"{weight}{rng.choice(new)} : {', '.join([*within, atom])}"
            function = "#sum" if weight else "#count"
        sign = rng.choice(("", "", "", "not "))
        return f"{sign}{function} {{ {elements} }} {operator} {rng.choice((0, 1, 1, 2, 3))}"
