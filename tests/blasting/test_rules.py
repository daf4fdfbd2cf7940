"""Every rule draws something of the tone asked for, or less, and says so in its name."""

from __future__ import annotations

import numpy as np
import pytest

from penink_cli.blasting.blast import blast
from penink_cli.blasting.rules import rule
from penink_cli.ground.errors import ParameterError
from penink_cli.ground.rules import RULES
from penink_cli.options.textures import find_texture
from tests.blasting import measures
from tests.textures.shipped import TEXTURES


@pytest.mark.parametrize("name", RULES)
def test_a_rule_draws_more_where_it_is_darker(name):
    texture = find_texture("crosshatch")
    inks = []
    for tone in (0.2, 0.6):
        strokes = blast(np.full((8, 8), tone), 100, 100, None, texture, rule=name)
        inks.append(float(measures.rendered(strokes, 600).mean()))
        assert 0 < inks[-1] < tone + 0.05 and strokes.texture == "crosshatch"
    assert inks[0] < inks[1]


@pytest.mark.parametrize("name", RULES)
def test_a_rule_says_which_textures_it_lays_along_a_field(name):
    assert {type(rule(name).follows(texture)) for texture in TEXTURES.values()} == {bool}
    fur = find_texture("fur")
    if rule(name).SETS:
        assert rule(name).follows(fur) and len(blast(np.full((8, 8), 0.5), 100, 100, None, fur, rule=name))
    else:
        with pytest.raises(ParameterError, match="a set of strokes"):
            blast(np.full((8, 8), 0.5), 100, 100, None, fur, rule=name)


def test_no_other_rule():
    with pytest.raises(ParameterError, match="known are best, strict"):
        rule("fair")
