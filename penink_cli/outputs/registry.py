"""By the ending of a file's name, the subcommand that writes such a file."""

from __future__ import annotations

#: Of strokes, each file a layer.
OF_STROKES = {
    ".ps": "to-ps",
    ".eps": "to-ps",
    ".svg": "to-svg",
    ".pdf": "to-pdf",
    ".png": "to-png",
    ".pgm": "to-pgm",
}
#: Of an illustration.
OF_ILLUSTRATIONS = {".penink": "pack", ".html": "to-html"}
STROKES = ".jsonl"  # the strokes themselves

ENDINGS = (*OF_STROKES, STROKES, *OF_ILLUSTRATIONS)
ON_SCREEN = (".png", ".svg", ".pgm")  # looked at as they are, mostly; a printer would darken them
