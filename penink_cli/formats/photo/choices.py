"""How the user wants a photograph read, and which faults of its file are errors."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from penink_cli.ground.errors import FormatError

ALPHA = "alpha"


@dataclass(frozen=True)
class Choices:
    """What a user may say of a photograph.

    background: red, green, blue (0 … 255) of what shows through where the photograph is transparent; or ALPHA: the grey
        that is read is the transparency itself, black where the photograph is opaque.
    profile: whether an embedded profile or gamma is applied.
    damage: "strict" refuses a file that is not whole; "lenient" reads what is left of damaged pixels; "" refuses
        damaged pixels, and reports a file that is not whole although all its pixels are.
    """

    background: tuple[int, int, int] | str = (255, 255, 255)
    profile: bool = True
    damage: str = ""


@dataclass(frozen=True)
class Verdict:
    """Decides by the user's choices whether a fault is an error or a line to `say`."""

    choices: Choices
    say: Callable[[str], None]

    def scar(self, line: str) -> None:
        """Report that a file is not whole although all its pixels are. Raises FormatError where damage is "strict"."""
        if self.choices.damage == "strict":
            raise FormatError(line)
        self.say(line)

    def damage(self, error: FormatError) -> None:
        """Raise the error, which says that pixels are lost or wrong; where damage is "lenient", only report it."""
        if self.choices.damage != "lenient":
            raise error
        self.say(f"{error.message}; what is left of it is read")
