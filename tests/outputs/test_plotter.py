"""For a plotter: how long it takes, its pens, one path a width, the place on the sheet; nothing is lost on the way."""

from __future__ import annotations

import io
import itertools
import json
import math
import re
import shutil
import subprocess
import xml.etree.ElementTree as ET
from dataclasses import replace

import jsonschema
import numpy as np
import pytest

from penink_cli.formats import pens as pens_format
from penink_cli.formats import strokes as strokes_format
from penink_cli.ground.errors import FormatError
from penink_cli.travel import clock
from tests.conftest import ROOT
from tests.outputs.drawings import crosshatch, every_kind, strokes_of

SVG = "{http://www.w3.org/2000/svg}"
LABEL = "{http://www.inkscape.org/namespaces/inkscape}label"
MM = 72 / 25.4
SCHEMA = ROOT / "penink_cli/formats/schemas/pens.schema.json"


# ------------------------------------------------------------------------------------------------ time


def planned(points, speed, acceleration, corner):
    """Seconds along a polyline (n, 2) in mm by the published model, step by step: the oracle."""
    kept = [points[0]]
    for point in points[1:]:
        if math.dist(point, kept[-1]) > 1e-9:
            kept.append(point)
    if len(kept) < 2:
        return 0.0
    limit = [0.0]
    for a, b, c in zip(kept, kept[1:], kept[2:]):
        ab, bc = (b[0] - a[0], b[1] - a[1]), (c[0] - b[0], c[1] - b[1])
        cosine = -(ab[0] * bc[0] + ab[1] * bc[1]) / math.hypot(*ab) / math.hypot(*bc)
        sine = math.sqrt(max(0.0, (1 - cosine) / 2))
        limit.append(speed if sine > 1 - 1e-9 else min(speed, math.sqrt(acceleration * corner * sine / (1 - sine))))
    limit.append(0.0)
    long = [math.dist(a, b) for a, b in itertools.pairwise(kept)]
    for i, length in enumerate(long):
        limit[i + 1] = min(limit[i + 1], math.sqrt(limit[i] ** 2 + 2 * acceleration * length))
    for i in range(len(long) - 1, -1, -1):
        limit[i] = min(limit[i], math.sqrt(limit[i + 1] ** 2 + 2 * acceleration * long[i]))
    total = 0.0
    for i, length in enumerate(long):
        one, other = limit[i], limit[i + 1]
        peak = math.sqrt((one**2 + other**2) / 2 + acceleration * length)
        if peak <= speed:
            total += (2 * peak - one - other) / acceleration
        else:
            rest = length - (2 * speed**2 - one**2 - other**2) / (2 * acceleration)
            total += (2 * speed - one - other) / acceleration + rest / speed
    return total


def whole(layers, x=0.0, y=0.0):
    """Seconds of an AxiDraw for layers, stroke by stroke, curves in 400 chords a segment."""
    at, total = (0.0, 0.0), 0.0
    t = np.linspace(0, 1, 401)[1:, None]
    for layer in layers:
        for i in range(len(layer)):
            p = (layer[i] + (x, y)) / MM
            line = [p[:1]]
            for k in range(0, len(p) - 1, 3):
                a, b, c, d = p[k : k + 4]
                line.append((1 - t) ** 3 * a + 3 * t * (1 - t) ** 2 * b + 3 * t * t * (1 - t) * c + t**3 * d)
            line = np.concatenate(line).tolist()
            total += planned([at, line[0]], 200, 400, 0) + 0.24 + planned(line, 50, 200, 0.127)
            at = line[-1]
    return total + planned([at, (0.0, 0.0)], 200, 400, 0)


def bowed(count=60):
    """Strokes along rings."""
    t = np.linspace(0, 1, 7)
    return strokes_of(
        [
            np.stack([72 + r * np.cos(t * 2 + r), 72 + r * np.sin(t * 2 + r)], axis=1)
            for r in np.linspace(5, 70, count)
        ],
        0.4,
    )


