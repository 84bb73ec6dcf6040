"""[link] of the robot file: where the wheels' and servos' board is, and what it speaks."""

from typing import Literal, Self
from urllib.parse import urlsplit

from pydantic import Field, field_validator, model_validator

from tapreach.robot.section import Positive, Section

Protocol = Literal["tapreach", "ros_arduino_bridge"]
USUAL_BAUD: dict[Protocol, int] = {"tapreach": 115200, "ros_arduino_bridge": 57600}
SERVERS = ("socket", "rfc2217")
Part = Literal["left_motor", "right_motor", "left_encoder", "right_encoder"]
_RIGHT = "a device as /dev/ttyACM0, socket://HOST:PORT or rfc2217://HOST:PORT"


class WheelControlSection(Section):
    """Gains of the wheel speed controller on the board; error in ticks/s, output in PWM steps of 255."""

    kp: float = Field(ge=0, lt=256, description="PWM steps per tick/s of error")
    ki: float = Field(0.0, ge=0, lt=256, description="PWM steps per tick of summed error")
    kd: float = Field(0.0, ge=0, lt=256, description="PWM steps per tick/s²")
    feedforward: float = Field(0.0, ge=0, lt=256, description="PWM steps per tick/s asked for")


class LinkSection(Section):
    """The link to a microcontroller board."""

    address: str = Field(description=f"{_RIGHT}; a name below /dev/serial/by-id/ survives replugging")
    baud: int | None = Field(
        None, ge=1200, le=2_000_000, description="left out: 115200, or 57600 for ros_arduino_bridge"
    )
    protocol: Protocol = Field(
        "tapreach",
        description="tapreach: our firmware/, framed and checked; ros_arduino_bridge: the ASCII commands of "
        "that firmware, without checksum, time stamps, faults or moves of its own",
    )
    pid_rate_hz: Positive = Field(
        30.0, description="ros_arduino_bridge only: how often that firmware controls its wheels"
    )
    wheel_control: WheelControlSection | None = Field(
        None, description="tapreach only; left out, the firmware keeps the gains it was built with"
    )

    reversed: tuple[Part, ...] = Field(
        (),
        description="tapreach only; parts that are wired the other way round, which the board makes up for: "
        "a motor that turns back when told to go forward, an encoder that counts down when its wheel goes "
        "forward. `tapreach doctor --teach motors` finds and writes them",
    )

    @property
    def baud_rate(self) -> int:
        """Bits per second on the wire."""
        return self.baud if self.baud is not None else USUAL_BAUD[self.protocol]

    @property
    def is_device(self) -> bool:
        """True for a port of this machine, False for one behind the network."""
        return "://" not in self.address

    @field_validator("address")
    @classmethod
    def _can_be_opened(cls, address: str) -> str:
        if "://" not in address:
            if not address.startswith("/"):
                raise ValueError(f"is not an address: give {_RIGHT}")
            return address
        parts = urlsplit(address)
        try:
            port = parts.port
        except ValueError:
            port = None
        if parts.scheme not in SERVERS or not parts.hostname or not port:
            raise ValueError(f"is not an address: give {_RIGHT}")
        return address

    @field_validator("reversed")
    @classmethod
    def _names_each_part_once(cls, parts: tuple[Part, ...]) -> tuple[Part, ...]:
        twice = sorted({part for part in parts if parts.count(part) > 1})
        if twice:
            raise ValueError(f"names {', '.join(twice)} twice")
        return parts

    @model_validator(mode="after")
    def _board_takes_what_is_set(self) -> Self:
        if self.protocol == "ros_arduino_bridge" and self.wheel_control is not None:
            raise ValueError("wheel_control is for protocol 'tapreach': leave it out here")
        if self.protocol == "ros_arduino_bridge" and self.reversed:
            raise ValueError("reversed is for protocol 'tapreach': swap the wires, or tell that firmware")
        return self
