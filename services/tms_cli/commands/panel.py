"""`tms panel`: show a start and a stop button for one task on the whole screen of a panel PC."""

import shutil
import subprocess

import click

from tms_cli import session
from tms_cli.reasons import NoBrowser
from tms_reason.errors import TmsError
from tms_ur import address

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")


@click.command()
@click.option(
    "--task", "task_id", type=click.IntRange(1, 2**31 - 1), required=True, metavar="ID", help="What to start."
)
@click.option("--url", "only_url", is_flag=True, help="Print the page's address and open nothing.")
@session.json_option
def command(task_id: int, only_url: bool, as_json: bool) -> None:
    """Open the panel of a task: a green start and a red software stop, as a kiosk page of the console.

    Alt+F4 closes it. It needs chromium on this PC; --url gives the address for any other browser.

    \b
    Examples:
      tms panel --task 4
      tms panel --task 4 --url
    """
    url = f"{address.url(session.site().file)}/panel.html?task={task_id}"
    if as_json:
        session.show_json({"url": url})
    if only_url and not as_json:
        click.echo(url)
    if only_url:
        return
    browser = next(filter(None, map(shutil.which, BROWSERS)), None)
    if browser is None:
        raise TmsError(NoBrowser(url))
    subprocess.run([browser, "--kiosk", "--no-first-run", "--disable-background-networking", url], check=False)
