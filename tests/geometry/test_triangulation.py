"""The triangulation of an arrangement: a validator of the mesh, its regions, and walking to a point."""

from __future__ import annotations

import importlib.util

import numpy as np
import pytest

from penink_cli.geometry import meshers
from penink_cli.geometry.regions import edges_around, region_mask
from penink_cli.geometry.triangulation import triangulate
from penink_cli.geometry.validity import check
from penink_cli.ground.errors import ArrangementError, ParameterError
from penink_cli.ground.model import EdgeList
from tests.oracles.brute import turn
from tests.reconstruction.arrangements import HOSTILE, edge_list, random_edges


@pytest.fixture(autouse=True, params=["triangle", "pythoncdt"])
def mesher(request, monkeypatch):
    """Every test with both libraries."""
    if request.param == "triangle" and importlib.util.find_spec("triangle") is None:
        pytest.skip("triangle has no release for this machine or interpreter")
    monkeypatch.setenv(meshers.VARIABLE, request.param)


def validate(mesh, edges):
    """Turns, areas, reciprocal neighbours, edges on both their sides."""
    v = [tuple(p) for p in mesh.vertices.tolist()]
    area = 0.0
    for t, corners in enumerate(mesh.triangles.tolist()):
        a, b, c = (v[k] for k in corners)
        assert turn(a, b, c) > 0
        area += ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2
        for k in range(3):
            beyond = mesh.neighbours[t, k]
            side = {corners[k], corners[(k + 1) % 3]}
            if beyond < 0:
                assert all(
                    any(v[i][axis] in (0, size) for axis, size in ((0, edges.width), (1, edges.height))) for i in side
                )
                continue
            back = mesh.neighbours[beyond].tolist().index(t)
            other = mesh.triangles[beyond].tolist()
            assert side == {other[back], other[(back + 1) % 3]}
            assert mesh.fixed[t, k] == mesh.fixed[beyond, back]
            assert mesh.fixed[t, k] or mesh.regions[t] == mesh.regions[beyond]
    assert area == pytest.approx(edges.width * edges.height)
    ends = {tuple(sorted(e)) for e in edges.edges.tolist()}
    found = {
        tuple(sorted((int(mesh.source[corners[k]]), int(mesh.source[corners[(k + 1) % 3]]))))
        for corners, fixed in zip(mesh.triangles, mesh.fixed)
        for k in range(3)
        if fixed[k]
    }
    assert found == ends


@pytest.mark.parametrize("name", HOSTILE)
def test_every_mesh_is_sound(name):
    validate(triangulate(HOSTILE[name]), HOSTILE[name])


@pytest.mark.parametrize("seed", range(8))
def test_random_meshes_are_sound(seed):
    rng = np.random.default_rng(seed)
    edges = random_edges(rng, 9, 7, 40, lattice=[None, 2][seed % 2])
    validate(triangulate(edges), edges)


def test_regions_are_what_edges_enclose():
    def count(name):
        return triangulate(HOSTILE[name]).regions.max() + 1

    assert count("none") == 1
    assert count("nearly closed square") == 1
    assert count("closed square") == 2
    assert count("wall from side to side") == 2
    assert count("frame") == 1
    two = edge_list(9, 5, [(1, 1), (4, 1), (4, 4), (1, 4), (7, 1), (7, 4)],
                    [(0, 1), (1, 2), (2, 3), (3, 0), (1, 4), (4, 5), (5, 2)])  # fmt: skip
    mesh = triangulate(two)
    a, b, c, d = mesh.regions_of(np.array([(2.0, 2.0), (5.0, 3.0), (8.0, 2.0), (0.5, 4.5)]))
    assert len({a, b, c}) == 3
    assert c == d


