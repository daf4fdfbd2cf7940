"""Fields of directions."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from penink_cli.ground.angles import direction


@dataclass(frozen=True, eq=False)
class Directions:
    """A line field: at every place the angle θ, modulo 180°, that strokes are to run at, and how sure that is.

    θ is measured from x towards y (clockwise on paper). The samples fill the image frame, as those of a grey image do.

    cos2, sin2: (h, w) cos 2θ and sin 2θ, a unit vector in each place; both 0 where no direction is known.
    confidence: (h, w), 0 nothing is known … 1 the form says so.
    """

    cos2: npt.NDArray[np.floating]
    sin2: npt.NDArray[np.floating]
    confidence: npt.NDArray[np.floating]

    def turned(self, degrees: float) -> Directions:
        """The field with every direction turned clockwise."""
        if not degrees:
            return self
        c, s = direction(2.0 * degrees)
        return replace(self, cos2=self.cos2 * c - self.sin2 * s, sin2=self.cos2 * s + self.sin2 * c)
