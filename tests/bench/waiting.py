"""A program whose two worker processes say who they are and wait for ever."""

import os
import signal

from tapreach.bench.spread import spread


def wait(number: int) -> int:
    """Say the process id, and wait."""
    os.write(1, b"%d\n" % os.getpid())
    signal.pause()
    return number


def main() -> None:
    """Spread the waiting over two processes."""
    spread(wait, [1, 2], 2)
