"""Archives: deterministic, and hostile ones refused in one line."""

from __future__ import annotations

import io
import json
import stat
import zipfile

import pytest

from penink_cli.formats import archive, parts
from penink_cli.ground.errors import PeninkError
from penink_cli.options.illustrations import read_illustration
from tests.conftest import ROOT


@pytest.fixture
def packed(penink, loose):
    done = penink("pack", loose)
    assert done.returncode == 0 and not done.stderr, done.stderr
    return done.stdout


def contents(data: bytes) -> dict[str, bytes]:
    with zipfile.ZipFile(io.BytesIO(data)) as z:
        return {name: z.read(name) for name in z.namelist()}


def zipped(members, method=zipfile.ZIP_STORED, **info_members) -> bytes:
    """An archive of (name, content) pairs with odd attributes."""
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", method) as z:
        for name, content in members:
            info = zipfile.ZipInfo("x")
            info.filename = info.orig_filename = name
            info.compress_type = method
            for key, value in info_members.items():
                setattr(info, key, value)
            z.writestr(info, content)
    return out.getvalue()


def test_pack_twice_gives_the_same_bytes_and_so_does_what_was_unpacked(penink, loose, packed, tmp_path):
    assert penink("pack", loose).stdout == packed
    folder = tmp_path / "unpacked"
    folder.mkdir()
    for name, content in contents(packed).items():
        (folder / name).write_bytes(content)
    assert penink("pack", folder / "illustration.json").stdout == packed
    assert penink("pack", input=packed).stdout == packed
    again = zipped(contents(packed).items(), zipfile.ZIP_DEFLATED)
    assert penink("pack", input=again).stdout == packed


def test_archives_of_one_file_for_each_member_are_read(penink, loose):
    old = ROOT / "tests/illustration/of_many_files.penink"
    assert list(contents(old.read_bytes())) == [
        "illustration.json",
        "0.samples",
        "1.samples",
        "1.edges",
        "1.directions",
    ]
    for layer in ("1", "2"):
        options = ("--width", "2in", "--layer", layer)
        drawn = penink("render", *options, old).stdout
        assert drawn and drawn == penink("render", *options, loose).stdout


@pytest.mark.parametrize("kind", ["samples", "edges", "directions"])
def test_a_member_of_a_newer_kind_is_said_to_be_one(penink, kind):
    old = contents((ROOT / "tests/illustration/of_many_files.penink").read_bytes())
    old[f"1.{kind}"] = old[f"1.{kind}"][:3] + b"9" + old[f"1.{kind}"][4:]
    run = penink("render", "--width", "2in", input=zipped(old.items(), zipfile.ZIP_DEFLATED))
    assert run.returncode == 1
    assert f"PI{kind[0]}9', which this penink does not know" in run.stderr.decode()


def test_the_manifest_wastes_nothing(packed):
    members = contents(packed)
    assert list(members) == ["illustration.json", "parts"]
    assert [part[:3] for part in parts.parts_from(members["parts"])] == [b"PIs", b"PIs", b"PIe", b"PId"]
    assert len(packed) == sum(map(len, members.values())) + 218  # a ZIP of two names of 22 letters
    manifest = json.loads(members["illustration.json"])
    assert manifest["layers"] == [
        {"name": "shade", "samples": "#0", "texture": "parallel", "seed": 3},
        {
            "samples": "#1",
            "edges": "#2",
            "directions": "#3",
            "outline": {"min_strength": 0.25},
        },
    ]
    with zipfile.ZipFile(io.BytesIO(packed)) as z:
        assert {i.date_time for i in z.infolist()} == {(1980, 1, 1, 0, 0, 0)}
        assert {i.compress_type for i in z.infolist()} == {zipfile.ZIP_STORED}


def test_plates_share_their_edges_and_keep_their_colour_and_turn(penink, loose, tmp_path):
    manifest = json.loads(loose.read_text())
    texture = penink("texture", "show", "--json", "parallel").stdout
    (loose.parent / "own.texture.json").write_bytes(texture)
    plate = {**manifest["layers"][1], "texture": "own.texture.json"}
    manifest["layers"] = [
        {**plate, "color": "#00aeef", "turn": 45},
        {**plate, "color": "#EC008c", "turn": 170.5, "name": "magenta"},
    ]
    (loose.parent / "plates.illustration.json").write_text(json.dumps(manifest))
    packed = penink("pack", loose.parent / "plates.illustration.json").stdout
    kept = parts.parts_from(contents(packed)["parts"])
    assert [part[:3] for part in kept] == [b"PIs", b"PIe", b"PId", b"PIt"]
    (tmp_path / "plates.penink").write_bytes(packed)
    assert penink("pack", tmp_path / "plates.penink").stdout == packed  # turned once, not again
    for name, color in (("1", "#00aeef"), ("magenta", "#EC008c")):
        options = ("--width", "1in", "--layer", name)
        drawn = penink("render", *options, tmp_path / "plates.penink").stdout
        assert drawn == penink("render", *options, loose.parent / "plates.illustration.json").stdout
        assert json.loads(drawn.splitlines()[0])["color"] == color
    refusal = penink("render", "--width", "1in", tmp_path / "plates.penink")
    assert refusal.returncode == 1
    assert b"layers of 2 colours" in refusal.stderr


def refused(penink, data: bytes, path) -> str:
    """The one line of the refusal, by a process; nothing is written."""
    path.write_bytes(data)
    done = penink("pack", path, "-o", path.with_suffix(".out"))
    assert not path.with_suffix(".out").exists()
    assert done.returncode == 1
    assert not done.stdout
    line = done.stderr.decode()
    assert line.count("\n") == 1 and line.endswith("\n") and "Traceback" not in line and "internal" not in line, line
    return line


