"""The prologues of the renderers: the numbers of `blasting.constants`, and two more, by one name in both languages."""

from __future__ import annotations

import math
from typing import Any

from penink_cli.blasting import constants
from penink_cli.ground.device import MEAN
from penink_cli.reconstruction.kernels import T1


def shared() -> dict[str, Any]:
    """Every number, and every row of numbers, that the renderers share with Python."""
    return {name: value for name, value in vars(constants).items() if name.isupper() and name != "DOT"} | {
        "MEAN": MEAN,
        "T1": T1,
    }


def javascript() -> str:
    """One `const` of all of them."""
    listed = ", ".join(f"{name} = {_number(value, '[%s]', ', ')}" for name, value in shared().items())
    return f"// The numbers of penink_cli/blasting/constants.py.\nconst {listed};\n"


def postscript() -> str:
    """A definition each. Waves, whose numbers hot procedures want one by one, are WAVER0, WAVER1 …, in degrees."""
    numbers = shared()
    waver, wave = numbers.pop("WAVER"), numbers.pop("WAVE")
    degrees = [value if i % 3 == 0 else round(math.degrees(value), 4) for i, value in enumerate(waver)]
    numbers |= {f"WAVER{i}": value for i, value in enumerate(degrees)}
    numbers |= {f"WAVE{i}": value for i, value in enumerate(wave)}
    lines = [f"/{name} {_number(value, '[ %s ]', ' ')} def" for name, value in numbers.items()]
    return "% The numbers of penink_cli/blasting/constants.py.\n" + "\n".join(lines) + "\n"


def _number(value: Any, row: str, between: str) -> str:
    if isinstance(value, tuple):
        return row % between.join(_number(v, row, between) for v in value)
    return f"{value:.9g}"
