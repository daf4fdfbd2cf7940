"""SVG drawings as textures: what leaves ink is a stroke, dashes are dashes, what is left out is said."""

from __future__ import annotations

import io

import numpy as np
import pytest

from penink_cli.formats import svg_texture
from penink_cli.ground.errors import FormatError

MM = 72 / 25.4


def imported(body: str, head: str = ""):
    """(strokes in mm, what was reported) of a drawing of 20 mm, in millimetres."""
    text = (
        '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" width="20mm" height="20mm" '
        f'viewBox="0 0 20 20">{head}{body}</svg>'
    )
    said: list[str] = []
    strokes = svg_texture.read(io.BytesIO(text.encode()), "a.svg", "a", report=said.append).strokes
    return [strokes[i] / MM for i in range(len(strokes))], said


INK = '<path d="M2 2h6" stroke="#000" fill="none"/>'
NO_INK = {
    "no stroke": '<path d="M2 8h6" style="fill:none;stroke:none"/>',
    "a group's none": '<g stroke="none" fill="none"><path d="M2 8h6"/></g>',
    "a class": '<style>.a{stroke:none;fill:none}</style><path class="a" d="M2 8h6"/>',
    "opacity 0": '<path d="M2 8h6" stroke="#000" opacity="0"/>',
    "opacity 0%": '<path d="M2 8h6" style="stroke:#000;opacity:0%"/>',
    "a class of opacity 0": '<style>.a{opacity:0}</style><path class="a" d="M2 8h6" stroke="#000"/>',
    "a group of opacity 0": '<g opacity="0"><path opacity="1" d="M2 8h6" stroke="#000"/></g>',
    "a group's class": '<style>.a{opacity:0}</style><g class="a"><path opacity="1" d="M2 8h6" stroke="#000"/></g>',
    "a group's class over the child's": '<style>.a{opacity:0}.b{opacity:1}</style><g class="a"><path class="b" '
    'd="M2 8h6" stroke="#000"/></g>',
    "a group that is not displayed": '<g display="none"><path display="inline" d="M2 8h6" stroke="#000"/></g>',
    "a class that is not displayed": '<style>.a{display:none}</style><g class="a"><g style="display:inline"><path '
    'd="M2 8h6" stroke="#000"/></g></g>',
    "a group's style": '<g style="opacity: 0.0; fill:none"><path opacity="1" d="M2 8h6" stroke="#000"/></g>',
    "stroke-opacity 0": '<path d="M2 8h6" fill="none" stroke="#000" stroke-opacity="0"/>',
    "transparent": '<path d="M2 8h6" fill="none" stroke="transparent"/>',
    "rgba": '<path d="M2 8h6" fill="none" stroke="rgba(0,0,0,0)"/>',
    "a width of 0": '<path d="M2 8h6" fill="none" stroke="#000" stroke-width="0"/>',
    "hidden": '<g visibility="hidden"><path d="M2 8h6" stroke="#000"/></g>',
    "collapsed": '<path d="M2 8h6" stroke="#000" visibility="collapse"/>',
    "display none": '<g display="none"><path d="M2 8h6" stroke="#000"/></g>',
    "a class not displayed": '<style>.a{display:none}</style><g class="a"><path d="M2 8h6" stroke="#000"/></g>',
    "white": '<path d="M2 8h6" fill="none" stroke="#fff"/>',
    "white by name": '<path d="M2 8h6" fill="none" stroke="white"/>',
    "white as currentColor": '<g color="#fff" stroke="currentColor"><path fill="none" d="M2 8h6"/></g>',
    "a white shape": '<rect x="2" y="2" width="5" height="5" fill="#ffffff"/>',
    "a white background": '<rect width="20" height="20" style="fill:#ffffff;stroke:none"/>',
    "a grey background": '<rect width="100%" height="100%" fill="#ddd"/>',
    "a background that is a path": '<path d="M0 0h20v20h-20z" fill="#123456"/>',
    "in defs": '<defs><path d="M2 8h6" stroke="#000"/></defs>',
    "a symbol": '<symbol id="s"><path d="M2 8h6" stroke="#000"/></symbol>',
    "a clip path": '<clipPath id="c"><path d="M2 8h6" stroke="#000"/></clipPath>',
    "a pattern": '<defs><pattern id="p"><path d="M2 8h6" stroke="#000"/></pattern></defs>',
}
DRAWN = {
    "in a hidden group, visible": '<g visibility="hidden"><path visibility="visible" d="M2 8h6" stroke="#000"/></g>',
    "currentColor": '<g color="#123" stroke="currentColor"><path fill="none" d="M2 8h6"/></g>',
    "a class over an attribute": '<style>.a{opacity:.5}</style><g class="a" opacity="0"><path d="M2 8h6" '
    'stroke="#000"/></g>',
    "half transparent": '<g opacity="0.5"><path d="M2 8h6" stroke="#000" stroke-opacity="0.5"/></g>',
    "over a group's none": '<g stroke="none"><path d="M2 8h6" stroke="#000"/></g>',
    "a symbol in use": '<symbol id="s"><path d="M2 8h6" stroke="#000"/></symbol><use xlink:href="#s"/>',
    "a path in use": '<defs><path id="d" d="M2 8h6" stroke="#000"/></defs><use href="#d"/>',
    "clipped": '<clipPath id="c"><rect width="9" height="9"/></clipPath><path clip-path="url(#c)" d="M2 8h6" '
    'stroke="#000"/>',
    "a gradient": '<path d="M2 8h6" fill="none" stroke="url(#g)"/>',
}


