"""Which chains of edges are worth their bytes: those that save more of a drawing's error than they cost.

A picture is reconstructed twice from a grid as fine as a drawing of a width needs: with all edges and with none. Near
edges the difference of the squared errors is what edges save. The saving at each place belongs to the nearest chain. A
chain that saves less than so many squared grey levels a bit is dropped. Where there is no picture, strong and long
chains stay.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from penink_cli.geometry import walls
from penink_cli.geometry.trails import trails
from penink_cli.ground.gaussian import smoothed
from penink_cli.ground.model import EdgeList, Ints
from penink_cli.reconstruction.camera import camera_blur
from penink_cli.reconstruction.enlarge import reconstruct
from penink_cli.reconstruction.extraction import extract_samples
from penink_cli.reconstruction.grid import SEEN_PT, SEEN_PX, VIEW_PX
from penink_cli.reconstruction.reduction import reduce
from penink_cli.reconstruction.shrinking import shrunk

Grey32 = npt.NDArray[np.float32]

WORTH = 80.0  # squared grey levels of 255 a bit, over a picture of so many pixels
PICTURE_PX = 500_000
CHAIN_BITS, EDGE_BITS = 22, 15  # what an archive takes for each
SHARE = 0.6  # of the edges that stay where no picture says what they are worth
_SPACING_PT = 3.0  # of the samples on paper
_LEAST_PX = 3  # and in pixels of the photo: with a sample a pixel no edge would save anything
_REACH = 1.5  # spacings beside a chain in which it saves something
_PARTS = 4096  # of a squared grey level: sums of whole numbers are the same in any order


def stretches(edges: EdgeList) -> list[list[int]]:
    """The edges of each chain between junctions, in order."""
    degree = np.bincount(edges.edges.ravel(), minlength=len(edges.vertices)).tolist()
    found: list[list[int]] = []
    for vertices, along in trails(edges.vertices, edges.edges):
        chain: list[int] = []
        for k, edge in enumerate(along):
            chain.append(edge)
            if degree[vertices[k + 1]] != 2 or k == len(along) - 1:
                found.append(chain)
                chain = []
    return found


def thin_edges(
    edges: EdgeList,
    photo: Grey32 | None = None,
    *,
    worth: float = WORTH,
    seen_at: float = 432.0,
    kept: npt.NDArray[np.bool_] | None = None,
    threads: int | None = None,
) -> EdgeList:
    """The edges whose chains are worth it, and the vertices that these have.

    Args:
        edges: in the frame of the photo.
        photo: (h, w), 0 … 1; None where strength and length are to tell.
        worth: squared grey levels that a chain must save a bit; 0 drops those that save nothing.
        seen_at: width on paper, points, of the drawing that is to show the difference.
        kept: (m,) edges that stay with their chains, whatever they are worth; None for none.
        threads: the bytes are the same for any number.

    """
    if not len(edges.edges):
        return edges
    chains = stretches(edges)
    bits = np.array([CHAIN_BITS + EDGE_BITS * len(chain) for chain in chains])
    if photo is None:
        stays = _strongest(edges, chains)
    else:
        stays = _saved(edges, chains, photo, seen_at, threads) > worth * bits
    if kept is not None:
        stays |= np.array([bool(kept[chain].any()) for chain in chains])
    chosen = np.array(sorted(e for chain, stay in zip(chains, stays.tolist()) if stay for e in chain), np.int64)
    used, ends = np.unique(edges.edges[chosen], return_inverse=True)
    strength = None if edges.strength is None else edges.strength[chosen]
    return replace(edges, vertices=edges.vertices[used], edges=ends.reshape(-1, 2), strength=strength)


def _strongest(edges: EdgeList, chains: list[list[int]]) -> npt.NDArray[np.bool_]:
    """The chains (c,) of most strength times the root of the length that have SHARE of the edges."""
    step = edges.vertices[edges.edges[:, 0]] - edges.vertices[edges.edges[:, 1]]
    length = np.sqrt(step[:, 0] * step[:, 0] + step[:, 1] * step[:, 1])
    strength = np.ones(len(length)) if edges.strength is None else edges.strength
    weight = []
    for chain in chains:
        total = np.cumsum(length[chain])[-1]
        weight.append(np.cumsum(strength[chain] * length[chain])[-1] / np.sqrt(total))
    order = np.argsort(-np.array(weight), kind="stable")
    count = np.cumsum(np.array([len(chain) for chain in chains])[order])
    stays = np.zeros(len(chains), bool)
    stays[order] = count <= SHARE * len(length)
    return stays


def _saved(
    edges: EdgeList, chains: list[list[int]], photo: Grey32, seen_at: float, threads: int | None
) -> npt.NDArray[np.float64]:
    """What each chain saves (c,), in squared grey levels over a picture of PICTURE_PX."""
    # a finer view tells no more of what is blurred by so much
    finest = SEEN_PT * photo.shape[1] / seen_at / SEEN_PX
    photo = shrunk(photo, max(1.0, finest, float(np.sqrt(photo.size / VIEW_PX))))
    height, width = photo.shape
    columns = max(2, min(width // _LEAST_PX, round(seen_at / _SPACING_PT)))
    rows = min(height, max(1, round(columns * height / width)))
    blur = camera_blur(photo, edges)
    errors = []
    for arrangement in (edges, EdgeList(edges.width, edges.height)):
        difference = _difference(arrangement, photo, columns, rows, blur, SEEN_PT * width / seen_at, threads)
        errors.append(np.square(difference, dtype=np.float64))
    saved = np.rint((errors[1] - errors[0]) * (255.0**2 * _PARTS)).astype(np.int64)
    nearest = walls.nearest(edges, width, height, _REACH * width / columns)
    chain_of = np.empty(len(edges.edges), np.int64)
    for number, chain in enumerate(chains):
        chain_of[chain] = number
    there = nearest >= 0
    totals: Ints = np.zeros(len(chains), np.int64)
    np.add.at(totals, chain_of[nearest[there]], saved[there])
    return totals.astype(np.float64) * (PICTURE_PX / photo.size / _PARTS)


def _difference(
    edges: EdgeList, photo: Grey32, columns: int, rows: int, blur: float, seen: float, threads: int | None
) -> Grey32:
    """What the reconstruction of a grid, as the camera would see it, differs from the photo, blurred by `seen`."""
    height, width = photo.shape
    samples = reduce(
        extract_samples(photo, edges), edges, columns, rows, photo=photo, fit="lsq", blur=blur, threads=threads
    )
    grey = reconstruct(samples.astype(float), edges, 2 * width, 2 * height, threads=threads)
    grey = np.clip(grey, 0, 1, out=grey).reshape(height, 2, width, 2).mean(axis=(1, 3))
    return smoothed(smoothed(grey, blur) - photo, seen)
