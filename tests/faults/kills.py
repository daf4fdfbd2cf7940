"""``python -m tests.faults.kills RUNS``: whole processes killed at random moments, as a batch would be.

Each run replaces a file. After each the file must be the old one or the new one, byte for byte, and after the
next run that is left alone nothing may lie beside it.
"""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

from tests.conftest import environment
from tests.faults.calls import arguments, make_inputs

NAMES = ("reduce", "enlarge", "blast", "to-ps", "detect-edges", "to-pdf")
SIGNALS = (signal.SIGKILL, signal.SIGKILL, signal.SIGTERM, signal.SIGINT, signal.SIGHUP)


def main(runs: int) -> int:
    chance = random.Random(8)
    seen: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "in").mkdir()
        (folder / "out").mkdir()
        make_inputs(folder / "in")
        env = environment()
        commands, new, took = {}, {}, {}
        for subcommand in NAMES:
            commands[subcommand] = [sys.executable, "-m", "penink_cli", *arguments(subcommand, folder / "in")]
            start = time.monotonic()
            new[subcommand] = subprocess.run(commands[subcommand], env=env, capture_output=True, check=True).stdout
            took[subcommand] = time.monotonic() - start
        for run in range(runs):
            subcommand, number = chance.choice(NAMES), chance.choice(SIGNALS)
            out = folder / "out" / subcommand
            out.write_bytes(b"old")
            process = subprocess.Popen([*commands[subcommand], "-o", str(out)], env=env, stderr=subprocess.PIPE)
            try:
                process.wait(chance.uniform(0, 1.2 * took[subcommand]))
            except subprocess.TimeoutExpired:
                process.send_signal(number)
            _, err = process.communicate()
            found = out.read_bytes()
            if found not in (b"old", new[subcommand]):
                print(f"run {run}: {subcommand}, {number.name}: torn, {len(found)} bytes")
                return 1
            # Before the interpreter has come to our first line, Ctrl-C is its own affair.
            if err and not (number == signal.SIGINT and b"KeyboardInterrupt" in err):
                print(f"run {run}: {subcommand}, {number.name}: said {err[-300:]!r}")
                return 1
            status = process.returncode
            seen["ended by itself" if status >= 0 else signal.Signals(-status).name] += 1
            seen["new file"] += found != b"old"
            seen["left a temporary file"] += any(n.startswith(".penink-") for n in os.listdir(folder / "out"))
            if err:
                seen["interrupted in the interpreter's own start"] += 1
        subprocess.run([*commands["to-ps"], "-o", str(folder / "out/to-ps")], env=env, check=True)
        stray = [n for n in os.listdir(folder / "out") if n not in NAMES]
        print(f"{runs} runs: " + ", ".join(f"{what} {count}" for what, count in sorted(seen.items())))
        print(f"torn: 0; stray files after the next run: {len(stray)}")
        return 1 if stray else 0


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1])))
