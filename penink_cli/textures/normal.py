"""Normal deviates without the C library, whose logarithm may differ in its last bit from machine to machine.

The ziggurat of Marsaglia and Tsang (2000) in 256 layers, with the same deviates from the same seeds as numpy's
generators. These call the C library for a deviate that falls beside the layers' cores.
"""

from __future__ import annotations

import functools
import math

import numpy as np

from penink_cli.ground import exact
from penink_cli.ground.model import Floats

LAYERS = 256
TAIL, AREA = 3.6541528853610087963519472518, 0.004928673233974655  # where the tail begins; the area of each layer
MANTISSA = 2**52  # steps of the mantissa of a draw


@functools.cache
def _layers() -> tuple[list[int], list[float], list[float]]:
    """Of each layer: the mantissa below which a deviate lies in the core, the width of a step, the density."""
    density = float(exact.exp(-0.5 * TAIL * TAIL))
    cores, steps, densities = [0] * LAYERS, [0.0] * LAYERS, [1.0] * LAYERS
    cores[0], steps[0] = int(TAIL / (AREA / density) * MANTISSA), AREA / density / MANTISSA
    steps[-1], densities[-1] = TAIL / MANTISSA, density
    outer = x = TAIL
    for i in range(LAYERS - 2, 0, -1):
        x = math.sqrt(-2.0 * float(exact.log(AREA / outer + float(exact.exp(-0.5 * outer * outer)))))
        cores[i + 1] = int(x / outer * MANTISSA)
        densities[i], steps[i] = float(exact.exp(-0.5 * x * x)), x / MANTISSA
        outer = x
    return cores, steps, densities


def normal(rng: np.random.Generator, deviation: float, shape: int | tuple[int, ...]) -> Floats:
    """Normal deviates of that shape, of mean 0 and that standard deviation."""
    tables = _layers()
    count = math.prod(shape) if isinstance(shape, tuple) else shape
    return deviation * np.array([_one(rng, *tables) for _ in range(count)]).reshape(shape)


def _one(rng: np.random.Generator, cores: list[int], steps: list[float], densities: list[float]) -> float:
    """A deviate of mean 0 and standard deviation 1."""
    draw = rng.bit_generator.random_raw
    while True:
        bits = int(draw())
        layer, negative, mantissa = bits & 255, bits >> 8 & 1, bits >> 9 & MANTISSA - 1
        x = mantissa * steps[layer]
        if mantissa >= cores[layer]:
            if layer == 0:
                return (1 - 2 * (bits >> 17 & 1)) * _beyond(rng)
            between = (densities[layer - 1] - densities[layer]) * rng.random() + densities[layer]
            if not between < float(exact.exp(-0.5 * x * x)):
                continue
        return -x if negative else x


def _beyond(rng: np.random.Generator) -> float:
    """A deviate above TAIL."""
    while True:
        x = -float(exact.log(1.0 - rng.random())) / TAIL
        y = -float(exact.log(1.0 - rng.random()))
        if y + y > x * x:
            return TAIL + x
