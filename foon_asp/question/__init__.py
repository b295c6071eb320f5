"""Data that was named and read, from text or from a store, and the problems that are posed of it."""

from foon_asp.question.question import Question, ask
from foon_asp.question.reading import question_files, read_question

__all__ = ["Question", "ask", "question_files", "read_question"]
