"""Want of memory within a kernel: one line, exit 1, no output, whichever allocation it is that fails."""

from __future__ import annotations

import json
import platform
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from penink_cli.formats import edge_list, pgm
from penink_cli.ground.model import EdgeList, GreyImage
from tests.conftest import ROOT, environment

# Those whose library calls for memory itself, be it in lines of its own or in those that a .pxd has brought.
KERNELS = {
    kernel.stem
    for kernel in (ROOT / "penink_cli").glob("**/_compiled/*.pyx")
    for library in kernel.parent.glob(f"{kernel.stem}.*.so")
    if re.search(rb"\0(malloc|calloc|realloc|aligned_alloc|posix_memalign)\0", library.read_bytes())
}
TWINS = {"separable_avx2", "separable"}  # one of them runs, by processor
SEARCH = ["search", "views", "nodes", "nearby_edges", "tile", "scratch"]
EDGES = ("-e", "crowd.edges.json")
COMMANDS = [
    (["enlarge", "small.pgm", *EDGES, "--scale", "6", "--threads", "2"], [*SEARCH, "sweep"]),
    (["enlarge", "small.pgm", *EDGES, "--scale", "6", "--maxval", "65535"], [*TWINS]),
    (["enlarge", "small.pgm", *EDGES, "--scale", "0.4"], ["search"]),
    (["reduce", "small.pgm", *EDGES, "--factor", "3", "--fit", "lsq", "--photo", "small.pgm"], SEARCH),
    (["compose", "small.pgm", "--width", "1in"], ["filters"]),
    (["detect-lines", "small.pgm"], ["masks", "tracing"]),
    (["detect-edges", "small.pgm"], ["gaussian", "ridges"]),
    (["outline", "crowd.edges.json", "--width", "1in"], ["curve_fitting", "trails"]),
]


def crowd(width: int, height: int) -> EdgeList:
    """Short edges side by side, in some places many of them, which do not meet."""
    rng = np.random.default_rng(1)
    corner = np.concatenate(
        [
            np.stack(np.meshgrid(np.arange(1, width - 2, 2.0), np.arange(1, height - 2, 2.0)), -1).reshape(-1, 2),
            np.stack(np.meshgrid(np.arange(9.02, 10.9, 0.12), np.arange(9.02, 10.9, 0.12)), -1).reshape(-1, 2),
        ]
    )
    size = np.where(np.arange(len(corner)) < len(corner) - 256, 0.9, 0.05)[:, None]
    inside = ((corner > 8) & (corner < 11)).all(1) & (size[:, 0] > 0.5)
    corner, size = corner[~inside], size[~inside]
    ends = corner[:, None] + size[:, None] * rng.random((len(corner), 2, 2))
    n = len(corner)
    return EdgeList(width, height, ends.reshape(-1, 2).round(3), np.arange(2 * n).reshape(n, 2))


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    folder = tmp_path_factory.mktemp("shortage")
    shim = folder / "shortage.so"
    built = subprocess.run(
        ["cc", "-O1", "-shared", "-fPIC", "-o", shim, ROOT / "tests/faults/shortage.c", "-ldl"],
        capture_output=True, check=False,
    )  # fmt: skip
    if platform.libc_ver()[0] != "glibc":
        pytest.skip("another C library than glibc")
    assert built.returncode == 0, built.stderr
    grey = np.random.default_rng(2).integers(0, 256, (30, 40)).astype(np.uint8)
    with open(folder / "small.pgm", "wb") as out:
        pgm.write(out, GreyImage(grey))
    with open(folder / "crowd.edges.json", "wb") as out:
        edge_list.write(out, crowd(40, 30))
    (folder / "plan.json").write_text(json.dumps(COMMANDS))
    done = subprocess.run(
        [sys.executable, "-m", "tests.faults.shortage", folder],
        env=environment(LD_PRELOAD=str(shim)), capture_output=True, check=False, cwd=ROOT,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return json.loads((Path(folder) / "found.json").read_text())


def test_one_line_and_no_output(found):
    for command, kernel, n, total, status, messages, left in found:
        where = f"{command}: allocation {n} of {total} of {kernel}"
        assert (status, messages, left) == (1, f"penink {command}: not enough memory\n", []), where


def test_each_kernel_that_allocates_is_met(found):
    met = {kernel for _, kernel, *_ in found}
    assert len(KERNELS) > 10, "no libraries beside the kernels: build them in place"
    assert met >= KERNELS - TWINS and met & TWINS
    assert {(command, kernel) for command, kernel, *_ in found} >= {("enlarge", "search"), ("reduce", "scratch")}


def test_room_that_grows_is_met(found):
    """Some of a kernel's allocations are its first; these kernels have more."""
    most = {kernel: max(f[3] for f in found if f[1] == kernel) for _, kernel, *_ in found}
    assert most["views"] > 6 and most["nodes"] > 4 and most["scratch"] > 5 and most["nearby_edges"] > 18
