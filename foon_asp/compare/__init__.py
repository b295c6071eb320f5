"""Searches held against the optimum, for one goal or thousands."""

from foon_asp.compare.comparison import MEASURED, Comparison, Judgement, Optimum, compare, judge
from foon_asp.compare.many import compare_goals, makeable
from foon_asp.compare.results_file import ResultsFile, comparison_json, results_question
from foon_asp.compare.rows_file import RowsFile
from foon_asp.compare.summary import Distance, Summary, all_proved, summarize_comparisons

__all__ = [
    "MEASURED",
    "Comparison",
    "Distance",
    "Judgement",
    "Optimum",
    "ResultsFile",
    "RowsFile",
    "Summary",
    "all_proved",
    "compare",
    "compare_goals",
    "comparison_json",
    "judge",
    "makeable",
    "results_question",
    "summarize_comparisons",
]
