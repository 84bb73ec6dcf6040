"""The ASGI application around a station."""

import mimetypes

from starlette.applications import Starlette
from starlette.middleware import Middleware
from starlette.routing import Mount, Route, WebSocketRoute
from starlette.staticfiles import StaticFiles
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from starlette.websockets import WebSocket

from tapreach.resources import resource_path
from tapreach.robot.clock import SECOND
from tapreach.server.access import AccessCheck, AccessPolicy
from tapreach.server.captures_api import CapturesApi
from tapreach.server.mjpeg import PlainVideo
from tapreach.server.session import Session
from tapreach.server.station import Station
from tapreach.server.video_socket import Viewer

# The system's table may lack these, and a module with a wrong type is refused by the browser.
for _type, _suffix in (
    ("text/javascript", ".js"),
    ("text/css", ".css"),
    ("image/svg+xml", ".svg"),
    ("font/woff2", ".woff2"),
    ("application/manifest+json", ".webmanifest"),
):
    mimetypes.add_type(_type, _suffix)

HEADERS = {
    "content-security-policy": "default-src 'self'; img-src 'self' blob: data:; worker-src 'self'; "
    "object-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    "x-content-type-options": "nosniff",
    "referrer-policy": "no-referrer",
    "cache-control": "no-cache",
}


class SafeHeaders:
    """ASGI middleware: headers that every answer carries unless it says otherwise."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """See ASGI."""

        async def send_with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                present = {name.lower() for name, _ in message["headers"]}
                extra = [(k.encode(), v.encode()) for k, v in HEADERS.items() if k.encode() not in present]
                message = {**message, "headers": [*message["headers"], *extra]}
            await send(message)

        await self._app(scope, receive, send_with_headers if scope["type"] == "http" else send)


def create_app(station: Station, policy: AccessPolicy | None = None) -> Starlette:
    """Return the application of a station that is started and stopped by the caller (see serve).

    Without a policy it serves loopback names only, without a token.
    """

    async def control(socket: WebSocket) -> None:
        await Session(socket, station).run()

    async def video(socket: WebSocket) -> None:
        interval_ns = round(SECOND / station.robot.description.camera.rate_hz)
        await Viewer(socket, station.feed, station.clock, interval_ns).run()

    plain = PlainVideo(station.feed, station.frames)
    captures = CapturesApi(station.captures, station.captures_changed)
    return Starlette(
        routes=[
            WebSocketRoute("/ws/control", control),
            WebSocketRoute("/ws/video", video),
            Route("/stream.mjpg", plain.stream),
            Route("/snapshot.jpg", plain.snapshot),
            *captures.routes(),
            Mount("/", StaticFiles(directory=resource_path("web"), html=True)),
        ],
        middleware=[Middleware(SafeHeaders), Middleware(AccessCheck, policy=policy or AccessPolicy())],
    )
