"""The ``penink`` command and ``python -m penink_cli``: signals first, everything else after.

What follows takes a tenth of a second to import; a Ctrl-C in that time is no fault to show a traceback for.
"""

from penink_cli import streams


def main() -> None:
    """Entry point of the ``penink`` command."""
    streams.install_signals()
    from penink_cli.main import main as run

    run()


if __name__ == "__main__":
    main()
