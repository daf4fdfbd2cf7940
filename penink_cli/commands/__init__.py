"""One module a subcommand: options, read, one call, write. Its docstring is its help text."""
