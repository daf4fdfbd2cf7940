"""Where `draw` spends its processor time, filter by filter.

Run as ``python -m tests.benchmarks.draw [stages] [watch] [canny] [against CHECKOUT] [half|two|twelve …]
[true|house …]``.
A portrait with a camera's grain, as a JPEG of half a megapixel, two and twelve, is drawn 6 in wide. Times are of the
processor, all threads together; Canny's detector of scikit-image (sigma 2) on the same photograph in the same run is
the unit beside them. The processor's time of each filter is told for one thread, for with more threads filters run at
the same time; for more threads it is told when each filter began and ended on the wall.

`canny`: twelve megapixels by all threads, on the wall from the process's start, and Canny's detector, in turn: medians
and their ratio, which is to be at most 2.5.

`watch`: seconds from the saving of a style, or of the user's strokes, until ``draw --watch`` has drawn again: on the
wall, which tells something on a quiet machine alone, and of the processor.

`against`: the same drawings by this checkout and by an older one that is built, in turn and several times, so that a
machine's other work slows both: medians, and this one's in parts of the older one's, filter by filter where one thread
draws, and the whole where all threads do.
"""

import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SIZES = {"half": (900, 600), "two": (1732, 1155), "twelve": (4242, 2828)}
HERE = Path(__file__).parents[2]
DRAWINGS = (("true", ".ps"), ("house", ".ps"), ("house", ".penink"))


def portrait(path, size):
    """A JPEG photograph of that size."""
    # imported here, so that a call of `draw` that is timed does not pay for it
    import numpy as np
    import skimage.data
    from PIL import Image

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
    """One call of `draw` in this process, told as JSON.

    spent: seconds of processor by filter, start-up and the rest beside them. spans: when each began and ended, seconds.
    """
    from penink_cli.__main__ import main as penink  # the entry point, which sets some things before anything else
    from penink_cli.chain import filters

    spent, spans = {"start": time.process_time()}, []
    run = filters.Chain.run

    def timed(self, filter_name, *rest, **named):
        start, began = time.process_time(), time.perf_counter()
        try:
            return run(self, filter_name, *rest, **named)
        finally:
            spent[filter_name] = spent.get(filter_name, 0) + time.process_time() - start
            spans.append((filter_name, began - wall, time.perf_counter() - wall))

    filters.Chain.run = timed
    wall = time.perf_counter()
    sys.argv = ["penink", "draw", "--quiet", *sys.argv[2:]]
    try:
        penink()
    except SystemExit as end:
        if end.code:
            raise
    wall = time.perf_counter() - wall
    total = time.process_time()
    spent["rest"] = total - sum(spent.values())
    json.dump({"total": total, "wall": wall, "MB": peak(), "spent": spent, "spans": spans}, sys.stdout)


def peak():
    """The most MB that this process has had; the figure of getrusage may be that of the process that started it."""
    text = Path("/proc/self/status").read_text()
    return int(text.split("VmHWM:")[1].split()[0]) / 1024


def drawn(photo, output, *options, checkout=HERE):
    """What one call in a process of its own took, and the result's bytes. checkout: whose package draws."""
    command = [sys.executable, __file__, "child", photo, "-o", output, *options]
    environment = {**os.environ, "PYTHONPATH": str(checkout)}
    done = subprocess.run(command, check=True, capture_output=True, env=environment, cwd=output.parent)
    return json.loads(done.stdout), output.read_bytes()


def stages(folder, sizes, drawings):
    for size in sizes:
        photo = folder / f"{size}.jpg"
        portrait(photo, SIZES[size])
        unit = canny(photo)
        print(f"{SIZES[size][0]} x {SIZES[size][1]} pixels; canny {unit:.2f} s")
        for style, ending in drawings:
            results = []
            for threads in (1, 2):
                options = ["--style", style, "--width", "6in", f"--threads={threads}"]
                took, result = drawn(photo, folder / f"d{ending}", *options)
                results.append(result)
                if threads == 1:
                    each = ", ".join(f"{name} {seconds:.2f}" for name, seconds in took["spent"].items())
                else:
                    each = ", ".join(f"{name} {began:.2f}-{ended:.2f}" for name, began, ended in took["spans"])
                print(f"  {style} {ending}, {threads} thread{'s' * (threads > 1)}: {took['total']:.2f} s of processor"
                      f" ({took['total'] / unit:.1f} x canny), {took['wall']:.2f} s on the wall, {took['MB']:.0f} MB\n"
                      f"    {each}", flush=True)  # fmt: skip
            if results[0] != results[1]:
                sys.exit("the threads change the bytes")