def dots():
    return strokes_of(np.random.default_rng(0).uniform(5, 139, (400, 1, 2)), 0.8)


@pytest.mark.parametrize(
    "drawing", [dots(), crosshatch(300, 144), bowed(), every_kind(), strokes_of([], 1)],
    ids=["dots", "hatching", "along a form", "every kind", "nothing"],
)  # fmt: skip
def test_the_time_is_that_of_the_published_model(drawing):
    ours, theirs = clock.seconds([drawing], clock.Plotter(), 30, 50), whole([drawing], 30, 50)
    assert ours == pytest.approx(theirs, rel=0.03, abs=1e-5)


@pytest.mark.parametrize("seed", range(5))
def test_polylines_are_planned_exactly(seed):
    rng = np.random.default_rng(seed)
    chains = []
    for _ in range(20):
        corners = rng.integers(0, 6, (rng.integers(2, 30), 2)) * rng.choice([0.3, 3, 30])
        thirds = np.linspace(0, 1, 4)[1:, None]
        legs = [a + thirds * (b - a) for a, b in itertools.pairwise(corners)]
        chains.append(np.concatenate([corners[:1], *legs]))
    strokes = strokes_of(chains, 1)
    motion = clock.Motion(50, 200)
    expected = [planned((strokes[i][::3] / MM).tolist(), 50, 200, 0.127) for i in range(len(strokes))]
    assert clock.drawn_seconds(strokes, motion) == pytest.approx(expected, rel=1e-4)


def test_every_part_of_the_time_counts():
    usual = clock.seconds([bowed()], clock.Plotter())
    slower = {
        "lift": replace(clock.Plotter(), lift=0.2),
        "speed": replace(clock.Plotter(), down=clock.Motion(20, 200)),
        "acceleration": replace(clock.Plotter(), down=clock.Motion(50, 50)),
        "corners": replace(clock.Plotter(), down=clock.Motion(50, 200, 0.001)),
        "travel": replace(clock.Plotter(), up=clock.Motion(50, 400, 0)),
    }
    for what, plotter in slower.items():
        assert clock.seconds([bowed()], plotter) > usual * 1.01, what
    assert clock.seconds([bowed()], slower["lift"]) - usual == pytest.approx(60 * 0.16)


# ------------------------------------------------------------------------------------------------ files


def saved(folder, name, strokes, color=None):
    path = folder / f"{name}.strokes.jsonl"
    with path.open("wb") as out:
        strokes_format.write(out, replace(strokes, layer=name, color=color))
    return str(path)


def drawn(penink, *arguments):
    done = penink("to-svg", *arguments)
    assert done.returncode == 0, done.stderr
    return ET.fromstring(done.stdout), done.stderr.decode()


def subpaths(root):
    """By layer: label, colour, and each subpath's width and length in mm, by a reader of its own."""
    t = np.linspace(0, 1, 65)[:, None]
    found = []
    for group in root.findall(f"{SVG}g"):
        strokes = []
        for path in group.findall(f"{SVG}path"):
            width = float(path.get("stroke-width", group.get("stroke-width")))
            for part in re.split("(?=M)", path.get("d"))[1:]:
                words = re.findall(r"[Mch]|-?[0-9]*\.?[0-9]+", part)
                at, length, begin = np.array(words[1:3], float), 0.0, np.array(words[1:3], float)
                if words[3] == "h":
                    length = float(words[4])
                else:
                    for b, c, d in np.array(words[4:], float).reshape(-1, 3, 2):
                        curve = 3 * t * (1 - t) ** 2 * b + 3 * t * t * (1 - t) * c + t**3 * d
                        length += float(np.hypot(*np.diff(curve, axis=0).T).sum())
                        at = at + d
                strokes.append((width, length, *begin, *at))
        found.append((group.get(LABEL), group.get("stroke"), strokes))
    return found


