"""How a photograph is to be read, and what becomes of what is wrong with it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from penink_cli.ground.errors import FormatError

ALPHA = "alpha"


@dataclass(frozen=True)
class Choices:
    """What a user may say of a photograph.

    background: red, green, blue (0 … 255) of what shows through where it is transparent, or ALPHA: its grey is the
        transparency itself, black where it is opaque.
    profile: whether an embedded profile or gamma is applied.
    damage: "strict": only a file that is whole; "lenient": what is left of a damaged one; "": no damaged
        pixels, but a line where only the file is not whole.
    """

    background: tuple[int, int, int] | str = (255, 255, 255)
    profile: bool = True
    damage: str = ""


@dataclass(frozen=True)
class Verdict:
    """Decides by the user's choices what is an error and what is only said, a line each."""

    choices: Choices
    say: Callable[[str], None]

    def scar(self, line: str) -> None:
        """A file is not whole while all its pixels are: a line says so. Raises FormatError where it was chosen."""
        if self.choices.damage == "strict":
            raise FormatError(line)
        self.say(line)

    def damage(self, error: FormatError) -> None:
        """Pixels are lost or wrong: the error is raised, or a line says it, by what was chosen."""
        if self.choices.damage != "lenient":
            raise error
        self.say(f"{error.message}; what is left of it is read")
