"""Textures: those shipped, those made, those imported, and what their file may not hold."""

import inspect
import io
import json
from importlib import resources

import jsonschema
import numpy as np
import pytest

from penink_cli.blasting import scaling
from penink_cli.blasting.blast import blast
from penink_cli.blasting.reach import reachable
from penink_cli.blasting.sheet import coverage
from penink_cli.blasting.tile import thresholds
from penink_cli.formats import svg_texture, texture
from penink_cli.ground.errors import FormatError, ParameterError
from penink_cli.main import command_of
from penink_cli.options.textures import find_texture, shipped
from penink_cli.textures import kinds
from penink_cli.textures.make import make, maker
from penink_cli.textures.normal import normal
from penink_cli.textures.registry import KINDS
from tests.textures.shipped import SETS, TILES

SCHEMA = json.loads((resources.files("penink_cli.formats") / "schemas" / "texture.schema.json").read_text("utf-8"))
GOOD = {
    "format": "penink-texture", "version": 1, "name": "dashes", "width": 144, "height": 144, "whole": True,
    "strokes": [{"priority": 0, "width": 0.4, "points": [[0, 8], [12, 8], [24, 9], [36, 9]]}],
    "layers": [{"angle": 10, "from": 0, "to": 0.5, "pen": 0.4}],
}  # fmt: skip


def read(document) -> texture.Texture:
    text = document if isinstance(document, bytes) else json.dumps(document).encode()
    return texture.read(io.BytesIO(text), "t.json")


def written(found) -> bytes:
    out = io.BytesIO()
    texture.write(out, found)
    return out.getvalue()


def test_every_kind_is_shipped():
    assert sorted(KINDS) == shipped()
    modules = {f.name.removesuffix(".py").replace("_", "-") for f in resources.files(kinds).iterdir()}
    assert set(KINDS) == {name for name in modules if not name.startswith("-")}


@pytest.mark.parametrize("name", TILES)
def test_a_shipped_texture_reaches_black_and_fills_up_steadily(name):
    found = find_texture(name)
    assert reachable(found, 72 / 600)[1] >= 0.975
    enters = thresholds(found, 72 / 600)
    assert enters[0] == 0 and (np.diff(enters) >= 0).all() and enters[-1] > 0.95


@pytest.mark.parametrize("name", sorted(set(TILES) - {"brick", "shingle"}))
@pytest.mark.parametrize("part", [0.1, 0.4])
def test_every_prefix_is_evenly_spread(name, part):
    """The ink of a prefix in 9 parts of the tile differs less than that of strokes thrown at random."""
    strokes = find_texture(name).strokes
    n = int(part * len(strokes))
    middles = np.array([strokes[i].mean(axis=0) for i in range(n)]) % (strokes.width, strokes.height)
    lot, _, _ = np.histogram2d(*middles.T, bins=3, range=[[0, strokes.width], [0, strokes.height]])
    assert lot.std() < 0.75 * np.sqrt(n / 9)


@pytest.mark.parametrize("name", ["stipple", "brick", "shingle", *SETS])
def test_a_shipped_texture_is_what_make_makes(name):
    assert written(make(name)) == written(find_texture(name))


@pytest.mark.parametrize("kind", KINDS)
def test_what_a_kind_takes_can_be_given(kind):
    options = {option.name for option in command_of("texture").commands["make"].params}
    keywords = {name for name, p in inspect.signature(maker(kind)).parameters.items() if p.kind is p.KEYWORD_ONLY}
    assert "pen" in keywords <= options


@pytest.mark.parametrize("kind", KINDS)
def test_an_option_that_means_nothing_is_refused(kind, penink):
    known = inspect.signature(maker(kind)).parameters
    options = {"angle": "9", "spacing": "2", "finest": "0.2", "lines": "9", "centre": "1 2", "layers": "1", "seed": "1"}
    for name, value in options.items():
        if name in known and known[name].kind == inspect.Parameter.KEYWORD_ONLY:
            continue
        with pytest.raises(ParameterError, match=f"{kind} takes no {name}, but .*pen"):
            make(kind, **{name: value})
    if "centre" not in known:
        done = penink("texture", "make", kind, "--centre", "1", "2")
        assert (done.returncode, done.stdout, done.stderr.count(b"\n")) == (1, b"", 1)


def test_deviates_are_numpys_but_for_the_last_bits():
    ours, theirs = np.random.default_rng(3), np.random.default_rng(3)
    assert np.allclose(normal(ours, 2.0, (300, 100)), theirs.normal(0, 2, (300, 100)), rtol=0, atol=1e-12)
    assert ours.random() == theirs.random()


