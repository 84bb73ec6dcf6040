"""`tapreach run`: start a robot, simulated unless told otherwise, and serve its page until Ctrl-C."""

import logging
import re
import secrets
from collections.abc import Callable
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from tapreach.cli.address import address_in_network, page_address, qr_code
from tapreach.cli.robot_file import describe_robot, find_robot_file
from tapreach.drivers.registry import make_robot
from tapreach.errors import InputError
from tapreach.robot.clock import MonotonicClock
from tapreach.robot.config import RobotDescription
from tapreach.server.access import AccessPolicy
from tapreach.server.serve import listening_socket, run_event_loop, serve
from tapreach.server.station import Station

SHORTEST_TOKEN = 12
TOKEN = re.compile(rf"[A-Za-z0-9_-]{{{SHORTEST_TOKEN},}}")


def run(
    robot: Annotated[str, typer.Option(help="a shipped robot or the path of a robot file")] = "sim",
    scene: Annotated[str | None, typer.Option(help="simulator: a shipped scene or a scene file")] = None,
    seed: Annotated[int | None, typer.Option(help="simulator: a random scene of this number")] = None,
    fault: Annotated[
        list[str] | None, typer.Option(help="simulator: NAME=VALUE, such as slip=0.02; repeat for more")
    ] = None,
    size: Annotated[str | None, typer.Option(help="picture: 640x480, 960x720 or 1280x720")] = None,
    port: Annotated[int, typer.Option(min=0, max=65535, help="0 takes any free one")] = 8080,
    lan: Annotated[
        bool, typer.Option("--lan", help="let a tablet in: serve the network, with a token")
    ] = False,
    token_file: Annotated[
        Path | None, typer.Option(help="with --lan: the token stands here; the address stays the same")
    ] = None,
    captures: Annotated[Path, typer.Option(help="where stored pictures go")] = Path("captures"),
) -> None:
    """Start the robot and the operator page; Ctrl-C ends both."""
    console = Console(highlight=False)
    logging.basicConfig(level=logging.WARNING, format="%(message)s")
    if token_file is not None and not lan:
        raise InputError("--token-file belongs to --lan: on this machine alone no token is asked for")
    description = describe_robot(robot, size, scene, seed, fault or [])
    token = _token(token_file) if lan else None
    listener = listening_socket("0.0.0.0" if lan else "127.0.0.1", port)
    clock = MonotonicClock()
    station = Station(make_robot(description, clock), clock, captures, robot_file=find_robot_file(robot))
    host = address_in_network() if lan else "localhost"
    # A token that stays is not told anew at every start: what is printed may end up in a journal.
    address = page_address(host, listener.getsockname()[1], None if token_file else token)
    policy = AccessPolicy(token, host_names=[host])
    console.print(f"Starting the robot {description.name!r} ...")
    run_event_loop(
        serve(station, listener, policy, _announcer(console, description, address, lan, token_file))
    )
    console.print("Stopped; the robot stands still.")


def _token(path: Path | None) -> str:
    """Return a fresh pairing token, or the one in the file. Raises InputError where it holds none."""
    if path is None:
        return secrets.token_urlsafe(12)
    try:
        token = path.read_text(encoding="ascii").strip()
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"--token-file {path} cannot be read: {error}") from None
    if not TOKEN.fullmatch(token):
        raise InputError(f"--token-file {path} must hold {SHORTEST_TOKEN} or more letters and digits alone")
    return token


def _announcer(
    console: Console, description: RobotDescription, address: str, lan: bool, token_file: Path | None
) -> Callable[[], None]:
    def announce() -> None:
        console.print(f"\n  Open  [bold]{address}[/bold]\n", soft_wrap=True)
        if token_file is not None:
            console.print(f"with ?token=... as in {token_file}; it stays the same.", markup=False)
        elif lan:
            console.print(qr_code(address), markup=False)
            console.print("Whoever has this address can drive. It changes with every start.")
        else:
            console.print("For a tablet on the same network, start with --lan: it prints a QR code.")
        console.print("Ctrl-C ends it.")

    return announce
