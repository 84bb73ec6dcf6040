"""Who is connected, by session id."""

import itertools


class Guests:
    """Names of open sessions. Ids count from 1 and are not used twice."""

    def __init__(self) -> None:
        self._names: dict[int, str] = {}
        self._ids = itertools.count(1)

    def arrive(self) -> int:
        """Return the id of a new session."""
        session_id = next(self._ids)
        self._names[session_id] = f"guest {session_id}"
        return session_id

    def call(self, session_id: int, name: str) -> None:
        """Take the name that a session gave itself; an empty one changes nothing."""
        if name.strip():
            self._names[session_id] = name.strip()

    def leave(self, session_id: int) -> None:
        """The session is over."""
        self._names.pop(session_id, None)

    def name_of(self, session_id: int | None) -> str:
        """Return the name; '' for nobody."""
        return self._names.get(session_id, "") if session_id is not None else ""
