"""One file of several members: ``*.penink``, a ZIP archive that is the same bytes for the same members.

Members are stored, in order, dated 1980-01-01, with mode 0644. `compact` has compressed them already: a deflate library
promises the same text back, but not the same bytes from one version to the next. Deflated members are read all the
same, so that people can zip what they unzipped.
"""

from __future__ import annotations

import io
import re
import stat
import struct
import zipfile
import zlib

from penink_cli.ground.errors import FormatError, LimitError, printable

MAX_BYTES = 1 << 26  # of the archive, and of all members together
MAX_MEMBERS = 300
MAGIC = b"PK\x03\x04"

_ENTRY = b"PK\x01\x02"
_NAME = re.compile(r"[A-Za-z0-9_-][A-Za-z0-9._-]{0,99}", re.ASCII)


def read(data: bytes, source: str) -> dict[str, bytes]:
    """Members by name.

    Raises FormatError for what is no whole archive or holds what `pack` never writes (folders, paths, links, a name
    twice, encryption), LimitError for more than MAX_BYTES, packed or unpacked, and for more than MAX_MEMBERS.
    """
    if len(data) > MAX_BYTES:
        raise LimitError(f"an archive of more than {MAX_BYTES} bytes", source)
    if data[:4] != MAGIC:
        raise FormatError("is not a penink archive (a ZIP)", source)
    # Counted before anything is parsed: a list of a million empty members takes seconds to read.
    if data.count(_ENTRY) > 2 * MAX_MEMBERS:
        raise LimitError(f"more than {MAX_MEMBERS} members", source)
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            members = archive.infolist()
            if len(members) > MAX_MEMBERS:
                raise LimitError(f"{len(members)} members; {MAX_MEMBERS} are allowed", source)
            _check(members)
            return {info.filename: _content(archive, info) for info in members}
    except FormatError as error:
        raise error.from_source(source) from None
    except (zipfile.BadZipFile, struct.error, EOFError, zlib.error, ValueError, OSError, NotImplementedError) as error:
        if isinstance(error, LimitError):
            raise error.from_source(source) from None
        raise FormatError(f"truncated or damaged archive: {printable(str(error), 60)}", source) from None


def _check(members: list[zipfile.ZipInfo]) -> None:
    """Raise FormatError for a member that is no plain file of its own name, LimitError for too many bytes in all."""
    names: set[str] = set()
    for info in members:
        name = printable(info.orig_filename, 60)
        if not _NAME.fullmatch(info.orig_filename) or info.filename != info.orig_filename:
            raise FormatError(f'member "{name}": a name of letters, digits, ".", "_" and "-" is needed')
        if info.filename in names:
            raise FormatError(f'member "{name}" is there twice')
        names.add(info.filename)
        kind = stat.S_IFMT(info.external_attr >> 16)
        if kind not in (0, stat.S_IFREG):
            raise FormatError(f'member "{name}" is a link or a device, not a file')
        if info.flag_bits & 0x2041:
            raise FormatError(f'member "{name}" is encrypted')
        if info.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
            raise FormatError(f'member "{name}" is compressed by method {info.compress_type}; 0 and 8 are read')
    size = sum(info.file_size for info in members)
    if size > MAX_BYTES:
        raise LimitError(f"unpacks to {size} bytes; {MAX_BYTES} are allowed")


def _content(archive: zipfile.ZipFile, info: zipfile.ZipInfo) -> bytes:
    """A member's bytes. Raises FormatError where there are fewer or more than it declares."""
    with archive.open(info) as stream:
        content = stream.read(info.file_size + 1)
    if len(content) != info.file_size:
        raise FormatError(f'member "{printable(info.filename, 60)}" holds {len(content)} of {info.file_size} bytes')
    return content


def pack(members: dict[str, bytes]) -> bytes:
    """The archive of these members, in their order."""
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_STORED) as archive:
        for name, content in members.items():
            info = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            info.create_system = 3
            info.external_attr = (stat.S_IFREG | 0o644) << 16
            archive.writestr(info, content)
    return out.getvalue()
