"""Snakemake and make over one small folder of photographs: the same files, byte by byte.

Run as ``python -m tests.benchmarks.workflow``. Snakemake has many dependencies, so it is installed into a virtual
environment of its own in build/snakemake, unless SNAKEMAKE names the program.
"""

import os
import stat
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image

ROOT = Path(__file__).parents[2]


def snakemake():
    """The program, installed if need be."""
    if "SNAKEMAKE" in os.environ:
        return os.environ["SNAKEMAKE"]
    home = ROOT / "build" / "snakemake"
    if not (home / "bin" / "snakemake").exists():
        print("   installing snakemake in", home.relative_to(ROOT), flush=True)
        subprocess.run([sys.executable, "-m", "venv", home], check=True)
        subprocess.run([home / "bin" / "python", "-m", "pip", "install", "--quiet", "snakemake"], check=True)
    return str(home / "bin" / "snakemake")


def main():
    program = snakemake()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        penink = folder / "penink"
        penink.write_text(f'#!/bin/sh\nPYTHONPATH={ROOT} exec "{sys.executable}" -m penink_cli "$@"\n')
        penink.chmod(penink.stat().st_mode | stat.S_IXUSR)
        for out in ("photos", "made"):
            (folder / out).mkdir()
            y, x = np.mgrid[:48, :64]
            for i, kind in enumerate(("png", "jpg")):
                picture = np.where((x - 30) ** 2 + (y - 24) ** 2 < 150 + 100 * i, 60, 200) + x // 2
                Image.fromarray(picture.astype(np.uint8)).save(folder / out / f"a picture{i}.{kind}".replace(" ", "-"))
        environment = {**os.environ, "PATH": f"{folder}:{os.environ['PATH']}", "HOME": str(folder)}
        options = ["--cores", "2", "--quiet", "all", "--config", "photos=photos", "out=drawn", "blast=--width 1in"]
        command = [program, "--snakefile", ROOT / "samples" / "Snakefile", *options]
        done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
        if done.returncode:
            sys.exit(done.stdout + done.stderr)
        (folder / "Makefile").write_text(f"include {ROOT}/samples/penink.mk\n")
        goals = [f"made/a-picture{i}.ps" for i in range(2)]
        subprocess.run(["make", "-s", "BLAST=--width 1in", *goals], cwd=folder, env=environment, check=True)
        drawn = sorted(p for p in (folder / "drawn").iterdir() if p.is_file())
        equal = [p.read_bytes() == (folder / "made" / p.name).read_bytes() for p in drawn]
        print(f"Snakemake and make on two photographs: {sum(equal)} of {len(equal)} files are the same bytes")
        if not all(equal) or len(equal) != 12:
            sys.exit("they differ")


if __name__ == "__main__":
    main()
