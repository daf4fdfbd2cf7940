"""How encoded photographs begin: for their reader, and for `recognise`, which names one in the wrong place."""

# The first bytes of each format, and Pillow's name for it.
SIGNATURES = (
    (b"\x89PNG\r\n\x1a\n", "PNG"),
    (b"\xff\xd8\xff", "JPEG"),
    (b"II*\x00", "TIFF"),
    (b"MM\x00*", "TIFF"),
    (b"II+\x00", "TIFF"),
    (b"MM\x00+", "TIFF"),
    (b"GIF87a", "GIF"),
    (b"GIF89a", "GIF"),
    (b"BM", "BMP"),
)
BMP_HEADERS = (12, 40, 52, 56, 64, 108, 124)  # their sizes, bytes
# Brands that ISO base media files (ISO/IEC 14496-12) declare if they are pictures, by Pillow's name for the kind.
BRANDS = {"AVIF": (b"avif", b"avis"), "HEIF": (b"heic", b"heix", b"heim", b"heis", b"hevc", b"hevx", b"mif1", b"msf1")}
NAMES = {"WEBP": "WebP", "HEIF": "HEIC"}  # as people write them, where Pillow's name is another


def kind_of(start: bytes) -> str | None:
    """Pillow's name for the kind of photograph that begins so; None where it is none that is read.

    >>> kind_of(b"RIFF1234WEBPVP8 ")
    'WEBP'
    """
    if start[:4] == b"RIFF" and start[8:12] == b"WEBP":
        return "WEBP"
    if start[4:8] == b"ftyp":
        brands = [
            start[8:12],
            *(start[i : i + 4] for i in range(16, min(len(start), int.from_bytes(start[:4], "big")), 4)),
        ]
        if b"crx " in brands:  # a camera raw
            return None
        return next((kind for brand in brands for kind, own in BRANDS.items() if brand in own), None)
    found = next((name for signature, name in SIGNATURES if start.startswith(signature)), None)
    # Many a text begins with BM, so the size of the header has to be one of BMP's.
    if found == "BMP" and int.from_bytes(start[14:18], "little") not in BMP_HEADERS:
        return None
    return found
