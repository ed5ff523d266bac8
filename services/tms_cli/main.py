"""Entry of `tms`: finds the verbs by listing commands/, loads one only when it is used, maps errors to exit codes."""

import contextlib
import importlib
import os
import pkgutil
import signal
import sys
from typing import NoReturn

import click

from tms_cli import commands, session, words
from tms_cli.reasons import FileRefused, SystemSays
from tms_reason import texts
from tms_reason.errors import TmsError
from tms_reason.reason import Foreign
from tms_runtime.last_resort import LEAVE_LIMIT, end_after

INTERRUPTED = 130
click.Context.formatter_class = words.Formatter  # of every verb's help page


class Verbs(words.Group):
    """Verbs are the modules of tms_cli.commands; each has a click command called `command`.

    A verb that is a word of Python has an underscore after its module's name.
    """

    def list_commands(self, ctx: click.Context) -> list[str]:
        return sorted(_modules())

    def get_command(self, ctx: click.Context, name: str) -> click.Command | None:
        if name not in _modules():
            return None
        module = importlib.import_module(f"tms_cli.commands.{_modules()[name]}")
        verb: click.Command = module.command
        return verb


def _modules() -> dict[str, str]:
    """The modules of the verbs."""
    names = [found.name for found in pkgutil.iter_modules(commands.__path__)]
    return {name.rstrip("_").replace("_", "-"): name for name in names}


@click.group(cls=Verbs, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.option("--site", metavar="NAME|FILE", help="Site to talk to (default: TMS_SITE, else the demo).")
@click.version_option("0.1.0", prog_name="tms")
@click.pass_context
def tms(ctx: click.Context, site: str | None) -> None:
    """ROS2-TMS for Construction: run tasks on excavators and dump trucks.

    \b
    Examples:
      tms task add configs/tasks/one_loading_cycle.xml
      tms run 1 --wait
      tms ps
    """
    ctx.obj = site


def _as_ours(error: OSError) -> TmsError:
    """A TmsError for an error of the operating system, with its remedy."""
    what = error.strerror or str(error) or type(error).__name__
    if error.filename is None:
        return TmsError(SystemSays(what))
    return TmsError(FileRefused(str(error.filename), what), "NO_ACCESS")


def _words(error: TmsError) -> str:
    """The text of an error, and what to do."""
    return str(error) if isinstance(error.reason, Foreign) else texts.sentence(error.reason, words.language())


def main() -> None:
    """Run a command. Exit codes: 0 done, 1 refused or failed, 2 usage, 130 interrupted."""
    try:
        sys.exit(tms(standalone_mode=False, prog_name="tms") or 0)
    except click.UsageError as error:
        error.show()
        sys.exit(2)
    except click.exceptions.Abort as error:
        if isinstance(error.__context__, EOFError):  # not Ctrl-C, and not the answer "no"
            text = (
                "nothing was done, since the question cannot be answered here: use a terminal (`docker exec -it`), "
                "or --yes where the command has it"
            )
            print(f"\ntms: {words.say(text)}", file=sys.stderr)
            sys.exit(1)
        sys.exit(INTERRUPTED)
    except KeyboardInterrupt:
        sys.exit(INTERRUPTED)
    except click.ClickException as error:
        error.show()
        sys.exit(1)
    except (TmsError, OSError) as error:
        ours = error if isinstance(error, TmsError) else _as_ours(error)
        print(f"tms: {_words(ours)}", file=sys.stderr)
        sys.exit(1)


def entry() -> NoReturn:
    """Run `main`, then leave the ROS graph within LEAVE_LIMIT, and end without a clean-up of C++."""
    code = 1  # exit code of a bug
    try:
        main()
        code = 0
    except SystemExit as end:
        code = int(end.code or 0)
    finally:
        bug = sys.exc_info()
        if bug[0] is not None:
            sys.excepthook(*bug)  # now: the process may end while it leaves
        with contextlib.suppress(BrokenPipeError):  # the reader of our output has ended
            sys.stdout.flush()
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # the command is done
        end_after(LEAVE_LIMIT, code)
        session.leaving.close()
        os._exit(code)


if __name__ == "__main__":
    entry()
