"""Two checkouts that do the same, in turn: what else the machine does slows both."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

HERE = Path(__file__).parents[2]
TURNS = 7  # of either checkout, after one that fills the caches

T = TypeVar("T")


def older_checkout(words: list[str]) -> Path:
    """The checkout that the first word names. The program ends where there is none."""
    if not words or not (Path(words[0]) / "penink_cli").is_dir():
        sys.exit("against what? the folder of an older checkout, built, is wanted")
    return Path(words[0]).resolve()


def in_turn(older: Path, run: Callable[[Path], tuple[T, bytes]]) -> tuple[list[T], list[T], bool]:
    """What the runs of the older checkout took, what those of this one took, and whether the results are the same.

    run: does the work by a checkout; returns what it took, and the bytes of the result.
    """
    taken: dict[Path, list[T]] = {older: [], HERE: []}
    results: dict[Path, bytes] = {}
    for turn in range(TURNS + 1):
        for checkout, figures in taken.items():
            one, results[checkout] = run(checkout)
            if turn:
                figures.append(one)
    return taken[older], taken[HERE], results[older] == results[HERE]
