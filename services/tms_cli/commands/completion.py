"""`tms completion`: lets the shell complete verbs and options."""

import click
from click.shell_completion import get_completion_class


@click.command()
@click.argument("shell", type=click.Choice(["bash", "zsh", "fish"]))
@click.pass_context
def command(ctx: click.Context, shell: str) -> None:
    """Print the script that lets a shell complete `tms`.

    \b
    Examples:
      eval "$(tms completion bash)"
      tms completion zsh > ~/.zfunc/_tms
      tms completion fish > ~/.config/fish/completions/tms.fish
    """
    kind = get_completion_class(shell)
    assert kind is not None, shell
    root = ctx.find_root().command
    click.echo(kind(root, {}, "tms", "_TMS_COMPLETE").source())
