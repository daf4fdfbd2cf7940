"""PostScript: by the conventions, small, and where the strokes say."""

import io
import re
import subprocess

import numpy as np
import pytest
from scipy.spatial import cKDTree

from penink_cli.formats import strokes
from penink_cli.outputs import postscript, postscript_arrays
from penink_cli.outputs.page import ink_box, lay_out
from penink_cli.travel.order import ordered_each
from tests.outputs.drawings import crosshatch, every_kind, strokes_of
from tests.outputs.rendering import difference, ghostscript

KINDS = {"d": 0, "l": 2, "b": 4, "c": 6}


def written(layers, paper=None, margin=0.0, landscape=False, **options):
    out = io.BytesIO()
    page = lay_out(layers, paper, margin, landscape)
    postscript.write(out, layers, page, order=ordered_each, **options)
    return out.getvalue()


def drawn(text):
    """The strokes of a file's arrays, slowly: (pen, points (3k + 1, 2)) each, in points, y up from the sheet's top."""
    units = int(re.search(rb"1 (\d+) div dup scale", text)[1])
    pen, at, result = 0.0, np.zeros(2), []
    body = text.split(b"%%BeginObject")[1].decode()
    for word in re.findall(r"[0-9.]+ w\b|\{[^}]*\}(?:d|\d+ [lbc])\b", body):
        if word.endswith("w"):
            pen = float(word[:-2])
            continue
        numbers, call = word[1:].split("}")
        kind, k = call[-1], int(call[:-2] or 0)
        for row in np.array(numbers.split(), int).reshape(-1, 2 + k * KINDS[kind]):
            points = [at + row[:2]]
            for j in range(k):
                a, n = points[-1], row[2 + j * KINDS[kind] :].astype(float)
                if kind == "c":
                    points += [a + n[:2], a + n[2:4], a + n[4:6]]
                    continue
                chord = n[:2]
                left = np.array([-chord[1], chord[0]]) / np.hypot(*chord) if kind == "b" else np.zeros(2)
                p, q = (n[2], n[2] + n[3]) if kind == "b" else (0, 0)
                points += [a + chord / 3 + left * p, a + chord * 2 / 3 + left * q, a + chord]
            at = points[-1]
            result.append((pen / units, np.array(points) / units))
    return result


def sampled(points, t):
    return np.concatenate(
        [(1 - t) ** 3 * p[0] + 3 * (1 - t) ** 2 * t * p[1] + 3 * (1 - t) * t**2 * p[2] + t**3 * p[3]
         for p in (points[i : i + 4] for i in range(0, len(points) - 1, 3))] or [points]
    )  # fmt: skip


