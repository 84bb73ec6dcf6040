"""The systemd unit that starts the robot with the machine, and starts it again when it ends."""

from dataclasses import dataclass
from pathlib import Path

from tapreach.errors import InputError

UNIT_PATH = Path("etc/systemd/system/tapreach.service")
TOKEN_PATH = Path("etc/tapreach/pairing-token")
CREDENTIAL = "pairing-token"

_UNIT = """\
# Written by tapreach install.
[Unit]
Description=Tapreach: the robot {name} and its operator page
After=network.target NetworkManager.service
StartLimitIntervalSec=0

[Service]
Type=exec
User={user}
SupplementaryGroups=dialout video
LoadCredential={credential}:/{token}
ExecStart={command} run --robot {robot} --port {port} --lan --token-file %d/{credential}
StateDirectory=tapreach
WorkingDirectory=%S/tapreach
Environment=PYTHONUNBUFFERED=1
Restart=always
RestartSec=3
# Ctrl-C: the wheels stop, ports and cameras are let go of.
KillSignal=SIGINT
KillMode=mixed
TimeoutStopSec=10

# It needs serial ports, cameras, the network, and to write what it records; nothing else.
DevicePolicy=closed
DeviceAllow=char-ttyACM rw
DeviceAllow=char-ttyUSB rw
DeviceAllow=char-ttyAMA rw
DeviceAllow=char-video4linux rw
CapabilityBoundingSet=
AmbientCapabilities=
NoNewPrivileges=yes
ProtectSystem=strict
ProtectHome=read-only
PrivateTmp=yes
ProtectClock=yes
ProtectControlGroups=yes
ProtectHostname=yes
ProtectKernelLogs=yes
ProtectKernelModules=yes
ProtectKernelTunables=yes
ProtectProc=invisible
RestrictAddressFamilies=AF_UNIX AF_INET AF_INET6 AF_NETLINK
RestrictNamespaces=yes
RestrictSUIDSGID=yes
LockPersonality=yes
RemoveIPC=yes
SystemCallArchitectures=native
SystemCallFilter=@system-service
SystemCallFilter=~@privileged
SystemCallErrorNumber=EPERM
UMask=0077

[Install]
WantedBy=multi-user.target
"""


@dataclass(frozen=True, slots=True)
class Service:
    """What is started at boot: an absolute command, a robot file, for a user of this machine."""

    name: str
    command: Path
    robot: Path
    user: str
    port: int


def unit_text(service: Service) -> str:
    """Return the unit. Raises InputError for a user that cannot be one, or that is root."""
    if not service.user.replace("-", "").replace("_", "").isalnum() or service.user[0].isdigit():
        raise InputError(f"--user {service.user!r} is no name of a user")
    if service.user == "root":
        raise InputError("the robot must not run as root: name the user that Tapreach belongs to by --user")
    return _UNIT.format(
        name=_plain(service.name),
        user=service.user,
        credential=CREDENTIAL,
        token=TOKEN_PATH,
        command=_quoted(service.command),
        robot=_quoted(service.robot),
        port=service.port,
    )


def _plain(text: str) -> str:
    return "".join(letter if letter.isprintable() else " " for letter in text).replace("%", "%%")


def _quoted(path: Path) -> str:
    """Return a path as one word of a unit: systemd takes \\, ", % and $ for its own."""
    text = _plain(str(path)).replace("\\", "\\\\").replace('"', '\\"').replace("$", "$$")
    return f'"{text}"'
