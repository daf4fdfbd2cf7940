"""One module a rule; `ground/rules.py` names them. Each has

    draw(task): the strokes of a `Task`, without those that are on the sheet already
    follows(texture): whether strokes of a texture run along a field of directions where there is one
    SETS: whether sets of oriented strokes are laid
"""

from __future__ import annotations

import importlib
from typing import Any

from penink_cli.ground.errors import ParameterError
from penink_cli.ground.rules import RULES


def rule(name: str) -> Any:
    """The module of the rule of that name; raises ParameterError where there is none."""
    if name not in RULES:
        raise ParameterError(f"rule {name!r}: known are {', '.join(RULES)}")
    return importlib.import_module(f"{__name__}.{name}")
