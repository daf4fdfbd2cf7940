"""What a drawing is measured by: its tone as the eye sees it, and how evenly its lines lie.

All of it looks at the finished drawing (rendered by Ghostscript, or the strokes themselves) and knows nothing
of how it was made.
"""

from __future__ import annotations

import io
import subprocess

import numpy as np
from scipy.ndimage import gaussian_filter, map_coordinates

from penink_cli.blasting.solids import BLACK, filled, found
from penink_cli.ground.model import Floats, Strokes
from penink_cli.outputs import postscript
from penink_cli.outputs.page import lay_out

EYE_INCH = 1 / 16
GRID = 100  # samples to the inch at which tones are compared


def rendered(strokes: Strokes, dpi: float) -> Floats:
    """The strokes printed at dpi, (rows, columns): 1 where there is ink."""
    out = io.BytesIO()
    postscript.write(out, [strokes], lay_out([strokes]))
    page = subprocess.run(
        ["gs", "-q", "-dSAFER", "-dBATCH", "-dNOPAUSE", "-dEPSCrop", f"-r{dpi:g}", "-sDEVICE=pgmraw",
         "-sOutputFile=-", "-"],
        input=out.getvalue(), capture_output=True, check=True,
    ).stdout  # fmt: skip
    head = page.split(b"\n", 3) if not page.split(b"\n")[1].startswith(b"#") else page.split(b"\n", 4)
    columns, rows = map(int, head[-3].split())
    return 1.0 - np.frombuffer(head[-1], np.uint8, rows * columns).reshape(rows, columns) / 255.0


def shrunk(values: Floats, rows: int, columns: int) -> Floats:
    """Means over rows × columns equal rectangles, whatever their borders cut through."""
    for axis, n in ((0, rows), (1, columns)):
        m = values.shape[axis]
        total = np.insert(np.cumsum(values, axis=axis), 0, 0.0, axis=axis)
        at = np.linspace(0, m, n + 1)
        lo = np.minimum(at.astype(int), m - 1)
        f = np.expand_dims(at - lo, 1 - axis)
        edge = np.take(total, lo, axis) * (1 - f) + np.take(total, lo + 1, axis) * f
        values = np.diff(edge, axis=axis) * (n / m)
    return values


def stretched(tone: Floats, rows: int, columns: int) -> Floats:
    """A tone at rows × columns, shrunk or interpolated."""
    if rows <= tone.shape[0] and columns <= tone.shape[1]:
        return shrunk(tone, rows, columns)
    y = (np.arange(rows) + 0.5) * tone.shape[0] / rows - 0.5
    x = (np.arange(columns) + 0.5) * tone.shape[1] / columns - 0.5
    return map_coordinates(tone, np.meshgrid(y, x, indexing="ij"), order=1, mode="nearest")


def tone_error(strokes: Strokes, tone: Floats, dpi: float = 600) -> Floats:
    """Tone wanted less tone printed, as the eye sees both, in percent: positive is too light. GRID samples an inch."""
    columns, rows = (max(8, round(side / 72 * GRID)) for side in (strokes.width, strokes.height))
    printed = shrunk(rendered(strokes, dpi), rows, columns)
    return 100 * gaussian_filter(stretched(tone, rows, columns) - printed, EYE_INCH * GRID, mode="reflect")


def tone_figures(strokes: Strokes, tone: Floats, dpi: float = 600) -> tuple[float, float, float]:
    """RMS, bias and worst of `tone_error`."""
    e = tone_error(strokes, tone, dpi)
    return float(np.sqrt((e * e).mean())), float(e.mean()), float(np.abs(e).max())


