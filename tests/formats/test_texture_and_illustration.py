"""Textures and illustrations: every rule of their formats, and what is said where one is broken."""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from penink_cli.formats import illustration, texture
from penink_cli.ground.errors import ParameterError, PeninkError
from penink_cli.ground.model import Strokes, Texture
from penink_cli.options.textures import find_texture
from tests.formats.readers import READERS
from tests.fuzz.seeds import ILLUSTRATION, TEXTURE

STROKE: Any = TEXTURE["strokes"][0]  # type: ignore[index]
HATCH = {"angle": 45, "from": 0, "to": 0.5, "pen": 0.4}
LAYER: Any = ILLUSTRATION["layers"][0]  # type: ignore[index]


def tile(**members: object) -> dict[str, Any]:
    return {**TEXTURE, **members}


def stroke(**members: object) -> dict[str, Any]:
    return tile(strokes=[STROKE, {**STROKE, **members}])


def hatch(**members: object) -> dict[str, Any]:
    return tile(layers=[{**HATCH, **members}])


def page(**members: object) -> dict[str, Any]:
    return {**ILLUSTRATION, **members}


def layer(**members: object) -> dict[str, Any]:
    return page(layers=[{**LAYER, **members}])


def outline(**members: object) -> dict[str, Any]:
    return layer(outline=members)


def without(document: dict[str, Any], name: str) -> dict[str, Any]:
    return {key: value for key, value in document.items() if key != name}


TEXTURES = {
    "an array": ([], "an object is expected"),
    "an edge list": (tile(format="penink-edges"), "not a texture but an edge list"),
    "version true": (tile(version=True), "version is true"),
    "version 1.0": (tile(version=1.0), "version is 1.0"),
    "no name": (without(TEXTURE, "name"), '"name" is missing'),
    "name a number": (tile(name=7), "name is 7; text"),
    "no width": (without(TEXTURE, "width"), '"width" is missing'),
    "width 0": (tile(width=0), "width is 0"),
    "a width that is written as 0": (tile(width=0.004), "width is 0.004; a number from 0.01"),
    "from and to that are written as one": (
        hatch(**{"from": 1e-5, "to": 2e-5}), '"from" is 1e-05 and "to" 2e-05; to 4'),
    "a wave too short as it is written": (hatch(wave=0.12345, wave_length=0.4938), "a wave of 0.12345 pt needs"),
    "a finest line that is written as the spacing": (
        tile(engraving={"finest": 1.45996, "spacing": 1.46}), "to 4 decimals finest must be less"),
    "a scale that is written as nothing": (
        tile(scales={"natural": 9}, strokes=[{**STROKE, "scale": [1e-5, 2e-5]}]), "the first must be less"),
    "a natural width that is written as 0": (tile(scales={"natural": 1e-4}), "natural is 0.0001; a number from 0.01"),
    "width true": (tile(width=True), "width is true"),
    "a negative height": (tile(height=-9), "height is -9"),
    "height beyond the limit": (tile(height=1e8), "height is"),
    "whole 1": (tile(whole=1), "whole is 1; true or false"),
    "whole null": (tile(whole=None), "whole is null"),
    "no strokes": (without(TEXTURE, "strokes"), '"strokes" is missing'),
    "strokes empty": (tile(strokes=[]), "strokes is empty"),
    "strokes an object": (tile(strokes={}), "strokes is an object"),
    "a stroke that is a list": (tile(strokes=[STROKE, []]), "stroke 1 is []"),
    "a stroke without priority": (tile(strokes=[without(STROKE, "priority")]), 'stroke 0: member "priority"'),
    "a stroke without points": (tile(strokes=[without(STROKE, "points")]), 'stroke 0: member "points"'),
    "priority true": (stroke(priority=True), "stroke 1: priority is true"),
    "priority as text": (stroke(priority="1"), "stroke 1: priority is"),
    "width of a stroke 0": (stroke(width=0), "stroke 1: width is 0"),
    "width of a stroke null": (stroke(width=None), "stroke 1: width is null"),
    "no points": (stroke(points=[]), "stroke 1: 0 points"),
    "two points": (stroke(points=[[1, 1], [2, 2]]), "stroke 1: 2 points"),
    "a point of three": (stroke(points=[[1, 1, 1]]), "stroke 1: point 0 is"),
    "a coordinate false": (stroke(points=[[1, False]]), "stroke 1: point 0 holds false"),
    "a coordinate as text": (stroke(points=[["1", 1]]), "stroke 1: point 0 holds"),
    "a point beyond the limit": (stroke(points=[[1, -2e7]]), "stroke 1: a point beyond"),
    "points an object": (stroke(points={}), "stroke 1: points is an object"),
    "layers an object": (tile(layers={}), "layers is an object"),
    "a layer null": (tile(layers=[None]), "layer 0 is null"),
    "a layer without its pen": (tile(layers=[without(HATCH, "pen")]), 'layer 0: member "pen"'),
    "an angle of more than a turn": (hatch(angle=361), "layer 0: angle is 361"),
    "a tone above 1": (hatch(to=1.1), "layer 0: to is 1.1"),
    "tones the wrong way round": (hatch(**{"from": 0.5}), '"from" must be less'),
    "a pen of nothing": (hatch(pen=0), "layer 0: pen is 0"),
    "a wave shorter than it is high": (hatch(wave=3, wave_length=4), "at least four times"),
    "infinity": (json.dumps(TEXTURE).replace("0.4", "1e999"), "out of range"),
    "a member twice": (json.dumps(TEXTURE).replace("{", '{"width": 9, ', 1), "appears twice"),
    "cut short": (json.dumps(TEXTURE)[:-9], "not JSON"),
    "nothing": ("", "empty"),
}

