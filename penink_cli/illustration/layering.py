"""The layers of an illustration, drawn together on one sheet so that their tones add up to the picture's."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from penink_cli.blasting.pens import finer_texture
from penink_cli.composition.separation import SOLID
from penink_cli.ground import pens
from penink_cli.ground.model import Floats, GreyImage, Illustration, Layer, Strokes
from penink_cli.illustration.drawing import Advance, enlarged, grey_size, lined, outlined, tone_curve

LEAST_TONE = 1 / 255  # of an overlay: less is paper
#: Layers that share a sheet are hatched at most ROUNDS times, each time with the error of the time before added to the
#: tone wanted. It is enough once the error (RMS of tone as the eye sees it) is GOOD, as small as that of a single
#: layer.
ROUNDS, GOOD = 3, 0.006


def steps(illustration: Illustration, chosen: Sequence[int] | None = None) -> int:
    """By how much `layer_strokes` advances in all."""
    wanted = set(range(len(illustration.layers)) if chosen is None else chosen)
    groups = [group for group in of_one_colour(illustration) if wanted & set(group)]
    apart = (replace(illustration, layers=tuple(illustration.layers[i] for i in group)) for group in groups)
    return sum(map(_steps, apart))  # whole numbers


def _steps(illustration: Illustration) -> int:
    """By how much layers of one colour advance in all."""
    return len(illustration.layers) * (ROUNDS if _together(illustration) else 1)


def layer_strokes(
    illustration: Illustration,
    width_pt: float,
    *,
    device_dpi: float | None = 600.0,
    seed: int = 0,
    threads: int | None = None,
    pen_pt: float | None = None,
    chosen: Sequence[int] | None = None,
    advance: Advance = lambda done: None,
) -> list[tuple[Strokes, Strokes]]:
    """Hatching and outline strokes of each layer, bottom first, for a picture width_pt wide.

    Layers of one colour share the sheet. The outlines and telling lines of all are ink first. Then each layer is
    hatched wherever it has tone itself, up to the sum of its tone and the tones below, with all ink so far counted: so
    tones add up, and no ink is there twice. The error along common borders of layers, where neither is free to add ink,
    is fed back to all of them. A layer with the threshold rule is hatched as a device hatches an illustration that
    draws itself, whatever the other layers are. Inks of other colours are transparent, and each is drawn as if it had
    the sheet to itself.

    device_dpi: the printer's, None for none. seed: added to the layers' own. pen_pt: one pen for all strokes; without
    it small prints have finer pens (`ground.pens`). chosen: numbers of the layers wanted, None for all; the result has
    these alone, and layers of colours that none of them has are not drawn. advance: is told of progress, see `steps`.
    """
    wanted = range(len(illustration.layers)) if chosen is None else chosen
    drawn: dict[int, tuple[Strokes, Strokes]] = {}
    for group in of_one_colour(illustration):
        if not set(group) & set(wanted):
            continue
        layers = tuple(illustration.layers[i] for i in group)
        found = _on_one_sheet(
            replace(illustration, layers=layers), width_pt, device_dpi=device_dpi, seed=seed + group[0],
            threads=threads, pen_pt=pen_pt, advance=advance,
        )  # fmt: skip
        for i, parts in zip(group, found, strict=True):
            color = illustration.layers[i].color
            drawn[i] = replace(parts[0], color=color), replace(parts[1], color=color)
    return [drawn[i] for i in wanted]


def of_one_colour(illustration: Illustration) -> list[list[int]]:
    """The numbers of the layers of each colour; colours are in the order of their first layers."""
    groups: dict[str, list[int]] = {}
    for i, layer in enumerate(illustration.layers):
        groups.setdefault((layer.color or "#000000").lower(), []).append(i)
    return list(groups.values())


def _on_one_sheet(
    illustration: Illustration, width_pt: float, *, device_dpi: float | None, seed: int, threads: int | None,
    pen_pt: float | None, advance: Advance,
) -> list[tuple[Strokes, Strokes]]:  # fmt: skip
    """Hatching and outline strokes of layers of one colour."""
    height_pt = width_pt * illustration.height / illustration.width
    layers = tuple(_with_pens(layer, width_pt, device_dpi, pen_pt) for layer in illustration.layers)
    illustration = replace(illustration, layers=layers)
    size = grey_size(width_pt, illustration.height / illustration.width)
    outlines: list[Strokes] = []
    for layer in illustration.layers:
        drawn = Strokes(width_pt, height_pt, device_dpi=device_dpi)
        if layer.outline is not None and layer.edges is not None:
            before = Strokes.joined(outlines) if outlines else None
            drawn = outlined(layer.edges, width_pt, height_pt, layer.outline, before, device_dpi)
        if layer.lines is not None:
            told = lined(layer.lines, width_pt, height_pt, layer.line, device_dpi)
            drawn = Strokes.joined([drawn, told]) if len(drawn) else told
        outlines.append(drawn)
    greys = [enlarged(layer.samples, layer.edges, size, threads) for layer in illustration.layers]
    best: tuple[int, list[Strokes]] | None = None
    extra: Floats | None = None
    left = _steps(illustration)
    while left:
        hatched, total = _hatched(
            illustration, width_pt, height_pt, greys, extra, outlines, device_dpi, seed, threads, advance
        )
        left -= len(hatched)
        if not _together(illustration):
            best = 0, hatched
            break
        from penink_cli.blasting.blast import left_over

        error = left_over(total, width_pt, height_pt, Strokes.joined([*outlines, *hatched]), device_dpi, threads)
        # summed as whole numbers, whose sum does not depend on the order, which machines choose differently
        squares = int((np.rint(error * 4096).astype(np.int64) ** 2).sum())
        if best is None or squares < best[0]:
            best = squares, hatched
        if squares <= (GOOD * 4096) ** 2 * error.size:
            break
        extra = error if extra is None else extra + error
    advance(left)
    assert best is not None
    return list(zip(best[1], outlines))


def _with_pens(layer: Layer, width_pt: float, device_dpi: float | None, pen_pt: float | None) -> Layer:
    """The layer with one pen for all strokes, pen_pt, or else with pens that suit the size.

    The texture of a layer with the threshold rule stays: the rule magnifies it as its pen.
    """
    outline = layer.outline
    if pen_pt is not None:
        outline = None if outline is None else replace(outline, pen_pt=pen_pt, even=True)
        return replace(layer, pen_pt=pen_pt, outline=outline, line=replace(layer.line, pen_pt=pen_pt, even=True))
    by = pens.part(width_pt)
    if by == 1.0:
        return layer

    def finer(pen_pt: float) -> float:
        return pens.finer(pen_pt, by, device_dpi)

    return replace(
        layer, pen_pt=None if layer.pen_pt is None else finer(layer.pen_pt),
        texture=layer.texture if layer.rule == "threshold" else finer_texture(layer.texture, by, device_dpi),
        outline=None if outline is None else replace(outline, pen_pt=finer(outline.pen_pt)),
        line=replace(layer.line, pen_pt=finer(layer.line.pen_pt)),
    )  # fmt: skip


def _together(illustration: Illustration) -> bool:
    """Whether several layers share the sheet that can correct one another's errors."""
    return sum(layer.rule == "best" for layer in illustration.layers) > 1


