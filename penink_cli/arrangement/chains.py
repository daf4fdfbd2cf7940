"""Edge points linked into chains."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from penink_cli.arrangement._compiled import points as _points
from penink_cli.arrangement.gradient import EdgePoints
from penink_cli.ground import exact
from penink_cli.ground.model import Floats

Ints32 = npt.NDArray[np.int32]


@dataclass(frozen=True, eq=False)
class Chains:
    """Runs of edge points, one after the other along an edge.

    order: (p,) edge points, chain after chain; first: (c + 1,) offsets into it.
    ring: (c,) whether the last point is linked back to the first.
    """

    order: Ints32
    first: Ints32
    ring: npt.NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.ring)

    @property
    def owner(self) -> Ints32:
        """The chain (p,) of each entry of `order`."""
        return np.repeat(np.arange(len(self), dtype=np.int32), np.diff(self.first))

    def where(self, wanted: npt.NDArray[np.bool_]) -> Chains:
        """The chains for which wanted (c,) holds."""
        lengths = np.diff(self.first)[wanted]
        order = self.order[np.repeat(wanted, np.diff(self.first))]
        return Chains(order, np.concatenate([[0], np.cumsum(lengths)]).astype(np.int32), self.ring[wanted])


def link_chains(points: EdgePoints) -> Chains:
    """Link each edge point to the next along its edge (Devernay 1995); singles are left out."""
    n = len(points.pixel)
    following, preceding = np.empty(n, np.int32), np.empty(n, np.int32)
    _points.link(points.pixel, points.position, points.gradient, points.index, following, preceding)
    order, first = np.empty(n, np.int32), np.zeros(n + 1, np.int32)
    count = _points.follow(following, preceding, order, first)
    first = first[: count + 1]
    ring = preceding[order[first[:-1]]] >= 0 if count else np.zeros(0, bool)
    chains = Chains(order, first, ring)
    return chains.where(np.diff(first) > 1)


def chain_lengths(chains: Chains, position: Floats) -> Floats:
    """Length (c,) of each chain in pixels, along its points."""
    if not len(chains):
        return np.zeros(0)
    steps = np.zeros(len(chains.order))
    steps[1:] = exact.length(np.diff(position[chains.order], axis=0))
    steps[chains.first[:-1]] = 0
    return np.add.reduceat(steps, chains.first[:-1])
