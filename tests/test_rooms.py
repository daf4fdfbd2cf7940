"""The house's plan: imports point downward, compiled ones too, and libraries are met where they may be known."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path

import pytest

from penink_cli.outputs.registry import OUTPUTS
from tests.conftest import ROOT

HOUSE = ROOT / "penink_cli"
#: The rooms from the ground up: each may import those before it, and itself.
FLOORS = (
    ("ground",),
    ("geometry", "travel"),
    ("arrangement", "reconstruction", "textures", "styles", "formats"),
    ("composition",),
    ("directions",),
    ("lines",),
    ("blasting",),
    ("outputs", "selfdrawing"),
    ("illustration", "measuring"),
    ("options",),
    ("main",),
    ("manual", "chain"),
    ("commands",),
    ("__main__",),
)
FLOOR = {room: floor for floor, rooms in enumerate(FLOORS) for room in rooms}
ALGORITHMS = ("geometry", "travel", "composition", "directions", "lines", "arrangement", "reconstruction", "blasting")
#: Libraries, and the rooms that must not know them.
STRANGERS = {
    "click": (*ALGORITHMS, "ground", "textures", "formats", "outputs", "illustration", "selfdrawing"),
    "PIL": (*ALGORITHMS, "textures", "illustration"),
    "json": ALGORITHMS,
    "sys": ALGORITHMS,
}

Import = tuple[str, str, int]  # file, module imported, line


def _python(path: Path) -> Iterator[Import]:
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.Import):
            for name in node.names:
                yield str(path), name.name, node.lineno
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            for name in node.names:
                yield str(path), f"{node.module}.{name.name}", node.lineno


CYTHON = re.compile(r"^\s*(?:from\s+([\w.]+)\s+)?c?import\s+([\w.]+)", re.MULTILINE)


def _cython(path: str, text: str) -> Iterator[Import]:
    for match in CYTHON.finditer(text):
        module = f"{match[1]}.{match[2]}" if match[1] else match[2]
        yield path, module, text.count("\n", 0, match.start()) + 1


@lru_cache
def _imports() -> tuple[Import, ...]:
    found: list[Import] = []
    for path in sorted(HOUSE.rglob("*")):
        if path.suffix == ".py":
            found += _python(path)
        if path.suffix in (".pyx", ".pxd") or (path.suffix == ".py" and path.name.startswith("_")):
            found += _cython(str(path), path.read_text("utf-8"))
    return tuple(found)


def _room(path: str) -> str:
    return Path(path).relative_to(HOUSE).parts[0].removesuffix(".py")


def test_imports_point_downward() -> None:
    upward = []
    for path, module, line in _imports():
        here, parts = _room(path), module.split(".")
        if parts[0] != "penink_cli" or here == "__init__" or len(parts) == 1 or parts[1] not in FLOOR:
            continue
        there = parts[1]
        if there != here and FLOOR[there] >= FLOOR[here]:
            upward.append(f"{path}:{line}: {here} imports {module}, which is not below it")
    assert not upward, "\n".join(upward)


def test_every_room_is_on_the_plan() -> None:
    rooms = {path.name for path in HOUSE.iterdir() if (path / "__init__.py").exists()}
    assert rooms <= FLOOR.keys(), f"not on the plan: {', '.join(sorted(rooms - FLOOR.keys()))}"


@pytest.mark.parametrize("library", STRANGERS)
def test_rooms_know_no_strangers(library: str) -> None:
    met = [
        f"{path}:{line}"
        for path, module, line in _imports()
        if module.split(".")[0] == library and _room(path) in STRANGERS[library]
    ]
    assert not met, "\n".join(met)


def test_compiled_imports_are_seen() -> None:
    text = "from penink_cli.blasting.sheet cimport x\n"
    assert list(_cython("x.pyx", text)) == [("x.pyx", "penink_cli.blasting.sheet.x", 1)]


ROOMS = sorted(path.parent for path in HOUSE.rglob("__init__.py") if path.parent != HOUSE)


@pytest.mark.parametrize("room", ROOMS, ids=lambda room: str(room.relative_to(HOUSE)))
def test_a_room_s_first_page_names_what_is_in_it(room: Path) -> None:
    """Whoever comes in finds each module in the docstring of `__init__`, except where one table names them all."""
    page = ast.get_docstring(ast.parse((room / "__init__.py").read_text("utf-8"))) or ""
    assert page
    if room.name in ("_compiled", "commands", "kinds", "rules"):
        return
    modules = {path.stem for path in room.glob("*.py")} | {path.parent.name for path in room.glob("*/__init__.py")}
    if room.name == "outputs":
        modules -= {name.removeprefix("to-").replace("-", "_") for name, output in OUTPUTS.items() if not output.own}
    unnamed = {name for name in modules if not name.startswith("_") and not re.search(rf"\b{name}\b", page)}
    assert not unnamed, f"a line about each in {room}/__init__.py: {', '.join(sorted(unnamed))}"


def test_the_map_leads_to_what_is_there() -> None:
    """Paths of the map, from the house or from a room that is named before in the same part."""
    for guide in (HOUSE / "README.md", ROOT / ".github" / "CONTRIBUTING.md"):
        lost = []
        for part in guide.read_text("utf-8").split("\n## "):
            rooms = [HOUSE, ROOT, *(HOUSE / room for room in FLOOR if re.search(rf"\b{room}\b", part))]
            places = [*rooms, *(room / "_compiled" for room in rooms)]
            for name in re.findall(r"`([\w./*-]+\.(?:pyx|pxd|py|md|json)|\w+/)`", part):
                if "NAME" not in name and not any(any(place.glob(name)) for place in places):
                    lost.append(name)
        assert not lost, f"{guide}: {', '.join(lost)}"


def test_the_map_lists_the_rooms_from_the_ground_up() -> None:
    rows = re.findall(r"^\| `(\w+)` \|", (HOUSE / "README.md").read_text("utf-8"), re.MULTILINE)
    floors = [FLOOR[room] for room in rows]
    assert floors == sorted(floors)
    assert {room for room in FLOOR if (HOUSE / room).is_dir()} == set(rows)
