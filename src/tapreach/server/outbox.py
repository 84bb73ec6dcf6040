"""What waits to be sent to one page: answers in order, everything else newest wins."""

import asyncio
from collections import OrderedDict, deque

MOST_ANSWERS = 256


class Outbox:
    """Never grows: a key holds one text, and whoever answers waits for `room` first."""

    def __init__(self) -> None:
        self._answers: deque[str] = deque()
        self._newest: OrderedDict[str, str] = OrderedDict()
        self._filled = asyncio.Event()
        self._has_room = asyncio.Event()
        self._has_room.set()

    def __len__(self) -> int:
        return len(self._answers) + len(self._newest)

    def answer(self, text: str) -> None:
        """Queue an answer; none is ever dropped."""
        self._answers.append(text)
        self._filled.set()
        if len(self._answers) >= MOST_ANSWERS:
            self._has_room.clear()

    def put(self, key: str, text: str) -> None:
        """Queue `text`, in the place of what waits under the same key."""
        self._newest[key] = text
        self._filled.set()

    async def room(self) -> None:
        """Return when there are fewer than MOST_ANSWERS answers waiting."""
        await self._has_room.wait()

    async def next(self) -> str:
        """Take the next text, answers first; wait for one."""
        await self._filled.wait()
        text = self._answers.popleft() if self._answers else self._newest.popitem(last=False)[1]
        if len(self._answers) < MOST_ANSWERS:
            self._has_room.set()
        if not len(self):
            self._filled.clear()
        return text
