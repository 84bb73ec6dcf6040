"""Coroutines that live and die together."""

import asyncio
from collections.abc import Coroutine
from typing import Any

from starlette.websockets import WebSocketDisconnect


async def run_until_first_ends(*coroutines: Coroutine[Any, Any, None]) -> None:
    """Run them side by side; when the first ends, cancel the rest and wait for them.

    A socket that closed is a normal end. Any other exception is raised.
    """
    tasks = [asyncio.create_task(coroutine) for coroutine in coroutines]
    try:
        await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for task in tasks:
            task.cancel()
        results = await asyncio.gather(*tasks, return_exceptions=True)
    for result in results:
        if isinstance(result, Exception) and not is_disconnect(result):
            raise result


def is_disconnect(error: BaseException) -> bool:
    """Tell whether this is how Starlette and uvicorn say that the other end is gone."""
    if isinstance(error, WebSocketDisconnect):
        return True
    # Sending on a socket that has just closed.
    return isinstance(error, RuntimeError) and "close" in str(error).lower()