def against(folder, sizes, drawings, older):
    """This checkout beside an older one, in turn."""
    from tests.benchmarks._turns import in_turn  # not at the top: a child that is timed runs this file alone

    for size in sizes:
        photo = folder / f"{size}.jpg"
        portrait(photo, SIZES[size])
        for style, ending in drawings:
            print(f"{SIZES[size][0]} x {SIZES[size][1]} pixels, {style} {ending}: older, this, this by older")
            for way, threads in (("all threads", []), ("one thread", ["--threads=1"])):
                call = photo, folder / f"d{ending}", "--style", style, "--width", "6in", *threads
                *runs, same = in_turn(older, lambda checkout, call=call: drawn(*call, checkout=checkout))
                print(f"  {way}; {'the same bytes' if same else 'OTHER BYTES'}")
                for name in ("total", "wall", "MB", *(runs[1][0]["spent"] if threads else ())):
                    old, new = (statistics.median(_figure(one, name) for one in took) for took in runs)
                    print(f"    {name:<18}{old:8.3f}{new:8.3f}" + (f"{new / old:7.2f}" if old else ""), flush=True)


def _figure(took, name):
    """One figure of those that a call took, 0 for a filter that it has not run."""
    return took[name] if name in took else took["spent"].get(name, 0.0)


def beside_canny(folder, drawings, turns=7):
    """How long whole drawings of twelve megapixels take beside Canny's detector."""
    photo = folder / "twelve.jpg"
    portrait(photo, SIZES["twelve"])
    drawings = [drawing for drawing in drawings if drawing[1] == ".ps"]
    units, walls = [], {style: [] for style, _ in drawings}
    for _ in range(turns):
        units.append(canny(photo))
        for style, ending in drawings:
            took, _ = drawn(photo, folder / f"d{ending}", "--style", style, "--width", "6in")
            walls[style].append(took["wall"] + took["spent"]["start"])
    unit = statistics.median(units)
    print(f"  canny: {unit:.2f} s ({min(units):.2f} to {max(units):.2f})")
    for style, each in walls.items():
        wall = statistics.median(each)
        print(f"  {style}: {wall:.2f} s on the wall ({min(each):.2f} to {max(each):.2f}), {wall / unit:.2f} x canny")


SAVED = {  # what is saved, after the drawing in crosshatch
    "texture": (("form", 0.3), 3),
    "pen": (("form", 0.4), 3),
    "texture again": (("crosshatch", 0.4), 3),
    "a stroke": (("crosshatch", 0.4), 60),
}


def watch(folder):
    """How long it takes from a file's being saved to the drawing."""
    photo, drawing = folder / "half.jpg", folder / "d.svg"
    portrait(photo, SIZES["half"])

    def save(texture, pen, x):
        stages = {"compose": {}, "edges": {"high": 0.15}, "lines": {"pen": 0.9}, "directions": {}}
        stages["blast"] = {"texture": texture, "pen": pen}
        texts = {
            "my.style.json": json.dumps({"format": "penink-style", "version": 1, **stages}),
            "mine.svg": '<svg xmlns="http://www.w3.org/2000/svg" width="900" height="600">'
            f'<line x1="{x}" y1="3" x2="400" y2="500"/></svg>',
        }
        for name, text in texts.items():
            if not (folder / name).exists() or (folder / name).read_text() != text:
                (folder / "new").write_text(text)
                os.replace(folder / "new", folder / name)

    def spent(process):
        fields = Path(f"/proc/{process.pid}/stat").read_text().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def drawn_again(process, before):
        while process.poll() is None and (not drawing.exists() or drawing.stat().st_ino == before):
            time.sleep(0.005)
        if process.poll() is not None:
            sys.exit("it has ended")
        return time.perf_counter()

    save("crosshatch", 0.3, 3)
    command = [sys.executable, "-m", "penink_cli", "draw", photo, "--watch", "--quiet", "--width", "6in", "-o", drawing]
    command += ["--style", folder / "my.style.json", "--directions", folder / "mine.svg"]
    with subprocess.Popen(command) as process:
        try:
            drawn_again(process, 0)
            for name, ((texture, pen), x) in SAVED.items():
                before, processor = drawing.stat().st_ino, spent(process)
                start = time.perf_counter()
                save(texture, pen, x)
                wall = drawn_again(process, before) - start
                processor = spent(process) - processor
                print(f"  {name}: {wall:.2f} s on the wall, {processor:.2f} s of processor", flush=True)
        finally:
            process.terminate()


def main():
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)  # a package that is installed comes compiled
    if sys.argv[1:2] == ["child"]:
        child()
        return
    told = sys.argv[1:]
    older = None
    if "against" in told:
        from tests.benchmarks._turns import older_checkout

        older = older_checkout(told[told.index("against") + 1 :])
    with tempfile.TemporaryDirectory() as name:
        sizes = [size for size in SIZES if size in told] or list(SIZES)
        drawings = [drawing for drawing in DRAWINGS if drawing[0] in told] or DRAWINGS
        if older is not None:
            against(Path(name), sizes, drawings, older)
        if "canny" in told or not told:
            beside_canny(Path(name), drawings)
        if not {"watch", "against", "canny"}.intersection(told) or "stages" in told:
            stages(Path(name), sizes, drawings)
        if "watch" in told or not told:
            watch(Path(name))


if __name__ == "__main__":
    main()