def flattened(strokes: Strokes, i: int) -> Floats:
    """Stroke i as a polyline of steps of a point or so."""
    p = strokes[i]
    out = [p[:1]]
    for k in range((len(p) - 1) // 3):
        a, b, c, d = p[3 * k : 3 * k + 4]
        n = int(np.abs(np.diff(p[3 * k : 3 * k + 4], axis=0)).sum()) + 2
        t = np.linspace(0, 1, n)[1:, None]
        out.append((1 - t) ** 3 * a + 3 * (1 - t) ** 2 * t * b + 3 * (1 - t) * t * t * c + t**3 * d)
    return np.concatenate(out)


def lengths(strokes: Strokes) -> Floats:
    """Length of each stroke, points."""
    legs = (np.diff(flattened(strokes, i), axis=0) for i in range(len(strokes)))
    return np.array([np.hypot(*leg.T).sum() for leg in legs])


def long_share(strokes: Strokes) -> float:
    """The share of all ink that is in strokes of over 20 pt."""
    length = lengths(strokes)
    ink = length * strokes.widths
    return float(ink[length > 20].sum() / max(ink.sum(), 1e-9))


def evenness(strokes: Strokes, angle: float, margin: float = 14.0, step: float = 7**0.5) -> dict[str, float]:
    """How evenly the strokes within 15° of angle (degrees, y down) lie on a field of one tone.

    Lines are scanned across the hatch every `step` points, and the gaps between the strokes they meet are pooled:
    cv, their deviation by their mean; spread, half the distance of the quantiles 16 and 84 % by the median; doubled and
    gaping, the shares under 0.4 and over 1.8 of the mean; doubled_long, those doubled by a pair that stays so for 6 pt.
    aligned_ends: the share of strokes whose first end has the first end of one in a neighbouring lane within 2 pt.
    Those of `repeats` besides.
    """
    along = np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
    across = np.array([-along[1], along[0]])
    met, starts, ink = [], [], []
    for i in range(len(strokes)):
        line = flattened(strokes, i)
        legs = np.diff(line, axis=0)
        chord = line[-1] - line[0]
        if abs(chord @ across) > 0.26 * abs(chord @ along):
            continue
        ink.append(np.column_stack([(line[1:] + line[:-1]) / 2, np.hypot(*legs.T) * strokes.widths[i]]))
        u, v = line @ along, line @ across
        if u[0] > u[-1]:
            u, v = u[::-1], v[::-1]
        if line.min() > 1 and line[:, 0].max() < strokes.width - 1 and line[:, 1].max() < strokes.height - 1:
            starts.append((u[0], v[0]))
        columns = np.arange(np.ceil(u[0] / step), np.floor(u[-1] / step) + 1)
        met.append(np.column_stack([columns, np.interp(columns * step, u, v), np.full(len(columns), i)]))
    cross = np.concatenate(met)
    place = cross[:, :1] * step * along + cross[:, 1:2] * across
    inside = ((place > margin) & (place < (strokes.width - margin, strokes.height - margin))).all(axis=1)
    cross = cross[inside]
    cross = cross[np.lexsort((cross[:, 1], cross[:, 0]))]
    same = cross[1:, 0] == cross[:-1, 0]
    gaps = np.diff(cross[:, 1])[same]
    pairs = np.sort(np.column_stack([cross[:-1, 2], cross[1:, 2]])[same], axis=1)
    mean = gaps.mean()
    close = gaps < 0.4 * mean
    _, count = np.unique(pairs[close], axis=0, return_counts=True)
    low, median, high = np.percentile(gaps, [16, 50, 84])
    ends = np.array(sorted(starts))
    aligned = 0
    for u, v in ends:
        near = ends[np.searchsorted(ends[:, 0], u - 2) : np.searchsorted(ends[:, 0], u + 2), 1] - v
        aligned += bool(((np.abs(near) > 0.4 * mean) & (np.abs(near) < 1.6 * mean)).any())
    return {
        "cv": gaps.std() / mean,
        "spread": (high - low) / 2 / median,
        "doubled": close.mean(),
        "doubled_long": count[count * step > 6].sum() / len(gaps),
        "gaping": (gaps > 1.8 * mean).mean(),
        "aligned_ends": aligned / max(1, len(ends)),
        **repeats(np.concatenate(ink), strokes.width, strokes.height, across, mean),
    }


TILE_PT = 144


def repeats(ink: Floats, width: float, height: float, across: Floats, gap: float) -> dict[str, float]:
    """How much a field of one tone repeats itself. ink: (n, 3) x, y, area of small bits of stroke.

    tile_db: the mean power at the harmonics of a tile of TILE_PT by that half a harmonic beside them, 10 lg;
    tile_peak_db: the strongest of the ones by the strongest of the others. Power is divided by the median around it.
    repeat_corr: the highest peak of the autocorrelation of the ink, blurred by the mean gap, over 30 pt away and not
    on the same line.
    """
    rows, columns = round(height), round(width)
    field = np.zeros((rows + 2, columns + 2))
    at = ink[(ink[:, :2] >= 0).all(axis=1) & (ink[:, 0] < columns) & (ink[:, 1] < rows)]
    cell = np.floor(at[:, :2] + 0.5).astype(int)
    f = at[:, :2] + 0.5 - cell
    for dx, dy in ((0, 0), (1, 0), (0, 1), (1, 1)):
        share = (f[:, 0] if dx else 1 - f[:, 0]) * (f[:, 1] if dy else 1 - f[:, 1])
        np.add.at(field, (cell[:, 1] + dy, cell[:, 0] + dx), share * at[:, 2])
    field = field[1:-1, 1:-1]

    n = min(rows, columns) // TILE_PT * TILE_PT
    tiles = n // TILE_PT
    window = np.hanning(n + 1)[:n]
    part = field[:n, :n] - field[:n, :n].mean()
    power = np.fft.fftshift(np.abs(np.fft.fft2(part * window * window[:, None])) ** 2)
    most = 13 * tiles
    k = np.arange(-most, most + 1)
    power = power[n // 2 - most - 4 : n // 2 + most + 5, n // 2 - most - 4 : n // 2 + most + 5]
    around = np.lib.stride_tricks.sliding_window_view(power, (9, 9))
    power = power[4:-4, 4:-4] / np.median(around, axis=(2, 3))
    frequency = np.hypot(k, k[:, None]) / n
    band = (frequency <= min(0.75 / gap, 12 / TILE_PT)) & (frequency > 0.7 / TILE_PT) & (k[:, None] >= 0)
    half = tiles // 2

    def lattice(y: int, x: int) -> Floats:
        return power[band & (k[:, None] % tiles == y) & (k % tiles == x)]

    on, off = lattice(0, 0), [lattice(0, half), lattice(half, 0), lattice(half, half)]

    fy, fx = np.fft.fftfreq(2 * rows)[:, None], np.fft.fftfreq(2 * columns)
    padded, there = np.zeros((2, 2 * rows, 2 * columns))
    padded[:rows, :columns], there[:rows, :columns] = field - field.mean(), 1.0
    blur = np.exp(-2 * (np.pi * gap) ** 2 * (fx**2 + fy**2))
    together = np.fft.ifft2(np.abs(np.fft.fft2(padded) * blur) ** 2).real
    together /= np.maximum(np.fft.ifft2(np.abs(np.fft.fft2(there)) ** 2).real, 1)
    dx, dy = fx * 2 * columns, fy * 2 * rows
    far = (np.abs(dx) < 0.6 * columns) & (np.abs(dy) < 0.6 * rows) & (np.hypot(dx, dy) > 30)
    far &= np.abs(dx * across[0] + dy * across[1]) > 3 * gap
    return {
        "tile_db": 10 * np.log10(on.mean() / np.mean([o.mean() for o in off])),
        "tile_peak_db": 10 * np.log10(on.max() / np.mean([o.max() for o in off])),
        "repeat_corr": (together / together[0, 0])[far].max(),
    }


def solids(
    tone: Floats, width_pt: float, height_pt: float, pen_pt: float | None, gain_pt: float, ink: Floats,
    black: float = BLACK,
) -> Strokes:  # fmt: skip
    """Strokes that fill what is black in the tone, without white lines."""
    return filled(found(tone, width_pt, height_pt, ink, black), width_pt, height_pt, pen_pt, gain_pt)


def ends_in_rows(strokes: Strokes, angle: float) -> float:
    """The share of ends within 15° of angle that stand in a row: two others within 4 pt along and 4 pt across.

    An end that meets the next stroke of its own line is none.
    """
    along = np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
    across = np.array([-along[1], along[0]])
    ends: list[list[tuple[float, float]]] = [[], []]
    for i in range(len(strokes)):
        a, b = strokes[i][0], strokes[i][-1]
        if abs((b - a) @ across) < 0.26 * abs((b - a) @ along) and np.hypot(*(b - a)) > 7:
            a, b = (a, b) if (b - a) @ along > 0 else (b, a)
            for side, p in enumerate((a, b)):
                if (p > 3).all() and (p < (strokes.width - 3, strokes.height - 3)).all():
                    ends[side].append((float(p @ along), float(p @ across)))
    starts, stops = (np.array(sorted(side)) for side in ends)

    def free(some: Floats, others: Floats) -> Floats:
        d = np.abs(some[:, None] - others[None])
        return some[~((d[..., 0] < 2.5) & (d[..., 1] < 0.5)).any(axis=1)]

    rows, total = 0, 0
    for side in (free(starts, stops), free(stops, starts)):
        d = np.abs(side[:, None] - side[None])
        near = (d[..., 0] < 4) & (d[..., 1] < 4) & (d[..., 1] > 0.3)
        rows += int((near.sum(axis=1) >= 2).sum())
        total += len(side)
    return rows / max(total, 1)


def ray_gaps(strokes: Strokes, margin: float = 20.0, angle: float = 25.0, reach: float = 14.0) -> dict[str, float]:
    """How evenly strokes that curve lie on a field of one tone.

    From points on the strokes (10 000 legs, drawn by lot) a ray goes out square to the stroke, to the next one of about
    the same direction (within `angle` degrees, `reach` points). cv, the deviation of these gaps by their mean; doubled
    and gaping, the shares under 0.4 and over 1.8 of it. Not to be compared with `evenness`, whose scans are straight.
    """
    from scipy.spatial import cKDTree

    lines = [flattened(strokes, i) for i in range(len(strokes))]
    start = np.concatenate([line[:-1] for line in lines])
    leg = np.concatenate([np.diff(line, axis=0) for line in lines])
    who = np.repeat(np.arange(len(lines)), [len(line) - 1 for line in lines])
    length = np.hypot(*leg.T)
    start, leg, who, length = (values[length > 1e-9] for values in (start, leg, who, length))
    along = leg / length[:, None]
    middle = start + leg / 2
    tree = cKDTree(middle)
    inside = ((middle > margin) & (middle < (strokes.width - margin, strokes.height - margin))).all(axis=1)
    rng = np.random.default_rng(0)
    chosen = rng.choice(np.flatnonzero(inside), min(10_000, int(inside.sum())), replace=False)
    ray = np.column_stack([-along[:, 1], along[:, 0]])[chosen]
    around = tree.query_ball_point(middle[chosen] + ray * (reach / 2), reach / 2 + 1)
    k = np.repeat(np.arange(len(chosen)), [len(some) for some in around])
    near = np.concatenate([np.asarray(some, np.int64) for some in around])
    alike = np.abs((along[near] * along[chosen[k]]).sum(axis=1)) > np.cos(np.radians(angle))
    k, near = k[alike & (who[near] != who[chosen[k]])], near[alike & (who[near] != who[chosen[k]])]
    # where the ray meets the leg: how far along the one and, in parts, along the other
    offset = start[near] - middle[chosen[k]]
    cross = ray[k, 0] * leg[near, 1] - ray[k, 1] * leg[near, 0]
    far = (offset[:, 0] * leg[near, 1] - offset[:, 1] * leg[near, 0]) / cross
    part = (offset[:, 0] * ray[k, 1] - offset[:, 1] * ray[k, 0]) / cross
    hit = (part > -0.05) & (part < 1.05) & (far > 0.01)
    gaps = np.full(len(chosen), np.inf)
    np.minimum.at(gaps, k[hit], far[hit])
    gaps = gaps[np.isfinite(gaps)]
    mean = gaps.mean()
    return {
        "cv": float(gaps.std() / mean), "mean": float(mean),
        "doubled": float((gaps < 0.4 * mean).mean()), "gaping": float((gaps > 1.8 * mean).mean()),
    }  # fmt: skip
