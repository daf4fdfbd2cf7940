"""An engraving's lines that waver, as those cut in wood."""

from __future__ import annotations

from functools import partial

from penink_cli.ground.model import Engraving
from penink_cli.textures.engraved import engraved

make = partial(engraved, "wood", Engraving(along=False, spacing_pt=1.78, finest_pt=0.25, waver=1.0, blunt=True))