def test_merged_paths_are_the_same_strokes(tmp_path, penink):
    files = [saved(tmp_path, "kinds", every_kind()), saved(tmp_path, "hatching", crosshatch(200, 144), "#112233")]
    plain, merged = (subpaths(drawn(penink, *more, *files)[0]) for more in ((), ("--merge",)))
    assert [layer[:2] for layer in plain] == [layer[:2] for layer in merged]
    for one, other in zip(plain, merged, strict=True):
        assert sorted(one[2]) == sorted(other[2])
    root, _ = drawn(penink, "--merge", *files)
    for group, strokes in zip(root.findall(f"{SVG}g"), (every_kind(), crosshatch(200, 144)), strict=True):
        assert len(group.findall(f"{SVG}path")) == len(np.unique(strokes.widths))
    ordered = subpaths(drawn(penink, "--merge", "--order", "--join", "0", *files)[0])
    assert [len(layer[2]) for layer in ordered] == [len(layer[2]) for layer in plain]


def test_svgelements_reads_the_same_from_both(tmp_path, penink):
    import svgelements

    path = saved(tmp_path, "kinds", every_kind())
    lengths = []
    for more in ((), ("--merge",)):
        drawing = svgelements.SVG.parse(io.BytesIO(penink("to-svg", *more, path).stdout))
        parts = [svgelements.Path(sub) for e in drawing.elements() if isinstance(e, svgelements.Path)
                 for sub in e.as_subpaths()]  # fmt: skip
        lengths.append(sorted(round(float(part.length(error=1e-4)), 2) for part in parts))
    assert len(lengths[0]) == len(lengths[1]) == len(every_kind())
    assert lengths[0] == pytest.approx(lengths[1], abs=0.02)


PENS = {
    "format": "penink-pens", "version": 1, "pens": [
        {"name": "fine", "width": "0.3mm", "speed": "50mm", "refill": "200mm"},
        {"name": "broad", "width": "1mm"},
        {"name": "red", "color": "#d2232a", "width": "0.5mm", "speed": "100mm"}],
}  # fmt: skip


def pens_file(folder, document=PENS):
    path = folder / "my.pens.json"
    path.write_text(json.dumps(document))
    return str(path)


def test_strokes_go_to_the_pen_of_their_colour_and_width(tmp_path, penink):
    thin = strokes_of([[[10, 10 + i]] for i in range(5)], 0.7)
    thick = strokes_of([[[30, 10 + i]] for i in range(3)], 2.5)
    files = [
        saved(tmp_path, "a", thin), saved(tmp_path, "b", thick), saved(tmp_path, "c", thick, "#ff0000"),
        saved(tmp_path, "d", thin, "#202020"),
    ]  # fmt: skip
    layers = subpaths(drawn(penink, "--pens", pens_file(tmp_path), *files)[0])
    assert [(label, colour, len(strokes)) for label, colour, strokes in layers] == [
        ("1+S25 fine", "#000000", 10), ("!2 broad", "#000000", 3), ("!3+S50 red", "#d2232a", 3),
    ]  # fmt: skip
    assert {s[0] for s in layers[0][2]} == {0.3} and {s[0] for s in layers[2][2]} == {0.5}


def test_a_layer_ends_where_the_pen_wants_refilling(tmp_path, penink):
    lines = strokes_of([[[0, i], [30, i], [60, i], [100 * MM, i]] for i in range(10)], 0.85)
    path = saved(tmp_path, "lines", lines)
    layers = subpaths(drawn(penink, "--pens", pens_file(tmp_path), path)[0])  # 200 mm a filling
    assert [(label, len(strokes)) for label, _, strokes in layers] == [
        ("1+S25 fine 1/5", 2), ("!2+S25 fine 2/5", 2), ("!3+S25 fine 3/5", 2), ("!4+S25 fine 4/5", 2),
        ("!5+S25 fine 5/5", 2),
    ]  # fmt: skip
    layers = subpaths(drawn(penink, "--split-length", "350mm", path)[0])
    assert [(label, len(strokes)) for label, _, strokes in layers] == [
        ("1 lines 1/4", 3), ("!2 lines 2/4", 3), ("!3 lines 3/4", 3), ("!4 lines 4/4", 1)]  # fmt: skip
    one = subpaths(drawn(penink, "--split-length", "10mm", path)[0])
    assert [len(strokes) for _, _, strokes in one] == [1] * 10  # a stroke is never cut
    _, said = drawn(penink, "--split-length", "350mm", "--speed", "50mm", path)
    assert re.search(r"10 strokes: 1.00 m drawn, .* on the plotter and 3 pauses", said)


