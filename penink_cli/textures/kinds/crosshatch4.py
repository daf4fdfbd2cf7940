"""Lines in up to four directions."""

from __future__ import annotations

from functools import partial

from penink_cli.textures.kinds import crosshatch

make = partial(crosshatch.make, layers=4)
