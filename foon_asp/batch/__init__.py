"""Thousands of questions in one run: local processes or a cluster, results as they come."""

from foon_asp.batch.answer_row import Row, answer_row
from foon_asp.batch.asked import Asked, Asker, Opener
from foon_asp.batch.cluster import answer_on_cluster
from foon_asp.batch.question_file import QuestionLine, each_question, read_questions
from foon_asp.batch.results import Results, open_results
from foon_asp.batch.tally import Tally
from foon_asp.batch.workers import Work, answer_all

__all__ = [
    "Asked",
    "Asker",
    "Opener",
    "QuestionLine",
    "Results",
    "Row",
    "Tally",
    "Work",
    "answer_all",
    "answer_on_cluster",
    "answer_row",
    "each_question",
    "open_results",
    "read_questions",
]
