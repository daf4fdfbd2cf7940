"""What every subcommand does with its output, and what can be wrong with it."""

from __future__ import annotations

import errno
import os
import signal
import stat
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from tests.conftest import environment
from tests.faults.calls import CALLS, arguments
from tests.faults.forkserver import ForkServer

every = pytest.mark.parametrize("name", CALLS)
readers = pytest.mark.parametrize("name", [name for name, call in CALLS.items() if call.reads])


def one_line(err: bytes, name: str) -> str:
    """The one error line, after ``penink NAME: ``."""
    name = {"texture": "texture make", "style": "style show"}.get(name, name)
    text = err.decode()
    assert text.startswith(f"penink {name}: ") and text.endswith("\n") and text[:-1].isprintable(), text
    assert "internal error" not in text
    return text.removeprefix(f"penink {name}: ")[:-1]


@pytest.fixture(scope="session")
def expected(server: ForkServer, inputs: Path) -> dict[str, bytes]:
    """What each subcommand writes when nothing is wrong."""
    found = {}
    for name in CALLS:
        done = server.run(*arguments(name, inputs))
        assert (done.status, done.err) == (0, b"") and done.out, (name, done)
        found[name] = done.out
    return found


@readers
def test_a_file_a_dash_and_nothing_at_all_are_the_same(name, server, inputs, expected):
    given = (inputs / CALLS[name].reads).read_bytes()
    words = arguments(name, inputs, by_name=False)
    assert server.run(*words, stdin=given, cwd=inputs).out == expected[name]
    assert server.run(*words, "-", stdin=given, cwd=inputs).out == expected[name]
    assert server.run(*words, "-o", "-", stdin=given, cwd=inputs).out == expected[name]
    reading, writing = os.pipe()
    writer = threading.Thread(target=lambda: (os.write(writing, given), os.close(writing)))
    writer.start()
    assert server.run(*words, stdin=reading, cwd=inputs).out == expected[name]
    writer.join()
    os.close(reading)


@every
def test_a_file_of_that_name_holds_the_same_and_nothing_else_is_left(name, server, inputs, expected, tmp_path):
    done = server.run(*arguments(name, inputs), "-o", tmp_path / "out", umask=0o027)
    assert (done.status, done.out, done.err) == (0, b"", b"")
    assert (tmp_path / "out").read_bytes() == expected[name] and os.listdir(tmp_path) == ["out"]
    assert stat.S_IMODE((tmp_path / "out").stat().st_mode) == 0o640


@every
def test_links_fifos_and_devices(name, server, inputs, expected, tmp_path):
    (tmp_path / "target").write_bytes(b"old")
    (tmp_path / "link").symlink_to("target")
    os.mkfifo(tmp_path / "fifo")
    assert server.run(*arguments(name, inputs), "-o", tmp_path / "link").status == 0
    assert (tmp_path / "link").is_symlink() and (tmp_path / "target").read_bytes() == expected[name]
    got: list[bytes] = []
    reader = threading.Thread(target=lambda: got.append((tmp_path / "fifo").read_bytes()))
    reader.start()
    assert server.run(*arguments(name, inputs), "-o", tmp_path / "fifo").status == 0
    reader.join()
    assert got == [expected[name]] and stat.S_ISFIFO((tmp_path / "fifo").stat().st_mode)
    assert server.run(*arguments(name, inputs), "-o", "/dev/null").status == 0
    assert stat.S_ISCHR(os.stat("/dev/null").st_mode)
    assert sorted(os.listdir(tmp_path)) == ["fifo", "link", "target"]


@every
def test_no_room(name, server, inputs, expected, tmp_path):
    """A full device, and a limit on the size of files: an error, and the old file."""
    with open("/dev/full", "wb") as full:
        done = server.run(*arguments(name, inputs), stdout=full.fileno())
    assert done.status == 1
    assert one_line(done.err, name) == f"<stdout>: cannot be written: {os.strerror(errno.ENOSPC)}"
    done = server.run(*arguments(name, inputs), "-o", "/dev/full")
    assert one_line(done.err, name) == f"/dev/full: cannot be written: {os.strerror(errno.ENOSPC)}"
    (tmp_path / "out").write_bytes(b"old")
    done = server.run(*arguments(name, inputs), "-o", tmp_path / "out", limits={"FSIZE": len(expected[name]) - 1})
    assert done.status == 1 and not done.out
    assert one_line(done.err, name) == f"{tmp_path}/out: cannot be written: {os.strerror(errno.EFBIG)}"
    assert (tmp_path / "out").read_bytes() == b"old" and os.listdir(tmp_path) == ["out"]


