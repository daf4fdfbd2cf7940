"""Pictures of the outputs by other people's renderers, and how far two of them differ."""

import io
import subprocess

import numpy as np
from PIL import Image
from scipy.ndimage import gaussian_filter


def ghostscript(file, dpi, exact=True, *options):
    """Grey picture (h, w) 0 … 255 of a PS, EPS or PDF; any warning fails.

    exact: pixels count where their middle is inked; Ghostscript's usual rule counts all that ink touches, as printers
    do, which at 4 × 4 subpixels widens every stroke by a quarter of a pixel.
    """
    command = ["gs", "-dSAFER", "-q", "-dBATCH", "-dNOPAUSE", "-sDEVICE=pgmraw", f"-r{dpi}", "-dGraphicsAlphaBits=4"]
    rule = ["-c", "0 0 .setfilladjust2"] if exact else []
    command += [*options, "-sOutputFile=-", *rule, "-f", str(file)]
    done = subprocess.run(command, capture_output=True, check=False)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr
    assert not done.stderr, done.stderr
    assert done.stdout.startswith(b"P5"), done.stdout[:300]  # Ghostscript's complaints would come first
    return pixels(done.stdout)


def pixels(image):
    """Grey values (h, w) of the bytes of an image file."""
    return np.asarray(Image.open(io.BytesIO(image)).convert("L"), float)


def difference(one, other, dpi):
    """RMS difference in % of full scale after a low-pass of 1/16 inch."""
    h, w = (min(a, b) for a, b in zip(one.shape, other.shape))
    low = gaussian_filter(one[:h, :w] - other[:h, :w], dpi / 16)
    return float(np.sqrt(np.mean(low**2)) / 2.55)
