"""A question asked again from the report of a disagreement."""

import json
from pathlib import Path
from typing import Any


def reported(folder: Path) -> dict[str, Any]:
    """Read the only report in a folder."""
    (file,) = folder.glob("foon-asp-disagreement-*.json")
    report: dict[str, Any] = json.loads(file.read_text())
    return report


def words_to_ask_again(report: dict[str, Any], folder: Path) -> list[str]:
    """Write what a report has as text to a folder, and return the words that ask its question of it."""
    folder.mkdir()
    for name, text in report["data"].items():
        (folder / name).write_text(text)
    asked = report["question"]
    words = ["solve", "--data", str(folder), "--objective", ",".join(asked["objectives"]), "--cross-check"]
    words += ["--containers", asked["containers"], "--level", str(asked["level"])]
    words += [word for goal in asked["goals"] for word in ("--goal", goal if ";" in goal else goal + ";")]
    words += [word for each in asked["constants"] for word in ("-c", each)]
    for number, text in enumerate(asked["constraints"]):
        (folder / f"{number}.lp").write_text(text)
        words += ["--constraint", str(folder / f"{number}.lp")]
    for number, soft in enumerate(asked["soft"]):
        (folder / f"soft-{number}.lp").write_text(soft["rules"])
        words += ["--soft", f"{folder / f'soft-{number}.lp'}={soft['weight']}"]
    return words
