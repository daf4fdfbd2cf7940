"""One photo being drawn: its chain of filters, what each stage is told, and its size on paper."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from penink_cli.chain.filters import Chain
from penink_cli.chain.words import words
from penink_cli.options.textures import find_texture

if TYPE_CHECKING:
    from penink_cli.formats.style import Value
    from penink_cli.ground.model import Texture
    from penink_cli.options.inks import Inks

ARCHIVE = ".penink"
USUAL_TEXTURE = "crosshatch"  # as `blast` has it
FADING = {"mask", "vignette"}  # options that take tone away, and compose even at strength 0
COMPOSING = {"strength", "detail", "mix", "target", "style_name", *FADING}  # options by which a call asks for composing
OUTLINE_LENGTH = 0.04  # part of the photo's longer side: shorter chains are texture, which the hatching shows


@dataclass(frozen=True)
class Job:
    """What all the stages of one drawing share.

    stages: options by stage. given: options of the call that the user has named.
    width: of the drawing, points; aspect: its height over its width. ending: of what is written, `.ps`.
    device_dpi: the printer's, None for what has no gain. inks: None for one black ink.
    """

    chain: Chain
    stages: dict[str, dict[str, Value]]
    given: dict[str, Any]
    width: float
    aspect: float
    ending: str
    device_dpi: float | None
    inks: Inks | None

    @property
    def composes(self) -> bool:
        """Whether plates are made of composed colours, and not of the photo's own.

        They are where the call says how to compose, or names a style that does.
        """
        moved = self.stages["compose"].get("strength") != 0 or not FADING.isdisjoint(self.given)
        return moved and not COMPOSING.isdisjoint(self.given)

    @property
    def on_paper(self) -> list[str]:
        """Words that tell a filter the width."""
        return ["--width", repr(self.width)]

    @property
    def device(self) -> list[str]:
        """Words that tell a filter the printer."""
        return ["--device-dpi", "none" if self.device_dpi is None else repr(self.device_dpi)]

    @property
    def seen_at(self) -> list[str]:
        """Words that tell a filter to leave out what the drawing of an archive would not show."""
        return ["--seen-at", repr(self.width)] if self.ending == ARCHIVE else []

    def enlarged(self, size: tuple[int, int]) -> bool:
        """Whether a grey of that width and height has fewer pixels than the drawing can show, and is reconstructed."""
        from penink_cli.illustration.drawing import grey_size

        return size[0] < grey_size(self.width, self.aspect)[0]

    @property
    def texture(self) -> Texture:
        """The texture of the hatching."""
        return find_texture(str(self.stages["blast"].get("texture", USUAL_TEXTURE)))

    def words(self, stage: str, filter_name: str) -> list[str]:
        """The words that tell the filter its options of the stage."""
        options = self.stages.get(stage, {})
        if filter_name == "blast" and "natural" not in options and self.texture.scales is not None:
            options = {**options, "natural": self.width}
        return words(stage, filter_name, options)

    def run(self, filter_name: str, words: list[str], wanted: str) -> str:
        """Run a filter whose result is handed on; the result's name on the bench, the wanted one or one like it."""
        name = self.chain.name(wanted)
        self.chain.run(filter_name, words, name)
        return name


def least_length(size: tuple[int, int]) -> int:
    """Pixels of the shortest chain of edges that is outlined, in a photo of that width and height."""
    return math.floor(OUTLINE_LENGTH * max(size) + 0.5)
