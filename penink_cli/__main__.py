"""The ``penink`` command and ``python -m penink_cli``: signals first, everything else after.

What follows takes a tenth of a second to import; a Ctrl-C in that time is no fault to show a traceback for.
"""

# Before anything else: the interpreter's own handler would end a Ctrl-C during the next imports in a traceback.
# The module behind `signal` is built in, and costs nothing.
import _signal  # type: ignore[import-not-found]
import gc
import os

if _signal.getsignal(_signal.SIGINT) is _signal.default_int_handler:
    _signal.signal(_signal.SIGINT, _signal.SIG_DFL)

from penink_cli.ground import streams
from penink_cli.ground._compiled import heap


def main() -> None:
    """Entry point of the ``penink`` command."""
    heap.share()
    streams.install_signals()
    # numpy's linear algebra, of which little is used here, would start a thread a processor, each with its megabytes;
    # under `ulimit -v` it spins for ever where it gets none.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    # Hardly anything here is made in circles, no array is; looking for those at every 700 new objects takes 3 % of a
    # drawing's time, and once at 50 000 one and a half.
    gc.set_threshold(500_000)
    from penink_cli.main import main as run

    try:
        run()
    finally:
        gc.freeze()  # all that is left ends with the process: to look through it once more takes another 3 %


if __name__ == "__main__":
    main()
