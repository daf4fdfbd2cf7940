"""The illustration itself: few samples of each plate, and a manifest that says how they are drawn."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Any

from penink_cli.chain.job import USUAL_TEXTURE, Job, least_length
from penink_cli.chain.plates import Plate
from penink_cli.ground.units import parse_length
from penink_cli.outputs.registry import writer

if TYPE_CHECKING:
    from penink_cli.formats.style import Value

DEVICE_SIDE = 254  # most samples a side that a device is sent
RICH_ERROR = 2.0  # grey levels by which samples may be off where --max-bytes makes them fewer later


def illustrate(
    job: Job, plates: list[Plate], size: tuple[int, int], edges: str, lines: str | None, directions: str | None,
    output: str | None, page: list[str],
) -> None:  # fmt: skip
    """Write the illustration, or the page that draws it.

    size: width and height of the grey, pixels. page: words for the filter that writes it.
    """
    layers = [_layer(job, plate, _reduced(job, plate, size, edges), edges, directions) for plate in plates]
    if lines:
        told = job.stages["lines"]
        layers[-1]["lines"] = lines
        layers[-1]["line"] = {
            name.replace("-", "_"): _number(name, told[name])
            for name in ("pen", "even", "density", "per-inch2", "min-rank", "ruled", "loose")
            if name in told
        }
    if "outline" in job.stages:
        told = job.stages["outline"]
        pen = told.get("pen", told.get("weight", 0.7))
        layers[-1]["outline"] = {
            "pen": _number("pen", pen),
            "even": "pen" in told,
            "min_strength": float(told.get("min-strength", 0)),
            "min_length": float(told.get("min-length", least_length(size))),
        }
    manifest = {"format": "penink-illustration", "version": 1, "width": job.width}
    manifest |= {"height": job.width * job.aspect, "layers": layers}
    name = job.chain.name("drawing.illustration.json")
    job.chain.put(name, json.dumps(manifest) + "\n")
    by = writer(job.ending)
    assert by is not None
    if "max_bytes" in job.given:
        page = [*page, "--max-bytes", str(job.given["max_bytes"])]
    job.chain.run(by, [*page, name], output)


def _reduced(job: Job, plate: Plate, size: tuple[int, int], edges: str) -> str:
    """The samples of a plate: as few as show it, or as many as a device is sent."""
    samples = job.run("extract-samples", ["-e", edges, plate.grey], plate.named("samples.pgm"))
    reduced = job.chain.name(plate.named("reduced.pgm"))
    reduce = ["-e", edges, "--photo", plate.grey]
    auto = [*reduce, "--auto", "--seen-at", repr(job.width)]
    if "max_bytes" in job.given:
        auto += ["--max-error", repr(RICH_ERROR)]
    elif job.stages["compose"].get("strength") != 0:  # where nothing is composed, faint things are to be faint
        auto.append("--relative")
    auto.append(samples)
    # A page is sent what a device can take. For a photo of noise or fine texture no grid is near enough; half is taken.
    if job.ending == ".html" or not job.chain.run("reduce", auto, reduced, may_fail=True):
        shrink = max(2.0, max(size) / DEVICE_SIDE)
        smaller = f"{max(1, math.floor(size[0] / shrink))}x{max(1, math.floor(size[1] / shrink))}"
        job.chain.run("reduce", [*reduce, "--size", smaller, samples], reduced)
    return reduced


def _layer(job: Job, plate: Plate, samples: str, edges: str, directions: str | None) -> dict[str, Any]:
    """A layer of the manifest."""
    blast = job.stages["blast"]
    layer: dict[str, Any] = {"samples": samples, "edges": edges, "texture": blast.get("texture", USUAL_TEXTURE)}
    if directions:
        layer["directions"] = directions
    for name in ("pen", "gamma", "seed", "rule", "swell"):
        if name in blast:
            layer[name] = _number(name, blast[name])
    return layer | plate.members()


def _number(name: str, value: Value) -> Value:
    """The value of an option as a manifest has it, a length in points."""
    if name == "rule" or not isinstance(value, str):
        return value
    return parse_length(value) if name == "pen" else int(value) if name == "seed" else float(value)
