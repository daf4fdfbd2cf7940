"""Plates of several inks, drawn so that together they print the right colours."""

from __future__ import annotations

from collections.abc import Callable

from penink_cli.chain.job import Job
from penink_cli.chain.plates import Plate
from penink_cli.chain.words import said


def balanced(
    job: Job, plates: list[Plate], greys: list[str], over: list[str], white: list[str],
    hatched: Callable[[list[str], str], list[str]],
) -> list[str]:  # fmt: skip
    """The strokes of plates that are drawn, drawn again by corrected tones, and pressed.

    greys: that each plate is blasted from. over: strokes that are on the sheet already. white: words of the white
    lines.
    hatched: draws such greys, under names of that ending. With --gamma, which asks for other colours, tones are not
    corrected; with one pen for all strokes they are not pressed.
    """
    told = [word for grey in greys for word in ("--tone", grey)]
    told += [*(word for name in over for word in ("--ink", name)), *white]
    gamma = job.stages["blast"].get("gamma")
    drawn = hatched(greys, "draft.jsonl" if gamma is None else "hatching.jsonl")
    if gamma is None:
        corrected = job.chain.run_plates("balance", ["--correct", *told, *drawn], "corrected-{}.pgm", len(plates))
        drawn = hatched(corrected, "hatching.jsonl")
    else:
        told += ["--gamma", said(gamma)]
    if "pen" in job.given:
        return drawn
    return job.chain.run_plates("balance", [*told, *drawn], "pressed-{}.jsonl", len(plates))