@pytest.mark.parametrize("drawing", [crosshatch(400, 144), every_kind()], ids=["crosshatch", "every kind"])
def test_the_numbers_say_where_the_strokes_are(drawing):
    t = np.linspace(0, 1, 33)[:, None]
    found = drawn(written([drawing]))
    expected = [(w, drawing[i] * (1, -1)) for i, w in enumerate(drawing.widths)]
    pieces = sum(max(1, -(-(len(p) - 1) // (3 * postscript_arrays.CHAIN))) for _, p in expected)
    assert len(found) == pieces
    ink = cKDTree(np.concatenate([sampled(p, t) for _, p in found]))
    for width, points in expected:
        curve = sampled(points, t)
        distance, _ = ink.query(curve)
        spacing = np.hypot(*np.diff(curve, axis=0).T).max(initial=0) / 2
        assert distance.max() <= 2.5 / postscript_arrays.UNITS + spacing
        assert any(abs(w - width) < 1e-3 for w, _ in found)


@pytest.mark.parametrize("compress", [False, True])
def test_ghostscript_draws_what_the_strokes_say(tmp_path, compress):
    from penink_cli.outputs.raster import cover

    for drawing in (every_kind(), crosshatch(500, 144)):
        file = tmp_path / "a.eps"
        file.write_bytes(written([drawing], compress=compress))
        page = lay_out([drawing])
        ours = np.concatenate(list(cover.bands([drawing], page, 300, 255)))
        theirs = ghostscript(file, 300, True, "-g600x600")
        assert difference(ours.astype(float), theirs, 300) < 0.5


def test_compressed_and_plain_are_the_same_picture(tmp_path):
    layers = [every_kind(), crosshatch(300, 144)]
    for name, compress in (("a.eps", False), ("b.eps", True)):
        (tmp_path / name).write_bytes(written(layers, compress=compress))
    assert np.array_equal(ghostscript(tmp_path / "a.eps", 150), ghostscript(tmp_path / "b.eps", 150))


def test_the_structuring_conventions_of_an_eps():
    text = written([every_kind(), strokes_of([[[1, 1]]], 1, layer="näme (2)\n%%EOF")]).decode("ascii")
    lines = text.split("\n")
    assert lines[0] == "%!PS-Adobe-3.0 EPSF-3.0"
    assert lines[-2:] == ["%%EOF", ""]
    assert all(len(line) <= 255 for line in lines)
    order = ["%%BoundingBox:", "%%HiResBoundingBox:", "%%Pages: 1", "%%EndComments", "%%BeginProlog", "%%EndProlog",
             "%%Page: 1 1", "%%BeginObject:", "%%EndObject", "%%PageTrailer", "%%Trailer", "%%EOF"]  # fmt: skip
    places = [next(i for i, line in enumerate(lines) if line.startswith(key)) for key in order]
    assert places == sorted(places)
    assert text.count("%%EOF") == 1 + text.count("\\012%%EOF")
    assert "%%BeginObject: (Every kind)" in lines
    assert "%%BeginObject: (n\\303\\244me \\(2\\)\\012%%EOF)".replace("\\(", "\\050").replace("\\)", "\\051") in lines
    # What an included file must not do, by the EPSF specification.
    forbidden = "banddevice clear cleardictstack copypage erasepage exitserver framedevice grestoreall initclip \
initgraphics initmatrix quit renderbands setglobal setpagedevice setshared startjob letter a4 \
statusdict userdict Date"  # fmt: skip
    for word in forbidden.split():
        assert not re.search(rf"\b{word}\b", text), word


def test_the_preview_is_what_the_strokes_look_like(tmp_path):
    """The layers reach over the sheet, so that the bounding box does too."""
    layers = [crosshatch(300, 144), strokes_of([[[-9, 20], [0, 30], [100, 40], [150, 160]]], 12)]
    colours = [(0.0, 0.0, 0.0), (1.0, 0.5, 0.0)]
    text = written(layers, colours=colours, with_preview=True)
    head, begin, rest = text.partition(b"%%EndComments\n%%BeginPreview: ")
    section, end, body = rest.partition(b"%%EndPreview\n")
    assert begin and end and head + b"%%EndComments\n" + body == written(layers, colours=colours)
    size, *lines = section.decode().splitlines()
    width, height, depth, count = map(int, size.split())
    assert depth == 8 and count == len(lines) and all(re.fullmatch(r"%[0-9a-f]{2,80}", line) for line in lines)
    shown = np.frombuffer(bytes.fromhex("".join(line[1:] for line in lines)), np.uint8).reshape(height, width)
    box = [int(v) for v in re.search(rb"%%BoundingBox: (.*)", head)[1].split()]
    assert box[0] < -9 and (width, height) == (box[2] - box[0], box[3] - box[1])
    (tmp_path / "a.ps").write_bytes(b"%%!\n%d %d translate\n" % (-box[0], -box[1]) + text)
    paper = (f"-dDEVICEWIDTHPOINTS={width}", f"-dDEVICEHEIGHTPOINTS={height}")
    fine = ghostscript(tmp_path / "a.ps", 576, True, *paper)  # 8 pixels a point, of the ink's grey
    wanted = 255 - fine.reshape(height, 8, width, 8).mean(axis=(1, 3))
    assert np.abs(shown - wanted).mean() < 4 and np.abs(shown - wanted).max() < 60


def test_a_large_pictures_preview_stays_small(penink, tmp_path):
    wide = strokes_of([[[0, 0]]], 3, 5000, 2500)
    section = written([wide], with_preview=True).split(b"%%BeginPreview: ")[1]
    assert section.startswith(b"1000 500 8 12500\n") or section.startswith(b"1000 501 8 12525\n")
    path = tmp_path / "a.strokes.jsonl"
    with path.open("wb") as out:
        strokes.write(out, wide)
    assert b"%%BeginPreview" in penink("to-ps", "--preview", str(path)).stdout
    for other in (("--paper", "a0"), ("--separations",)):
        assert penink("to-ps", "--preview", *other, str(path)).returncode == 2


def test_the_same_bytes_twice():
    assert written([every_kind()]) == written([every_kind()])


@pytest.mark.parametrize("compress", [False, True])
def test_stacks_and_graphics_state_are_left_as_found(tmp_path, compress):
    file = tmp_path / "a.eps"
    file.write_bytes(written([every_kind()], compress=compress))
    program = f"""/showpage {{}} def
    17 (here) 3 setlinewidth 0.5 setgray /x (mine) def /A (too) def countdictstack
    ({file}) run countdictstack eq {{(dicts )}} {{(DICTS )}} ifelse print
    (here) eq exch 17 eq and count 1 eq and {{(operands )}} {{(OPERANDS )}} ifelse print
    currentlinewidth 3 eq currentgray 0.5 eq and x (mine) eq and A (too) eq and {{(state)}} {{(STATE)}} ifelse print"""
    done = subprocess.run(
        ["gs", "-dNOSAFER", "-q", "-dBATCH", "-dNOPAUSE", "-sDEVICE=nullpage", "-c", program],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert done.stdout == "dicts operands state"


def test_the_bounding_box_holds_all_ink_and_the_sheet(tmp_path):
    drawing = every_kind()
    file = tmp_path / "a.eps"
    text = written([drawing])
    file.write_bytes(text)
    box = list(map(float, re.search(rb"%%HiResBoundingBox: (.*)", text)[1].split()))
    rough = list(map(int, re.search(rb"%%BoundingBox: (.*)", text)[1].split()))
    assert rough == [*np.floor(box[:2]), *np.ceil(box[2:])]
    assert box[0] < 0  # there is ink left of the sheet and below it
    assert box[1] < 0
    assert box[2] >= 144
    assert box[3] >= 144
    shifted = tmp_path / "b.ps"
    shifted.write_bytes(b"200 200 translate\n" + text)
    done = subprocess.run(
        ["gs", "-dSAFER", "-q", "-dBATCH", "-dNOPAUSE", "-sDEVICE=bbox", "-r720", str(shifted)],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    ink = [float(v) - 200 for v in re.search(r"%%HiResBoundingBox: (.*)", done.stderr)[1].split()]
    assert box[0] <= ink[0] + 0.2
    assert box[1] <= ink[1] + 0.2
    assert box[2] >= ink[2] - 0.2
    assert box[3] >= ink[3] - 0.2


def test_a_crosshatch_takes_few_bytes_and_keeps_its_tone(tmp_path):
    drawing = crosshatch(15000)
    plain, packed = written([drawing]), written([drawing], compress=True)
    assert len(plain) / len(drawing) <= 22
    assert len(packed) / len(drawing) <= 10
    (tmp_path / "a.ps").write_bytes(plain)
    naive = "%!\n1 setlinecap 1 setlinejoin 1 -1 scale 0 -576 translate\n" + "".join(
        "{} {} moveto {} {} {} {} {} {} curveto {} setlinewidth stroke\n".format(*drawing[i].ravel(), w)
        for i, w in enumerate(drawing.widths)
    )
    (tmp_path / "b.ps").write_text(naive + "showpage\n")
    size = ("-g1200x1200",)
    one, other = ghostscript(tmp_path / "a.ps", 150, True, *size), ghostscript(tmp_path / "b.ps", 150, True, *size)
    assert abs(one.mean() - other.mean()) / 2.55 < 0.05
    assert difference(one, other, 150) < 0.25


@pytest.mark.parametrize("landscape", [False, True])
def test_a_page_for_a_printer(tmp_path, landscape):
    drawing = strokes_of([[[0, 0]], [[200, 100]]], 4, 200, 100)
    text = written([drawing], paper="a4", margin=36, landscape=landscape)
    assert text.startswith(b"%!PS-Adobe-3.0\n")
    assert (b"%%Orientation: " + (b"Landscape" if landscape else b"Portrait")) in text
    assert re.search(rb"%%DocumentMedia: a4 595\.276 841\.89 0 \(\) \(\)", text)
    (tmp_path / "a.ps").write_bytes(text)
    picture = ghostscript(tmp_path / "a.ps", 72)
    assert picture.shape == (842, 595)
    y, x = np.nonzero(picture < 128)
    assert abs(x.mean() - 595.276 / 2) < 1
    assert abs(y.mean() - 841.89 / 2) < 1
    assert np.ptp(y if landscape else x) == pytest.approx(203, abs=2)


def test_layers_have_their_colours(tmp_path):
    layers = [strokes_of([[[20, 20]]], 20, 60, 60), strokes_of([[[40, 40]]], 20, 60, 60)]
    (tmp_path / "a.ps").write_bytes(written(layers, colours=[(1.0, 0.0, 0.0)]))
    picture = ghostscript(tmp_path / "a.ps", 72, True, "-g60x60")
    assert 50 < picture[20, 20] < 200  # red as grey
    assert picture[40, 40] == 0


def test_nothing_to_draw_is_a_blank_page(tmp_path):
    (tmp_path / "a.ps").write_bytes(written([strokes_of([], 1, 30, 20)]))
    assert (ghostscript(tmp_path / "a.ps", 72, True, "-dEPSCrop") == 255).all()


def test_the_box_is_where_curves_reach_and_not_their_control_points():
    rng = np.random.default_rng(0)
    points = rng.normal(50, 20, (60, 4, 2)).round(3)
    strokes = strokes_of(list(points), 2.0, 100, 100)
    t = np.linspace(0, 1, 4001)[:, None, None]
    p0, p1, p2, p3 = np.moveaxis(points, 1, 0)
    on = (1 - t) ** 3 * p0 + 3 * (1 - t) ** 2 * t * p1 + 3 * (1 - t) * t * t * p2 + t**3 * p3
    seen = [*(on.min(axis=(0, 1)) - 1), *(on.max(axis=(0, 1)) + 1)]
    assert np.allclose(ink_box(strokes), seen, atol=1e-4)
    controls = [*(points.min(axis=(0, 1)) - 1), *(points.max(axis=(0, 1)) + 1)]
    assert not np.allclose(controls, seen, atol=0.5)
