"""Lines evenly far apart whose width is the tone, along the form."""

from __future__ import annotations

from functools import partial

from penink_cli.ground.model import Engraving
from penink_cli.textures.engraved import engraved

make = partial(engraved, "engraving", Engraving())
