"""Ending what runs beside a measurement."""

import asyncio
from typing import Any


async def finish(task: "asyncio.Task[Any]") -> None:
    """Cancel a task and wait for its end; what it raised is not of interest any more."""
    task.cancel()
    await asyncio.gather(task, return_exceptions=True)
