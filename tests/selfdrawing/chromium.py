"""A headless Chromium, driven over a pair of pipes by the DevTools protocol."""

from __future__ import annotations

import base64
import contextlib
import fcntl
import io
import json
import os
import shutil
import signal
import subprocess
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

NAMES = ("chromium-headless-shell", "chromium", "chromium-browser")
FLAGS = (
    "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update", "--disable-sync", "--remote-debugging-pipe", "--hide-scrollbars",
    "--host-resolver-rules=MAP * ~NOTFOUND",
)  # fmt: skip


class Page:
    """One page of a browser of its own; console holds what it wrote there, requests what it fetched."""

    def __init__(self, path: Path, width: int = 1024, height: int = 1024):
        name = next((n for n in NAMES if shutil.which(n)), None)
        assert name, "no Chromium: apt-get install chromium-headless-shell"
        self.profile = tempfile.mkdtemp(prefix="penink-chromium-")
        in_read, in_write = os.pipe()
        out_read, out_write = os.pipe()
        far = [fcntl.fcntl(end, fcntl.F_DUPFD, 20) for end in (in_read, out_write)]

        def connect() -> None:  # the browser reads its file 3 and writes its file 4
            os.dup2(far[0], 3)
            os.dup2(far[1], 4)

        self.process = subprocess.Popen(
            [name, *FLAGS, f"--user-data-dir={self.profile}", f"--window-size={width},{height}", "about:blank"],
            preexec_fn=connect,  # noqa: PLW1509 - no thread is running yet
            close_fds=False, start_new_session=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )  # fmt: skip
        for end in far:
            os.close(end)
        os.close(in_read)
        os.close(out_write)
        self.write, self.read = os.fdopen(in_write, "wb"), os.fdopen(out_read, "rb")
        self.buffer, self.number = b"", 0
        self.console: list[str] = []
        self.thrown: list[str] = []  # of the console, errors that no code of the page has caught
        self.requests: list[str] = []
        targets = self.call("Target.getTargets")["targetInfos"]
        target = next(t["targetId"] for t in targets if t["type"] == "page")
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")
        self.call("Emulation.setTouchEmulationEnabled", enabled=True)
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)
        self.call("Page.navigate", url=path.resolve().as_uri())
        self.until("document.body && document.body.dataset.ready === 'yes'")

    def call(self, method: str, **params: Any) -> Any:
        self.number += 1
        message = {"id": self.number, "method": method, "params": params}
        if getattr(self, "session", None):
            message["sessionId"] = self.session
        self.write.write(json.dumps(message).encode() + b"\0")
        self.write.flush()
        while True:
            answer = self._next()
            if answer.get("id") == self.number:
                assert "error" not in answer, answer["error"]
                return answer["result"]

    def _next(self) -> dict[str, Any]:
        while b"\0" not in self.buffer:
            more = self.read.read1(1 << 16)
            assert more, "the browser has gone"
            self.buffer += more
        message, self.buffer = self.buffer.split(b"\0", 1)
        event: dict[str, Any] = json.loads(message)
        params = event.get("params", {})
        match event.get("method"):
            case "Runtime.consoleAPICalled":
                self.console.append(str(params["args"]))
            case "Runtime.exceptionThrown":
                self.console.append(str(params["exceptionDetails"]))
                self.thrown.append(self.console[-1])
            case "Log.entryAdded":
                self.console.append(params["entry"]["text"])
            case "Network.requestWillBeSent":
                self.requests.append(params["request"]["url"][:200])
        return event

    def _asked(self, expression: str) -> Any:
        """The answer of the page; None where it was reloaded before it could give one."""
        try:
            return self.evaluate(expression)
        except AssertionError as error:
            if "navigated" not in str(error):
                raise
            return None

    def evaluate(self, expression: str) -> Any:
        result = self.call("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True)
        assert "exceptionDetails" not in result, result["exceptionDetails"]
        return result["result"].get("value")

    def until(self, expression: str) -> None:
        """Wait, in the page, for what the expression says."""
        while not self._asked(f"new Promise(done => requestAnimationFrame(() => done(!!({expression}))))"):
            assert not self.thrown, self.thrown

    def screenshot(self) -> np.ndarray:
        data = base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"])
        return np.asarray(Image.open(io.BytesIO(data)).convert("L"))

    def processor_ms(self) -> float:
        """Processor time of all the browser's processes so far."""
        stats = {}
        for path in Path("/proc").glob("[0-9]*/stat"):
            try:
                fields = path.read_text().rsplit(")", 1)[1].split()
            except OSError:  # it has ended
                continue
            stats[int(path.parent.name)] = int(fields[1]), int(fields[11]) + int(fields[12])
        ours, ticks = {self.process.pid}, 0
        for pid in sorted(stats):  # children are younger than their parents
            if pid in ours or stats[pid][0] in ours:
                ours.add(pid)
                ticks += stats[pid][1]
        return 1000.0 * ticks / os.sysconf("SC_CLK_TCK")

    def close(self) -> None:
        self.write.close()
        self.read.close()
        self.process.terminate()
        self.process.wait()
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self.process.pid, signal.SIGKILL)  # its helpers outlive it, and write to the profile
        for _ in range(1000):
            shutil.rmtree(self.profile, ignore_errors=True)
            if not os.path.exists(self.profile):
                break

    def __enter__(self) -> Page:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