def test_bricks_are_hatched_evenly_from_side_to_side():
    tile = find_texture("brick").strokes
    ends = [tile[i][[0, -1]] for i in range(len(tile))]
    feet = np.array([a[0] for a, b in ends if 0.8 < abs(a[0] - b[0]) < 6 and abs(a[1] - b[1]) > 5])
    share, _ = np.histogram(feet % 35.75, bins=4, range=(0, 35.75))
    assert len(feet) > 100 and share.std() < 0.25 * share.mean()


def test_writing_and_reading_again_changes_nothing():
    found = read(GOOD)
    again = read(written(found))
    assert written(again) == written(found)
    assert again.whole and again.layers == found.layers and again.layers[0].high == 0.5


def test_what_is_written_obeys_the_schema():
    jsonschema.validate(json.loads(written(find_texture("grain"))), SCHEMA)
    jsonschema.validate(GOOD, SCHEMA)


def test_strokes_are_sorted_by_priority():
    strokes = [{"priority": p, "width": 1 + p, "points": [[p, 0]]} for p in (3, 1, 2)]
    found = read({**GOOD, "strokes": strokes})
    assert found.priorities.tolist() == [1, 2, 3] and found.strokes.points[:, 0].tolist() == [1, 2, 3]


@pytest.mark.parametrize(
    ("change", "complaint"),
    [
        ({"format": "x"}, "format is"),
        ({"version": 2}, "version is 2"),
        ({"name": 3}, "name is 3"),
        ({"width": 0}, "width is 0"),
        ({"height": True}, "height is true"),
        ({"whole": 1}, "whole is 1"),
        ({"oriented": 1, "layers": []}, "oriented is 1"),
        ({"oriented": True}, "oriented and with layers"),
        ({"strokes": []}, "at least one"),
        ({"strokes": [3]}, "stroke 0 is 3"),
        ({"strokes": [{"width": 1, "points": [[0, 0]]}]}, 'stroke 0: member "priority" is missing'),
        ({"strokes": [{"priority": 0, "width": -1, "points": [[0, 0]]}]}, "stroke 0: width"),
        ({"strokes": [{"priority": 0, "width": 1, "points": [[0, 0], [1, 1]]}]}, "stroke 0: 2 points"),
        ({"strokes": [{"priority": 0, "width": 1, "points": []}]}, "stroke 0: 0 points"),
        ({"strokes": [{"priority": 0, "width": 1, "points": [[0, "a"]]}]}, "stroke 0: point 0"),
        ({"strokes": [{"priority": 0, "width": 1, "points": [[0, 1e9]]}]}, "stroke 0: a point beyond"),
        ({"layers": [{"angle": 0, "from": 0.5, "to": 0.5, "pen": 1}]}, 'layer 0: "from"'),
        ({"layers": [{"angle": 0, "from": 0, "pen": 1}]}, 'layer 0: member "to" is missing'),
        ({"layers": [{"angle": 0, "from": 0, "to": 1, "pen": 1, "wave": 9}]}, "layer 0: a wave"),
    ],
)
def test_a_wrong_texture_is_refused_and_the_place_named(change, complaint):
    with pytest.raises(FormatError, match=r"t\.json") as error:
        read({**GOOD, **change})
    assert complaint in str(error.value)


@pytest.mark.parametrize(
    ("points", "count", "complaint"),
    [
        ([[3, 3]], 1, "oriented stroke 0, by priority, leads 0 pt on; from 1 to 250"),
        ([[9, 0], [6, 0], [3, 0], [0, 0]], 1, "leads -9 pt on"),
        ([[0, 0], [99, 0], [200, 0], [251, 0]], 1, "leads 251 pt on"),
        ([[0, 0], [1, 0], [2, 0], [3, 0]], 1001, "1001 oriented strokes; 1000 are allowed"),
    ],
)
def test_a_wrong_set_is_refused(points, count, complaint):
    strokes = [{"priority": 0, "width": 0.4, "points": points}] * count
    with pytest.raises(FormatError, match=complaint):
        read({**GOOD, "layers": [], "oriented": True, "strokes": strokes})


def test_a_set_is_written_and_read_as_such():
    found = find_texture("fur")
    assert found.oriented and read(written(found)).oriented and reachable(found, 72 / 600) == (0, 0.99)
    jsonschema.validate(json.loads(written(found)), SCHEMA)