def test_one_pen_joins_across_widths(tmp_path, penink):
    lines = [[[0, 0], [5, 0], [9, 0], [20, 0]], [[20, 0], [25, 0], [29, 0], [40, 0]]]
    path = saved(tmp_path, "lines", strokes_of(lines, [0.4, 0.8]))
    assert len(subpaths(drawn(penink, "--order", path)[0])[0][2]) == 2
    layer = subpaths(drawn(penink, "--order", "--pen", "0.5mm", path)[0])[0][2]
    assert [stroke[0] for stroke in layer] == [0.5]
    assert layer[0][1] == pytest.approx(40 / MM, abs=0.01)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"pens": []}, "0 pens; 1 to 64"),
        ({"pens": [{"width": 1}]}, 'pen 0: member "name"'),
        ({"pens": [{"name": "a"}]}, 'pen 0: member "width"'),
        ({"pens": [{"name": "", "width": 1}]}, "pen 0: name"),
        ({"pens": [{"name": "a", "width": 0}]}, "pen 0: width is 0"),
        ({"pens": [{"name": "a", "width": True}]}, "pen 0: width is true"),
        ({"pens": [{"name": "a", "width": "1 furlong"}]}, "pen 0: width: "),
        ({"pens": [{"name": "a", "width": 1, "color": "red"}]}, "pen 0: color"),
        ({"pens": [{"name": "a", "width": 1, "speed": -1}]}, "pen 0: speed is -1"),
        ({"pens": [{"name": "a", "width": 1}, {"name": "a", "width": 2}]}, "pen 1: the name"),
        ({"pens": [1]}, "pen 0 is 1"),
        ({"format": "penink-style"}, "style"),
        ({"version": 2}, "version is 2"),
    ],
)
def test_what_is_no_pen_is_refused(change, said):
    schema = jsonschema.Draft202012Validator(json.loads(SCHEMA.read_text("utf-8")))
    schema.validate(PENS)
    if "the name" not in said:
        assert list(schema.iter_errors({**PENS, **change}))
    with pytest.raises(FormatError) as caught:
        pens_format.read(io.BytesIO(json.dumps({**PENS, **change}).encode()), "my.pens.json")
    assert said in str(caught.value)


# ------------------------------------------------------------------------------------------------ the sheet

#: Options, the page in mm, and where on it the picture (144 pt square) begins; None where it is refused.
SHEETS = [
    ((), (50.8, 50.8), (0, 0)),
    (("--margin", "10mm"), (70.8, 70.8), (10, 10)),
    (("--paper", "a4"), (210, 297), (79.6, 123.1)),
    (("--paper", "a4", "--landscape"), (297, 210), (123.1, 79.6)),
    (("--paper", "300x210mm"), (300, 210), (124.6, 79.6)),
    (("--paper", "300mmx210mm"), (300, 210), (124.6, 79.6)),
    (("--paper", "300x210mm", "--landscape"), (300, 210), (124.6, 79.6)),
    (("--paper", "210x300mm", "--landscape"), (300, 210), (124.6, 79.6)),
    (("--paper", "11x17in"), (279.4, 431.8), (114.3, 190.5)),
    (("--paper", "30 × 21 cm"), (300, 210), (124.6, 79.6)),
    (("--paper", "144x144"), (50.8, 50.8), (0, 0)),
    (("--paper", "a4", "--at", "20mm,35mm"), (210, 297), (20, 35)),
    (("--at", "20mm,1in"), (70.8, 76.2), (20, 25.4)),
    (("--at", "20mm,0", "--margin", "5mm"), (75.8, 55.8), (20, 0)),
    (("--paper", "a4", "--at", "160mm,0"), None, None),
    (("--paper", "a4", "--at", "150mm,0", "--margin", "10mm"), None, None),
    (("--paper", "40x40mm"), None, None),
]


