"""`tapreach run`: start a robot, simulated unless told otherwise, and serve its page until Ctrl-C."""

import logging
import secrets
from collections.abc import Callable
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from tapreach.cli.address import address_in_network, page_address, qr_code
from tapreach.cli.robot_file import describe_robot
from tapreach.drivers.registry import make_robot
from tapreach.robot.clock import MonotonicClock
from tapreach.robot.config import RobotDescription
from tapreach.server.access import AccessPolicy
from tapreach.server.serve import listening_socket, run_event_loop, serve
from tapreach.server.station import Station


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
    captures: Annotated[Path, typer.Option(help="where stored pictures go")] = Path("captures"),
) -> None:
    """Start the robot and the operator page; Ctrl-C ends both."""
    console = Console(highlight=False)
    logging.basicConfig(level=logging.WARNING, format="%(message)s")
    description = describe_robot(robot, size, scene, seed, fault or [])
    listener = listening_socket("0.0.0.0" if lan else "127.0.0.1", port)
    token = secrets.token_urlsafe(12) if lan else None
    clock = MonotonicClock()
    station = Station(make_robot(description, clock), clock, captures)
    host = address_in_network() if lan else "localhost"
    address = page_address(host, listener.getsockname()[1], token)
    policy = AccessPolicy(token, host_names=[host])
    console.print(f"Starting the robot {description.name!r} ...")
    run_event_loop(serve(station, listener, policy, _announcer(console, description, address, lan)))
    console.print("Stopped; the robot stands still.")


def _announcer(
    console: Console, description: RobotDescription, address: str, lan: bool
) -> Callable[[], None]:
    def announce() -> None:
        console.print(f"\n  Open  [bold]{address}[/bold]\n", soft_wrap=True)
        if lan:
            console.print(qr_code(address), markup=False)
            console.print("Whoever has this address can drive. It changes with every start.")
        else:
            console.print("For a tablet on the same network, start with --lan: it prints a QR code.")
        console.print("Ctrl-C ends it.")

    return announce
