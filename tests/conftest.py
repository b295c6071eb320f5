"""What tests share: the bundled kitchen, the real corpus where it is at hand, and the command line."""

import io
import json
import signal
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import jsonschema
import pytest
from hypothesis import HealthCheck, settings
from hypothesis.internal.conjecture import providers

from foon_asp.cli.main import main
from foon_asp.json_layout import schema_name
from foon_asp.results.schema_file import schema

ROOT = Path(__file__).resolve().parents[1]
CORPUS = ROOT.parent / "shared" / "corpus"

# On a busy machine, a limit comes while a file is read: between opening it and seeing to its end.
STRUCK_WHILE_READING = pytest.mark.filterwarnings(
    "ignore:Exception ignored in. <_io.FileIO:pytest.PytestUnraisableExceptionWarning"
)

# The machine may be busy: no example fails for being slow.
settings.register_profile("busy", deadline=None, suppress_health_check=(HealthCheck.too_slow,))
settings.load_profile("busy")

# Hypothesis also draws what is written in modules of ours that are imported by then. So examples would depend
# on which tests ran before, and a sixth of all time would go into choosing among thousands of texts.
if hasattr(providers, "_get_local_constants"):
    none = providers._local_constants
    providers._get_local_constants = lambda: none

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    # started in the background by a shell, we ignore ctrl-C, and so would all commands that tests interrupt
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Make slow tests of the cases that ``default_cases`` does not name."""
    for item in items:
        named = item.get_closest_marker("default_cases")
        if named is not None and item.name.partition("[")[2].removesuffix("]") not in named.args:
            item.add_marker(pytest.mark.slow)


@cache
def _validator(kind: str) -> Any:
    return jsonschema.Draft202012Validator(schema(kind))


def valid(value: Any) -> Any:
    """Give a document of ours back if its schema has it; of certificates, there is another description."""
    if value.get("format") == "foon-asp certificate":
        return value
    name, kind, _ = value["schema"].split("/")
    assert (name, value["schema"]) == ("foon-asp", schema_name(kind))
    validator = _validator(kind)
    if not validator.is_valid(value):
        fault = jsonschema.exceptions.best_match(validator.iter_errors(value))
        raise AssertionError(f"{kind}: {fault.json_path}: {fault.message[:500]}")
    if kind == "each":
        for answer in value["answers"]:
            valid(answer)
    return value


class Ran(NamedTuple):
    """How a command ended."""

    code: int
    out: str
    err: str

    @property
    def json(self) -> Any:
        """Parse what was printed, and hold it against its schema."""
        return valid(json.loads(self.out))


Cli = Callable[..., Ran]


@pytest.fixture
def cli(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Cli:
    """Run ``foon-asp`` with words and give exit code, stdout and stderr."""
    monkeypatch.setattr(sys, "stdin", io.StringIO())

    def run(*words: str | Path) -> Ran:
        capsys.readouterr()
        with pytest.raises(SystemExit) as ended:
            main([str(word) for word in words])
        captured = capsys.readouterr()
        code = ended.value.code
        assert isinstance(code, int)
        return Ran(code, captured.out, captured.err)

    return run


@pytest.fixture(scope="session")
def universal() -> Path:
    """Give the folder of the real universal FOON, or skip."""
    folder = CORPUS / "universal"
    if not folder.is_dir():
        pytest.skip(f"the real corpus is not at {CORPUS}")
    return folder
