"""The numbers by which a picture that draws itself draws, here, on a printer and on a page: one source for all three.

`screens`, `threshold`, `outlines` and their kernels take them from here; `selfdrawing.constants` writes them as the
prologue of the renderers in PostScript and JavaScript. Lengths are points, or units of a pen magnified with its tile.
"""

from __future__ import annotations

#: Lines of a hatching screen, one above the other; their number is a power of two.
LINES = 256
#: Size of a hatching screen's tile.
ALONG, ACROSS = 288.0, 100.0
#: Coverage of a screen with parts of its lines, piecewise linear (measured): half of them do not touch one another.
PARTS, COVERS = (0.0, 0.5, 0.63, 0.75, 1.0), (0.0, 0.6912, 0.845, 0.943, 0.995)
#: A stroke of a line is at least so long, and what is left of the line joins it if that is shorter than the rest.
LONG, LONG_REST = 42.0, 30.0
#: How far the ends of a stroke, and the control points between them, may lie off the line.
TILT, BOW = 0.1, 0.15
#: Steps a point in which it is kept how far a line gives way, and what part of the way it goes a sample.
WAY_STEPS, GIVE = 24.0, 0.2
#: Random numbers: a congruence that 32-bit signed integers can hold, and its first states.
CHAIN_FACTOR, CHAIN_STEP = 25173, 13849
SEED, SEED_STEP = 4711, 97
#: A hand's waver, two waves: how far, and radians a point along and across the line.
WAVER = (0.3, 0.09, 0.03, 0.2, 0.21, -0.05)
#: The grain of wood, of parts of its depth: how far, divisor of the way across; how far, times along, divisor across.
WAVE = (0.4, 3.0, 0.15, 1.7, 5.0)
#: Strokes are sampled about so often.
SAMPLE = 1.5
#: Runs bridge so many samples of too little tone; shorter ones than `SHORT` samples are left out, unless tone exceeds
#: the threshold by more than `DEEP` 255ths somewhere.
GAP, SHORT, DEEP = 3, 3.0, 24.0
#: From one sample to the next tone falls by more than so many 255ths: there is an edge to end at.
STEEP = 10.0
#: By how many pens a run ends before the place where tone reaches its threshold.
EARLY = 0.4
#: Side of the blocks in which ink is compared with tone; a stroke is looked at once for each patch it passes.
BLOCK, PATCH = 9.0, 18.0
#: Of textures that are not lines half of what is lacking in a block is chance, and more easily added than taken away:
#: all of it fed back, scribble on coins was 1.1 % too dark, now 0.3.
TAKEN_UP = 0.5
#: The pixel of a device of 600 dpi, which tables are meant for, and what it adds to a pen, roughly (0.146 to a dot of
#: 0.4, 0.15 to a line): 0.54 is the effective width of a pen of 0.4 on it.
PIXEL = 72 / 600
WIDENED = 0.14
#: The finest pen, in device pixels with its gain, that is painted as wide as it should be: what is left of a thinner
#: one when the gain is taken off is under one pixel, and that is painted without gain.
LEAST_PIXELS = 2.45
#: Outline strokes keep so many pens' widths from one another; what is shorter than so many is a crumb.
CLEAR, SHORTEST = 1.8, 4.0
#: The longest piece of one width; the width at a tip in parts of the full one; the way from one to the other.
PIECE, THIN, TAPER = 4.0, 0.55, 14.0
#: The pressure's variation along a stroke, up and down, and over about which length.
PRESSURE, PRESSURE_LONG = 0.16, 30.0
