"""`draw --watch` and `draw --out-dir`: the same bytes as drawings made one by one, and no more work than is needed."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys

import click
import numpy as np
import pytest
from PIL import Image
from scipy.ndimage import gaussian_filter

from penink_cli.chain.kept import Kept
from penink_cli.ground.errors import PeninkError
from penink_cli.main import penink as command
from penink_cli.options import watching
from tests.conftest import environment

SQUARE = '<svg xmlns="http://www.w3.org/2000/svg" width="80" height="60"><line x1="{0}" y1="3" x2="40" y2="50"/></svg>'


class Interrupted(BaseException):
    """The user has seen enough."""


def save(path, content):
    """As editors do: a new file that takes the old one's place."""
    beside = path.with_name("beside")
    beside.write_bytes(content if isinstance(content, bytes) else content.encode())
    os.replace(beside, path)


def style(texture, **more):
    stages = {"compose": {"strength": 0}, "directions": {}, "blast": {"texture": texture}, **more}
    return json.dumps({"format": "penink-style", "version": 1, **stages})


def photograph(path, radius=20):
    y, x = np.mgrid[0:60, 0:80] + 0.5
    grey = np.where(np.hypot(x - 35, y - 30) < radius, 0.25 + 0.002 * y, 0.9 - 0.002 * x)
    Image.fromarray(np.uint8(gaussian_filter(grey, 0.7) * 255)).save(path)


@pytest.fixture
def desk(tmp_path):
    """A photo, a style and somebody's strokes."""
    photograph(tmp_path / "photo.png")
    save(tmp_path / "my.style.json", style("form"))
    save(tmp_path / "strokes.svg", SQUARE.format(3))
    return tmp_path


def words(desk, output):
    return [
        "draw", "--quiet", "--width", "1in", "--style", str(desk / "my.style.json"),
        "--directions", str(desk / "strokes.svg"), "-o", str(desk / output), str(desk / "photo.png"),
    ]  # fmt: skip


def fresh(desk):
    command.main(words(desk, "fresh.ps"), standalone_mode=False)
    return (desk / "fresh.ps").read_bytes()


def watched(monkeypatch, desk, *changes, output="seen.ps"):
    """Watch while changes are made, one when all is drawn; what was seen, and what filters ran, after each.

    A change may be several, each of which is made at the next look.
    """
    seen, ran, looks = [], [], iter([step for change in changes for step in (*change, None, None)])
    made = []
    keep = Kept.keep
    monkeypatch.setattr(Kept, "keep", lambda self, call, *rest: (made.append(call[0]), keep(self, call, *rest)))

    def look():
        step = next(looks, Interrupted)
        if step is Interrupted:
            raise Interrupted
        if step is not None:
            step()

    monkeypatch.setattr(watching, "look", look)
    replace = os.replace

    def placed(source, target):
        replace(source, target)
        if str(target).endswith(output):
            seen.append((desk / output).read_bytes())
            ran.append(made.copy())
            made.clear()

    monkeypatch.setattr(os, "replace", placed)
    with pytest.raises(Interrupted):
        command.main([*words(desk, output), "--watch"], standalone_mode=False)
    monkeypatch.undo()
    return seen, ran


def test_what_changes_is_drawn_again_and_nothing_else_is_made_anew(monkeypatch, desk):
    seen, ran = watched(
        monkeypatch, desk,
        [lambda: save(desk / "my.style.json", style("crosshatch"))],
        [lambda: save(desk / "strokes.svg", SQUARE.format(30))],
        [lambda: photograph(desk / "photo.png", 25)],
        [lambda: save(desk / "photo.png", (desk / "photo.png").read_bytes())],  # touched, and the same
    )  # fmt: skip
    assert len(seen) == 5 and len(set(seen)) == 4
    assert seen[-1] == seen[-2] == fresh(desk)
    assert {"compose", "detect-edges", "detect-directions", "blast"} <= set(ran[0])
    assert ran[1] == ["blast"]
    assert ran[2] == ["detect-directions", "blast"]
    assert {"compose", "detect-edges", "detect-directions", "blast"} <= set(ran[3])
    assert "blast" not in ran[4] and "detect-edges" not in ran[4]  # their inputs are the same bytes
    save(desk / "my.style.json", style("form"))
    assert fresh(desk) != seen[-1]


def test_half_a_file_is_said_in_a_line_and_waited_for(monkeypatch, desk, capsys):
    whole = style("crosshatch")
    seen, _ = watched(
        monkeypatch, desk,
        [lambda: save(desk / "my.style.json", whole[:40])],
        [(desk / "my.style.json").unlink],
        [lambda: save(desk / "my.style.json", whole)],
    )  # fmt: skip
    assert len(seen) == 2 and seen[-1] == fresh(desk)
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 2 and all("my.style.json" in line for line in lines)


