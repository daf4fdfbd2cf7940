"""Every rule draws something of the tone asked for, or less, and says so in its name."""

from __future__ import annotations

import subprocess
import sys

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
    with pytest.raises(ParameterError, match=f"known are {', '.join(RULES)}$"):
        rule("fair")


@pytest.mark.parametrize(("texture", "loaded"), [("crosshatch", []), ("form", ["form", "reserved"]), ("fur", ["form"])])
def test_what_a_texture_does_not_use_is_not_loaded(texture, loaded):
    """A dark square on white, in a process of its own."""
    script = (
        "import sys, numpy as np\n"
        "from penink_cli.blasting.blast import blast\n"
        "from penink_cli.options.textures import find_texture\n"
        "tone = np.zeros((60, 60)); tone[10:50, 10:50] = 0.96\n"
        f"blast(tone, 150, 150, None, find_texture({texture!r}))\n"
        "print(*(n for n in ('form', 'reserved', 'engraving') if f'penink_cli.blasting.{n}' in sys.modules))"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout.split() == loaded
