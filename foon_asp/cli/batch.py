"""``foon-asp batch``: thousands of questions in one run, each answer a row."""

import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import click

from foon_asp.asp import Settings
from foon_asp.asp.assembly import rules_digest
from foon_asp.batch.answer_row import Row
from foon_asp.batch.asked import Asked
from foon_asp.batch.cluster import answer_on_cluster
from foon_asp.batch.question_file import each_question, read_questions
from foon_asp.batch.results import open_results
from foon_asp.batch.tally import Tally
from foon_asp.batch.workers import Work, answer_all
from foon_asp.cli import options
from foon_asp.cli.batch_data import Opening, digest, measured
from foon_asp.cli.click_option import click_options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.named_path import NamedPath
from foon_asp.cli.output_file import check_outputs
from foon_asp.cli.progress import Progress
from foon_asp.document.json_document import document
from foon_asp.network import counted
from foon_asp.questions.options import EACH_LIMITS, JOBS, RULES
from foon_asp.rules.constraint import Constraint
from foon_asp.text.json_value import Json, json_text


@click.command("batch")
@click.argument("questions", type=click.Path(path_type=NamedPath), metavar="QUESTIONS.jsonl")
@options.sources_argument
@click.option(
    "--results",
    "results_file",
    required=True,
    type=click.Path(path_type=NamedPath),
    metavar="FILE",
    help="A file for the rows, as JSON Lines; if its name ends in .parquet, a folder of Parquet files.",
)
@click_options(JOBS)
@click.option("--scheduler", metavar="ADDRESS", help="Use the workers of a Dask cluster: tcp://HOST:PORT.")
@click_options(*RULES, *EACH_LIMITS)
@options.format_option("text", "json")
@options.data_options
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

    @goals stands for the goals file, @makeable for everything that can be made; a list within the list is one
    tree for several goals; kitchens, stocks and what stays are files in the folder of the questions;
    the kitchen @starting is what no unit makes.
    --time-limit is for each question without a limit of its own, --memory-limit for each process that
    answers, and rules hold for all questions.

    When the same command is run again, it continues: what has an answer is not asked again. A question that
    fails becomes a row with the reason. Exits with 0 when every answer is proved, 1 when some failed, and
    with 3 when a limit stopped some, or ctrl-C the run.
    """
    check_outputs()
    given = options.with_sources(sources, data["folder"], data["network"])
    data["folder"], data["network"] = given
    lines = read_questions(questions, time_limit, measured(data))
    opening = Opening(tuple(data.items()), digest(data, [file for line in lines for file in line.files]))
    asked = list(each_question(lines, opening(quiet=False)))

    def warn(message: str) -> None:
        click.echo(message, err=True)

    how = Settings(constraints, encodings, constants)
    common = {"data": opening.digest, "level": data["level"], **rules_digest(how, warn)}
    interrupted = False
    began = time.monotonic()
    with open_results(results_file, common) as results:
        left = [one for one in asked if one.key not in results.done]
        tally = Tally(results.done[one.key] for one in asked if one.key in results.done)
        before = len(asked) - len(left)
        with Progress() as progress:
            progress.step("answering", before, len(asked))
            progress.begin()
            try:
                rows = _rows(Work(opening, memory_limit, how=how), left, jobs, scheduler)
                for number, (one, row) in enumerate(rows, 1):
                    results.add(one, row)
                    tally.add(row)
                    progress.step("answering", before + number, len(asked))
            except KeyboardInterrupt:
                interrupted = True
    seconds = round(time.monotonic() - began, 3)
    summary = document("batch", questions=len(asked)) | tally.summary() | {"seconds": seconds}
    if format_ == "json":
        click.echo(json_text(summary), nl=False)
    else:
        for line in _in_words(summary, tally):
            click.echo(line)
        click.echo(f"results: {results_file}")
    if interrupted:
        click.echo("interrupted: run the same command again to continue", err=True)
    return _exit_code(tally, interrupted)


def _rows(
    work: Work, asked: Sequence[Asked], jobs: int, scheduler: str | None
) -> Iterator[tuple[Asked, Row]]:
    if scheduler is not None:
        return answer_on_cluster(work.opener, asked, scheduler, work.memory_limit, work.how)
    return answer_all(work, asked, min(jobs, max(1, len(asked))))


def _in_words(summary: Json, tally: Tally) -> Iterator[str]:
    before = tally.before.total()
    yield counted(summary["questions"], "question", ",") + (
        f", {before:,} of them answered before" if before else ""
    )
    counts = tally.statuses + tally.before
    yield "in total: " + (", ".join(f"{n:,} {status}" for status, n in sorted(counts.items())) or "none")
    if tally.statuses:
        yield f"answered {tally.statuses.total():,} in {summary['seconds']:.1f} s"
        proofs = ", ".join(f"{count:,} by {proof}" for proof, count in sorted(tally.proofs.items()))
        yield f"proved: {proofs or 'none'}"
    if summary["seconds_median"] is not None:
        yield f"seconds for one: median {summary['seconds_median']:.3f}, worst {summary['seconds_worst']:.3f}"
    yield from (f"failed: {error}" for error in tally.errors)
    if tally.statuses["failed"] > len(tally.errors):
        yield f"... and {tally.statuses['failed'] - len(tally.errors)} more failed: see their rows"


def _exit_code(tally: Tally, interrupted: bool) -> ExitCode:
    counts = tally.statuses + tally.before
    if interrupted or counts["feasible"] or counts["unknown"]:
        return ExitCode.LIMIT
    return ExitCode.NEGATIVE if counts["failed"] else ExitCode.DONE