ILLUSTRATIONS = {
    "an array": ([], "an object is expected"),
    "a texture": (page(format="penink-texture"), "not an illustration but a texture"),
    "version 2": (page(version=2), "version is 2"),
    "no width": (without(ILLUSTRATION, "width"), '"width" is missing'),
    "width 0": (page(width=0), "width is 0"),
    "width as text": (page(width="9"), 'width is "9"'),
    "height true": (page(height=True), "height is true"),
    "a page of 4 km": (page(height=1e7), "height is"),
    "no layers": (without(ILLUSTRATION, "layers"), '"layers" is missing'),
    "layers empty": (page(layers=[]), "0 layers; 1 to 64"),
    "too many layers": (page(layers=[LAYER] * 65), "65 layers; 1 to 64"),
    "layers an object": (page(layers={}), "layers is an object"),
    "a layer that is text": (page(layers=["a"]), 'layer 0 is "a"'),
    "no samples": (page(layers=[without(LAYER, "samples")]), 'layer 0: member "samples"'),
    "samples null": (layer(samples=None), "layer 0: samples is null"),
    "samples nowhere": (layer(samples=""), "relative to the manifest"),
    "an absolute path": (layer(samples="/etc/passwd"), "relative to the manifest"),
    "a null in a path": (layer(samples="a\0b"), "relative to the manifest"),
    "edges in place of samples": (layer(samples="a.edges"), 'layer 0: samples "a.edges": not a PGM'),
    "samples in place of edges": (layer(edges="a"), 'layer 0: edges "a": not an edge list but a PGM image'),
    "edges null": (layer(edges=None), "layer 0: edges is null"),
    "a texture there is none of": (layer(texture="nonesuch"), "layer 0: "),
    "a texture file that is none": (layer(texture="a.json"), 'layer 0: texture "a.json"'),
    "texture null": (layer(texture=None), "layer 0: texture is null"),
    "a rule nobody knows": (layer(rule="fair"), "known are best, strict, threshold"),
    "name a number": (layer(name=1), "layer 0: name is 1"),
    "one level": (layer(levels=1), "layer 0: levels is 1"),
    "half a level": (layer(levels=2.5), "layer 0: levels is 2.5"),
    "a pen of nothing": (layer(pen=0), "layer 0: pen is 0"),
    "pen true": (layer(pen=True), "layer 0: pen is true"),
    "gamma 0": (layer(gamma=0), "layer 0: gamma is 0"),
    "a colour by its name": (layer(color="red"), 'layer 0: color "red" is not #rrggbb'),
    "color null": (layer(color=None), "layer 0: color null is not #rrggbb"),
    "more than a whole turn": (layer(turn=361), "layer 0: turn is 361"),
    "a negative seed": (layer(seed=-1), "layer 0: seed is -1"),
    "a seed of 64 bits": (layer(seed=2**63), "layer 0: seed is"),
    "outline true": (layer(outline=True), "layer 0: outline is true"),
    "outline even 1": (outline(even=1), "outline: even is 1"),
    "a strength above 1": (outline(min_strength=1.5), "outline: min_strength is 1.5"),
    "a negative length": (outline(min_length=-1), "outline: min_length is -1"),
    "a region of one number": (outline(regions=[[1]]), "region 0 is [1]"),
    "regions null": (outline(regions=None), "regions is null"),
    "NaN": (json.dumps(ILLUSTRATION).replace("0.5", "NaN"), "NaN is not JSON"),
    "nothing": ("", "empty"),
}


def text_of(document: Any) -> bytes:
    return document.encode() if isinstance(document, str) else json.dumps(document).encode()


@pytest.mark.parametrize(
    ("reader", "name"), [("texture", n) for n in TEXTURES] + [("illustration", n) for n in ILLUSTRATIONS]
)
def test_is_refused(reader, name):
    document, complaint = {"texture": TEXTURES, "illustration": ILLUSTRATIONS}[reader][name]
    with pytest.raises(PeninkError) as caught:
        READERS[reader](text_of(document))
    line = str(caught.value)
    assert complaint in line and line.startswith("given.file: ") and line.isprintable() and len(line) < 300


