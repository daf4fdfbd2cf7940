"""The grey that each ink draws."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from penink_cli.chain.job import Job
from penink_cli.ground.codes import code_of
from penink_cli.options.inks import CMYK


@dataclass(frozen=True)
class Plate:
    """The grey that one ink draws.

    size: width and height of the grey, pixels. number: of the ink, from 1; 0 for a drawing of one ink, for which the
    rest says nothing. name, colour: of the ink. turn: degrees by which its hatching is turned. seed: of its hatching.
    """

    grey: str
    size: tuple[int, int]
    number: int = 0
    name: str = ""
    colour: str = ""
    turn: float = 0.0
    seed: int = 0

    def named(self, wanted: str) -> str:
        """A name for what is made of this plate."""
        return f"{self.number}-{wanted}" if self.number else wanted

    def words(self) -> list[str]:
        """Words that tell `blast` of the plate."""
        if not self.number:
            return []
        from penink_cli.composition.separation import SOLID

        told = ["--turn", repr(self.turn), "--seed", str(self.seed), "--solid", repr(SOLID)]
        return [*told, "--color", self.colour, "--layer", self.name]

    def members(self) -> dict[str, Any]:
        """The same as members of a layer of a manifest."""
        if not self.number:
            return {}
        return {"name": self.name, "color": self.colour, "turn": self.turn, "seed": self.seed}


def plates(job: Job, photo: list[str], size: tuple[int, int]) -> list[Plate]:
    """The plate of each of the job's inks, the lightest first.

    photo: words that name the photo, or the picture composed of it; size: its width and height, pixels.
    """
    from penink_cli.composition.separation import lightest_first, turns

    assert job.inks is not None
    n = len(job.inks.names)
    order = lightest_first(job.inks.colours)
    layers = job.texture.layers
    first = layers[0].angle if layers else 0.0
    apart = [layer.angle - first if layer.turn is None else layer.turn for layer in layers]
    turned = turns(apart, n)[::-1]  # the darkest lies as the texture has it
    seed = int(job.stages["blast"].get("seed", 0))
    told = ["--inks", "cmyk" if job.inks is CMYK else ",".join(job.inks.names)]
    told += ["--black", repr(job.given["black"])] if "black" in job.given else []
    made = job.chain.run_plates("separate", [*told, *photo], "plate-{}.pgm", n)
    result = []
    for place, number in enumerate(order):
        name, colour = job.inks.names[number], code_of(job.inks.colours[number])
        result.append(Plate(made[number], size, number + 1, name, colour, turned[place], seed + n - 1 - place))
    return result
