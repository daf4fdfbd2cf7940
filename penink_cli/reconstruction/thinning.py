"""Which chains of edges are worth their bytes: those that save more of a drawing's error than they cost.

A picture is reconstructed twice from a grid as fine as a drawing of a width needs: with all edges and with none. Near
edges the difference of the squared errors is what edges save. The saving at each place belongs to the nearest chain. A
chain that saves less than so many squared grey levels a bit is dropped. No chain saves more than there is error without
edges: those that could not be worth it even so are left out of the first picture, which takes most of the time. Where
there is no picture, strong and long chains stay.
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
from penink_cli.reconstruction.extraction import contamination, extract_samples
from penink_cli.reconstruction.grid import SEEN_PT, SEEN_PX, VIEW_PX
from penink_cli.reconstruction.reduction import Reduction
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
    stay = np.zeros(len(chains), bool)
    if kept is not None:
        stay = np.array([bool(kept[chain].any()) for chain in chains])
    if photo is None:
        stays = _strongest(edges, chains)
    else:
        savings = _Savings(edges, chains, photo, seen_at, threads)
        hopeful = (savings.of_none > worth * bits) | stay
        stays = savings.of(_only(edges, chains, hopeful)) > worth * bits
    return _only(edges, chains, stays | stay)


def _only(edges: EdgeList, chains: list[list[int]], stays: npt.NDArray[np.bool_]) -> EdgeList:
    """The edges of the chains (c,) that stay, and the vertices that these have."""
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


class _Savings:
    """What chains save of the error that a drawing of a width shows, in squared grey levels over PICTURE_PX."""

    def __init__(
        self, edges: EdgeList, chains: list[list[int]], photo: Grey32, seen_at: float, threads: int | None
    ) -> None:
        """edges, photo, seen_at, threads: as of `thin_edges`."""
        # a finer view tells no more of what is blurred by so much
        finest = SEEN_PT * photo.shape[1] / seen_at / SEEN_PX
        self.photo = shrunk(photo, max(1.0, finest, float(np.sqrt(photo.size / VIEW_PX))))
        height, width = self.photo.shape
        self.columns = max(2, min(width // _LEAST_PX, round(seen_at / _SPACING_PT)))
        self.rows = min(height, max(1, round(self.columns * height / width)))
        self.blur = camera_blur(self.photo, edges)
        self.seen = SEEN_PT * width / seen_at
        self.threads = threads
        chain_of = np.empty(len(edges.edges), np.int64)
        for number, chain in enumerate(chains):
            chain_of[chain] = number
        nearest = walls.nearest(edges, width, height, _REACH * width / self.columns)
        self.there = nearest >= 0
        self.chain = chain_of[nearest[self.there]]
        self.count = len(chains)
        self.without = self._error(EdgeList(edges.width, edges.height))
        self.of_none = self._sums(self.without)  # the most that each chain (c,) could save

    def of(self, edges: EdgeList) -> npt.NDArray[np.float64]:
        """What each chain (c,) saves where these edges are."""
        return self._sums(self.without - self._error(edges))

    def _sums(self, saved: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        """Sums (c,) of what is saved (h, w), each place's by the nearest chain."""
        parts = np.rint(saved[self.there] * (255.0**2 * _PARTS)).astype(np.int64)
        totals: Ints = np.zeros(self.count, np.int64)
        np.add.at(totals, self.chain, parts)
        return totals.astype(np.float64) * (PICTURE_PX / self.photo.size / _PARTS)

    def _error(self, edges: EdgeList) -> npt.NDArray[np.float64]:
        """Squares (h, w) of what the reconstruction of a grid, as the camera would see it, differs from the photo."""
        height, width = self.photo.shape
        samples = extract_samples(self.photo, edges, contamination(self.blur))
        reduction = Reduction(samples, edges, "lsq", self.threads)
        reduced = reduction.to(self.columns, self.rows, self.photo, self.blur)
        grey = reconstruct(reduced.astype(float), edges, 2 * width, 2 * height, threads=self.threads)
        grey = np.clip(grey, 0, 1, out=grey).reshape(height, 2, width, 2).mean(axis=(1, 3))
        return np.square(smoothed(smoothed(grey, self.blur) - self.photo, self.seen), dtype=np.float64)