@every
def test_outputs_that_cannot_be(name, server, inputs, tmp_path):
    for path, why in ((tmp_path, errno.EISDIR), (tmp_path / "no/where", errno.ENOENT), ("/dev/null/x", errno.ENOTDIR)):
        done = server.run(*arguments(name, inputs), "-o", path)
        assert done.status == 1 and not done.out and os.strerror(why) in one_line(done.err, name)
    assert os.listdir(tmp_path) == []


@every
def test_a_reader_that_leaves(name, server, inputs):
    """Death by SIGPIPE, in silence, also where the caller has SIGPIPE ignored."""
    for ignore in ((), (signal.SIGPIPE,)):
        reading, writing = os.pipe()
        os.close(reading)
        done = server.run(*arguments(name, inputs), stdout=writing, ignore=ignore)
        os.close(writing)
        assert (done.status, done.err) == (-signal.SIGPIPE, b"")


@readers
def test_inputs_that_cannot_be(name, server, inputs, tmp_path):
    (tmp_path / "out").write_bytes(b"old")
    for path, why in ((tmp_path, errno.EISDIR), (tmp_path / "none", errno.ENOENT), ("/proc/self/mem", errno.EIO)):
        done = server.run(*arguments(name, inputs, by_name=False), path, "-o", tmp_path / "out")
        assert done.status == 1 and not done.out
        assert os.strerror(why) in (line := one_line(done.err, name)) and line.startswith(str(path))
    assert (tmp_path / "out").read_bytes() == b"old" and os.listdir(tmp_path) == ["out"]


@readers
@pytest.mark.parametrize("cut", [0, 0.02, 0.5, 0.97])
def test_an_input_cut_short_gives_no_byte_of_output(name, server, inputs, expected, tmp_path, cut):
    (tmp_path / "out").write_bytes(b"old")
    given = (inputs / CALLS[name].reads).read_bytes()
    end = int(cut * len(given))
    if CALLS[name].reads == "photo.png":
        end = min(end, given.index(b"IEND") - 9)  # what is behind its pixels may be missing
    for extra in ([], ["-o", tmp_path / "out"]):
        done = server.run(*arguments(name, inputs, by_name=False), *extra, stdin=given[:end])
        assert done.status == 1 and not done.out
        assert one_line(done.err, name).startswith("<stdin>: ")
    assert (tmp_path / "out").read_bytes() == b"old" and os.listdir(tmp_path) == ["out"]


def without_root(command: list[str]) -> list[str]:
    """Root may write anywhere; without these two capabilities it is like anybody."""
    return command if os.geteuid() else ["setpriv", "--bounding-set", "-dac_override,-dac_read_search", *command]


def test_folders_and_files_that_may_not_be_written(inputs, tmp_path):
    folder = tmp_path / "folder"
    folder.mkdir()
    (folder / "out").write_bytes(b"old")
    (tmp_path / "out").write_bytes(b"old")
    (tmp_path / "out").chmod(0o444)
    folder.chmod(0o555)
    try:
        for path in (folder / "out", folder / "new", tmp_path / "out"):
            command = [sys.executable, "-m", "penink_cli", *arguments("to-ps", inputs), "-o", str(path)]
            done = subprocess.run(without_root(command), env=environment(), capture_output=True, check=False)
            assert done.returncode == 1 and "Permission denied" in one_line(done.stderr, "to-ps")
    finally:
        folder.chmod(0o755)
    assert (folder / "out").read_bytes() == (tmp_path / "out").read_bytes() == b"old"
    assert os.listdir(folder) == ["out"] and sorted(os.listdir(tmp_path)) == ["folder", "out"]


def test_a_file_system_that_is_full(inputs, tmp_path):
    """The real thing, where the system lets us mount one; /dev/full and RLIMIT_FSIZE are tested everywhere."""
    script = f'mount -t tmpfs -o size=8k tmpfs {tmp_path} && echo old > {tmp_path}/out && exec "$@"'
    probe = subprocess.run(["unshare", "-Urm", "true"], capture_output=True, check=False)
    if probe.returncode:
        pytest.skip("this system does not let us mount a small file system")
    command = [
        sys.executable,
        "-m",
        "penink_cli",
        *arguments("enlarge", inputs),
        "--scale",
        "20",
        "-o",
        f"{tmp_path}/out",
    ]
    check = ["sh", "-c", '"$@" || { ls -A "$0"; cat "$0/out"; }', str(tmp_path), *command]
    mounted = ["unshare", "-Urm", "sh", "-c", script, "sh", *check]
    done = subprocess.run(mounted, env=environment(), capture_output=True, check=False)
    assert one_line(done.stderr, "enlarge").endswith("cannot be written: No space left on device")
    assert done.stdout == b"out\nold\n"
