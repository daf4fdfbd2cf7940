"""What composing does to each pixel, one operation of numpy after the other. All are float32."""

from __future__ import annotations

import numpy as np

F = np.float32


def root(square):
    return np.sqrt(np.maximum(square, 0))


def limited(values):
    part = values * F(1 / 0.4)
    return values / np.sqrt(1 + part * part)


def stretched(grey, low, by):
    return np.clip((grey - F(low)) * F(by), 0, 1)


def based(grey, slope, offset):
    return np.clip(slope * grey + offset, 0, 1)


def stirred(fine, broad, noise):
    band = fine - broad
    return np.maximum(0, band * band - F(noise))


def rooted(square):
    return root(square)


def weighed(activity, by):
    return F(0.25) + np.minimum(F(1.5), activity * F(by))


def lifted_by(carved, exposed, broad, key):
    return F(key) * carved * (exposed - broad) * np.clip((F(0.75) - broad) * F(1 / 0.2), 0, 1)


def without_shine(carved, broad):
    return carved * np.clip((F(0.90) - broad) * F(1 / 0.15), 0, 1)


def blanked(grey, carved, light, more, paper):
    over = np.maximum(grey - F(light), 0)
    return grey + np.minimum(F(more) * over, np.maximum(F(paper) - grey, 0)) * (1 - carved)


def sunk(grey, around):
    deep = np.clip((F(0.21) - around) * F(1 / (0.21 - 0.13)), 0, 1)
    deep *= np.clip((F(0.3) - grey) * F(1 / 0.3), 0, 1) * F(2)
    return np.maximum(grey - F(0.07) * np.minimum(deep, 1), 0)


def less_light(lights, lifted, carved):
    lights = lights - F(0.6) * np.maximum(0, lifted - F(0.12))
    return lights - F(0.4) * carved * np.maximum(0, lights - F(0.6))


def gained(usual, slope, lifted, carved, grain, coarse, gain):
    each = usual * (F(gain) * np.clip(slope, 0.8, 1.4))
    each *= 1 + F(0.35 / 0.25) * np.clip(lifted, 0, 0.25)
    each *= 1 + F(0.5) * carved
    fine = root(grain) / (root(coarse) + F(0.004))
    each *= 1 - F(1 - 0.4) * np.clip((fine - F(0.6)) * F(1 / (0.95 - 0.6)), 0, 1)
    return each


def guarded(values, variance, level, twice):
    return values * np.clip((root(variance) - F(level)) / F(twice), 0.15, 1)


def drawn(each, middle, fine):
    return limited(each * middle) + F(0.4) * each * fine


def with_room(lights, detail, squares):
    strong = root(squares)
    share = np.clip((strong - F(0.045)) / F(0.05), 0, 1)
    more = 1 + F(0.7) * share * np.clip((lights - F(0.5)) / F(0.3), 0, 1)
    result = lights - F(0.6) * share * np.maximum(0, lights - F(0.60))
    strong = strong * more
    above = np.maximum(0, result + F(1.6) * strong - 1)
    result -= above * np.clip((strong - F(0.02)) / F(0.05), 0, 1)
    below = np.maximum(0, F(0.06) - (result - strong))
    result += below * np.clip(strong / F(0.05), 0, 1)
    return result + limited(detail * more)
