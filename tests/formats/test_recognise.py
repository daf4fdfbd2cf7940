"""The wrong kind of file: the error says what it is, and the way out."""

from __future__ import annotations

import io
import json
import re

import pytest

from penink_cli.formats import (
    edge_list,
    illustration,
    lines,
    pens,
    pgm,
    photo,
    recognise,
    strokes,
    svg_texture,
    texture,
)
from penink_cli.ground.errors import PeninkError
from penink_cli.main import SUBCOMMANDS


def manifest(kind: str, **members: object) -> bytes:
    return json.dumps({"format": f"penink-{kind}", "version": 1, "width": 9, "height": 9} | members).encode()


STROKES = manifest("strokes") + b'\n{"width": 0.4, "points": [[1, 1]]}\n'
FILES = {
    "pgm": b"P5\n1 1\n255\n\xff",
    "photo": b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\xff\xfe",
    "strokes": STROKES,
    "edges": manifest("edges", vertices=[], edges=[]),
    "lines": manifest("lines", lines=[]),
    "texture": manifest("texture", name="x", strokes=[]),
    "pens": manifest("pens", pens=[]),
    "illustration": b"PK\x03\x04\x14\0\0\0\xff",
    "svg": b'<?xml version="1.0"?>\n<svg xmlns="http://www.w3.org/2000/svg"/>\n',
    "page": b"%!PS-Adobe-3.0 EPSF-3.0\n",
    "foreign": b"\0\0\0\x18ftypcrx \0\0\0\0\xff",
}
READERS = {
    "pgm": lambda data: pgm.read(io.BytesIO(data), "f", 100),
    "photo": lambda data: photo.read_grey(io.BytesIO(data), "f", 100),
    "strokes": lambda data: strokes.read(io.BytesIO(data), "f"),
    "edges": lambda data: edge_list.read(io.BytesIO(data), "f"),
    "lines": lambda data: lines.read(io.BytesIO(data), "f"),
    "texture": lambda data: texture.read(io.BytesIO(data), "f"),
    "pens": lambda data: pens.read(io.BytesIO(data), "f"),
    "illustration": lambda data: illustration.read(data, "f", lambda _: b"", lambda _: None, 100),
    "svg": lambda data: svg_texture.read(io.BytesIO(data), "f", "name"),
}


@pytest.mark.parametrize(
    ("wanted", "found"),
    [(w, f) for w in READERS for f in FILES if f != w and (w, f) != ("photo", "pgm")],
)
def test_a_file_of_another_kind_is_named(wanted, found):
    with pytest.raises(PeninkError) as caught:
        READERS[wanted](FILES[found])
    kind = recognise.kind(FILES[found])
    assert kind and kind[0] == found
    assert str(caught.value).startswith(f"f: not {recognise._NAMES[wanted]} but {kind[1]}")
    for name in re.findall("`penink ([a-z-]+)", str(caught.value)):
        assert name in SUBCOMMANDS


@pytest.mark.parametrize("wanted", READERS)
@pytest.mark.parametrize("data", [b"", b"hello\n", b"{}", b'{"format": "penink-x"}', b"PNG", b"P5x", b"RIFF0000WAVE"])
def test_what_is_of_no_known_kind_is_not_guessed_at(wanted, data):
    with pytest.raises(PeninkError) as caught:
        READERS[wanted](data)
    assert " but a" not in str(caught.value)


def test_the_way_out_of_a_shell(penink, tmp_path):
    (tmp_path / "x.pgm").write_bytes(FILES["pgm"])
    done = penink("to-ps", tmp_path / "x.pgm")
    assert done.returncode == 1
    assert done.stderr.decode().endswith("x.pgm: not strokes but a PGM image: `penink blast` makes strokes of it\n")
    done = penink("to-ps", "--self", input=STROKES * 50_000)  # longer than a manifest may be
    assert b"<stdin>: not an illustration but strokes" in done.stderr
