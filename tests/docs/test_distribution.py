"""The sdist and the wheel: complete, and working where there is no checkout."""

import json
import os
import shutil
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest

from tests.conftest import ROOT

pytestmark = pytest.mark.slow


def run(*arguments: str | Path, cwd: Path, by: str | Path = sys.executable, **environment: str) -> str:
    """Run Python in a folder and give its stdout; fails with its stderr when it does not end with 0."""
    command = [str(by), *map(str, arguments)]
    variables = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    ended = subprocess.run(
        command, cwd=cwd, env=variables | environment, capture_output=True, text=True, check=False
    )
    assert ended.returncode == 0, f"{command} ended with {ended.returncode}\n{ended.stderr}"
    return ended.stdout


def files_in(folder: str) -> set[str]:
    """Give the files of a folder of the checkout, relative to the checkout."""
    paths = (path for path in (ROOT / folder).rglob("*") if path.is_file())
    return {path.relative_to(ROOT).as_posix() for path in paths if "__pycache__" not in path.parts}


@pytest.fixture(scope="module")
def sdist(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Build the sdist from the checkout."""
    folder = tmp_path_factory.mktemp("sdist")
    run("-m", "hatchling", "build", "-t", "sdist", "-d", folder, cwd=ROOT)
    (built,) = folder.glob("*.tar.gz")
    return built


@pytest.fixture(scope="module")
def unpacked(sdist: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Unpack the sdist."""
    folder = tmp_path_factory.mktemp("unpacked")
    with tarfile.open(sdist) as archive:
        archive.extractall(folder, filter="data")
    (top,) = folder.iterdir()
    return top


@pytest.fixture(scope="module")
def wheel(unpacked: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Build the wheel from the unpacked sdist, as installers do."""
    folder = tmp_path_factory.mktemp("wheel")
    run("-m", "hatchling", "build", "-t", "wheel", "-d", folder, cwd=unpacked)
    (built,) = folder.glob("*.whl")
    return built


@pytest.fixture(scope="module")
def installed(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Install the wheel on its own; its dependencies are those of the running Python."""
    folder = tmp_path_factory.mktemp("installed")
    run(
        *("-m", "pip", "--disable-pip-version-check", "install", "--quiet"),
        *("--no-deps", "--no-index", "--target", folder, wheel),
        cwd=folder,
    )
    return folder


def test_sdist_has_everything_to_work_on(unpacked: Path) -> None:
    packed = {path.relative_to(unpacked).as_posix() for path in unpacked.rglob("*") if path.is_file()}
    expected = {"LICENSE", "README.md", "pyproject.toml", "Makefile", ".ci/run"}
    for folder in ("foon_asp", "encodings", "data", "tests", "benchmarks", "docs"):
        expected |= files_in(folder)
    assert sorted(expected - packed) == []
    assert sorted(path for path in packed if path.endswith(".pyc") or path.startswith(".venv")) == []


def test_wheel_has_encodings_data_and_grammar(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        contents = {name: archive.read(name) for name in archive.namelist()}
    beside = {f"foon_asp/{name}": name for name in files_in("encodings") | files_in("data")}
    expected = beside | {name: name for name in files_in("foon_asp")}
    packed = {name for name in contents if not name.split("/")[0].endswith(".dist-info")}
    assert packed == set(expected)
    assert all(contents[name] == (ROOT / file).read_bytes() for name, file in expected.items())
    assert {"foon_asp/text/foon.lark", "foon_asp/py.typed", "foon_asp/encodings/show.lp"} <= packed
    (entry_points,) = (name for name in contents if name.endswith("entry_points.txt"))
    assert "foon-asp = foon_asp.cli.start:main" in contents[entry_points].decode()


@pytest.mark.parametrize(
    "entry",
    [
        ["-m", "foon_asp"],
        ["{installed}/bin/foon-asp"],
    ],
    ids=["module", "script"],
)
def test_installed_wheel_solves_in_an_empty_folder(entry: list[str], installed: Path, tmp_path: Path) -> None:
    if entry[0].startswith("{") and os.name == "nt":
        pytest.skip("the script is an .exe there")
    command = [word.format(installed=installed) for word in entry]
    question = ["solve", "--goal", "ice", "--format", "json"]
    answer = json.loads(run(*command, *question, cwd=tmp_path, PYTHONPATH=str(installed)))
    assert answer["status"] == "optimal"
    assert answer["costs"]["units"] == 2
    assert str(installed) in json.dumps(answer["units"]), "the units come from the kitchen of the wheel"
    assert not list(tmp_path.iterdir())


def test_an_editable_install_runs_the_encodings_and_the_kitchen_of_the_checkout(
    unpacked: Path, tmp_path: Path
) -> None:
    checkout = tmp_path / "checkout"
    shutil.copytree(unpacked, checkout)
    build = "import hatchling.build, sys; print(hatchling.build.build_editable(sys.argv[1]))"
    name = run("-c", build, tmp_path, cwd=checkout).split()[-1]
    # an environment of its own: it finds dependencies where the running Python does, but no other foon-asp
    run("-m", "venv", "--without-pip", tmp_path / "venv", cwd=tmp_path)
    python = tmp_path / "venv" / ("Scripts" if os.name == "nt" else "bin") / "python"
    folder = Path(
        run("-c", "import sysconfig; print(sysconfig.get_path('purelib'))", cwd=tmp_path, by=python).strip()
    )
    dependencies = [path for path in sys.path if path.endswith("site-packages")]
    (folder / "dependencies.pth").write_text("\n".join(dependencies), encoding="utf-8")
    run(
        *("-m", "pip", "--disable-pip-version-check", "install", "--quiet"),
        *("--no-deps", "--no-index", "--target", folder, tmp_path / name),
        cwd=tmp_path,
    )
    question = ("-m", "foon_asp", "solve", "--goal", "ice", "--format", "json")
    assert json.loads(run(*question, cwd=tmp_path, by=python))["costs"]["units"] == 2
    with (checkout / "encodings" / "constraints" / "forbid_motion.lp").open(
        "a", encoding="utf-8"
    ) as encoding:
        encoding.write('\n:- use(U), motion(U, "crush").\n')
    rule = ("--constraint", "forbid_motion", "-c", "forbidden_motion=fry")
    answer = json.loads(run(*question, *rule, cwd=tmp_path, by=python))
    assert answer["costs"]["units"] == 3, "the encoding that was changed is not the one that ran"
