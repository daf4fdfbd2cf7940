"""What the two edge indexes beside `geometry.edge_index` are worth: `python -m tests.benchmarks.edge_index`.

The reconstruction's index lists an edge in the cells that it touches, and not in all cells of its bounding box. Its
gain is the fewer edges that a look into a cell meets, its cost the time to build it. The arrangement's takes edges in
and out; the common index would be built anew for each.
"""

from __future__ import annotations

import time

import numpy as np
import skimage.data

from penink_cli.arrangement import planar
from penink_cli.arrangement.detection import detect_edges
from penink_cli.geometry import edge_index
from penink_cli.ground.model import EdgeList
from penink_cli.reconstruction._compiled import cells, scene
from penink_cli.reconstruction.paths import sample_units

REPEATS = 7


def median(work: object) -> float:
    """Milliseconds of processor, the median of some runs."""
    taken = []
    for _ in range(REPEATS):
        begin = time.process_time()
        work()  # type: ignore[operator]
        taken.append(1000 * (time.process_time() - begin))
    return float(np.median(taken))


def scattered(count: int, side: int, length: float) -> EdgeList:
    """Edges of that length at random places; that they cross is of no matter here."""
    rng = np.random.default_rng(0)
    start = rng.uniform(length, side - length, (count, 2))
    turn = rng.normal(size=(count, 2))
    ends = start + length * turn / np.sqrt((turn * turn).sum(axis=1))[:, None]
    vertices = np.stack([start, ends], axis=1).reshape(-1, 2)
    return EdgeList(side, side, vertices, np.arange(2 * count).reshape(-1, 2))


def crossed(ends: np.ndarray, side: int) -> np.ndarray:
    """How many segments (m, 4) run through each of side × side unit cells."""
    count = np.zeros((side, side))
    for ax, ay, bx, by in ends.tolist():
        for row in range(max(0, int(min(ay, by))), min(side - 1, int(max(ay, by))) + 1):
            part = [(y - ay) / (by - ay) if by != ay else t for y, t in ((row, 0.0), (row + 1, 1.0))]
            x = [ax + min(1.0, max(0.0, t)) * (bx - ax) for t in part]
            count[row, max(0, int(min(x))) : int(max(x)) + 1] += 1
    return count.ravel()


def spans(name: str, edges: EdgeList) -> None:
    """The cells of the reconstruction against lists by bounding boxes on the same cells."""
    side = edges.width
    points = sample_units(edges.vertices, side, side, (side, side))
    ends = points[edges.edges].reshape(-1, 4) + 1

    def by_box() -> tuple[np.ndarray, np.ndarray]:
        return edge_index.lists(*edge_index.cells(ends, 1.0), side + 1, side + 1)

    def by_span() -> scene.Scene:
        made = scene.Scene(points, edges.edges, side, side, 3.0)
        cells.sort_edges(made)
        return made

    begin, _ = by_box()
    box, span = np.diff(begin).astype(float), crossed(ends, side + 1)
    # a look is made where there are edges: the entries that it meets, weighted by them
    met = [float((count * count).sum() / count.sum()) for count in (box, span)]
    times = median(by_box), median(by_span)
    print(
        f"{name:28}{len(edges.edges):7}{box.sum() / len(ends):8.2f}{span.sum() / len(ends):8.2f}"
        f"{met[0]:9.2f}{met[1]:8.2f}{times[0]:9.2f}{times[1]:8.2f}"
    )


def changes(edges: EdgeList) -> None:
    """One edge out of an arrangement and in again, against the common index built anew."""
    vertices = planar.to_units(edges.vertices)
    index = planar.planar(edges.width, edges.height, vertices, edges.edges.astype(np.int32))
    for s in range(len(edges.edges)):
        index.add(s)

    def out_and_in() -> None:
        for s in range(len(edges.edges)):
            index.remove(s)
            index.add(s)

    ends = edges.vertices[edges.edges].reshape(-1, 4)
    anew = median(lambda: edge_index.lists(*edge_index.cells(ends, 4.0), edges.width // 4 + 2, edges.height // 4 + 2))
    one = median(out_and_in) / len(edges.edges)
    print(f"an edge out and in again {1000 * one:.2f} µs; the common index anew {1000 * anew:.0f} µs")


def main() -> None:
    print(f"{'':28}{'edges':>7}{'cells an edge':>16}{'met in a look':>17}{'ms to build':>17}")
    print(f"{'':28}{'':7}{'box':>8}{'span':>8}{'box':>9}{'span':>8}{'box':>9}{'span':>8}")
    camera = detect_edges(skimage.data.camera() / 255.0)
    spans("camera", camera)
    for length in (2.0, 8.0, 32.0, 128.0):
        spans(f"scattered, {length:g} samples long", scattered(2000, 512, length))
    changes(camera)


if __name__ == "__main__":
    main()
