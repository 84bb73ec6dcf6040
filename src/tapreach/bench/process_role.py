"""Which part of `tapreach run` a process is, by its command."""

from tapreach.bench.proc import ProcessId

_ROLES = {"tapreach.drivers.sim": "simulator", "tapreach.tasks.compute": "compute"}


def role_of(member: ProcessId) -> str:
    """Return 'server', 'compute' or 'simulator'."""
    return next((name for part, name in _ROLES.items() if part in member.command), "server")
