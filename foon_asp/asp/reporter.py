"""Receiver of the progress of a search: warnings, trees, bounds and steps."""

from fractions import Fraction

from foon_asp.problem import Costs, Objective


class Reporter:
    """Receives progress during a search; override the methods you need.

    Example:
        >>> class Printer(foon_asp.Reporter):
        ...     def tree(self, costs):
        ...         print("found", costs.units, "units")
        >>> answer = foon_asp.solve(foon_asp.load().problem("ice"), reporter=Printer())
        found 2 units
    """

    def warning(self, message: str) -> None:
        """Receive a warning about a constraint or an encoding.

        Parameters:
            message: The text of the warning.
        """

    def statistics(self, text: str) -> None:
        """Receive clingo's statistics of one search, if the option ``--stats`` asks for them.

        Parameters:
            text: A line for each statistic; a single line where clingo did not run.
        """

    def tree(self, costs: Costs) -> None:
        """Receive the costs of a tree that was found, the best so far.

        Parameters:
            costs: The costs of the tree.
        """

    def bound(self, objective: Objective, bound: int | Fraction) -> None:
        """Receive a proved bound on an objective.

        Parameters:
            objective: The objective that is being optimized.
            bound: The best value that any tree can still have.
        """

    def step(self, word: str, done: int, total: int) -> None:
        """Receive the number of answers found so far: once at the start, then after each answer.

        Parameters:
            word: A word for people that names the work being done.
            done: The number of answers found.
            total: The number of answers asked for.
        """