@pytest.mark.parametrize(("options", "page", "place"), SHEETS, ids=[" ".join(s[0]) or "none" for s in SHEETS])
def test_papers_and_places(tmp_path, penink, options, page, place):
    path = saved(tmp_path, "dot", strokes_of([[[0, 0]], [[144, 144]]], 1))
    if page is None:
        done = penink("to-svg", *options, path)
        assert done.returncode == 1
        assert b"is larger than" in done.stderr and not done.stdout
        return
    root, _ = drawn(penink, *options, path)
    assert [float(root.get(side)[:-2]) for side in ("width", "height")] == pytest.approx(page, abs=0.01)
    assert subpaths(root)[0][2][0][2:4] == pytest.approx(place, abs=0.01)
    pdf = penink("to-pdf", *options, path).stdout
    box = re.search(rb"/MediaBox \[0 0 ([0-9.]+) ([0-9.]+)\]", pdf)
    assert [float(side) / MM for side in box.groups()] == pytest.approx(page, abs=0.01)
    head = penink("to-ps", *options, path).stdout.decode()
    if "--paper" in options:
        size = [float(v) / MM for v in re.search(r"PageSize \[([0-9.]+) ([0-9.]+)\]", head).groups()]
        assert sorted(size) == pytest.approx(sorted(page), abs=0.01)


def table(columns):
    """The rows of the README's table with that many columns, about sheets or about layers."""
    text = (ROOT / "README.md").read_text("utf-8")
    rows = re.findall(r"^\| `(--[^`|]*)`(.*)\|$", text, re.MULTILINE)
    return [(options.split(), more.split("|")) for options, more in rows if more.count("|") == columns - 1]


SHEETS_TOLD = [(options, *cells[1:]) for options, cells in table(3)]
LOADS_TOLD = [(options, cells[1]) for options, cells in table(2)]


def test_the_readme_has_both_tables():
    assert len(SHEETS_TOLD) >= 8 and len(LOADS_TOLD) >= 4


@pytest.mark.parametrize(("options", "page", "place"), SHEETS_TOLD, ids=[" ".join(row[0]) for row in SHEETS_TOLD])
def test_sheets_are_as_the_readme_says(tmp_path, penink, options, page, place):
    sides = tuple(float(side) for side in page.split("×"))
    test_papers_and_places(tmp_path, penink, tuple(options), sides, tuple(float(v) for v in place.split(",")))


@pytest.mark.parametrize(("options", "counts"), LOADS_TOLD, ids=[" ".join(row[0]) for row in LOADS_TOLD])
def test_layers_are_as_the_readme_says(tmp_path, penink, options, counts):
    path = saved(tmp_path, "lines", strokes_of([[[0, i], [30, i], [60, i], [100 * MM, i]] for i in range(10)], 0.85))
    options = [pens_file(tmp_path) if word == "FILE" else word for word in options]
    layers = subpaths(drawn(penink, *options, path)[0])
    assert [len(strokes) for _, _, strokes in layers] == [int(count) for count in counts.split(",")]
    assert [label.startswith("!") for label, _, _ in layers] == [False] + [True] * (len(layers) - 1)


@pytest.mark.parametrize("value", ["20mm", "1,2,3", "a,b", "-1,2"])
def test_what_is_no_place_is_a_usage_error(penink, value):
    assert penink("to-svg", "--at", value, input=b"").returncode == 2


# ------------------------------------------------------------------------------------------------ the machine

#: Where an HP 7475A can draw on A4 that lies across, mm from the sheet's left and top.
HP_7475A = (10.0, 297 - 11.0), (13.0, 210 - 4.0)


def pen_downs(hpgl):
    """How often a pen goes down in HPGL, which is once a stroke."""
    down = count = 0
    for command in hpgl.split(";"):
        if command[:2] == "PU":
            down = 0
        elif command[:2] == "PD":
            count, down = count + (not down), 1
    return count


