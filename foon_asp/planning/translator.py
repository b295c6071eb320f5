"""The translator of Fast Downward, which reads PDDL and grounds it, run as another process.

It comes with the extra ``pddl``. It is under the GPL, so it is never installed otherwise, and never imported.
"""

import importlib.util
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from foon_asp.deadline import Deadline
from foon_asp.errors import UserError
from foon_asp.planning.pddl_outline import PddlOutline

_MODULE = "fast_downward.translate"
_ADVICE = "pip install 'foon-asp[pddl]' brings it along"
_INPUT_ERROR, _OUT_OF_MEMORY = 31, 20  # exit codes of the translator
# Without invariants each atom is a variable with two values: facts are atoms and their negations, and no
# action is pruned that is applicable in the delete relaxation alone.
_TRANSLATOR_OPTIONS = ("--invariant-generation-max-candidates", "0")


def is_installed() -> bool:
    """Whether the translator is installed."""
    try:
        return importlib.util.find_spec(_MODULE) is not None
    except ModuleNotFoundError:
        return False


def require_translator(purpose: str) -> None:
    """Raise :class:`UserError` if the translator is not installed; ``purpose`` is what needs it."""
    if not is_installed():
        raise UserError(f"{purpose} takes Fast Downward's translator, which is not installed: {_ADVICE}")


def translate(domain: PddlOutline, problem: PddlOutline, deadline: Deadline) -> str:
    """Return the text of the file that the translator writes for a planning task in PDDL.

    Raises :class:`UserError` if the translator is missing, refuses the task or fails. Raises
    :class:`LimitError` at the deadline.
    """
    require_translator(f"{problem.file}: reading PDDL")
    with tempfile.TemporaryDirectory(prefix="foon-asp-") as name:
        folder = Path(name)
        for outline in (domain, problem):
            (folder / f"{outline.kind}.pddl").write_text(outline.text, encoding="utf-8")
        code, output = _run(folder, deadline)
        written = folder / "output.sas"
        if code == 0 and written.is_file():
            return written.read_text(encoding="ascii")
    raise _failure(domain, problem, code, output)


def _run(folder: Path, deadline: Deadline) -> tuple[int, str]:
    """Run the translator in a folder until it ends; return its exit code and its output.

    Error output is included. The memory of the translator counts for the deadline. If a limit is reached, the
    process is killed and :class:`LimitError` is raised.
    """
    # Unbuffered, it notices at its next line that nobody reads it any more, should this process be killed.
    command = [sys.executable, "-P", "-u", "-m", _MODULE, *_TRANSLATOR_OPTIONS, "domain.pddl", "problem.pddl"]
    process = subprocess.Popen(
        command,
        cwd=folder,
        env={**os.environ, "PYTHONHASHSEED": "0"},  # the same task gets the same numbers
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        encoding="utf-8",
        errors="replace",
    )
    deadline.count_memory_of(process.pid)
    try:
        while True:
            try:
                output, _ = process.communicate(timeout=deadline.seconds_to_next_check())
            except subprocess.TimeoutExpired:
                deadline.check()
            else:
                return process.returncode, output
    finally:
        process.kill()
        process.wait()
        deadline.uncount_memory_of(process.pid)
        if process.stdout is not None:
            process.stdout.close()


def _failure(domain: PddlOutline, problem: PddlOutline, code: int, output: str) -> UserError:
    """Return the error that the translator's exit code and output mean.

    It is either an error in the planning task, or a failure of the translator itself.
    """
    lines = [line.strip() for line in output.splitlines() if line.strip()]
    if code == _INPUT_ERROR:
        return UserError(_input_error(domain, problem, lines))
    last = lines[-1] if lines else "it says nothing"
    if code == _OUT_OF_MEMORY or last.startswith("MemoryError"):
        reason = "Fast Downward's translator ran out of memory"
    elif code < 0:
        reason = f"Fast Downward's translator was ended by signal {-code}"
    elif last.startswith("RecursionError"):
        reason = "found conditions nested too deeply for Fast Downward's translator: nest them less"
    else:
        reason = f"Fast Downward's translator fails on these files, with {last[:200]!r}"
    return UserError(f"{domain.file}, {problem.file}: {reason}")


def _input_error(domain: PddlOutline, problem: PddlOutline, lines: list[str]) -> str:
    """Return the translator's error about its input in one line, with the file that it is in.

    The translator prints its context ("Parsing problem", "->Parsing goal") and a message. Mostly it also
    prints what it expects ("Syntax: ...") and what it found ("Got: ...").
    """
    context, messages, expectation = list[str](), list[str](), ""
    for line in lines:
        label, _, content = line.removeprefix("->").partition(": ")
        if label.startswith("Parsing"):
            context.append(label.removeprefix("Parsing "))
        elif label == "Got":
            expectation = f": found {content[:120]}" + expectation
        elif label == "Syntax":
            expectation = f", expected {content}"
        elif label == "Error":
            context.append("domain" if "domain file" in content else "problem")
        elif line not in messages and label != "Warning":
            messages.append(line.removeprefix("Reason: ").removesuffix("."))
    message = "; ".join(messages)[:500]
    file = (domain if context[:2] == ["Parsing...", "domain"] else problem).file
    section = f" (in {', '.join(dict.fromkeys(context[2:]))})" if context[2:] else ""
    return f"{file}: error: {message}{expectation}{section}: so says Fast Downward's translator"
