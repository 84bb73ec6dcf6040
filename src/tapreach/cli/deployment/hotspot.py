"""The robot's own Wi-Fi: a connection file of NetworkManager."""

import re
import uuid
from dataclasses import dataclass
from pathlib import Path

from tapreach.errors import InputError

CONNECTION_PATH = Path("etc/NetworkManager/system-connections/tapreach-hotspot.nmconnection")
ADDRESS = "10.42.0.1"
LONGEST_SSID = 32
_UUID = uuid.uuid5(uuid.NAMESPACE_DNS, "hotspot.tapreach.example")

_KEYFILE = """\
# Written by tapreach install. Networks that are known already are joined first.
[connection]
id=tapreach-hotspot
uuid={uuid}
type=wifi
interface-name={interface}
autoconnect=true
autoconnect-priority=-100

[wifi]
mode=ap
band=bg
ssid={ssid}

[wifi-security]
key-mgmt=wpa-psk
proto=rsn;
pairwise=ccmp;
group=ccmp;
psk={password}

[ipv4]
method=shared
address1={address}/24

[ipv6]
method=disabled
"""


@dataclass(frozen=True, slots=True)
class Hotspot:
    """A network of this name on a Wi-Fi interface."""

    ssid: str
    interface: str


def keyfile_text(hotspot: Hotspot, password: str) -> str:
    """Return the connection file. Raises InputError for a name or interface that cannot be one."""
    if not re.fullmatch(rf"[\w.-][\w .-]{{0,{LONGEST_SSID - 1}}}", hotspot.ssid, re.ASCII):
        raise InputError(
            f"--ssid {hotspot.ssid!r} cannot be used: up to {LONGEST_SSID} letters, digits, blanks and .-_"
        )
    if not re.fullmatch(r"[\w.-]{1,15}", hotspot.interface, re.ASCII):
        raise InputError(
            f"--interface {hotspot.interface!r} is none; ls /sys/class/net shows those there are"
        )
    return _KEYFILE.format(
        uuid=_UUID, interface=hotspot.interface, ssid=hotspot.ssid, password=password, address=ADDRESS
    )
