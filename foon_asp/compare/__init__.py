"""Searches compared with the optimum, for one goal or thousands."""

from foon_asp.compare.comparison import MEASURED as MEASURED
from foon_asp.compare.comparison import Comparison as Comparison
from foon_asp.compare.comparison import Judgement as Judgement
from foon_asp.compare.comparison import Optimum as Optimum
from foon_asp.compare.comparison import compare as compare
from foon_asp.compare.comparison import judge as judge
from foon_asp.compare.many import compare_goals as compare_goals
from foon_asp.compare.many import makeable as makeable
from foon_asp.compare.results_file import ResultsFile as ResultsFile
from foon_asp.compare.results_file import comparison_json as comparison_json
from foon_asp.compare.results_file import results_question as results_question
from foon_asp.compare.rows_file import RowsFile as RowsFile
from foon_asp.compare.summary import Distance as Distance
from foon_asp.compare.summary import Summary as Summary
from foon_asp.compare.summary import all_proved as all_proved
from foon_asp.compare.summary import summarize_comparisons as summarize_comparisons