def test_truncation_at_any_length_is_refused(packed):
    for size in range(0, len(packed), 7):
        with pytest.raises(PeninkError):
            archive.read(packed[:size], "x")


def test_any_changed_byte_is_refused_or_harmless(packed):
    for at in range(0, len(packed), 3):
        bad = bytearray(packed)
        bad[at] ^= 0x55
        try:
            members = archive.read(bytes(bad), "x")
        except PeninkError:
            continue
        assert all(isinstance(content, bytes) for content in members.values())


@pytest.mark.parametrize(
    "name",
    ["../0.samples", "/etc/passwd", "a/b", "a\\b", "..", "", "c:x", "x\ny", "ü.samples", ".hidden", "n" * 101, "f/"],
)
def test_names_that_are_no_plain_names_are_refused(name):
    with pytest.raises(PeninkError, match="member"):
        archive.read(zipped([(name, b"")]), "x")


def hostile(packed: bytes) -> dict[str, tuple[bytes, str]]:
    members = list(contents(packed).items())
    bomb = zipped([("illustration.json", bytes(1 << 27))], zipfile.ZIP_DEFLATED)
    lying = bytearray(zipped([("illustration.json", bytes(1 << 16))], zipfile.ZIP_DEFLATED))
    for at in (lying.find(b"PK\x03\x04") + 22, lying.find(b"PK\x01\x02") + 24):
        lying[at : at + 4] = (100).to_bytes(4, "little")
    encrypted = bytearray(packed)
    encrypted[6] |= 1
    encrypted[packed.find(b"PK\x01\x02") + 8] |= 1
    return {
        "truncated": (packed[: len(packed) * 2 // 3], "truncated"),
        "empty": (b"", "not a penink archive"),
        "a photograph": (b"\x89PNG\r\n\x1a\n" + bytes(100), "not a penink archive"),
        "bomb": (bomb, "unpacks to 134217728 bytes"),
        "lying about its size": (bytes(lying), "damaged"),
        "encrypted": (bytes(encrypted), "encrypted"),
        "twice": (zipped([members[0], members[0]]), "there twice"),
        "link": (zipped(members, external_attr=(stat.S_IFLNK | 0o777) << 16), "is a link"),
        "too many": (zipped([(f"m{i}", b"") for i in range(301)]), "members"),
        "far too many": (zipped([(f"m{i}", b"") for i in range(5000)]), "members"),
        "another method": (zipped(members, zipfile.ZIP_LZMA), "method 14"),
        "no manifest": (zipped(members[1:]), "without illustration.json"),
        "a member gone": (zipped(members[:1]), "is not in the archive"),
        "escaping path": (
            zipped([("illustration.json", members[0][1].replace(b'"#0"', b'"../x.pgm"')), *members[1:]]),
            "is not in the archive",
        ),
        "absolute path": (
            zipped([("illustration.json", members[0][1].replace(b'"#0"', b'"/etc/passwd"')), *members[1:]]),
            "relative",
        ),
        "a part too far": (
            zipped([("illustration.json", members[0][1].replace(b'"#0"', b'"#4"')), *members[1:]]),
            'layer 0: samples "#4": is not among its 4 parts',
        ),
        "a part of another kind": (
            zipped([("illustration.json", members[0][1].replace(b'"#0"', b'"#2"')), *members[1:]]),
            'layer 0: samples "#2": ',
        ),
        "parts cut short": (
            zipped([members[0], ("parts", members[1][1][:-1])]),
            'parts "parts": its parts end at byte',
        ),
        "parts of parts": (
            zipped([members[0], ("parts", parts.parts_bytes([members[1][1]]))]),
            "part 0 is no compact member",
        ),
        "too many parts": (zipped([members[0], ("parts", parts.parts_bytes([b"PIs1"] * 321))]), "321 parts; 320 are"),
    }


@pytest.mark.filterwarnings("ignore:Duplicate name")
def test_hostile_archives_are_refused(packed, tmp_path):
    path = tmp_path / "bad.penink"
    for what, (data, reason) in hostile(packed).items():
        path.write_bytes(data)
        with pytest.raises(PeninkError) as raised:
            read_illustration(str(path), 10**6)
        line = str(raised.value)
        assert reason in line and line.startswith(f"{path}: ") and "\n" not in line, (what, line)


def test_a_refusal_is_one_line(penink, packed, tmp_path):
    assert "truncated" in refused(penink, packed[:-30], tmp_path / "bad.penink")
    assert "name it *.penink" in refused(penink, packed, tmp_path / "bad.illustration.json")


@pytest.mark.parametrize("member", ["samples", "edges", "texture"])
def test_a_member_of_the_name_of_a_dash_is_a_file_and_not_standard_input(penink, tmp_path, member):
    layer = {"samples": "a.pgm", member: "-"}
    manifest = {"format": "penink-illustration", "version": 1, "width": 9, "height": 9, "layers": [layer]}
    (tmp_path / "x.json").write_text(json.dumps(manifest))
    (tmp_path / "a.pgm").write_bytes(b"P5 2 2 255\n1234")
    done = penink("pack", "x.json", input=b"P5 2 2 255\n1234", cwd=tmp_path)
    assert (done.returncode == 1 and f"layer 0: {member}" in done.stderr.decode()) or b"no texture -" in done.stderr
    if member == "samples":
        (tmp_path / "-").write_bytes(b"P5 2 2 255\n4321")
        assert penink("pack", "x.json", cwd=tmp_path).returncode == 0
