"""Why a link is not there, in a sentence that a person can act on."""

import errno
from pathlib import Path

from tapreach.robot.link_section import LinkSection

UNREACHABLE = {errno.EHOSTUNREACH, errno.ENETUNREACH, errno.EHOSTDOWN}


def why_not_opened(section: LinkSection, error: BaseException) -> str:
    """Return why the address could not be opened and what to do."""
    cause = error.__context__ if isinstance(error.__context__, OSError) else error
    number = getattr(error, "errno", None) or getattr(cause, "errno", None)
    where = section.address
    if section.is_device:
        return _why_no_device(where, number, error)
    if isinstance(cause, ConnectionRefusedError) or number == errno.ECONNREFUSED:
        return f"{where} refuses the connection: start the serial server there, or correct [link] address"
    if isinstance(cause, TimeoutError) or number in UNREACHABLE:
        return f"{where} does not answer: is the robot on, and is this computer in its network?"
    return f"{where} cannot be opened: {cause}"


def _why_no_device(where: str, number: int | None, error: BaseException) -> str:
    if number in (errno.ENOENT, errno.ENXIO, errno.ENODEV) or not Path(where).exists():
        return f"{where} is not there: plug the board in{_others()}"
    if number in (errno.EACCES, errno.EPERM):
        return f"{where} may not be opened by you: sudo usermod -aG dialout $USER, then log in again"
    if number in (errno.EBUSY, errno.EAGAIN, errno.EWOULDBLOCK) or "lock" in str(error):
        return f"{where} is in use by another program: close it (a serial monitor, ModemManager)"
    return f"{where} cannot be opened: {error}"


def _others() -> str:
    found = sorted(str(p) for kind in ("ttyACM*", "ttyUSB*") for p in Path("/dev").glob(kind))
    return f" (there are {', '.join(found)}: correct [link] address)" if found else ""


def why_ended(section: LinkSection, error: BaseException | None) -> str:
    """Return why an open link came to its end and what to do."""
    told = f" ({error})" if error is not None else ""
    if section.is_device:
        return f"{section.address} was unplugged{told}: plug the board in again, driving comes back by itself"
    return f"{section.address} closed the connection{told}: trying again"
