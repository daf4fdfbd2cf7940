"""Pages printed by two browsers: ``python -m tests.benchmarks.printing [firefox=PROGRAM] [PAGE.html …]``.

Pictures of 9 : 16, 1 : 1 and 16 : 9, or the pages named, on A4 and Letter, by Chromium and, where it is named, by
Firefox, which is driven by its Marionette protocol. Of each: how many sheets, how large the picture is on the first,
and its proportions against its own. More sheets than one, or another shape, end the run with status 1.
"""

from __future__ import annotations

import base64
import json
import shutil
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from penink_cli.ground.model import Illustration
from penink_cli.selfdrawing import html
from tests.selfdrawing.chromium import Page
from tests.selfdrawing.pictures import illustration

SHEETS = {"A4": (8.27, 11.69), "Letter": (8.5, 11.0)}  # inches
SHAPES = ((9, 16), (1, 1), (16, 9))
DPI, PORT = 50, 2929
SHAPE = 0.03  # how far proportions may be off


def by_chromium(page: Path, sheet: tuple[float, float]) -> bytes:
    with Page(page, 300, 300) as opened:
        return base64.b64decode(opened.call("Page.printToPDF", paperWidth=sheet[0], paperHeight=sheet[1])["data"])


class Firefox:
    """A Firefox with a profile of its own and without a screen."""

    def __init__(self, program: str):
        self.profile = tempfile.mkdtemp(prefix="penink-firefox-")
        Path(self.profile, "user.js").write_text(f'user_pref("marionette.port", {PORT});\n')
        self.process = subprocess.Popen(
            [program, "--headless", "--marionette", "--no-remote", "--profile", self.profile],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )  # fmt: skip
        while True:
            try:
                self.line = socket.create_connection(("127.0.0.1", PORT))
                break
            except OSError:
                assert self.process.poll() is None, "Firefox has ended"
                time.sleep(0.2)
        self.number, self.rest = 0, b""
        self._message()
        self.call("WebDriver:NewSession", capabilities={"alwaysMatch": {"acceptInsecureCerts": True}})

    def _message(self) -> Any:
        while b":" not in self.rest:
            self.rest += self.line.recv(1 << 16)
        size, _, self.rest = self.rest.partition(b":")
        while len(self.rest) < int(size):
            self.rest += self.line.recv(1 << 20)
        message, self.rest = self.rest[: int(size)], self.rest[int(size) :]
        return json.loads(message)

    def call(self, command: str, **parameters: Any) -> Any:
        self.number += 1
        text = json.dumps([0, self.number, command, parameters]).encode()
        self.line.sendall(str(len(text)).encode() + b":" + text)
        _, _, error, result = self._message()
        assert error is None, error
        return result

    def prints(self, page: Path, sheet: tuple[float, float]) -> bytes:
        self.call("WebDriver:Navigate", url=page.resolve().as_uri())
        ready = "const done = arguments[0]; (function look() { document.body.dataset.ready === 'yes' ? done(1) : \
requestAnimationFrame(look); })()"
        self.call("WebDriver:ExecuteAsyncScript", script=ready, args=[])
        cm = {"width": sheet[0] * 2.54, "height": sheet[1] * 2.54}
        return base64.b64decode(self.call("WebDriver:Print", page=cm)["value"])

    def ends(self) -> None:
        self.process.terminate()
        self.process.wait()
        self.line.close()
        shutil.rmtree(self.profile, ignore_errors=True)


@contextmanager
def browsers(program: str | None) -> Iterator[dict[str, Any]]:
    firefox = Firefox(program) if program else None
    try:
        yield {"chromium": by_chromium} | ({"firefox": firefox.prints} if firefox else {})
    finally:
        if firefox:
            firefox.ends()


def printed(pdf: bytes, folder: Path) -> tuple[int, float, float]:
    """How many sheets, and the width and height of what is on the first, inches."""
    path = folder / "printed.pdf"
    path.write_bytes(pdf)
    for old in folder.glob("sheet*.pgm"):
        old.unlink()
    command = ["gs", "-q", "-dBATCH", "-dNOPAUSE", f"-r{DPI}", "-sDEVICE=pgmraw", f"-sOutputFile={folder}/sheet%d.pgm"]
    subprocess.run([*command, str(path)], check=True, capture_output=True)
    rows, columns = np.nonzero(np.asarray(Image.open(folder / "sheet1.pgm")) < 128)
    return len(list(folder.glob("sheet*.pgm"))), (np.ptp(columns) + 1) / DPI, (np.ptp(rows) + 1) / DPI


def pages(folder: Path, named: list[str]) -> dict[Path, float]:
    """Pages, and how much wider than tall each picture is, 0 where that is not known."""
    result = {Path(name): 0.0 for name in named}
    for wide, tall in () if named else SHAPES:
        path = folder / f"{wide}x{tall}.html"
        path.write_bytes(html.write(Illustration(72 * 1.2 * wide, 72 * 1.2 * tall, illustration().layers), "picture"))
        result[path] = wide / tall
    return result


def main(arguments: list[str]) -> int:
    tools = dict(argument.split("=", 1) for argument in arguments if "=" in argument)
    bad = False
    with tempfile.TemporaryDirectory() as name, browsers(tools.get("firefox")) as known:
        folder = Path(name)
        for page, shape in pages(folder, [argument for argument in arguments if "=" not in argument]).items():
            for sheet, sides in SHEETS.items():
                for browser, prints in known.items():
                    count, wide, tall = printed(prints(page, sides), folder)
                    same = count == 1 and (not shape or abs(wide / tall / shape - 1) < SHAPE)
                    bad |= not same
                    said = f"{count} sheet{'s' * (count > 1)}, {wide:.2f} x {tall:.2f} in"
                    print(f"{page.stem:8} {sheet:7} {browser:9} {said}{'' if same else '   WRONG'}", flush=True)
    return int(bad)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
