"""Where `draw` spends its processor time, filter by filter.

Run as ``python -m tests.benchmarks.draw [stages] [half|two|twelve …]``. A portrait with a camera's grain, as a JPEG of
half a megapixel, two and twelve, is drawn 6 in wide. Times are of the processor, all threads together; Canny's detector
of scikit-image (sigma 2) on the same photograph in the same run is the unit beside them.
"""

import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import skimage.data
from PIL import Image

SIZES = {"half": (900, 600), "two": (1732, 1155), "twelve": (4242, 2828)}
STYLES = ("true", "house")


def portrait(path, size):
    """A JPEG photograph of that size."""
    face = Image.fromarray(skimage.data.astronaut()[85:427])
    values = np.asarray(face.resize(size, Image.Resampling.BICUBIC), float)
    noise = np.random.default_rng(0).normal(0, 3, values.shape)
    Image.fromarray(np.clip(values + noise, 0, 255).astype(np.uint8)).save(path, quality=92)


def canny(path):
    """Seconds of processor of Canny's detector, in a process that has done it before on little."""
    code = """if True:
        import sys, time, numpy as np
        from PIL import Image
        from skimage.feature import canny
        canny(np.eye(64), 2)
        grey = np.asarray(Image.open(sys.argv[1]).convert("L")) / 255
        start = time.process_time()
        canny(grey, 2)
        print(time.process_time() - start)"""
    return float(subprocess.run([sys.executable, "-c", code, path], check=True, capture_output=True).stdout)


def child():
    """One call of `draw` in this process; prints what each filter took, start-up and the rest beside them, as JSON."""
    from penink_cli.commands import chain
    from penink_cli.main import penink

    spent = {"start": time.process_time()}
    run = chain.Chain.run

    def timed(self, filter_name, *rest, **named):
        start = time.process_time()
        try:
            return run(self, filter_name, *rest, **named)
        finally:
            spent[filter_name] = spent.get(filter_name, 0) + time.process_time() - start

    chain.Chain.run = timed
    wall = time.perf_counter()
    penink.main(["draw", "--quiet", *sys.argv[2:]], standalone_mode=False)
    wall = time.perf_counter() - wall
    total = time.process_time()
    spent["rest"] = total - sum(spent.values())
    json.dump({"total": total, "wall": wall, "MB": peak(), "spent": spent}, sys.stdout)


def peak():
    """MB that this process has had at the most; what getrusage says may be those of the process that started it."""
    text = Path("/proc/self/status").read_text()
    return int(text.split("VmHWM:")[1].split()[0]) / 1024


def drawn(photo, output, *options):
    """What one call in a process of its own took, and the result's bytes."""
    command = [sys.executable, "-m", "tests.benchmarks.draw", "child", photo, "-o", output, *options]
    done = subprocess.run(command, check=True, capture_output=True)
    return json.loads(done.stdout), output.read_bytes()


def stages(folder, sizes):
    for size in sizes:
        photo = folder / f"{size}.jpg"
        portrait(photo, SIZES[size])
        unit = canny(photo)
        print(f"{SIZES[size][0]} x {SIZES[size][1]} pixels; canny {unit:.2f} s")
        for style in STYLES:
            results = []
            for threads in (1, 2):
                took, result = drawn(photo, folder / "d.ps", "--style", style, "--width", "6in", f"--threads={threads}")
                results.append(result)
                each = ", ".join(f"{name} {seconds:.2f}" for name, seconds in took["spent"].items())
                print(f"  {style}, {threads} thread{'s' * (threads > 1)}: {took['total']:.2f} s of processor"
                      f" ({took['total'] / unit:.1f} x canny), {took['wall']:.2f} s on the wall, {took['MB']:.0f} MB\n"
                      f"    {each}", flush=True)  # fmt: skip
            if results[0] != results[1]:
                sys.exit("the threads change the bytes")


def main():
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)  # a package that is installed comes compiled
    if sys.argv[1:2] == ["child"]:
        child()
        return
    told = sys.argv[1:]
    with tempfile.TemporaryDirectory() as name:
        sizes = [size for size in SIZES if size in told] or list(SIZES)
        stages(Path(name), sizes)


if __name__ == "__main__":
    main()
