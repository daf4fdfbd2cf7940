"""Layers drawn together: their tones add up to the picture's, along their common borders too."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from penink_cli.ground.model import EdgeList, GreyImage, Illustration, Layer, OutlineChoice, Strokes
from penink_cli.illustration import layering
from penink_cli.options.textures import find_texture
from tests.blasting import measures


def two_layers(side: int = 48) -> tuple[Illustration, np.ndarray]:
    """A dark ring, hatched and outlined, on a stippled ground that its shadow darkens; the tone (h, w) of both."""
    y, x = (np.mgrid[0:side, 0:side] + 0.5) / side
    within = np.abs(np.hypot(x - 0.45, y - 0.45) - 0.22) < 0.03
    tone = np.where(within, 0.55, 0.06 + 0.3 * np.exp(-(np.hypot(x - 0.6, y - 0.6) ** 2) / 0.04))
    turn = np.arange(48) * np.pi / 24
    around = np.column_stack([np.cos(turn), np.sin(turn)])
    ends = np.column_stack([np.arange(48), (np.arange(48) + 1) % 48])
    circles = EdgeList(
        side, side, side * (0.45 + np.concatenate([0.25 * around, 0.19 * around])), np.concatenate([ends, ends + 48])
    )
    layers = tuple(
        Layer(GreyImage.from_grey(1 - np.where(part, tone, 0.0), 255), circles, find_texture(texture), outline=outline)
        for part, texture, outline in ((~within, "stipple", None), (within, "crosshatch", OutlineChoice(0.84)))
    )
    return Illustration(144, 144, layers), tone


def left_over(illustration: Illustration, tone: np.ndarray) -> float:
    """The mean of four hands: one's may be off by a tenth."""
    drawings = [
        Strokes.joined([part for pair in layering.layer_strokes(illustration, 144.0, seed=100 * hand) for part in pair])
        for hand in range(4)
    ]
    return float(np.mean([measures.tone_figures(strokes, tone)[0] for strokes in drawings]))


def test_what_is_left_over_along_a_common_border_is_fed_back(monkeypatch):
    illustration, tone = two_layers()
    together = left_over(illustration, tone)
    monkeypatch.setattr(layering, "ROUNDS", 1)
    assert together < 0.9
    assert together < 0.9 * left_over(illustration, tone)


def test_it_advances_as_often_as_it_says():
    illustration, _ = two_layers(24)
    for layers in (illustration.layers, illustration.layers[:1]):
        some = Illustration(36, 36, layers)
        steps: list[int] = []
        layering.layer_strokes(some, 36.0, advance=steps.append)
        assert sum(steps) == layering.steps(some)


def in_colours(illustration: Illustration, *colours: str | None) -> Illustration:
    layers = tuple(replace(layer, color=color) for layer, color in zip(illustration.layers, colours, strict=True))
    return replace(illustration, layers=layers)


def test_inks_of_different_colours_know_nothing_of_each_other():
    illustration, _ = two_layers(24)
    apart = layering.layer_strokes(in_colours(illustration, "#00aeef", None), 72.0)
    alone = [
        layering.layer_strokes(Illustration(144, 144, (layer,)), 72.0, seed=i)[0]
        for i, layer in enumerate(illustration.layers)
    ]
    for pair, expected, color in zip(apart, alone, ("#00aeef", None), strict=True):
        for one, other in zip(pair, expected, strict=True):
            assert np.array_equal(one.points, other.points)
            assert one.color == color
    together = layering.layer_strokes(illustration, 72.0)
    assert not np.array_equal(together[1][0].points, apart[1][0].points)
    black = layering.layer_strokes(in_colours(illustration, "#000000", None), 72.0)
    assert np.array_equal(together[1][0].points, black[1][0].points)


def test_a_layer_alone_is_drawn_with_its_colour_only():
    illustration, _ = two_layers(24)
    coloured = in_colours(illustration, "#00aeef", None)
    every = layering.layer_strokes(coloured, 72.0)
    steps: list[int] = []
    only = layering.layer_strokes(coloured, 72.0, chosen=[1], advance=steps.append)
    assert len(only) == 1
    assert np.array_equal(only[0][0].points, every[1][0].points)
    assert sum(steps) == layering.steps(coloured, [1]) == 1
