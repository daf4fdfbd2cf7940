"""Packing a renderer: its sources without comments and needless spaces, and codings that PostScript can undo."""

from __future__ import annotations

import base64
import re
import zlib
from importlib import resources

import numpy as np

from penink_cli.selfdrawing import constants

PROLOGUES = {"constants.js": constants.javascript, "constants.ps": constants.postscript}
_PS_TOKENS = re.compile(r"%[^\n]*|\((?:[^()\\]|\\.)*\)|[{}\[\]]|/?[^\s{}\[\]()%/]+")


def source(name: str) -> str:
    """One of the renderers' source files, or one of the prologues, which are made."""
    if name in PROLOGUES:
        return PROLOGUES[name]()
    return (resources.files("penink_cli.selfdrawing") / "renderer" / name).read_text("utf-8")


def strip_postscript(text: str) -> str:
    """The program without comments, and without white space but where two words would run together.

    >>> strip_postscript("/Half { 2 div } def  % of it")
    '/Half{2 div}def'
    """
    out: list[str] = []
    delimited = True
    for token in _PS_TOKENS.findall(text):
        if token.startswith("%"):
            continue
        starts = token[0] in "{}[](/"
        if not (delimited or starts):
            out.append(" ")
        out.append(token)
        delimited = token[0] in "{}[]("
    return "".join(out)


def deflate(data: bytes) -> bytes:
    """Coded for /FlateDecode, at a fixed level: one version of zlib always gives the same bytes."""
    return zlib.compress(data, 9)


def lzw(data: bytes) -> bytes:
    """Coded for /LZWDecode: codes of 9 to 12 bits, most significant bit first, lengthened one code early."""
    table: dict[bytes, int] = {bytes([i]): i for i in range(256)}
    codes: list[tuple[int, int]] = [(256, 9)]
    following, width, word = 258, 9, b""
    for i in range(len(data)):
        longer = word + data[i : i + 1]
        if longer in table:
            word = longer
            continue
        codes.append((table[word], width))
        table[longer] = following
        following += 1
        if following + 1 > (1 << width):
            width += 1
        if following >= 4094:
            codes.append((256, min(width, 12)))
            table = {bytes([k]): k for k in range(256)}
            following, width = 258, 9
        word = data[i : i + 1]
    if word:
        codes.append((table[word], width))
        following += 1
        if following + 1 > (1 << width):
            width += 1
    codes.append((257, min(width, 12)))
    bits = "".join(f"{code:0{size}b}" for code, size in codes)
    bits += "0" * (-len(bits) % 8)
    return int(bits, 2).to_bytes(len(bits) // 8, "big")


def ascii85(data: bytes) -> bytes:
    """Coded for /ASCII85Decode, in lines of at most 80 characters, none of which looks like a structuring comment."""
    text = base64.a85encode(data)
    lines = [text[i : i + 79] for i in range(0, len(text), 79)]
    return b"\n".join(b" " + line if line.startswith(b"%") else line for line in lines) + b"\n~>\n"


def letters(data: bytes) -> str:
    """Five letters for each four bytes, the last filled up with zeros, that HTML and JavaScript leave as they are.

    The letters are the 85 characters from ( on, but } for < and ~ for the backslash. Base 64 takes 7 % more.

    >>> letters(bytes([0, 0, 0, 1]))
    '(((()'
    """
    words = np.frombuffer(data + bytes(-len(data) % 4), ">u4").astype(np.int64)
    digits = words[:, None] // 85 ** np.arange(4, -1, -1) % 85 + 40
    return digits.astype(np.uint8).tobytes().decode("ascii").replace("<", "}").replace("\\", "~")


_JS_TOKENS = re.compile(r"//[^\n]*|\"(?:[^\"\\\n]|\\.)*\"|`(?:[^`\\]|\\.)*`|[ \t]+|\n\s*|[^\s\"`/]+|/")


def strip_javascript(text: str) -> str:
    """The program without comments, indentation, and spaces beside punctuation. Line ends stay: some end statements.

    >>> strip_javascript('const a = 1;  // one\\n\\n  f("a  b", a)')
    'const a=1;\\nf("a  b",a)'
    """
    out: list[str] = []
    for token in _JS_TOKENS.findall(text):
        if token.startswith("//"):
            continue
        if token[0] == "\n":
            while out and out[-1] in (" ", "\n"):
                out.pop()
            if out:
                out.append("\n")
        elif token[0] in " \t":
            if out and out[-1] != "\n":
                out.append(" ")
        else:
            out.append(token)
    joined = "".join(out)
    parts = re.split(r"(\"(?:[^\"\\\n]|\\.)*\"|`(?:[^`\\]|\\.)*`)", joined)
    return "".join(
        part if i % 2 else re.sub(r" ?([=+*/<>?:;,{}()\[\]&|%!^-]) ?", _closed, part) for i, part in enumerate(parts)
    ).rstrip("\n")


def _closed(match: re.Match[str]) -> str:
    return match.group(1)