def test_paths_of_a_drawing_become_examples_from_left_to_right(penink):
    done = penink("texture", "import", "--oriented", "--name", "hair", input=SVG)
    found = read(done.stdout)
    assert done.returncode == 0 and found.oriented and len(found.strokes) == 3  # and the circle, which comes round
    assert done.stderr.count(b"\n") == 1
    assert b"1 of the paths left out, which lead less than 1 pt from left to right" in done.stderr
    turned = SVG.replace(b'x1="0" y1="6" x2="12"', b'x1="12" y1="6" x2="0"')
    back = penink("texture", "import", "--oriented", input=turned)
    assert back.stdout == penink("texture", "import", "--oriented", input=SVG).stdout
    upright = b'<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9"><path d="M1 1V9"/></svg>'
    done = penink("texture", "import", "--oriented", input=upright)
    assert done.returncode == 1 and not done.stdout and done.stderr.count(b"\n") == 1
    assert b"no stroke from left to right in the drawing" in done.stderr


def test_an_unknown_texture_is_refused_with_the_known_ones():
    with pytest.raises(ParameterError, match="stipple"):
        find_texture("stippel")


SVG = b"""<svg xmlns="http://www.w3.org/2000/svg" width="96" height="48" viewBox="0 0 48 24">
<g transform="translate(2 0)" stroke="black" stroke-width="0.5"><path d="M0 0 L9 0 Q12 5 9 9 M3 3 c1 0 1 1 2 1"/>
<line x1="0" y1="6" x2="12" y2="6" stroke-width="1"/></g><circle cx="20" cy="10" r="4"/></svg>"""


def test_a_drawing_becomes_a_texture_in_its_own_units():
    found = svg_texture.read(io.BytesIO(SVG), "d.svg", "d")
    assert (found.strokes.width, found.strokes.height) == (72, 36)  # 96 × 48 CSS pixels
    assert len(found.strokes) == 4 and np.diff(found.strokes.first).tolist()[:3] == [7, 4, 4]
    assert np.allclose(found.strokes[2][[0, -1]], [[3, 9], [21, 9]])
    assert np.allclose(found.strokes.widths, [0.75, 0.75, 1.5, 0.4])
    ring = found.strokes[3]
    assert np.allclose(np.hypot(*(ring[::3] - (30, 15)).T), 6) and np.allclose(ring[0], ring[-1])
    assert svg_texture.read(io.BytesIO(SVG), "d.svg", "d", pen_pt=1.0).strokes.widths.tolist() == [1.0] * 4


@pytest.mark.parametrize("shape", [b'<circle cx="24" cy="12" r="9"/>', b'<rect x="9" y="3" width="30" height="18"/>'])
@pytest.mark.parametrize("rule", ["best", "strict"])
def test_closed_shapes_are_drawn_as_others_are(shape, rule):
    drawing = SVG[: SVG.index(b"<g")] + shape + b"</svg>"
    found = svg_texture.read(io.BytesIO(drawing), "d.svg", "d")
    (loop,) = (found.strokes[i] for i in range(len(found.strokes)))
    assert np.hypot(*np.diff(loop, axis=0).T).min() > 0.1  # and no crumb where it closes
    drawn = blast(np.full((9, 9), 0.4), 144, 144, None, found, rule=rule, device_dpi=None)
    ends = drawn.points[drawn.first[:-1]] - drawn.points[drawn.first[1:] - 1]
    assert np.count_nonzero(np.hypot(*ends.T) < 0.01) >= 4


@pytest.mark.parametrize("text", [b"", b"<svg", b"<a/>", b"\xff\xfe", b'<svg xmlns="http://www.w3.org/2000/svg"/>'])
def test_what_is_no_drawing_is_refused(text):
    with pytest.raises(FormatError, match=r"d\.svg"):
        svg_texture.read(io.BytesIO(text), "d.svg", "d")


def test_what_a_drawing_s_import_leaves_out_is_said(penink):
    text = b'<text x="1" y="5">a</text><text x="1" y="9">b</text><image href="p.png" width="9" height="9"/></svg>'
    done = penink("texture", "import", input=SVG.replace(b"</svg>", text))
    assert done.returncode == 0 and done.stdout == penink("texture", "import", input=SVG).stdout
    told = b"penink texture import: warning: <stdin>: 2 texts and 1 image left out; turn text to paths to have it\n"
    assert done.stderr == told
    assert not penink("texture", "import", input=SVG).stderr
    only = penink("texture", "import", input=b'<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9">' + text)
    assert only.returncode == 1