def recipe():
    """The README's call of to-svg for a plotter."""
    text = (ROOT / "README.md").read_text("utf-8")
    return re.search(r"penink to-svg ([^|\n]*)\| vpype (read [^\n]*)", text)


def test_the_readmes_plotter_draws_every_stroke(tmp_path, penink):
    options, vpype = (part.split() for part in recipe().groups())
    strokes = crosshatch(400, 432)
    root, _ = drawn(penink, *options, saved(tmp_path, "a", strokes))
    width, height = (float(root.get(side)[:-2]) for side in ("width", "height"))
    found = np.array([stroke[2:] for stroke in subpaths(root)[0][2]]).reshape(-1, 2, 2)
    across = found if width > height else found[..., ::-1]
    for axis, (low, high) in enumerate(HP_7475A):
        whole = (max, min)[axis](width, height)
        for side in (across[..., axis], whole - across[..., axis]):  # whichever way the sheet lies
            assert low <= side.min() and side.max() <= high
    if program := shutil.which("vpype"):  # and there it is counted, by a reader of our own
        (tmp_path / "a.svg").write_bytes(penink("to-svg", *options, saved(tmp_path, "a", strokes)).stdout)
        command = [program, "read", str(tmp_path / "a.svg"), *vpype[vpype.index("write") :]]
        subprocess.run([*command[:-1], str(tmp_path / "a.hpgl")], check=True, capture_output=True)
        assert pen_downs((tmp_path / "a.hpgl").read_text()) == len(found)


@pytest.mark.parametrize(("columns", "rows"), [(18, 32), (24, 24), (32, 18)])
@pytest.mark.parametrize("paper", [("a4",), ("letter", "--landscape"), ("100x150mm",)])
def test_a_drawing_for_a_paper_is_as_large_as_that_holds(tmp_path, penink, columns, rows, paper):
    from PIL import Image

    y, x = np.mgrid[0:rows, 0:columns]
    Image.fromarray((40 + 5 * x + 2 * y).astype(np.uint8)).save(tmp_path / "photo.png")
    done = penink("draw", "--style", "true", "--paper", *paper, "--margin", "15mm", str(tmp_path / "photo.png"))
    assert done.returncode == 0, done.stderr
    page = [float(v) for v in re.search(rb"PageSize \[([0-9.]+) ([0-9.]+)\]", done.stdout).groups()]
    x0, y0, x1, y1 = (float(v) for v in re.search(rb"HiResBoundingBox: (.*)\n", done.stdout)[1].split())
    assert min(x0, y0, page[0] - x1, page[1] - y1) > 12 * MM  # all of it, with strokes that reach over the sheet
    room = np.array(page) - 30 * MM
    assert max((x1 - x0) / room[0], (y1 - y0) / room[1]) > 0.97 or max(x1 - x0, y1 - y0) > 425


def test_draw_with_pens(tmp_path, penink):
    from PIL import Image

    y, x = np.mgrid[0:24, 0:24]
    Image.fromarray(np.dstack([9 * x, 9 * y, 255 - 9 * x]).astype(np.uint8)).save(tmp_path / "photo.png")
    two = (("k", "#000000"), ("r", "#d2232a"))
    pens = {**PENS, "pens": [{"name": name, "color": color, "width": "0.4mm"} for name, color in two]}
    options = ("--inks", "#d2232a,#000000", "--pens", pens_file(tmp_path, pens), "--style", "true", "--width", "1in")
    done = penink("draw", *options, str(tmp_path / "photo.png"), "-o", str(tmp_path / "a.svg"))
    assert done.returncode == 0, done.stderr
    layers = subpaths(ET.parse(tmp_path / "a.svg").getroot())
    assert [layer[:2] for layer in layers] == [("1 k", "#000000"), ("!2 r", "#d2232a")]
    assert {stroke[0] for layer in layers for stroke in layer[2]} == {0.4}
