"""One module a subcommand: options, read, one call, write. Its docstring is its help text.

`SUBCOMMANDS` of `main.py` names them. `to_output` makes those of outputs that need no options of their own.
"""