def test_a_plotter_s_reach_and_a_name_of_one_s_own(penink):
    assert b" without a device" in penink("texture", "show", "stipple", "--device-dpi", "none").stdout
    made = penink("texture", "make", "parallel", "--name", "mine").stdout
    assert texture.read(io.BytesIO(made), "x").name == "mine"


def test_the_command_lists_shows_makes_and_imports(penink):
    assert penink("texture", "list").stdout.decode().split("\n")[0].startswith("barb")
    shown = penink("texture", "show", "crosshatch")
    assert shown.returncode == 0 and "0.990" in shown.stdout.decode()
    assert texture.read(io.BytesIO(penink("texture", "show", "--json", "grass").stdout), "x").name == "grass"
    assert texture.read(io.BytesIO(penink("texture", "import", input=SVG).stdout), "x").name == "imported"
    wrong = penink("texture", "import", input=b"<a/>")
    assert wrong.returncode == 1 and wrong.stderr.count(b"\n") == 1 and b"<stdin>" in wrong.stderr


GROWS = GOOD | {"scales": {"natural": 288, "least": 6, "fill": "parallel"}}
GROWS = {name: value for name, value in GROWS.items() if name != "layers"}
GROWS["strokes"] = [
    {"priority": k, "width": 0.4, "points": [[0, 8], [12, 8], [24, 9], [36, 9]], "scale": [k, 9]} for k in range(4)
] + [{"priority": 9, "width": 0.4, "points": [[9, 9]]}]


def test_a_texture_that_grows_is_written_and_read():
    found = read(GROWS)
    assert found.scales is not None
    assert len(found.strokes) == 3 and found.scales.fixed.tolist() == [False, False, True]
    assert found.scales.spans.tolist() == [[k, 9] for k in range(4)]
    assert written(read(written(found))) == written(found)
    jsonschema.validate(json.loads(written(found)), SCHEMA)
    large = scaling.at_size(found, 2.5 * 288, None)
    assert (large.strokes.width, len(large.strokes)) == (360, 3)
    assert np.allclose(large.strokes[0][-1], [90, 22.5]) and large.strokes.widths[0] == 0.4
    assert scaling.at_size(found, 100, 100).strokes.width == 144
    assert scaling.at_size(found, 0.1, None).strokes.width == 6
    assert set(scaling.FILLS) == set(texture.FILLS)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"scales": 3}, "scales is 3"),
        ({"scales": {"least": 6}}, "natural"),
        ({"scales": {"natural": 0}}, "natural is 0"),
        ({"scales": {"natural": 9, "fill": "brick"}}, "known are parallel, crosshatch"),
        ({"layers": GOOD["layers"]}, "no layers"),
        ({"strokes": [GROWS["strokes"][0] | {"scale": [2, 2]}]}, "the first must be less"),
        ({"strokes": [GROWS["strokes"][0] | {"scale": [2]}]}, "has 1 numbers"),
        ({"strokes": [GROWS["strokes"][4]]}, "no stroke that grows"),
        ({"strokes": [GROWS["strokes"][0] | {"scale": [2, 3]}]}, "no stroke at the natural size"),
    ],
)
def test_a_texture_that_cannot_grow_is_refused(change, told):
    with pytest.raises(FormatError, match=told):
        read(GROWS | change)


def period(profile: np.ndarray) -> int:
    """The first lag, in samples, at which a profile is much like itself again."""
    flat = profile[40:-40] - np.convolve(profile, np.full(81, 1 / 81), "valid")
    like = [float(np.mean(flat[lag:] * flat[:-lag]) / np.mean(flat * flat)) for lag in range(1, 160)]
    return next(k + 1 for k in range(10, 158) if like[k] > 0.35 and like[k] == max(like[max(0, k - 9) : k + 10]))


@pytest.mark.parametrize(("name", "course"), [("brick", 11.75), ("shingle", 13.3)])
def test_a_wall_is_the_same_wall_at_every_size(name, course):
    """A light flat tone shows little but joints: as many courses from top to bottom, whatever the size."""
    found, tone = find_texture(name), np.full((160, 240), 0.12)
    for inches, natural, times, rule in (
        (2, 288, 1, "best"), (4, 288, 1, "best"), (8, 288, 1, "best"), (4, 576, 2, "best"),
        (2, 288, 1, "threshold"), (8, 288, 1, "threshold"),
    ):  # fmt: skip
        large = blast(tone, 72 * inches, 48 * inches, None, found, natural_pt=natural, device_dpi=None, rule=rule)
        lag = period(coverage(large, 960, 1440).mean(axis=1))
        assert 192 / course * times == pytest.approx(960 / lag, abs=1), (inches, natural, rule)
