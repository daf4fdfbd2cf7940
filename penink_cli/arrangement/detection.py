"""Photo to edge list: the paper's first step (section 3)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from penink_cli.arrangement._compiled import planar as _planar
from penink_cli.arrangement._compiled.planar import Planar
from penink_cli.arrangement.chains import Chains, chain_lengths, link_chains
from penink_cli.arrangement.corners import sharpen
from penink_cli.arrangement.gradient import EdgePoints, edge_points, noise_level
from penink_cli.arrangement.joints import Joints, join_ends, loose_ends
from penink_cli.arrangement.junctions import settle_junctions
from penink_cli.arrangement.planar import from_units, planar, to_units
from penink_cli.arrangement.simplification import simplify
from penink_cli.arrangement.smoothing import position_error, smooth, unbend
from penink_cli.arrangement.strengths import strengths
from penink_cli.ground import exact
from penink_cli.ground.median import median
from penink_cli.ground.model import EdgeList, Floats

TOLERANCE = 0.3
MIN_LENGTH = 6.0
TELLING = 13.0  # least `_telling` score of a chain; the median of grass and fur is 6, of outlines over 20
_ALONE = 2.0  # times as steep as what is around: texture reaches 1.4 to 2, letters 2.5 to 3.3
_BRIDGE = 0.4  # of that is enough for a chain that leads from a telling chain to another, or to the frame
_LEAST_LENS = 0.32  # pixels
_OWN = 1 / 12 + 1 / 3  # variance, pixels², of what a pixel's area and the central difference add to a blur
_CAMERA_BLUR = 0.8  # pixels: pixel area, lens and the central difference, where nothing better is known


def detect_edges(
    grey: npt.NDArray[np.floating],
    *,
    sigma: float | None = None,
    low: float | None = None,
    high: float | None = None,
    tolerance: float = TOLERANCE,
    min_length: float = MIN_LENGTH,
    seen_at: float | None = None,
    report: Callable[[str], None] = lambda line: None,
) -> EdgeList:
    """Find the discontinuity edges of a photo.

    Args:
        grey: (h, w), 0 … 1.
        sigma: smoothing before the gradient is taken, pixels.
        low: least grey step (0 … 1) anywhere along an edge, as far as the gradient tells.
        high: grey step that each edge reaches somewhere.
        tolerance: how far segments may stray from the edge found, pixels.
        min_length: shortest chain that is kept, pixels.
        seen_at: the width on paper, points, of the drawing that the edges are for, None for any: corners and junctions
            are settled only where it shows them.
        report: is told, in a line, what was chosen by the photo.

    """
    height, width = grey.shape
    noise = noise_level(grey)
    if sigma is None:
        sigma = float(np.clip(0.3 + 0.225 * 255 * noise, 0.6, 1.6))
    steepness = 1 / (np.sqrt(2 * np.pi) * exact.hypot(sigma, _CAMERA_BLUR))  # of an edge of step 1, grey per pixel
    unrest = noise / (5.013 * sigma * sigma) / steepness  # the noise of the gradient, as a step
    high = max(0.05, 6 * unrest) if high is None else high
    low = min(max(0.5 * high, 3.5 * unrest) if low is None else low, high)
    sigma, low, high = float(sigma), float(low), float(high)
    report(f"chosen: --sigma {sigma} --low {low} --high {high}; noise {255 * noise:.1f} grey levels of 255")
    points = edge_points(grey, sigma, low * steepness)
    chains = _telling(points, link_chains(points), high * steepness, min_length, sigma)
    if not len(chains):
        return EdgeList(width, height, strength=np.zeros(0))
    points, chains = _compact(points, chains)
    blur = _blur(points, chains, sigma)
    error = position_error(points, noise, sigma, blur)
    sharp = sharpen(points, chains, blur, error)
    points, chains = replace(points, position=sharp.position), sharp.chains
    points = replace(points, position=smooth(points.position, sharp.pieces, error))
    points = replace(points, position=unbend(points, sharp.pieces, blur))
    lens = float(np.sqrt(max(_LEAST_LENS**2, blur * blur - sigma * sigma - _OWN)))

    def settle(arrangement: Planar, step: Floats) -> None:
        settle_junctions(arrangement, grey, step, lens, noise, blur, seen_at)

    edges, slopes = _arrange(points, chains, join_ends(points, chains, blur), tolerance, steepness, settle)
    measured = strengths(grey, edges, lens, noise)
    return replace(edges, strength=np.where(measured < 0, slopes, measured))


def _compact(points: EdgePoints, chains: Chains) -> tuple[EdgePoints, Chains]:
    """Only the points that chains go through: in texture one of ten."""
    used = np.zeros(len(points.pixel), bool)
    used[chains.order] = True
    order = (np.cumsum(used, dtype=np.int32) - 1)[chains.order].astype(np.int32)
    return points.where(used), replace(chains, order=order)


def _blur(points: EdgePoints, chains: Chains, sigma: float) -> float:
    """Whole blur (pixels) that edges are seen through: the photo's, its pixels' and the detector's."""
    widths = points.width[chains.order]
    widths = widths[widths > 0]
    if not len(widths):
        return float(exact.hypot(sigma, _CAMERA_BLUR))
    return float(np.clip(median(widths), sigma, 3 * sigma))


