"""Each filter by this checkout and by an older one: ``python -m tests.benchmarks.against CHECKOUT [NAME …]``.

CHECKOUT is another worktree whose kernels this interpreter has built. Both checkouts do the same with the same files,
in turn, so that a machine's other work slows both. Printed are the median of each one's processor time, starting Python
included, and this one's in parts of the older one's. NAMEs are those of the table's first column. `draw` is measured so
by `python -m tests.benchmarks.draw against`.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

from tests.benchmarks._turns import in_turn, older_checkout

CALLS = {
    "enlarge": "enlarge -e e.json --scale 4 samples.pgm -o out",
    "enlarge 16 bits": "enlarge -e e.json --scale 4 --maxval 65535 samples.pgm -o out",
    "reduce": "reduce -e e.json --factor 4 clean.pgm -o out",
    "reduce lsq": "reduce -e e.json --factor 4 --fit lsq --photo photo.pgm clean.pgm -o out",
    "detect-edges": "detect-edges photo.pgm -o out",
    "extract-samples": "extract-samples -e e.json photo.pgm -o out",
    "blast crosshatch": "blast -e e.json --width 6in --texture crosshatch photo.pgm -o out",
    "blast stipple": "blast -e e.json --width 6in --texture stipple photo.pgm -o out",
    "blast brick": "blast -e e.json --width 6in --texture brick photo.pgm -o out",
    "to-ps": "to-ps hatching.jsonl -o out",
    "to-svg": "to-svg hatching.jsonl -o out",
    "to-pgm": "to-pgm --dpi 150 hatching.jsonl -o out",
    "outline": "outline --width 6in e.json -o out",
}
INPUTS = (
    "detect-edges photo.pgm -o e.json",
    "extract-samples -e e.json photo.pgm -o clean.pgm",
    "reduce -e e.json --factor 4 clean.pgm -o samples.pgm",
    "blast -e e.json --width 6in --texture crosshatch photo.pgm -o hatching.jsonl",
)


def ran(checkout: Path, call: str, folder: Path) -> float:
    """Seconds of processor that a call of penink takes by the package of a checkout."""
    environment = {**os.environ, "PYTHONPATH": str(checkout)}
    process = subprocess.Popen(
        [sys.executable, "-m", "penink_cli", *call.split()], cwd=folder, env=environment, stderr=subprocess.PIPE
    )
    assert process.stderr is not None
    said = process.stderr.read().decode()
    _, status, usage = os.wait4(process.pid, 0)
    if status:
        sys.exit(f"{checkout}: penink {call}: {said}")
    return usage.ru_utime + usage.ru_stime


def main() -> None:
    """Print the table."""
    import skimage.data
    from PIL import Image

    told = sys.argv[1:]
    older = older_checkout(told)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        face = Image.fromarray(skimage.data.astronaut()).convert("L")
        face.resize((768, 768), Image.Resampling.BICUBIC).save(folder / "photo.pgm")
        for call in INPUTS:
            ran(older, call, folder)  # both checkouts can read what the older one writes
        print(f"{'':<18}{'older s':>9}{'this s':>9}{'this by older':>15}")
        for what in told[1:] or CALLS:

            def once(checkout: Path, call: str = CALLS[what]) -> tuple[float, bytes]:
                return ran(checkout, call, folder), (folder / "out").read_bytes()

            *taken, same = in_turn(older, once)
            old, new = map(statistics.median, taken)
            print(f"{what:<18}{old:9.3f}{new:9.3f}{new / old:15.3f}{'' if same else '  other bytes'}", flush=True)


if __name__ == "__main__":
    main()
