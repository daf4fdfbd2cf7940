#!/usr/bin/env python3
"""Write the sample photographs: ``photographs.py FOLDER [NAME …]``.

They come from scikit-image's bundled pictures, which are in the public domain or free to use
(the notes beside them name each source), so nothing is downloaded and no picture is kept here.
"""

import sys
from pathlib import Path

import numpy as np
import skimage.data
from PIL import Image

NAMES = ("astronaut", "camera", "chelsea", "coffee", "coins", "moon", "rocket")


def main() -> None:
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name in sys.argv[2:] or NAMES:
        Image.fromarray(np.asarray(getattr(skimage.data, name)())).save(folder / f"{name}.png")


if __name__ == "__main__":
    main()
