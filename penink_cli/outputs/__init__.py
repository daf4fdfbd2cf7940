"""Strokes to pictures: PostScript, SVG, PDF, pixels, and the page that they lie on."""
