"""Making a texture of a kind."""

from __future__ import annotations

import importlib
import inspect
from collections.abc import Callable
from typing import Any

from penink_cli.ground.errors import ParameterError
from penink_cli.ground.model import Texture


def maker(kind: str) -> Callable[..., Texture]:
    """The function that makes textures of a kind; `kinds` describes its keywords."""
    found: Callable[..., Texture] = importlib.import_module(f"penink_cli.textures.kinds.{kind.replace('-', '_')}").make
    return found


def make(kind: str, **options: Any) -> Texture:
    """A texture of a kind of the registry; without options, the shipped one. An option of None is not given.

    Raises ParameterError for an option that the kind does not take, and for options that do not go together.
    """
    make_kind = maker(kind)
    known = [name for name, p in inspect.signature(make_kind).parameters.items() if p.kind is p.KEYWORD_ONLY]
    given = {name: value for name, value in options.items() if value is not None}
    for name in given:
        if name not in known:
            raise ParameterError(f"{kind} takes no {name}, but {', '.join(known)}")
    return make_kind(**given)
