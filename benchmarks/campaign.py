"""The campaign of the tests at length: ``python -m benchmarks.campaign 2000 [FIRST SEED]``."""

import sys
import time
from collections import Counter
from collections.abc import Sequence

from tests.oracle.campaign import campaign

_AT_ONCE = 50  # networks between two lines


def main(words: Sequence[str]) -> int:
    """Ask about ``number`` networks; gives 1 if an answer is wrong."""
    number, first = int(words[0]), int(words[1]) if len(words) > 1 else 0
    began, total = time.monotonic(), Counter({"wrong": 0})
    for start in range(first, first + number, _AT_ONCE):
        wrong: list[str] = []
        total.update(campaign(range(start, min(start + _AT_ONCE, first + number)), wrong))
        for said in wrong:
            print(f"WRONG: {said}", flush=True)
        print(f"{time.monotonic() - began:6.0f} s  {dict(total)}", file=sys.stderr, flush=True)
    for name, count in total.items():
        print(f"{name:32} {count:6}")
    return int(total["wrong"] > 0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
