"""Thousands of questions in one run: local processes or a cluster, results as they come."""

from foon_asp.batch.answer_row import Row as Row
from foon_asp.batch.answer_row import answer_row as answer_row
from foon_asp.batch.asked import Asked as Asked
from foon_asp.batch.asked import Asker as Asker
from foon_asp.batch.asked import Opener as Opener
from foon_asp.batch.cluster import answer_on_cluster as answer_on_cluster
from foon_asp.batch.question_file import QuestionLine as QuestionLine
from foon_asp.batch.question_file import each_question as each_question
from foon_asp.batch.question_file import read_questions as read_questions
from foon_asp.batch.results import Results as Results
from foon_asp.batch.results import open_results as open_results
from foon_asp.batch.tally import Tally as Tally
from foon_asp.batch.workers import Work as Work
from foon_asp.batch.workers import answer_all as answer_all
