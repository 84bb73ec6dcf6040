"""`tapreach install`: the robot starts with its computer, and opens a Wi-Fi of its own."""

import getpass
import os
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from segno.helpers import make_wifi_data

from tapreach.cli.address import address_in_network, page_address, qr_code
from tapreach.cli.deployment.files import PRIVATE, PUBLIC, PlannedFile, is_kept, write_file
from tapreach.cli.deployment.hotspot import ADDRESS, CONNECTION_PATH, Hotspot, keyfile_text
from tapreach.cli.deployment.secret_text import Draw, draw_secretly, secret_text
from tapreach.cli.deployment.unit import TOKEN_PATH, UNIT_PATH, Service, unit_text
from tapreach.cli.robot_file import find_robot_file
from tapreach.robot.config import load_robot

HIDDEN = "(drawn by --apply, shown once)"


@dataclass(frozen=True, slots=True)
class Installation:
    """Everything that goes onto the machine, and the secrets in it."""

    files: tuple[PlannedFile, ...]
    password: str
    token: str


def install(
    robot: Annotated[str, typer.Option(help="a shipped robot or the path of a robot file")],
    apply: Annotated[
        bool, typer.Option("--apply", help="write the files; without it they are shown")
    ] = False,
    user: Annotated[
        str | None, typer.Option(help="whom the robot runs as [default: you, also behind sudo]")
    ] = None,
    hotspot: Annotated[bool, typer.Option(help="a Wi-Fi of its own, where no known one is in reach")] = True,
    ssid: Annotated[str, typer.Option(help="name of that Wi-Fi")] = "tapreach",
    interface: Annotated[str, typer.Option(help="Wi-Fi interface of this machine")] = "wlan0",
    port: Annotated[int, typer.Option(min=1024, max=65535, help="of the operator page")] = 8080,
    new_secrets: Annotated[
        bool, typer.Option("--new-secrets", help="draw password and token anew where there are some")
    ] = False,
    root: Annotated[Path, typer.Option(help="folder to write below, such as a mounted SD card")] = Path("/"),
) -> None:
    """Start the robot with its computer (systemd) and open a hotspot (NetworkManager).

    Without --apply nothing is written. The hotspot's password and the page's pairing token are drawn at
    random and shown once.
    """
    path = find_robot_file(robot).absolute()
    command = Path(sys.executable).absolute().with_name("tapreach")
    service = Service(load_robot(path).name, command, path, user or _this_user(), port)
    access = Hotspot(ssid, interface) if hotspot else None
    console = Console(highlight=False, markup=False, soft_wrap=True)
    if not apply:
        _show(console, root, planned(service, access, lambda _: "", HIDDEN))
        return
    _apply(console, root, planned(service, access, draw_secretly), new_secrets, access, port)


def planned(service: Service, access: Hotspot | None, draw: Draw, instead: str = "") -> Installation:
    """Return what is to be written, with fresh secrets, or with `instead` in their place."""
    password, token = instead or secret_text(draw), instead or secret_text(draw)
    files = [
        PlannedFile(UNIT_PATH, unit_text(service), PUBLIC),
        PlannedFile(TOKEN_PATH, f"{token}\n", PRIVATE, holds_secret=True),
    ]
    if access is not None:
        text = keyfile_text(access, password)
        files.append(PlannedFile(CONNECTION_PATH, text, PRIVATE, holds_secret=True))
    return Installation(tuple(files), password, token)


def _show(console: Console, root: Path, installation: Installation) -> None:
    for file in installation.files:
        console.print(f"--- {root / file.path} (mode {file.mode:o})\n{file.text}")
    console.print("Nothing was written; --apply does.")


def _apply(
    console: Console,
    root: Path,
    installation: Installation,
    renews: bool,
    access: Hotspot | None,
    port: int,
) -> None:
    written = []
    for file in installation.files:
        if is_kept(root, file, renews):
            console.print(f"kept     {root / file.path} (--new-secrets draws anew)")
            continue
        write_file(root, file)
        written.append(file.path)
        console.print(f"written  {root / file.path}")
    if access is not None and CONNECTION_PATH in written:
        console.print(f"\nWi-Fi {access.ssid!r}, password {installation.password}: shown this once.\n")
        console.print(qr_code(make_wifi_data(access.ssid, installation.password, "WPA")))
    if TOKEN_PATH in written:
        address = page_address(ADDRESS if access else address_in_network(), port, installation.token)
        console.print(f"\nOperator page {address}: shown this once. Whoever has it can drive.\n")
        console.print(qr_code(address))
    console.print("\nNow, once:")
    if access is not None:
        console.print("  sudo nmcli connection reload")
    console.print("  sudo systemctl daemon-reload\n  sudo systemctl enable --now tapreach")
    console.print("What it says: journalctl -u tapreach")


def _this_user() -> str:
    return os.environ.get("SUDO_USER") or getpass.getuser()
