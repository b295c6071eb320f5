"""``foon-asp batch``: thousands of questions in one run, with a row for each answer."""

import time
from pathlib import Path
from typing import Any

import click

from foon_asp.asp import Settings
from foon_asp.asp.assembly import rules_digest
from foon_asp.batch.answer_row import ANSWERS, AnswerRow
from foon_asp.batch.answer_table import TABLE_SUFFIXES, check_table, write_table
from foon_asp.batch.cluster import answer_on_cluster
from foon_asp.batch.question_file import expand_questions, files_of_questions, read_questions
from foon_asp.batch.run_summary import RunSummary
from foon_asp.batch.workers import answer_all
from foon_asp.cli import shared_options
from foon_asp.cli.batch_data import Opening, data_digest, measure_names
from foon_asp.cli.click_option import click_options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.named_path import NamedPath, WrittenPath
from foon_asp.cli.output_file import check_outputs, refuse_inputs
from foon_asp.cli.progress_line import Progress
from foon_asp.comparison.rows_file import RowsFile
from foon_asp.problem import Objective
from foon_asp.questions.options import EACH_LIMITS, JOBS, RULES
from foon_asp.rules.passed_constraint import Constraint


@click.command("batch")
@click.argument("questions", type=click.Path(path_type=NamedPath), metavar="QUESTIONS.jsonl")
@shared_options.sources_argument
@click.option(
    "--results",
    "results_file",
    required=True,
    type=WrittenPath(),
    metavar="FILE",
    help="A file for the rows, as JSON Lines; if its name ends in .csv or .parquet, a table of them.",
)
@click_options(JOBS)
@click.option("--scheduler", metavar="ADDRESS", help="Use the workers of a Dask cluster: tcp://HOST:PORT.")
@click_options(*RULES, *EACH_LIMITS)
@shared_options.format_option("text", "json")
@shared_options.data_options
def command(
    questions: Path,
    results_file: Path,
    jobs: int,
    scheduler: str | None,
    constraints: tuple[Constraint, ...],
    constants: tuple[str, ...],
    encodings: Path | None,
    time_limit: float | None,
    memory_limit: int | None,
    format_: str,
    sources: tuple[Path, ...],
    **data: Any,
) -> ExitCode:
    """Answer every question of a file, and write each answer as soon as it is found.

    \b
    foon-asp batch questions.jsonl --results answers.jsonl --jobs 2
    foon-asp batch questions.jsonl --results answers.parquet --network recipes.foon
    foon-asp batch questions.jsonl recipe.txt --results answers.jsonl
    foon-asp batch questions.jsonl --results answers.jsonl --scheduler tcp://10.0.0.5:8786

    \b
    A line of the file asks for every combination of its values:
    {"goal": ["ice", "macaroni"], "objective": ["units", "success,units"]}
    {"goal": "@makeable", "containers": ["strict", "implied"], "kitchen": "small.json"}
    {"goal": [["ice", "macaroni"]], "time_limit": 10}
    {"goal": "@goals", "items": "used-up", "stock": "stock.txt"}
    {"goal": "ice", "amount": [1, 8]}

    @goals stands for all goals of the goals file, @makeable for everything that can be made. A list within
    the list of goals asks for one tree that makes several goals; a list within the list of amounts has an
    amount for each of them. Kitchens, stocks and lists of what stays are files in the folder of the
    questions. The kitchen @starting is what makes the units of each file run. --time-limit is for each
    question without a limit of its own, --memory-limit for each process that answers. Rules hold for all
    questions.

    When the same command is run again, it continues: questions with an answer are not asked again. A question
    that fails becomes a row with the reason. Exits with 0 when every answer is proved, 1 when some questions
    failed, and 3 when a limit stopped some or ctrl-C the run.
    """
    check_outputs()
    data["folder"], data["network"] = shared_options.folder_and_networks(
        sources, data["folder"], data["network"]
    )
    measures = measure_names(data)
    unexpanded_questions = read_questions(questions, time_limit, measures)
    files = files_of_questions(unexpanded_questions)
    refuse_inputs(results_file, files)
    opening = Opening(tuple(data.items()), data_digest(data, files))
    opened = opening(quiet=False)
    distinct_questions = list(expand_questions(unexpanded_questions, opened))

    def warn(message: str) -> None:
        """Print a warning to standard error."""
        click.echo(message, err=True)

    settings = Settings(constraints, encodings, constants)
    run_settings = {
        "data": opening.digest,
        "level": data["level"],
        **rules_digest(settings, warn, opened.example),
    }
    rows_file = results_file
    if results_file.suffix in TABLE_SUFFIXES:
        rows_file = results_file.with_name(f"{results_file.name}.jsonl")
        check_table(results_file, rows_file)
    answered: list[AnswerRow] = []
    interrupted = False
    began = time.monotonic()
    with RowsFile(rows_file, ANSWERS, run_settings) as results:
        for warning in results.duplicate_warnings:
            warn(warning)
        answered_before = [
            results.done[question] for question in distinct_questions if question in results.done
        ]
        open_questions = [question for question in distinct_questions if question not in results.done]
        with Progress() as progress:
            progress.step("answering", len(answered_before), len(distinct_questions))
            progress.begin()
            processes = min(jobs, max(1, len(open_questions)))
            try:
                rows = (
                    answer_all(opening, open_questions, processes, memory_limit, settings)
                    if scheduler is None
                    else answer_on_cluster(opening, open_questions, scheduler, memory_limit, settings)
                )
                for row in rows:
                    results.add(row)
                    answered.append(row)
                    progress.step("answering", len(answered_before) + len(answered), len(distinct_questions))
            except KeyboardInterrupt:
                interrupted = True
        if rows_file is not results_file:
            objectives = (*Objective, *map(Objective.of_measure, measures))
            write_table(results_file, results.done.values(), objectives)
    summary = RunSummary.of(len(distinct_questions), answered_before, answered, time.monotonic() - began)
    if format_ == "json":
        click.echo(summary.json_text(), nl=False)
    else:
        click.echo(f"{summary.text()}results: {results_file}")
    if interrupted:
        click.echo("interrupted: run the same command again to continue", err=True)
    return _exit_code(summary.statuses, interrupted)


def _exit_code(statuses: dict[str, int], interrupted: bool) -> ExitCode:
    """Return ``LIMIT`` if ctrl-C or a limit came first, ``NEGATIVE`` if a question failed, else ``DONE``.

    ``statuses`` has the number of questions by status.
    """
    if interrupted or statuses.keys() & {"feasible", "unknown"}:
        return ExitCode.LIMIT
    return ExitCode.NEGATIVE if "failed" in statuses else ExitCode.DONE
