"""Edges that are worth their bytes."""

import json

import numpy as np
import pytest

from penink_cli.ground.model import EdgeList
from penink_cli.reconstruction import thinning
from penink_cli.reconstruction.thinning import stretches, thin_edges

CHAINS = {"strong": [0, 1, 2, 3], "false": [4, 5], "faint": [6]}


@pytest.fixture(scope="module")
def scene():
    """A dark square with its four edges, two edges where nothing is, and a step of a hundredth with one."""
    y, x = np.mgrid[0:160, 0:160] + 0.5
    grey = 0.8 + 0 * x
    grey[(x > 30) & (x < 80) & (y > 30) & (y < 80)] = 0.2
    grey[x > 130] += 0.01
    vertices = np.array(
        [[30, 30], [80, 30], [80, 80], [30, 80], [20, 120], [60, 120], [100, 140], [130, 0], [130, 160.0]]
    )
    ends = np.array([[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [7, 8]])
    return grey.astype(np.float32), EdgeList(160, 160, vertices, ends, np.array([0.6] * 4 + [0.3] * 2 + [0.01]))


def which(scene, thinned):
    """The names of the chains that are left, whole."""
    _, edges = scene
    left = {tuple(sorted(map(tuple, thinned.vertices[ends].tolist()))) for ends in thinned.edges}
    found = set()
    for name, chain in CHAINS.items():
        here = [tuple(sorted(map(tuple, edges.vertices[edges.edges[e]].tolist()))) in left for e in chain]
        assert all(here) or not any(here), "a chain is kept or dropped as a whole"
        found |= {name} if all(here) else set()
    return found


def test_chains_are_kept_by_what_they_save(scene):
    grey, edges = scene
    assert which(scene, thin_edges(edges, grey, seen_at=96, worth=0.5)) == {"strong", "faint"}
    assert which(scene, thin_edges(edges, grey, seen_at=96)) == {"strong"}
    assert which(scene, thin_edges(edges, grey, seen_at=96, worth=1e9)) == set()
    thinned = thin_edges(edges, grey, seen_at=96)
    assert len(thinned.vertices) == 4 and thinned.strength is not None and (thinned.strength == 0.6).all()


def test_a_chain_saves_no_more_than_is_wrong_without_edges(scene):
    """So what cannot be worth it is left out before the picture with edges is made."""
    grey, edges = scene
    savings = thinning._Savings(edges, list(CHAINS.values()), grey, 96.0, 1)
    assert (savings.of(edges) <= savings.of_none).all() and (savings.of_none >= 0).all()
    strong, false, faint = savings.of_none
    assert strong > 1000 * faint and faint > 100 * false


def test_what_is_to_be_kept_stays(scene):
    grey, edges = scene
    kept = np.zeros(7, bool)
    kept[4] = True
    assert which(scene, thin_edges(edges, grey, seen_at=96, worth=1e9, kept=kept)) == {"false"}


def test_without_a_photo_the_strong_and_long_stay(scene):
    _, edges = scene
    assert which(scene, thin_edges(edges)) == {"strong"}
    assert len(thin_edges(EdgeList(9, 9)).edges) == 0


def test_chains_end_at_junctions():
    star = EdgeList(
        9, 9, np.array([[4, 4], [1, 1], [8, 1], [4, 8], [5, 8.5]]), np.array([[0, 1], [0, 2], [0, 3], [3, 4]])
    )
    assert sorted(sorted(chain) for chain in stretches(star)) == [[0], [1], [2, 3]]


def test_outlined_chains_and_regions_stay(scene, penink, tmp_path):
    """The command: what would be outlined, and what bounds a region, is not left out."""
    _, edges = scene
    path = tmp_path / "e.json"
    document = {"format": "penink-edges", "version": 1, "width": 160, "height": 160}
    document |= {
        "vertices": edges.vertices.tolist(),
        "edges": edges.edges.tolist(),
        "strength": edges.strength.tolist(),
    }
    path.write_text(json.dumps(document))
    (tmp_path / "p.pgm").write_bytes(b"P5 160 160 255\n" + bytes([99]) * 160 * 160)

    def left(*words):
        done = penink("thin-edges", "-e", path, "--photo", tmp_path / "p.pgm", "--seen-at", "96", *words)
        assert done.returncode == 0, done.stderr
        found = json.loads(done.stdout)
        return which(
            scene,
            EdgeList(
                160, 160, np.array(found["vertices"]).reshape(-1, 2), np.array(found["edges"], int).reshape(-1, 2)
            ),
        )

    assert left() == set()
    assert left("--keep-strength", "0.25") == {"strong", "false"}
    assert left("--keep-strength", "0.25", "--keep-length", "150") == {"strong"}
    assert left("--keep-region", "50,50") == {"strong"}
