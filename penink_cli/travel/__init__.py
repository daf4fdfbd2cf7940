"""The order in which a pen draws strokes, so that it travels little while it is up."""
