"""One tree of errors; every message names the value that was wrong and what would be right.

TapreachError
├── InputError          a number, pixel or argument that cannot be used
├── ConfigError         a robot or scene file that cannot be used; names file and line
├── FrameError
│   ├── FrameUnknown    no frame of this id was ever stored
│   └── FrameExpired    the frame was stored and has been dropped since
├── PoseError
│   ├── PoseExpired     the pose at this time was known and has been dropped since
│   └── PoseNotYetKnown the time lies after the newest pose
├── DriverError         the robot or its link does not do what was asked
│   └── LinkLost        the link to the robot is gone
└── SetupError          something is missing on this machine; says how to get it
"""


class TapreachError(Exception):
    """Root of all errors that this package raises on purpose."""


class InputError(TapreachError):
    """A value given by the caller cannot be used."""


class ConfigError(TapreachError):
    """A robot or scene file cannot be used. The message names file, line and the known keys."""


class FrameError(TapreachError):
    """A frame that was asked for is not there."""


class FrameUnknown(FrameError):
    """No frame of this id was ever stored."""


class FrameExpired(FrameError):
    """The frame was stored and has been dropped since."""


class PoseError(TapreachError):
    """The pose at the time asked for is not there."""


class PoseExpired(PoseError):
    """The pose at this time was known and has been dropped since, or is from before the first pose."""


class PoseNotYetKnown(PoseError):
    """The time lies after the newest pose."""


class DriverError(TapreachError):
    """The robot, or a part of it, did not do what was asked."""


class LinkLost(DriverError):
    """The link to the robot is gone."""


class SetupError(TapreachError):
    """Something is missing on this machine. The message says how to get it."""
