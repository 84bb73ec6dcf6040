"""What holds until something newer is told: who drives, and where fetching stands."""

from tapreach.client.control_link import Message
from tapreach.client.news import FetchNews, StateNews


class Standing:
    """Hears a session from its beginning, since newcomers are greeted with what stands."""

    def __init__(self) -> None:
        self.state: StateNews | None = None
        self.fetch: FetchNews | None = None

    def hear(self, message: Message) -> None:
        """Take one piece of news. Raises ValueError for what cannot be read."""
        if message["type"] == "state":
            self.state = StateNews.model_validate(message)
        elif message["type"] == "fetch":
            self.fetch = FetchNews.model_validate(message)

    def is_driven_by(self, session_id: int) -> bool:
        """Whether this session holds the lease."""
        return self.state is not None and self.state.lease.holder_id == session_id

    @property
    def driver(self) -> str:
        """The name of who drives."""
        return (self.state.lease.holder_name if self.state is not None else "") or "somebody"
