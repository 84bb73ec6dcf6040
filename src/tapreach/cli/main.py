"""The command `tapreach`: one file per command group, put together here."""

import sys

import typer
from rich.console import Console

from tapreach.cli.bench import bench
from tapreach.cli.doctor import doctor
from tapreach.cli.estimate import estimate
from tapreach.cli.fetch import fetch
from tapreach.cli.firmware import firmware
from tapreach.cli.install import install
from tapreach.cli.run import run
from tapreach.cli.two_tap import two_tap
from tapreach.errors import TapreachError

app = typer.Typer(
    name="tapreach",
    help="Tap a thing in a robot's live picture: get its 3D position with an honest error bar.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    add_completion=False,
    rich_markup_mode=None,
)
app.command()(run)
app.command()(fetch)
app.command("two-tap")(two_tap)
app.command()(estimate)
app.command()(doctor)
app.command()(install)
app.add_typer(bench)
app.add_typer(firmware)


@app.callback()
def tapreach() -> None:
    """Tap a thing in a robot's live picture: get its 3D position with an honest error bar."""


def main() -> None:
    """Run the command; a known error is one sentence on stderr and exit code 2, Ctrl-C is quiet (130)."""
    try:
        app()
    except TapreachError as error:
        Console(stderr=True, highlight=False).print(f"tapreach: {error}", markup=False, soft_wrap=True)
        sys.exit(2)
    except KeyboardInterrupt:
        sys.exit(130)