@pytest.mark.parametrize("name", ["through samples", "spiral", "star", "tiny", "closed square"])
def test_walking_finds_the_triangle_from_anywhere(name):
    mesh = triangulate(HOSTILE[name])
    rng = np.random.default_rng(0)
    lattice = np.stack(np.meshgrid(np.arange(0, 6, 0.5), np.arange(0, 5, 0.5)), -1).reshape(-1, 2)
    for x, y in np.concatenate([rng.uniform(0, 5, (40, 2)), lattice]):
        found = {mesh.locate(x, y, int(t)) for t in rng.integers(0, len(mesh.triangles), 4)}
        assert len(found) == 1
        corners = mesh.triangles[found.pop()]
        assert all(mesh.side(corners[k], corners[(k + 1) % 3], x, y) > 0 for k in range(3))


def test_a_point_outside_the_frame_is_refused():
    with pytest.raises(ArrangementError, match="outside the frame"):
        triangulate(HOSTILE["star"]).locate(7.0, 2.0)


def test_crossing_edges_are_refused_here_too():
    crossing = EdgeList(9, 9, np.array([(1.0, 1), (8, 8), (1, 8), (8, 1)]), np.array([(0, 1), (2, 3)]))
    with pytest.raises(ArrangementError, match="cross"):
        triangulate(crossing)


def test_edges_through_a_vertex_are_refused_here_too():
    through = EdgeList(9, 9, np.array([(1.0, 1), (8, 8), (4, 4), (8, 1)]), np.array([(0, 1), (2, 3)]))
    with pytest.raises(ArrangementError, match="cross"):
        triangulate(through)


@pytest.mark.parametrize(
    "vertices",
    [
        [(1.395, 6.975), (6.038, 1.484), (2.877796401393742, 5.221384871838674), (2.312, 5.184)],
        [(8.963, 8.704), (5.158, 2.796), (6.807608601700982, 5.357337087739658), (7.198, 4.714)],
        [(7.243, 1.196), (2.296, 3.461), (4.227547060112535, 2.576634911834467), (3.763, 2.617)],
    ],
)
def test_slivers_turn_as_they_do_and_not_as_rounding_says(vertices):
    """The third vertex lies a hair beside the first edge; by doubles the triangle between them turns the other way."""
    edges = edge_list(10, 10, vertices, [(0, 1), (2, 3)])
    check(edges)
    validate(triangulate(edges), edges)


@pytest.mark.parametrize("case", [*HOSTILE, *range(40)])
def test_both_libraries_part_the_frame_into_the_same_regions(case, monkeypatch):
    """Masks and outlines, which are what is written, do not depend on where diagonals lie."""
    if importlib.util.find_spec("triangle") is None:
        pytest.skip("triangle has no release for this machine or interpreter")
    rng = np.random.default_rng(case if isinstance(case, int) else 0)
    if isinstance(case, int):
        edges = random_edges(rng, 9, 7, 40, lattice=2 if case % 4 == 3 else None)
    else:
        edges = HOSTILE[case]
    points = rng.uniform(0.02, 0.98, (30, 2)) * (edges.width, edges.height)
    found = []
    for name in meshers.MESHERS:
        monkeypatch.setenv(meshers.VARIABLE, name)
        labels = triangulate(edges).regions_of(points)
        same = labels[:, None] == labels[None, :]
        some = points[:1]
        found.append((same, region_mask(edges, some, 36, 28), edges_around(edges, some)))
    for one, other in zip(*found):
        assert np.array_equal(one, other)


def test_a_library_that_is_not_there_is_named(monkeypatch):
    monkeypatch.setenv(meshers.VARIABLE, "cgal")
    with pytest.raises(ParameterError, match="PENINK_MESHER='cgal': known are triangle, pythoncdt"):
        triangulate(HOSTILE["star"])
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    monkeypatch.setenv(meshers.VARIABLE, "triangle")
    with pytest.raises(ParameterError, match="not installed"):
        triangulate(HOSTILE["star"])
    monkeypatch.delenv(meshers.VARIABLE)
    with pytest.raises(ParameterError, match="neither triangle nor pythoncdt is installed"):
        triangulate(HOSTILE["star"])
