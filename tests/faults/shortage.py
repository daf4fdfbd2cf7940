"""Run subcommands while one allocation of one kernel fails; `shortage.c` must be preloaded. See test_shortage.py.

``python -m tests.faults.shortage FOLDER`` reads from FOLDER/plan.json a list of commands, and for each the kernels
to watch. It writes FOLDER/found.json: for each command and kernel how many allocations there are, and what became of
the command as some of them failed, one at a time: the first few, some between, and the last.
"""

from __future__ import annotations

import ctypes
import importlib
import json
import os
import sys
from pathlib import Path

FIRST, BETWEEN = 8, 5  # of the allocations of a kernel that fail


def run(command: list[str], kernel: str, n: int) -> tuple[int, str, list[str], int]:
    """Exit status, messages, what lies in the folder of outputs, and how many allocations there were."""
    out = Path("out")
    out.mkdir(exist_ok=True)
    for old in out.iterdir():
        old.unlink()
    child = os.fork()
    if not child:
        status = 70
        try:
            messages = os.open("messages", os.O_RDWR | os.O_CREAT | os.O_TRUNC)
            os.dup2(messages, 2)
            from penink_cli.main import _run

            shim.shortage_of(f"/_compiled/{kernel}.".encode(), n)
            status = _run([*command, "-o", "out/result"])
            sys.stderr.flush()
            Path("count").write_text(str(shim.shortage_seen()))
        finally:
            os._exit(status)
    ended = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    count = Path("count")
    seen = int(count.read_text()) if count.exists() else 0
    count.unlink(missing_ok=True)
    return ended, Path("messages").read_text(), sorted(p.name for p in out.iterdir()), seen


def some(total: int) -> list[int]:
    """Which allocations fail."""
    between = (FIRST + (total - FIRST) * k // (BETWEEN + 1) for k in range(1, BETWEEN + 1))
    return sorted({n for n in (*range(1, FIRST + 1), *between, total) if 0 < n <= total})


def main() -> None:
    """Do what plan.json says."""
    os.chdir(sys.argv[1])
    found = []
    for command, kernels in json.loads(Path("plan.json").read_text()):
        for kernel in kernels:
            status, messages, _, total = run(command, kernel, 0)
            assert (status, messages) == (0, ""), (command, status, messages)
            for n in some(total):
                status, messages, left, seen = run(command, kernel, n)
                if seen >= n:  # two threads need less room one time than another: so many may not be asked for
                    found.append([command[0], kernel, n, total, status, messages, left])
    Path("found.json").write_text(json.dumps(found))


if __name__ == "__main__":
    import pkgutil

    import penink_cli.commands

    # Once, and not in each child.
    for room in ("reconstruction", "formats", "composition", "lines", "blasting", "arrangement"):
        for module in pkgutil.walk_packages([f"{penink_cli.__path__[0]}/{room}"], f"penink_cli.{room}."):
            if "_compiled" not in module.name:
                importlib.import_module(module.name)
    for name in ("enlarge", "reduce", "compose", "detect_lines", "detect_edges", "outline"):
        importlib.import_module(f"penink_cli.commands.{name}")
    shim = ctypes.CDLL(None)
    shim.shortage_of.argtypes = (ctypes.c_char_p, ctypes.c_long)
    shim.shortage_seen.restype = ctypes.c_long
    main()
