"""Errors that a user can mend: each becomes one line on standard error and exit status 1.

Anything else that is raised is a fault of the program. It still becomes one line, and
``PENINK_DEBUG=1`` shows its traceback.
"""


class PeninkError(Exception):
    """What was found and what is allowed, in one line, without the name of the program.

    ``source`` names the file (``<stdin>`` for standard input) and is put before the
    message. Algorithms, which know of no file, leave it empty; the caller that knows the
    file adds it with `from_source`.
    """

    def __init__(self, message: str, source: str | None = None):
        super().__init__(message)
        self.message = message
        self.source = source

    def from_source(self, source: str) -> "PeninkError":
        """Name the file this error is about, unless it has a name already."""
        if self.source is None:
            self.source = source
        return self

    def __str__(self) -> str:
        return f"{self.source}: {self.message}" if self.source else self.message


class FormatError(PeninkError, ValueError):
    """The bytes of a file are not what its format allows."""


class ArrangementError(PeninkError, ValueError):
    """The discontinuity edges are not an arrangement: crossing, repeated, outside the frame …."""


class LimitError(PeninkError, ValueError):
    """An input declares more than the limit in force allows."""


class ParameterError(PeninkError, ValueError):
    """A parameter has a value that this input, or any input, cannot be served with."""


class StreamError(PeninkError, OSError):
    """A file could not be opened, read or written."""


def in_quotes(text: str, limit: int = 60) -> str:
    """Text as it was found, for an error line: printable, cut, in quotes, each backslash once.

    >>> print(in_quotes("hello\\n"))
    'hello\\n'
    """
    return f"'{printable(text, limit)}'"


def printable(text: str, limit: int | None = None) -> str:
    """Escape what a terminal would not show as one line of text, and cut quoted input at ``limit`` characters.

    >>> printable("a\\nb\\x1b[31m")
    'a\\\\nb\\\\x1b[31m'
    >>> printable("abcdef", 4)
    'abcd…'
    """
    cut = text if limit is None or len(text) <= limit else text[:limit] + "…"
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in cut)