@pytest.mark.parametrize("name", NO_INK)
def test_what_leaves_no_ink_is_no_stroke(name):
    strokes, _ = imported(INK + NO_INK[name])
    assert len(strokes) == 1
    assert strokes[0][0] == pytest.approx([2, 2])


@pytest.mark.parametrize("name", DRAWN)
def test_what_leaves_ink_is_a_stroke(name):
    strokes, _ = imported(INK + DRAWN[name])
    assert len(strokes) == 2
    assert strokes[1][[0, -1]] == pytest.approx(np.array([[2, 8], [8, 8]]))


@pytest.mark.parametrize(
    ("body", "points"),
    [
        ('<rect x="2" y="3" width="5" height="4"/>', 13),
        ('<rect x="2" y="3" width="5" height="4" fill="#888" stroke="#fff"/>', 13),
        ('<rect width="20" height="20" fill="none" stroke="#000"/>', 13),  # a frame is drawn
        ('<path d="M0 0h20v20z" stroke="#000" fill="#fff"/>', 10),
    ],
)
def test_what_is_only_filled_is_outlined_and_a_frame_is_no_background(body, points):
    strokes, said = imported(body)
    assert [len(s) for s in strokes] == [points]
    assert not said


def ends(strokes):
    """x where each begins and ends."""
    return np.array([(s[0, 0], s[-1, 0]) for s in strokes])


def test_dashes_are_dashes():
    strokes, said = imported('<path d="M2 5h16" stroke="#000" stroke-width="0.3" stroke-dasharray="1 1" fill="none"/>')
    assert not said
    assert [s[0, 0] for s in strokes] == pytest.approx(np.arange(2, 18, 2), abs=1e-4)
    assert [s[-1, 0] for s in strokes] == pytest.approx(np.arange(3, 19, 2), abs=1e-4)
    odd, _ = imported('<path d="M0 5h12" stroke="#000" stroke-dasharray="3,1,2" fill="none"/>')
    assert ends(odd) == pytest.approx(np.array([(0, 3), (4, 6), (9, 10)]), abs=1e-4)
    late, _ = imported('<path d="M0 5h6" stroke="#000" stroke-dasharray="2" stroke-dashoffset="1" fill="none"/>')
    assert ends(late) == pytest.approx(np.array([(0, 1), (3, 5)]), abs=1e-4)
    scaled, _ = imported('<g transform="scale(2)" style="stroke-dasharray:1 2;stroke:#000"><path d="M0 1h6"/></g>')
    assert ends(scaled) == pytest.approx(np.array([(0, 2), (6, 8)]), abs=1e-4)
    dots, _ = imported('<path d="M0 5h6" stroke="#000" stroke-dasharray="0 2" fill="none"/>')
    assert [len(s) for s in dots][:3] == [1, 1, 1]
    assert [s[0, 0] for s in dots][:3] == pytest.approx([0, 2, 4], abs=1e-4)
    solid, _ = imported('<path d="M0 5h6" stroke="#000" stroke-dasharray="0 0" fill="none"/>')
    assert len(solid) == 1


