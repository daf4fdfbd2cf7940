"""What subcommands share: options and the types of their values, files read for them, a progress bar."""