TAKEN = {
    "a texture with notes": ("texture", tile(note=[None, {"by": "hand"}], Width=-1)),
    "a dot, and a negative priority": ("texture", stroke(points=[[5, 5]], priority=-2.5)),
    "a hatched texture": ("texture", hatch(wave=1, wave_length=4)),
    "an illustration with notes": ("illustration", page(note=1, layers=[{**LAYER, "note": 2}])),
    "the least illustration": ("illustration", page(layers=[{"samples": "a"}])),
    "an empty outline": ("illustration", outline()),
}


@pytest.mark.parametrize("name", TAKEN)
def test_is_read(name):
    reader, document = TAKEN[name]
    READERS[reader](text_of(document))


def test_strokes_are_drawn_by_priority_and_equal_ones_in_their_order():
    given = [{**STROKE, "priority": p, "width": w} for p, w in ((2, 1), (1, 2), (2, 3), (-1, 4))]
    found = texture.read(io.BytesIO(text_of(tile(strokes=given))), "t")
    assert found.strokes.widths.tolist() == [4, 2, 1, 3] and found.priorities.tolist() == [-1, 1, 2, 2]


@pytest.mark.parametrize("name", ["crosshatch", "stipple", "scribble"])
def test_what_is_read_in_bulk_is_what_json_reads(name):
    out = io.BytesIO()
    texture.write(out, find_texture(name))
    text = out.getvalue()
    other = text.rstrip()[:-1] + b', "note": 0}'  # the strokes are not the last member: left to json
    assert texture._plain(text)[1] is not None and texture._plain(other)[1] is None
    bulk, slow = (texture.read(io.BytesIO(one), "t") for one in (text, other))
    for array in ("points", "first", "widths"):
        assert np.array_equal(getattr(bulk.strokes, array), getattr(slow.strokes, array))
    assert np.array_equal(bulk.priorities, slow.priorities) and bulk.layers == slow.layers and len(bulk.strokes) > 1000


def test_what_is_wrong_before_strokes_read_in_bulk_is_told_in_its_line():
    text = text_of(tile()).replace(b"{", b"{\n", 1).replace(b'"whole": false', b'"whole": fals')
    with pytest.raises(PeninkError, match="line 2, column"):
        texture.read(io.BytesIO(text), "t")


@pytest.mark.parametrize(
    ("changed", "why"),
    [
        ({"name": "\udcff"}, "name .* is not UTF-8"),
        ({"width": 0.0}, "width is 0"),
        ({"pen": 1e-5}, "stroke 0: width is 0"),
        ({"lead": 251.0}, "leads 251 pt on"),
        ({"count": 1001}, "1001 oriented strokes"),
        ({"at": 1.1e7}, "a point beyond"),
    ],
)
def test_a_texture_that_could_not_be_read_is_not_written(changed, why):
    made = {"name": "x", "width": 9.0, "pen": 0.4, "lead": 20.0, "count": 1, "at": 0.0} | changed
    example = [[0, made["at"]], [made["lead"], made["at"]], [made["lead"], 1], [made["lead"], 1]]
    strokes = Strokes.of(made["width"], 9.0, [example] * made["count"], [made["pen"]] * made["count"])
    out = io.BytesIO()
    with pytest.raises(ParameterError, match=why):
        texture.write(out, Texture(made["name"], strokes, np.arange(made["count"], dtype=np.float64), oriented=True))
    assert not out.getvalue()


@pytest.mark.parametrize("lead", [1.0, 1.0004, 250.0, 250.0004])
@pytest.mark.parametrize("start", [0.0, 0.001, 4.3337, 7.7777])
def test_an_example_of_the_shortest_and_the_longest_lead_is_read_wherever_it_begins(start, lead):
    example = [[start, 1], [start, 2], [start, 3], [start + lead, 1]]
    out = io.BytesIO()
    texture.write(out, Texture("x", Strokes.of(9.0, 9.0, [example], [0.4]), np.zeros(1), oriented=True))
    again = texture.read(io.BytesIO(out.getvalue()), "x")
    assert again.strokes[0][-1, 0] - again.strokes[0][0, 0] == pytest.approx(lead, abs=0.0011)


def test_the_defaults_that_the_schema_tells_are_those_of_the_reader():
    schema = json.loads((Path(illustration.__file__).parent / "schemas/illustration.schema.json").read_text())
    told = {n: m["default"] for n, m in schema["$defs"]["layer"]["properties"].items() if "default" in m}
    plain = READERS["illustration"](json.dumps(page(layers=[{"samples": "a"}])).encode()).layers[0]
    assert told == {
        "texture": plain.texture_name, "levels": plain.levels, "gamma": plain.gamma, "swell": plain.swell,
        "rule": plain.rule, "seed": plain.seed, "turn": plain.turn,
    }  # fmt: skip
