"""From a photograph to the grey that a drawing of it is made from (see README.md of the package)."""
