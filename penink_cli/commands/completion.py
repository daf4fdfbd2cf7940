"""``penink completion``."""

from __future__ import annotations

import click


@click.command(name="completion")
@click.argument("shell", type=click.Choice(["bash", "zsh", "fish"]))
@click.help_option("-h", "--help")
def completion(shell: str) -> None:
    """Print what makes a shell complete subcommands, options and their values.

    \b
    penink completion bash > ~/.local/share/bash-completion/completions/penink
    penink completion zsh > ~/.zfunc/_penink
    penink completion fish > ~/.config/fish/completions/penink.fish

    For zsh the folder must be in fpath before compinit is called. A package that is installed for
    all users brings these files along.
    """
    from penink_cli.manual import completion_script

    click.echo(completion_script(shell), nl=False)