def test_dashes_lie_on_the_curve_and_go_round_corners():
    circle = '<circle cx="10" cy="10" r="5" fill="none" stroke="#000" stroke-dasharray="3.1415926 3.1415926"/>'
    ring, _ = imported(circle)
    assert len(ring) in (5, 6)
    t = np.linspace(0, 1, 33)[:, None]
    for s in ring[:5]:
        length = 0.0
        for a, b, c, d in (s[k : k + 4] for k in range(0, len(s) - 1, 3)):
            curve = (1 - t) ** 3 * a + 3 * t * (1 - t) ** 2 * b + 3 * t * t * (1 - t) * c + t**3 * d
            assert np.hypot(*(curve - 10).T) == pytest.approx(5, abs=0.01)
            length += np.hypot(*np.diff(curve, axis=0).T).sum()
        assert length == pytest.approx(np.pi, rel=0.01)
    corner, _ = imported('<path d="M0 0h4v4" stroke="#000" stroke-dasharray="6 9" fill="none"/>')
    assert len(corner) == 1
    assert corner[0][[0, 3, 6]] == pytest.approx(np.array([[0, 0], [4, 0], [4, 2]]), abs=1e-4)


def test_one_line_says_what_is_left_out():
    body = INK + NO_INK["no stroke"] + NO_INK["opacity 0"] + NO_INK["white"] + NO_INK["a grey background"]
    _, said = imported(body + "<text>a</text>")
    assert said == [
        "2 invisible shapes, 1 white shape, 1 background and 1 text left out; turn text to paths to have it"
    ]
    assert imported(INK + NO_INK["white"])[1] == ["1 white shape left out"]
    assert imported(INK + DRAWN["clipped"])[1] == ["1 clipped, and drawn whole"]
    assert imported(INK)[1] == []
    with pytest.raises(FormatError, match="leaves ink in the drawing, only 1 invisible shape"):
        imported(NO_INK["no stroke"])


def nested(levels: int) -> str:
    """Ten to the power of so many lines, by groups that use one another."""
    groups = [f'<g id="g{i}">' + f'<use xlink:href="#g{i - 1}"/>' * 10 + "</g>" for i in range(1, levels + 1)]
    return f'<g id="g0">{INK}</g>' + "".join(groups)


@pytest.mark.parametrize(
    ("body", "why"),
    [
        (nested(9), "more than 1000000 elements"),
        (f'<g id="a"><use href="#a"/>{INK}</g>', "one that uses itself"),
        (f'<g id="a"><use href="#b"/></g><g id="b"><use xlink:href=" #a "/>{INK}</g>', "one that uses itself"),
        ('<path d="M2 2h6" stroke="#000" stroke-width="1e999"/>', "a stroke-width that is no number"),
        ('<path d="M2 2h6" stroke="#000" stroke-width="1e30"/>', "a stroke-width that is no number, or is beyond"),
        ('<path d="M2 2h1e30" stroke="#000"/>', "a coordinate or a stroke-width"),
    ],
    ids=["a bomb", "itself", "two by turns", "endless", "too wide", "too far"],
)
def test_what_grows_beyond_all_bounds_is_refused(body, why):
    with pytest.raises(FormatError, match=why):
        imported(body)


def test_what_is_used_several_times_is_drawn_as_often():
    assert len(imported(nested(1))[0]) == 11


@pytest.mark.parametrize("encoding", ["foo", "utf-7", "\u2028"])
def test_an_encoding_that_is_not_known_is_an_error_of_one_line(encoding):
    text = f'<?xml version="1.0" encoding="{encoding}"?><svg xmlns="http://www.w3.org/2000/svg"><use/>{INK}</svg>'
    for drawing in (text, text.replace("<use/>", "")):
        with pytest.raises(FormatError, match="not SVG") as caught:
            svg_texture.read(io.BytesIO(drawing.encode()), "a.svg", "a")
        assert str(caught.value).isprintable()