def test_a_file_is_left_alone_while_it_changes(monkeypatch, desk):
    saves = [lambda k=k: save(desk / "strokes.svg", SQUARE.format(k)) for k in (10, 20, 30)]
    seen, _ = watched(monkeypatch, desk, saves)
    assert len(seen) == 2 and seen[-1] == fresh(desk)


def test_a_page_that_is_watched_follows_its_file(monkeypatch, desk):
    def change():
        save(desk / "my.style.json", style("crosshatch"))

    seen, _ = watched(monkeypatch, desk, [change], output="seen.html")
    marks = [page.split(b'reloading("')[1][:8] for page in seen]
    assert len(set(marks)) == 2


def test_what_is_wrong_from_the_beginning_ends_it(monkeypatch, desk):
    (desk / "photo.png").write_bytes(b"no photo")
    with pytest.raises(PeninkError, match=r"photo\.png"):
        command.main([*words(desk, "seen.ps"), "--watch"], standalone_mode=False)
    assert not (desk / "seen.ps").exists()


@pytest.mark.parametrize("wrong", [("--watch",), ("--watch", "-o", "-"), ("--out-dir", "d", "-o", "x.ps", "a.png"),
                                   ("--out-dir", "d", "--watch", "a.png"), ("--out-dir", "d"), ("a.png", "b.png"),
                                   ("--watch", "-o", "x.ps", "-"), ("--as", "svg", "-o", "x.ps", "a.png"),
                                   ("--out-dir", "d", "a.png", "e/a.jpg")])  # fmt: skip
def test_calls_without_sense_are_refused(wrong, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(click.UsageError):
        command.main(["draw", *wrong], standalone_mode=False)
    assert not list(tmp_path.iterdir())


def test_many_photos_are_drawn_as_one_by_one(penink, tmp_path):
    for k in range(3):
        photograph(tmp_path / f"p{k}.png", 10 + 4 * k)
    (tmp_path / "broken.png").write_bytes((tmp_path / "p0.png").read_bytes()[:60])
    names = ["p0.png", "broken.png", "p1.png", "gone.jpg", "p2.png"]
    done = penink("draw", "--width", "1in", "--as", "svg", "--out-dir", "new/drawn", *names, cwd=tmp_path)
    assert done.returncode == 1
    line = done.stderr.decode()
    assert line.count("\n") == 1 and "2 of 5 photos" in line and "broken.png: " in line and "gone.jpg: " in line
    drawn = tmp_path / "new" / "drawn"
    assert sorted(path.name for path in drawn.iterdir()) == ["p0.svg", "p1.svg", "p2.svg"]
    for k in range(3):
        alone = penink("draw", "--width", "1in", "-o", tmp_path / "alone.svg", f"p{k}.png", cwd=tmp_path)
        assert alone.returncode == 0
        assert (drawn / f"p{k}.svg").read_bytes() == (tmp_path / "alone.svg").read_bytes()


def test_one_bar_goes_over_all_photos_and_what_failed_is_named_after_it(tmp_path):
    for k in range(3):
        photograph(tmp_path / f"p{k}.png", 10 + 4 * k)
    (tmp_path / "p1.png").write_bytes(b"no photo")
    ours, theirs = os.openpty()
    words = ["draw", "--width", "1in", "--out-dir", "d", "p0.png", "p1.png", "p2.png"]
    command = [sys.executable, "-m", "penink_cli", *words]
    done = subprocess.run(
        command, cwd=tmp_path, env=environment(TERM="xterm"), stdin=subprocess.DEVNULL, stderr=theirs, check=False
    )
    os.close(theirs)
    seen = os.read(ours, 100_000).decode()
    os.close(ours)
    bar, _, line = re.sub("\x1b\\[[^A-Za-z]*[A-Za-z]", "", seen).partition("100%")
    shares = [int(share) for share in re.findall("([0-9]+)%", bar)]
    assert done.returncode == 1 and shares == sorted(shares) and {33, 66} <= set(shares)
    assert "1 of 3 photos could not be drawn: p1.png: " in line
    assert sorted(path.name for path in (tmp_path / "d").iterdir()) == ["p0.ps", "p2.ps"]


def test_no_photo_is_drawn_over(penink, tmp_path):
    photograph(tmp_path / "p.png")
    before = (tmp_path / "p.png").read_bytes()
    done = penink("draw", "--as", "png", "--out-dir", ".", "p.png", cwd=tmp_path)
    assert done.returncode == 1 and b"overwrite" in done.stderr
    assert (tmp_path / "p.png").read_bytes() == before


def test_as_says_what_standard_output_is(penink, tmp_path):
    photograph(tmp_path / "p.png")
    done = penink("draw", "--width", "1in", "--as", "svg", "p.png", cwd=tmp_path)
    assert done.returncode == 0 and b"<svg" in done.stdout[:200]
