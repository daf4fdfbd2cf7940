"""How encoded photographs begin: what their reader goes by, and whoever finds one where it does not belong."""

# The first bytes of each format, and Pillow's name for it.
SIGNATURES = (
    (b"\x89PNG\r\n\x1a\n", "PNG"),
    (b"\xff\xd8\xff", "JPEG"),
    (b"II*\x00", "TIFF"),
    (b"MM\x00*", "TIFF"),
    (b"II+\x00", "TIFF"),
    (b"MM\x00+", "TIFF"),
    (b"RIFF", "WEBP"),
)
