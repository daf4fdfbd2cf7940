"""Every subcommand under every fault: what a shell, a full disk or an impatient user does to a filter."""
