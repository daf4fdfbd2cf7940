"""Photo to edge list: the paper's first step (section 3)."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from penink_cli.arrangement import _planar
from penink_cli.arrangement.chains import Chains, chain_lengths, join_ends, link_chains
from penink_cli.arrangement.gradient import EdgePoints, edge_points, noise_level
from penink_cli.arrangement.planar import from_units, planar, to_units
from penink_cli.arrangement.simplification import simplify
from penink_cli.model import EdgeList, Floats

SIGMA = 1.0
TOLERANCE = 0.3
MIN_LENGTH = 6.0
_CAMERA_BLUR = 0.8  # pixels: pixel area, lens and the central difference, where nothing better is known


def detect_edges(
    grey: npt.NDArray[np.floating],
    *,
    sigma: float | None = None,
    low: float | None = None,
    high: float | None = None,
    tolerance: float = TOLERANCE,
    min_length: float = MIN_LENGTH,
) -> EdgeList:
    """Find the discontinuity edges of a photo.

    Args:
        grey: (h, w), 0 … 1.
        sigma: smoothing before the gradient is taken, pixels.
        low: least grey step (0 … 1) anywhere along an edge, as far as the gradient tells.
        high: grey step that each edge reaches somewhere.
        tolerance: how far segments may stray from the edge found, pixels.
        min_length: shortest chain that is kept, pixels.

    """
    height, width = grey.shape
    sigma = SIGMA if sigma is None else sigma
    steepness = 1 / (np.sqrt(2 * np.pi) * np.hypot(sigma, _CAMERA_BLUR))  # of an edge of step 1, grey per pixel
    if high is None:
        noise = noise_level(grey) / (5.013 * sigma * sigma)  # of each component of the gradient
        high = max(0.06, 6 * noise / steepness)
    low = min(0.5 * high if low is None else low, high)
    points = edge_points(grey, sigma, low * steepness)
    chains = _telling(points, link_chains(points), high * steepness, min_length)
    if not len(chains):
        return EdgeList(width, height, strength=np.zeros(0))
    joins, places, reaching = join_ends(points, chains, radius=3.0 + sigma)
    return _arrange(points, chains, joins, places, reaching, tolerance, steepness)


def _telling(points: EdgePoints, chains: Chains, high: float, min_length: float) -> Chains:
    if not len(chains):
        return chains
    steepest = np.maximum.reduceat(points.magnitude[chains.order], chains.first[:-1])
    return chains.where((steepest >= high) & (chain_lengths(chains, points.position) >= min_length))


def _arrange(
    points: EdgePoints,
    chains: Chains,
    joins: npt.NDArray[np.int32],
    places: Floats,
    reaching: npt.NDArray[np.int32],
    tolerance: float,
    steepness: float,
) -> EdgeList:
    height, width = points.shape
    n = len(points.position)
    positions = np.concatenate([np.clip(points.position, 0, (width, height)), places])
    order = chains.order
    links = np.column_stack([order[:-1], order[1:]])
    links = np.delete(links, chains.first[1:-1] - 1, axis=0)
    rings = np.column_stack([order[chains.first[1:] - 1], order[chains.first[:-1]]])[chains.ring]
    frame = np.column_stack([reaching, n + np.arange(len(places))])
    ends = np.concatenate([links, rings, joins, frame]).astype(np.int32)
    arrangement = planar(width, height, to_units(positions), ends)
    _planar.insert(arrangement, ends)
    simplify(arrangement, tolerance)
    live = np.asarray(arrangement.live)[: len(ends)].astype(bool)
    edges = np.asarray(arrangement.ends)[live].astype(np.int64)
    step = np.concatenate([points.magnitude / steepness, np.zeros(len(places))])
    strength = np.clip(step[edges].max(axis=1), 0, 1)
    used, edges = np.unique(edges, return_inverse=True)
    vertices = from_units(np.asarray(arrangement.vertices)[used])
    return EdgeList(width, height, vertices, edges.reshape(-1, 2), strength)
