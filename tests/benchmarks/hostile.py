"""What hostile input costs before it is refused: ``python -m tests.benchmarks.hostile``.

Each file is such that a careless reader takes minutes or gigabytes. Wanted: an error within 2 s and 150 MB, or a
limit that the formats' README documents.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Iterator
from pathlib import Path

from tests.conftest import environment

# in a small process of its own: a child's peak counts what its parent held
MEASURE = """
import resource, subprocess, sys
done = subprocess.run(sys.argv[1:], capture_output=True)
used = resource.getrusage(resource.RUSAGE_CHILDREN)
said = done.stderr.decode().strip().splitlines() or [""]
print(done.returncode, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024, len(said), said[0][:90], sep="\\t")
"""


def crossing(count: int) -> bytes:
    """An edge list, each edge of which crosses many others."""
    side = 1 << 20
    ends = [((k * 7919) % side, 1, (k * 104729) % side, side - 1) for k in range(count)]
    vertices = ",".join(f"[{a},{b}],[{c},{d}]" for a, b, c, d in ends)
    edges = ",".join(f"[{2 * k},{2 * k + 1}]" for k in range(count))
    head = f'{{"format":"penink-edges","version":1,"width":{side},"height":{side},'
    return f'{head}"vertices":[{vertices}],"edges":[{edges}]}}'.encode()


def files(folder: Path) -> Iterator[tuple[str, Path, list[str]]]:
    """What it is, the file, the subcommand that is to refuse it."""
    samples = folder / "samples.pgm"
    samples.write_bytes(b"P5 2 2 255\n\x00\x01\x02\x03")
    path = folder / "huge.pgm"
    path.write_bytes(b"P5 1000000000 1000000000 255\n")
    yield "a header of 10^9 x 10^9 samples", path, ["enlarge", "--scale", "2", str(path)]
    for count in (250_000, 500_000, 1_000_000):
        path = folder / "crossing.json"
        path.write_bytes(crossing(count))
        yield f"{count} crossing edges", path, ["enlarge", "--scale", "2", "-e", str(path), str(samples)]
    path = folder / "long.json"
    path.write_bytes(b'{"format":"penink-edges","version":1,"vertices":[' + b"[1,2]," * 17_000_000 + b"]}")
    yield "an edge list of 100 MB", path, ["enlarge", "--scale", "2", "-e", str(path), str(samples)]
    path = folder / "endless.jsonl"
    head = {"format": "penink-strokes", "version": 1, "width": 9, "height": 9, "unit": "pt"}
    path.write_bytes(json.dumps(head).encode() + b'\n{"w":1,"p":[' + b"1," * 50_000_000)
    yield "a strokes line of 100 MB without end", path, ["to-ps", str(path)]
    path = folder / "bomb.penink"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as bomb, bomb.open("illustration.json", "w") as member:
        for _ in range(1024):
            member.write(bytes(1 << 20))
    yield "a zip bomb of 1 GB", path, ["render", str(path)]


def main() -> None:
    print(f"{'':38} {'bytes':>10}  exit  CPU s     MB  says")
    with tempfile.TemporaryDirectory() as name:
        for what, path, arguments in files(Path(name)):
            command = [sys.executable, "-S", "-c", MEASURE, sys.executable, "-m", "penink_cli", *arguments]
            line = subprocess.run(command, capture_output=True, text=True, check=True, env=environment()).stdout
            code, seconds, peak, lines, says = line.rstrip("\n").split("\t")
            says = says.replace(f"{name}/", "")
            print(f"{what:38} {path.stat().st_size:10}  {code:>4}  {float(seconds):5.2f}  {float(peak):5.0f}  {says}"
                  + ("" if lines == "1" else f" ({lines} lines)"), flush=True)  # fmt: skip


if __name__ == "__main__":
    main()
