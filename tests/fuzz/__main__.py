"""``python -m tests.fuzz SECONDS [READER…]``: fuzz each reader in turn, for SECONDS of CPU in all.

What a reader stumbles over is kept in tests/data/found/READER, where an ordinary test runs it from
then on. What the fuzzer has learnt is kept in build/fuzz/READER and used by the next run.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def fuzz(reader: str, arguments: list[str]) -> None:
    """In a process of its own, since libFuzzer ends it: begin at once, and end as it says."""
    import atheris

    with atheris.instrument_imports(include=["penink_cli"]):  # so nothing of ours is imported before
        from tests.formats.readers import judge
        from tests.fuzz.seeds import seeds

        for data in seeds(reader):
            judge(reader, data)
    atheris.Setup([sys.argv[0], *arguments], lambda data: judge(reader, data))
    atheris.Fuzz()


def main() -> int:
    if sys.argv[1] == "--one":
        fuzz(sys.argv[2], sys.argv[3:])
    from tests.formats.readers import READERS
    from tests.fuzz.seeds import seeds

    seconds = int(sys.argv[1])
    readers = sys.argv[2:] or list(READERS)
    bad = []
    for reader in readers:
        corpus, found = ROOT / "build/fuzz" / reader, ROOT / "tests/data/found" / reader
        for folder in (corpus, found):
            folder.mkdir(parents=True, exist_ok=True)
        for i, data in enumerate(seeds(reader)):
            (corpus / f"seed{i}").write_bytes(data)
        print(f"== {reader}", flush=True)
        options = [f"-max_total_time={max(1, seconds // len(readers))}", "-timeout=20", "-rss_limit_mb=2000"]
        options += [f"-artifact_prefix={found}/", "-verbosity=0", "-print_final_stats=1", "-max_len=4096", str(corpus)]
        if subprocess.run(
            [sys.executable, "-m", "tests.fuzz", "--one", reader, *options], cwd=ROOT, check=False
        ).returncode:
            bad.append(reader)
    print(f"found something: {', '.join(bad)}" if bad else "nothing found")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
