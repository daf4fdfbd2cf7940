"""``penink completion``."""

from __future__ import annotations

from typing import Any

import click

from penink_cli.ground.streams import writing
from penink_cli.options.common import output_options


@click.command(name="completion")
@click.argument("shell", type=click.Choice(["bash", "zsh", "fish"]))
@output_options
def completion(shell: str, output: str | None, **_: Any) -> None:
    """Print what makes a shell complete penink's words.

    \b
    penink completion bash > ~/.local/share/bash-completion/completions/penink
    penink completion zsh > ~/.zfunc/_penink
    penink completion fish > ~/.config/fish/completions/penink.fish

    The shell then completes subcommands, options and the values of many options. For zsh the folder must be in fpath
    before compinit is called. A package for all users brings these files along.
    """
    from penink_cli.manual import completion_script

    with writing(output, binary=False) as out:
        out.write(completion_script(shell).encode("ascii"))
