"""``python -m tests.faults.batch PHOTOGRAPHS [WIDTHxHEIGHT]``: a night's work by ``make -j2``, twice.

Every fiftieth photograph has 12 megapixels, the others the size given. One is cut short on purpose: it must fail
alone and by name, and leave no target. The second run, from nothing, must give the same bytes.
"""

from __future__ import annotations

import hashlib
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from tests.conftest import environment

RULES = """\
PHOTOS := $(sort $(wildcard photos/*))
RUN = $(PYTHON) -m tests.faults.measured
.DELETE_ON_ERROR:
all: $(PHOTOS:photos/%.jpg=%.ps)
%.edges.json: photos/%.jpg ; $(RUN) detect-edges $< -o $@
%.full.pgm: photos/%.jpg %.edges.json ; $(RUN) extract-samples $< -e $*.edges.json -o $@
%.pgm: %.full.pgm %.edges.json ; $(RUN) reduce $< -e $*.edges.json --size 200x150 -o $@
%.strokes.jsonl: %.pgm %.edges.json
	$(RUN) enlarge $< -e $*.edges.json --scale 2 | $(RUN) blast -e $*.edges.json --texture crosshatch --width 3in -o $@
%.ps: %.strokes.jsonl ; $(RUN) to-ps $< -o $@
.SECONDARY:
"""


def photographs(folder: Path, count: int, size: tuple[int, int]) -> None:
    """Bundled photographs, turned, cut and enlarged, each another."""
    import skimage.data
    from PIL import Image

    sources = [
        Image.fromarray(getattr(skimage.data, n)()) for n in ("astronaut", "coffee", "chelsea", "rocket", "camera")
    ]
    for i in range(count):
        chance = np.random.default_rng(i)
        source = sources[i % len(sources)].convert("RGB")
        w, h = source.size
        left, top = int(chance.integers(0, w // 4)), int(chance.integers(0, h // 4))
        cut = source.crop((left, top, left + 3 * w // 4, top + 3 * h // 4)).rotate(90 * (i % 4), expand=True)
        cut.resize((4000, 3000) if i % 50 == 49 else size, Image.Resampling.BICUBIC).save(
            folder / f"{i:03}.jpg", quality=90
        )


def run(folder: Path) -> tuple[dict[str, str], str, int]:
    """Digests of what one run has made, what it said, and its status."""
    command = ["make", "-k", "-j2", "-f", "rules.mk", f"PYTHON={sys.executable}"]
    env = environment(MAKEFLAGS="", MEASURED=str(folder / "peaks"))
    done = subprocess.run(command, cwd=folder, env=env, capture_output=True, text=True, check=False)
    made = {
        p.name: hashlib.sha256(p.read_bytes()).hexdigest() for p in sorted(folder.iterdir()) if re.match(r"\d", p.name)
    }
    return made, done.stderr, done.returncode


def main(count: int, size: tuple[int, int]) -> int:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "photos").mkdir()
        (folder / "rules.mk").write_text(RULES)
        photographs(folder / "photos", count, size)
        bad = folder / "photos" / f"{count // 2:03}.jpg"
        bad.write_bytes(bad.read_bytes()[: bad.stat().st_size // 2])
        first, said, status = run(folder)
        for made in first:
            os.unlink(folder / made)
        second, _, _ = run(folder)
        pictures = [n for n in first if n.endswith(".ps")]
        complaints = [line for line in said.splitlines() if line.startswith("penink ")]
        peaks = [line.split() for line in (folder / "peaks").read_text().splitlines()]
        peak, subcommand = max((int(kib) / 1024, what) for kib, what in peaks)
        print(f"{len(pictures)} of {count} drawn; make's status {status}; complaints:", *complaints, sep="\n  ")
        print(f"second run: {'the same bytes' if first == second else 'OTHER BYTES'} in {len(first)} files")
        print(f"peak memory of a process: {peak:.0f} MB ({subcommand}), of {len(peaks)} processes")
        alone = len(complaints) == 1 and bad.name in complaints[0] and not any(n.startswith(bad.stem) for n in first)
        good = len(pictures) == count - 1 and first == second and alone and peak < 400
        print("as promised" if good else "NOT as promised")
        return 0 if good else 1


if __name__ == "__main__":
    width, _, height = (sys.argv[2] if len(sys.argv) > 2 else "900x675").partition("x")
    sys.exit(main(int(sys.argv[1]), (int(width), int(height))))
