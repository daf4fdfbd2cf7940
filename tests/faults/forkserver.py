"""Processes that run ``penink`` without paying for its imports: a server that has them all, and forks.

A thousand runs take 20 seconds so, instead of 7 minutes. What concerns the start of the interpreter
itself (locale, hash seed, -OO, closed descriptors) is tested with whole processes instead.
"""

from __future__ import annotations

import contextlib
import fcntl
import json
import os
import signal
import socket
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tests.conftest import ROOT


@dataclass(frozen=True)
class Result:
    """How a run ended: status as subprocess has it (negative: the signal), what it wrote, its peak memory."""

    status: int
    out: bytes
    err: bytes
    peak_kib: int


class ForkServer:
    """Runs one ``penink`` process at a time."""

    def __init__(self) -> None:
        self._socket, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        environment = {**os.environ, "PYTHONPATH": str(ROOT), "OPENBLAS_NUM_THREADS": "1"}
        command = [sys.executable, "-m", "tests.faults.forkserver", str(theirs.fileno())]
        self._server = subprocess.Popen(command, pass_fds=[theirs.fileno()], env=environment, cwd=ROOT)
        theirs.close()

    def close(self) -> None:
        self._socket.close()
        self._server.wait()

    def run(
        self,
        *arguments: object,
        stdin: bytes | int | None = None,
        stdout: int | None = None,
        cwd: Path | None = None,
        env: Mapping[str, str] | None = None,
        limits: Mapping[str, int] | None = None,
        umask: int = 0o022,
        ignore: tuple[int, ...] = (),
        kill: tuple[int, float] | None = None,
    ) -> Result:
        """Run ``penink ARGUMENTS``.

        stdin: bytes, a descriptor, or nothing at all. stdout: a descriptor, or caught. limits: by
        name (``FSIZE``). ignore: signals ignored from the start. kill: a signal, and after how many seconds.
        What it says is caught in a pipe, which no limit on the size of files cuts short.
        """
        with tempfile.TemporaryFile() as given, tempfile.TemporaryFile() as out, _Pipe() as err:
            if isinstance(stdin, bytes):
                given.write(stdin)
                given.seek(0)
            request = {
                "arguments": list(map(os.fspath, map(_path_or_text, arguments))),
                "cwd": str(cwd or ROOT),
                "env": dict(env or {}),
                "limits": dict(limits or {}),
                "umask": umask,
                "ignore": list(ignore),
            }
            standard = [stdin if isinstance(stdin, int) else given.fileno(), stdout or out.fileno(), err.writing]
            socket.send_fds(self._socket, [json.dumps(request).encode()], standard)
            process = json.loads(self._socket.recv(1 << 16))
            if kill is not None:
                number, delay = kill
                self._socket.settimeout(max(delay, 1e-6))
                try:
                    reply = self._socket.recv(1 << 16)
                except TimeoutError:
                    with contextlib.suppress(ProcessLookupError):  # it has ended this very moment
                        os.kill(process, number)
                    reply = b""
                self._socket.settimeout(None)
                reply = reply or self._socket.recv(1 << 16)
            else:
                reply = self._socket.recv(1 << 16)
            status, peak = json.loads(reply)
            out.seek(0)
            return Result(status, out.read(), err.read(), peak)


class _Pipe:
    """A pipe that holds 1 MiB, read when the process at its other end is gone, whatever that has left running."""

    def __enter__(self) -> _Pipe:
        self._reading, self.writing = os.pipe()
        fcntl.fcntl(self.writing, fcntl.F_SETPIPE_SZ, 1 << 20)
        os.set_blocking(self._reading, False)
        return self

    def read(self) -> bytes:
        """All that is in it."""
        found = []
        with contextlib.suppress(BlockingIOError):
            while part := os.read(self._reading, 1 << 20):
                found.append(part)
        return b"".join(found)

    def __exit__(self, *_: object) -> None:
        os.close(self._reading)
        os.close(self.writing)


def _path_or_text(argument: object) -> str:
    return os.fspath(argument) if isinstance(argument, os.PathLike) else str(argument)


def _child(request: dict[str, Any], standard: list[int]) -> None:
    import resource

    for place, descriptor in enumerate(standard):
        os.dup2(descriptor, place)
    os.closerange(3, 256)
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    for number in request["ignore"]:
        signal.signal(number, signal.SIG_IGN)
    signal.pthread_sigmask(signal.SIG_SETMASK, ())
    os.umask(request["umask"])
    os.chdir(request["cwd"])
    os.environ.update(request["env"])
    for name, value in request["limits"].items():
        resource.setrlimit(getattr(resource, f"RLIMIT_{name}"), (value, value))
    sys.argv = ["penink", *request["arguments"]]
    from penink_cli.__main__ import main

    main()


def _serve(connection: socket.socket) -> None:
    import importlib
    import pkgutil

    import penink_cli.commands
    import penink_cli.main

    for module in pkgutil.walk_packages(penink_cli.__path__, "penink_cli."):
        if not module.name.endswith("__main__"):
            importlib.import_module(module.name)
    import PIL.Image

    PIL.Image.init()
    while True:
        message, standard, _, _ = socket.recv_fds(connection, 1 << 16, 3)
        if not message:
            return
        signal.pthread_sigmask(signal.SIG_BLOCK, signal.valid_signals())  # until the child has said what they do
        child = os.fork()
        if not child:
            status = 70
            try:
                _child(json.loads(message), standard)
            except SystemExit as stop:
                status = stop.code if isinstance(stop.code, int) else 0 if stop.code is None else 1
            except BaseException:
                sys.excepthook(*sys.exc_info())
            finally:
                sys.stderr.flush()
                os._exit(status)
        signal.pthread_sigmask(signal.SIG_SETMASK, ())
        for descriptor in standard:
            os.close(descriptor)
        connection.send(json.dumps(child).encode())
        _, status, usage = os.wait4(child, 0)
        connection.send(json.dumps([os.waitstatus_to_exitcode(status), usage.ru_maxrss]).encode())


if __name__ == "__main__":
    _serve(socket.socket(fileno=int(sys.argv[1])))
