"""Every transcript is what the command line prints."""

from pathlib import Path

import pytest

from tests.golden.transcript import KITCHEN, commands, recorded, run_here, transcripts


@pytest.mark.parametrize("path", transcripts(), ids=lambda path: path.stem)
def test_a_transcript_is_what_is_printed(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    assert "\n".join(recorded(commands(text), run_here, KITCHEN)) == text, (
        "python -m tests.golden records it anew"
    )
