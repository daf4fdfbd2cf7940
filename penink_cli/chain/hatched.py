"""Strokes of a drawing: telling lines and outlines first, then the hatching, which counts these as ink."""

from __future__ import annotations

from penink_cli.chain.filters import found
from penink_cli.chain.job import Job, least_length
from penink_cli.chain.plates import Plate
from penink_cli.options.common import warn
from penink_cli.outputs.registry import writer


def hatch(
    job: Job, plates: list[Plate], size: tuple[int, int], edges: str, lines: str | None, drawn: list[str],
    directions: str | None, output: str | None, page: list[str],
) -> None:  # fmt: skip
    """Draw all plates and write them.

    size: width and height of the grey, pixels; drawn: strokes over the hatching; page: words for what writes.
    """
    over = [*drawn, *_outlines(job, size, edges)]
    along = ["--directions", directions] if directions else []
    white = ["--lines", lines] if lines else []
    greys = [_enlarged(job, plate, edges) for plate in plates]

    def hatched(greys: list[str], wanted: str) -> list[str]:
        drawn = []
        for plate, grey in zip(plates, greys):
            true = ["--tone-of", plate.grey] if job.inks is None and grey != plate.grey else []
            ink = [word for name in over for word in ("--ink", name)] if plate is plates[-1] else []
            told = [*job.on_paper, *job.device, *job.words("blast", "blast"), *plate.words(), *along, *white, *ink]
            drawn.append(job.run("blast", ["-e", edges, *told, *true, grey], plate.named(wanted)))
        return drawn

    if job.inks is None:
        hatchings = hatched(greys, "hatching.jsonl")
    else:
        from penink_cli.chain.balanced import balanced

        hatchings = balanced(job, plates, greys, over, white, hatched)
    if not any(job.chain.lines(name) > 1 for name in (*hatchings, *over)):
        warn("a drawing without a stroke: the photo is paper white, or was made so")
    by = writer(job.ending)
    if by is None:
        job.chain.joined([*hatchings, *over], output)
        return
    if job.inks is not None:
        own = [plate.colour for plate in plates] + [plates[-1].colour] * len(over)
        knows_colours = any(parameter.name == "colours" for parameter in found(by).params)
        page = page + [word for colour in own * knows_colours for word in ("--color", colour)]
    job.chain.run(by, [*page, *hatchings, *over], output)


def lines_drawn(job: Job, lines: str) -> str:
    """Strokes along the telling lines, which are ink before hatching is laid."""
    return job.run("lines", [*job.on_paper, *job.device, *job.words("lines", "lines"), lines], "lines.jsonl")


def _outlines(job: Job, size: tuple[int, int], edges: str) -> list[str]:
    """Strokes along edges, where there are to be any, which are ink before hatching is laid."""
    if "outline" not in job.stages:
        return []
    least = [] if "min-length" in job.stages["outline"] else ["--min-length", str(least_length(size))]
    told = [*job.on_paper, *job.device, *job.words("outline", "outline"), *least]
    return [job.run("outline", [*told, edges], "outlines.jsonl")]


def _enlarged(job: Job, plate: Plate, edges: str) -> str:
    """The grey of a plate that is blasted: reconstructed where it has fewer pixels than the drawing can show."""
    if not job.enlarged(plate.size):
        return plate.grey
    from penink_cli.illustration.drawing import grey_size

    across, down = grey_size(job.width, job.aspect)
    samples = job.run("extract-samples", ["-e", edges, plate.grey], plate.named("samples.pgm"))
    enlarge = ["-e", edges, "--size", f"{across}x{down}", "--soften", samples]
    return job.run("enlarge", enlarge, plate.named("enlarged.pgm"))
