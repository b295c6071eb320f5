"""The benchmark of cost against size: exponents, and a whole run."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
import scaling

from tests.conftest import ROOT


def test_exponents_of_power_laws() -> None:
    sizes = (1000, 10_000, 100_000)
    assert scaling.slope([(size, 3e-6 * size) for size in sizes]) == pytest.approx(1)
    assert scaling.slope([(size, 0.25) for size in sizes]) == pytest.approx(0)
    assert scaling.slope([(size, 1e-9 * size**1.5) for size in sizes]) == pytest.approx(1.5)


@pytest.mark.slow
def test_a_whole_run(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    page, plot = tmp_path / "page.md", tmp_path / "growth.svg"
    page.write_text("<!-- begin scaling -->\n<!-- end scaling -->\n", encoding="utf-8")
    words = ["--units", "300", "--units", "600", "--runs", "1", "--page", str(page), "--plot", str(plot)]
    script = [sys.executable, str(ROOT / "benchmarks" / "scaling.py"), *words]
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    ran = subprocess.run(script, capture_output=True, text=True, check=True, env=environment)
    assert "| step | 300 units | 600 units | exponent |" in ran.stdout
    assert all(f"| {step} |" in ran.stdout for step in scaling.STEPS)
    assert ran.stdout.strip() in page.read_text(encoding="utf-8")
    assert all(f"| memory, {name} |" in ran.stdout for name in scaling.MEMORY)
    assert all(each in plot.read_text(encoding="utf-8") for each in ("seconds", "peak memory, MB"))
