"""Peers for metabolism, Meneco and Seed2LP (PyPI), each in a process that is ended at the limit."""

import os
import re
import signal
import subprocess
import sys
import time
import venv
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple
from xml.sax.saxutils import quoteattr

from foon_asp.problem import Problem

# Meneco imports a module that Python no longer has
_MENECO = """
import sys, xml.etree.ElementTree as tree
sys.modules["xml.etree.cElementTree"] = tree
from meneco.meneco import cmd_meneco
cmd_meneco(sys.argv[1:])
"""


class PeerAnswer(NamedTuple):
    """The answer of a peer: the size of its optimum, its seconds, and the sizes of intersection and union."""

    optimum: int | None
    seconds: float
    every: int | None = None
    some: int | None = None


def install_peers(folder: Path) -> Path:
    """Return the programs of an environment with the peers, which is made if it is not there."""
    programs = folder / ("Scripts" if sys.platform == "win32" else "bin")
    if not (programs / "seed2lp").exists():
        venv.create(folder, with_pip=True)
        subprocess.run([programs / "pip", "install", "--quiet", "meneco", "seed2lp"], check=True)
    return programs


def ask_meneco(programs: Path, problem: Problem, folder: Path, limit: float) -> PeerAnswer:
    """Ask for the fewest one-way reactions, and which are in every optimum and in some."""
    network = problem.network
    names = list(map(str, network.objects))
    reactions = [
        _reaction(f"u{unit}", *([names[o] for o in side[unit]] for side in (network.inputs, network.outputs)))
        for unit in range(len(network))
    ]
    models = {
        "repairnet": _model(names, reactions),
        "draftnet": _model(["no", "thing"], [_reaction("none", ["no"], ["thing"])]),
        "seeds": _model([names[o] for o in sorted(problem.kitchen)], []),
        "targets": _model([names[o] for o in problem.goals], []),
    }
    command = [str(programs / "python"), "-c", _MENECO, "--json"]
    for name, text in models.items():
        (folder / f"{name}.xml").write_text(text, encoding="utf-8")
        command += [f"--{name}", str(folder / f"{name}.xml")]
    said, seconds = _run(command, programs, folder, limit)
    sizes = []
    for key in (
        "One minimal completion",
        "Intersection of cardinality minimal completions",
        "Union of cardinality minimal completions",
    ):
        found = re.search(rf'"{key}": \[(.*?)\]', said, re.DOTALL)
        sizes.append(found[1].count('"u') if found else None)
    return PeerAnswer(sizes[0], seconds, sizes[1], sizes[2])


def ask_seed2lp(programs: Path, model: Path, problem: Problem, folder: Path, limit: float) -> PeerAnswer:
    """Ask for the fewest seeds beside those of the kitchen; targets may be seeds."""
    objects = problem.network.objects
    files = {"targets": problem.goals, "seeds": sorted(problem.kitchen)}
    command = [str(programs / "seed2lp"), "target", str(model), str(folder / "seeds-found")]
    for name, nodes in files.items():
        (folder / f"{name}.txt").write_text("".join(f"{objects[o]}\n" for o in nodes), encoding="utf-8")
        command += [f"--{name}-file", str(folder / f"{name}.txt")]
    command += ["--mode", "minimize", "--solve", "reasoning", "--number-solution", "1"]
    command += ["--targets-as-seeds", "--accumulation"]
    said, seconds = _run(command, programs, folder, limit)
    stated = re.search(r"Minimal size of seed set is (\d+)", said)  # those of the kitchen included
    size = int(stated[1]) if stated else None
    return PeerAnswer(None if size is None else size - len(problem.kitchen), seconds)


def _run(command: Sequence[str], programs: Path, folder: Path, limit: float) -> tuple[str, float]:
    """Return what a command prints in a folder, empty where its time was up, and its seconds."""
    began = time.monotonic()
    process = subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        cwd=folder,
        env={"PATH": f"{programs}:/usr/bin:/bin"},
        start_new_session=True,
    )
    try:
        said, _ = process.communicate(timeout=limit)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        said = ""
    return said, time.monotonic() - began


def _model(species: Iterable[str], reactions: Iterable[str]) -> str:
    listed = "".join(f"<species id={quoteattr(name)}/>" for name in species)
    return (
        f'<?xml version="1.0"?><sbml><model><listOfSpecies>{listed}</listOfSpecies>'
        f"<listOfReactions>{''.join(reactions)}</listOfReactions></model></sbml>"
    )


def _reaction(name: str, needs: Iterable[str], gives: Iterable[str]) -> str:
    sides = "".join(
        f"<{tag}>{''.join(f'<speciesReference species={quoteattr(node)}/>' for node in nodes)}</{tag}>"
        for tag, nodes in (("listOfReactants", needs), ("listOfProducts", gives))
    )
    return f'<reaction id="{name}" reversible="false">{sides}</reaction>'
