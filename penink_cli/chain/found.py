"""The filters that look at a photo before a stroke is drawn: its grey, its edges, its telling lines, its directions."""

from __future__ import annotations

from penink_cli.chain.job import ARCHIVE, Job, least_length
from penink_cli.outputs.registry import of_illustrations

COMPOSED_DPI = 288.0  # as `compose` has it
# Pixels an inch that an illustration is made from: enough for a drawing four times as wide. At 576 archives of photos
# of 10 pixels a point took 16 % fewer bytes and showed as much at their own width, but less four times as wide (detail
# .760 for .772); at 288 much less (.727).
POSTER_DPI = 1152.0
# Squared grey levels a bit that a chain of an archive's edges must save, usually and where --max-bytes thins them
# later.
WORTH, RICH_WORTH = 160.0, 40.0
FIELD_SIDE = 48  # samples of directions along the longer side of an archive


def composed(job: Job, photo: list[str], shape: tuple[int, ...]) -> tuple[str, tuple[int, int]]:
    """The grey of the drawing, or its colours where plates are made of them, and its width and height in pixels.

    photo: words; shape: its rows and columns.
    """
    from penink_cli.composition.compose import working_size

    if job.inks and job.composes:
        name = job.run("compose", ["--color", *_composing(job), *photo], "colours.ppm")
    else:
        name = job.run("compose", [*_composing(job), *photo], "grey.pgm")
    dpi = POSTER_DPI if of_illustrations(job.ending) else COMPOSED_DPI
    return name, working_size(shape, job.width, dpi / 72)


def _composing(job: Job) -> list[str]:
    told = [*job.on_paper, *job.words("compose", "compose")]
    told += ["--mask", job.given["mask"]] if "mask" in job.given else []
    return told + (["--dpi", repr(POSTER_DPI)] if of_illustrations(job.ending) else [])


def edges(job: Job, grey: str, size: tuple[int, int]) -> str:
    """The edges of the grey; for an archive only those that are worth their bytes or will be outlined."""
    told = job.words("edges", "detect-edges")
    if not of_illustrations(job.ending) and not job.enlarged(size):
        told += ["--seen-at", repr(job.width)]  # not where sizes are unknown, nor where the grey is to be enlarged
    found = job.run("detect-edges", [*told, grey], "e.json")
    if job.ending != ARCHIVE:
        return found
    worth = RICH_WORTH if "max_bytes" in job.given else WORTH
    told = ["--worth", repr(worth), *job.seen_at, "--photo", grey]
    if "outline" in job.stages:
        choice = job.stages["outline"]
        told += ["--keep-strength", str(choice.get("min-strength", 0))]
        told += ["--keep-length", str(choice.get("min-length", least_length(size)))]
    return job.run("thin-edges", ["-e", found, *told], "thin.json")


def lines(job: Job, photo: list[str]) -> str | None:
    """The telling lines, where there are to be any."""
    if "lines" not in job.stages:
        return None
    told = [*job.words("lines", "detect-lines"), *job.seen_at]
    for name in ("density", "per-inch2"):  # an archive keeps the lines that it will have room for
        if job.seen_at and name in job.stages["lines"]:
            told += [f"--{name}", str(job.stages["lines"][name])]
    return job.run("detect-lines", [*told, *photo], "lines.json")


def directions(job: Job, photo: list[str], edges: str, lines: str | None) -> str | None:
    """The field along which strokes run, if any."""
    own = job.given.get("directions_file")
    if own is None and ("directions" not in job.stages or not _follows(job)):
        return None
    if own is not None and own.lower().endswith(".pgm"):
        return str(own)
    told = job.words("directions", "detect-directions") if "directions" in job.stages else []
    if job.ending == ARCHIVE and "size" not in job.stages.get("directions", {}):
        told += ["--size", str(FIELD_SIDE)]
    told += ["--lines", lines] if lines else []
    told += ["--strokes", own] if own is not None else []
    return job.run("detect-directions", ["-e", edges, *told, *photo], "directions.pgm")


def _follows(job: Job) -> bool:
    """Whether the strokes of the texture can follow a field."""
    from penink_cli.blasting.rules import rule

    return bool(rule(str(job.stages["blast"].get("rule", "best"))).follows(job.texture))
