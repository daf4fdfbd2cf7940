"""Pens that suit a small print."""

from __future__ import annotations

from penink_cli.chain.job import Job
from penink_cli.ground import pens
from penink_cli.ground.units import parse_length
from penink_cli.outputs.registry import of_illustrations


def refine(job: Job) -> None:
    """Make the pens of the job's stages finer where the drawing is small.

    A pen that the user has named stays. An illustration gets its finer pens when it is drawn.
    """
    by = pens.part(job.width)
    if by == 1.0 or "pen" in job.given or of_illustrations(job.ending):
        return
    for stage, name, usual in (("blast", "pen", None), ("outline", "weight", 0.7), ("lines", "pen", 1.3)):
        if stage not in job.stages:
            continue
        told = job.stages[stage]
        name = "pen" if "pen" in told else name
        if (pen := told.get(name, usual)) is not None:
            width = parse_length(pen) if isinstance(pen, str) else float(pen)
            told[name] = pens.finer(width, by, job.device_dpi)
        if stage == "blast":
            told["finer"] = by
