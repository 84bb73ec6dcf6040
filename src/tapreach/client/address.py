"""Where a server is, from the address that `tapreach run` prints."""

from dataclasses import dataclass
from urllib.parse import parse_qs, quote, urlsplit

from tapreach.errors import InputError

LOCAL = "http://localhost:8080/"
"""Where `tapreach run` serves when it is told nothing."""
_EXAMPLES = f"{LOCAL} or http://192.168.1.7:8080/?token=TOKEN"


@dataclass(frozen=True)
class ServerAddress:
    """A server and the pairing token that it asks for; None: it asks for none."""

    host: str
    port: int
    token: str | None = None

    @classmethod
    def parse(cls, text: str) -> "ServerAddress":
        """Read what was printed, or `host:port`. Raises InputError showing what would be right."""
        parts = urlsplit(text if "://" in text else f"http://{text}")
        try:
            host, port = parts.hostname, parts.port
        except ValueError:
            host, port = None, None
        if parts.scheme != "http" or not host:
            raise InputError(
                f"the address {text!r} is none of a server; give it as printed, like {_EXAMPLES}"
            )
        (token,) = parse_qs(parts.query).get("token", [None])[:1]
        return cls(host, 80 if port is None else port, token)

    @property
    def page(self) -> str:
        """The address for people, without the token."""
        return f"http://{self._authority}/"

    @property
    def control_socket(self) -> str:
        """Where commands go and news come from."""
        return f"ws://{self._authority}{self.path('/ws/control')}"

    def path(self, path: str) -> str:
        """Return a path of this server with the token where one is needed."""
        return path if self.token is None else f"{path}?token={quote(self.token, safe='')}"

    @property
    def _authority(self) -> str:
        host = f"[{self.host}]" if ":" in self.host else self.host
        return f"{host}:{self.port}"