def _telling(points: EdgePoints, chains: Chains, high: float, min_length: float, sigma: float) -> Chains:
    """The chains that tell something: steep enough somewhere, long enough, and no texture.

    In texture (grass, fur, noise) every ridge of the gradient has others as steep around it, and
    ridges are short or meander. So a chain's steepness is divided by the mean steepness around it.
    It counts the more the farther the chain goes. It counts much more where the chain stands alone:
    letters do, and cannot go far. A short chain between two outlines cannot go far either, and the
    outlines around it are steep. Less than half as much is asked of it.
    """
    if not len(chains):
        return chains
    order, first, count = chains.order, chains.first[:-1], np.diff(chains.first)
    steepness = points.magnitude[order]
    contrast = np.add.reduceat(steepness, first) / np.maximum(np.add.reduceat(points.surround[order], first), 1e-12)
    position = points.position[order]
    extent = exact.length(np.maximum.reduceat(position, first) - np.minimum.reduceat(position, first))
    size = contrast * np.sqrt(extent) * np.maximum(1, contrast / _ALONE) ** 2
    candidates = (
        (size >= _BRIDGE * TELLING)
        & (np.maximum.reduceat(steepness, first) >= high)
        & (chain_lengths(chains, points.position) >= min_length)
        & (count >= 3)
    )
    chains, telling = chains.where(candidates), size[candidates] >= TELLING
    blur = _blur(points, chains.where(telling), sigma)
    ends = loose_ends(points, chains, blur, telling)
    meets = ends.meets.reshape(2, -1)
    joined = meets.any(axis=0) & (meets | ends.to_frame.reshape(2, -1)).all(axis=0)
    telling[np.flatnonzero(~chains.ring)[joined]] = True
    return chains.where(telling)


def _arrange(
    points: EdgePoints,
    chains: Chains,
    joints: Joints,
    tolerance: float,
    steepness: float,
    settle: Callable[[Planar, Floats], None],
) -> tuple[EdgeList, Floats]:
    """The edges, and the step (m,) that the slopes at their ends tell, 0 where these tell nothing."""
    height, width = points.shape
    places = joints.places
    positions = np.concatenate([np.clip(points.position, 0, (width, height)), places])
    order, first = chains.order, chains.first
    links = np.column_stack([order[:-1], order[1:]])
    kept = ~(joints.trimmed[:-1] | joints.trimmed[1:])
    kept[first[1:-1] - 1] = False
    rings = np.column_stack([order[first[1:] - 1], order[first[:-1]]])[chains.ring]
    ends = np.concatenate([links[kept], rings, joints.links]).astype(np.int32)
    arrangement = planar(width, height, to_units(positions), ends)
    _planar.insert(arrangement, ends)
    simplify(arrangement, tolerance, width, height)
    step = np.concatenate([points.magnitude / steepness, np.zeros(len(places))])
    live = np.asarray(arrangement.live)[: len(ends)].astype(bool)
    fresh = np.bincount(np.asarray(arrangement.ends)[live].ravel(), minlength=len(step)) == 0
    known = np.where(fresh, 0.0, step)  # what settling takes for new vertices are points of elsewhere
    settle(arrangement, known)
    live = np.asarray(arrangement.live)[: len(ends)].astype(bool)
    edges = np.asarray(arrangement.ends)[live].astype(np.int64)
    used, place = np.unique(edges, return_inverse=True)
    edges = place.reshape(-1, 2)
    vertices = from_units(np.asarray(arrangement.vertices)[used])
    return EdgeList(width, height, vertices, edges), np.clip(known[used][edges].max(axis=1), 0, 1)