def _hatched(
    illustration: Illustration, width_pt: float, height_pt: float, greys: list[GreyImage], extra: Floats | None,
    outlines: list[Strokes], device_dpi: float | None, seed: int, threads: int | None, advance: Advance,
) -> tuple[list[Strokes], Floats]:  # fmt: skip
    """The hatching of each layer, and the tone (h, w) of all together.

    greys: of each layer, (h, w). extra: (h, w) tone that is wanted besides, None for none. outlines: of each layer.
    """
    from penink_cli.blasting.blast import blast

    ink = Strokes.joined(outlines)
    total: Floats | None = None
    result = []
    by_device = _hatched_as_by_a_device(illustration, width_pt, height_pt, device_dpi, outlines, threads)
    for i, (layer, grey) in enumerate(zip(illustration.layers, greys)):
        tone = tone_curve(grey, layer.gamma)
        total = tone if total is None else np.minimum(1.0, total + tone)
        wanted = total
        if extra is not None and layer.rule == "best":
            wanted = np.clip(total + extra, 0.0, 1.0)
        if i > 0 or extra is not None:
            wanted = np.where(tone >= LEAST_TONE, wanted, 0.0)
        if layer.rule == "threshold":
            hatched = replace(by_device[i], device_dpi=device_dpi)
        else:
            hatched = blast(
                wanted, width_pt, height_pt, layer.edges, layer.texture, seed=seed + layer.seed + i,
                pen_pt=layer.pen_pt, device_dpi=device_dpi, rule=layer.rule, outlines=ink if len(ink) else None,
                directions=layer.directions and layer.directions.turned(layer.turn), lines=layer.lines,
                natural_pt=illustration.width, swell=layer.swell, solid=None if layer.color is None else SOLID,
                threads=threads,
            )  # fmt: skip
        hatched = hatched.rounded()
        ink = Strokes.joined([ink, hatched])
        result.append(hatched)
        advance(1)
    assert total is not None
    return result, total


def _hatched_as_by_a_device(
    illustration: Illustration, width_pt: float, height_pt: float, device_dpi: float | None, outlines: list[Strokes],
    threads: int | None,
) -> dict[int, Strokes]:  # fmt: skip
    """Hatching of the layers with the threshold rule, by their numbers: as a device draws it, from what it is sent."""
    numbers = [i for i, layer in enumerate(illustration.layers) if layer.rule == "threshold"]
    if not numbers:
        return {}
    from penink_cli.blasting import threshold
    from penink_cli.reconstruction.enlarge import enlarge
    from penink_cli.selfdrawing.data import as_sent, family

    layers, by = [illustration.layers[i] for i in numbers], pens.part(width_pt)
    textures = [(layer.texture, layer.pen_pt) for layer in layers]
    sheet = threshold.paper(textures, width_pt, height_pt, device_dpi, by)
    tones, edges = [], []
    for i, layer in zip(numbers, layers, strict=True):
        if len(outlines[i]):
            sheet.cover(outlines[i])
        samples, sent = as_sent(layer)
        h, w = samples.values.shape
        n, m = threshold.grid(layer.texture, layer.pen_pt, device_dpi, width_pt, height_pt, by)
        grey = enlarge(samples, sent, max(n, w), max(m, h), threads=threads)
        tones.append(threshold.in_255ths(tone_curve(grey, layer.gamma)))
        edges.append(sent)
    added = threshold.add_up(tones, [family(illustration, i) for i in numbers])
    return {
        i: threshold.blast_on(sheet, *tone, sent, layer.texture, layer.pen_pt, device_dpi, illustration.width, by)
        for i, layer, tone, sent in zip(numbers, layers, added, edges, strict=True)
    }
