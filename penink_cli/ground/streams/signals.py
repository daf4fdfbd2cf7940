"""Signals: a deadly one removes the temporary files first.

A thread waits for INT, TERM and HUP. It lets the process die of the signal at once, even while a compiled loop
runs in the main thread.
"""

from __future__ import annotations

import os
import signal
import threading
from typing import NoReturn

from penink_cli.ground.streams import temporary
from penink_cli.ground.streams.descriptors import hold_standard


def install_signals() -> None:
    """Prepare the process: standard descriptors, SIGPIPE, and the thread that waits for INT, TERM and HUP.

    Called once, first thing, by the entry point. A signal that the caller has set to be ignored
    (``nohup``, a background job) stays ignored, except for SIGPIPE: a filter whose reader has gone
    has nothing left to do.
    """
    hold_standard()
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGPIPE})
    deadly = {s for s in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP) if signal.getsignal(s) != signal.SIG_IGN}
    if not deadly:
        return
    for number in deadly:
        signal.signal(number, signal.SIG_DFL)
    # Blocked in every thread to come, so that the waiting thread alone receives them.
    signal.pthread_sigmask(signal.SIG_BLOCK, deadly)
    try:
        threading.Thread(target=_await, args=(deadly,), daemon=True, name="signals").start()
    except RuntimeError:  # no thread can be started: signals kill at once, and the next run removes what is left
        signal.pthread_sigmask(signal.SIG_UNBLOCK, deadly)


def _await(deadly: set[signal.Signals]) -> None:
    """Wait for a deadly signal, remove the temporary files, die of it."""
    number = signal.sigwait(deadly)
    temporary.remove_all()
    die_of(number)


def die_of(number: int) -> NoReturn:
    """End the process by a signal, as its parent expects of one that was told to stop."""
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {number})
    os.kill(os.getpid(), number)
    os._exit(128 + number)  # not reached: the disposition is the default one
