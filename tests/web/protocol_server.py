"""A small server that speaks the page's protocol and remembers all it hears. No robot behind it."""

import asyncio
import contextlib
import json
import threading
import time
from collections.abc import AsyncIterator, Callable
from pathlib import Path
from typing import Any, Self

import uvicorn
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Mount, Route, WebSocketRoute
from starlette.staticfiles import StaticFiles
from starlette.websockets import WebSocket, WebSocketDisconnect
from tests.web.synthetic_video import room, stamped_jpeg, video_message

from tapreach.server import messages

WEB = Path(__file__).parents[2] / "web"
Json = dict[str, Any]


def first_state() -> Json:
    """Return a robot that stands and is driven by nobody."""
    return {
        "type": "state",
        "server_ns": 0,
        "sent": {"linear": 0.0, "angular": 0.0},
        "limited_by": "",
        "own_move": None,
        "odometry": {
            "x": 0.31,
            "y": -0.02,
            "heading_deg": 12.4,
            "distance": 0.4,
            "linear": 0.0,
            "angular": 0.0,
        },
        "arm": {
            "rotation_deg": 0.0,
            "shoulder_deg": 90.0,
            "elbow_deg": 0.0,
            "claw_mm": 40.0,
            "is_moving": False,
        },
        "lease": {
            "holder_id": None,
            "holder_name": "",
            "is_idle": False,
            "asked_by_id": None,
            "asked_by_name": "",
        },
        "emergency_stop": "",
        "health": "running",
        "health_reason": "",
        "viewers": 1,
        "overruns": 0,
    }


class ProtocolServer:
    """Context manager; `url` while inside. Tests set its attributes and `push` messages to the page."""

    def __init__(self, size: tuple[int, int] = (640, 480)) -> None:
        self.size = size
        self.background = room(*size)
        self.state = first_state()
        self.markers: list[object] = []
        self.path: list[object] = []
        self.base = (0.0, 0.0, 0.0)
        self.sends_frames = True
        self.lessons: tuple[str, ...] = ()
        self.refuses = False
        self.silent_session = 0
        self.tap_refusal = ""
        self.capture_delay_ns = 0
        self.frozen_after_ms = 5000  # a busy machine must not freeze the pages of other tests
        self.captures: list[Json] = []
        self.received: list[Json] = []
        self.acked: list[int] = []
        self._heard = threading.Condition()
        self._sockets: dict[int, WebSocket] = {}
        self._sessions = 0
        self._frame_id = 0
        self._jpegs: dict[int, bytes] = {}
        self._server = uvicorn.Server(
            uvicorn.Config(self._app(), port=0, log_level="error", ws="websockets-sansio", lifespan="off")
        )
        self._thread = threading.Thread(target=self._serve, daemon=True)
        self._loop = asyncio.new_event_loop()

    def __enter__(self) -> Self:
        self._thread.start()
        self.wait_until(lambda: self._server.started)
        return self

    def __exit__(self, *_: object) -> None:
        self._server.should_exit = True
        self._server.force_exit = True
        self._thread.join(10)

    def _serve(self) -> None:
        asyncio.set_event_loop(self._loop)
        self._loop.run_until_complete(self._server.serve())
        self._loop.close()

    @property
    def url(self) -> str:
        """Return the page's address."""
        port = self._server.servers[0].sockets[0].getsockname()[1]
        return f"http://127.0.0.1:{port}/"

    # What the tests ask and do

    def wait_until(self, holds: Callable[[], object], seconds: float = 10.0) -> None:
        """Wait until `holds()`, looking again after all that is heard."""
        end = time.monotonic() + seconds
        with self._heard:
            while not holds():
                if time.monotonic() > end:
                    raise AssertionError(f"not within {seconds} s; heard last: {self.received[-8:]}")
                self._heard.wait(0.02)

    def heard(self, kind: str) -> list[Json]:
        """Return what the page sent of one type."""
        return [message for message in list(self.received) if message["type"] == kind]

    def wait_for(self, kind: str, count: int = 1) -> Json:
        """Wait for the `count`-th message of a type, and return it."""
        self.wait_until(lambda: len(self.heard(kind)) >= count)
        return self.heard(kind)[count - 1]

    def forget(self) -> None:
        """Forget what was heard so far."""
        with self._heard:
            self.received.clear()
            self.acked.clear()

    def push(self, message: Json) -> None:
        """Send a message to every page, checked against the protocol."""
        models = {m.model_fields["type"].default: m for m in messages.FromServer.__args__}
        text = models[message["type"]].model_validate(message).model_dump_json()
        asyncio.run_coroutine_threadsafe(self._tell_all(text), self._loop).result(5)

    def change(self, **facts: Any) -> None:
        """Change the state and tell every page at once."""
        self.state = {**self.state, **facts}
        self.push(self.state)

    def drop_sockets(self) -> None:
        """Close every control socket from this side."""

        async def close() -> None:
            for socket in list(self._sockets.values()):
                await socket.close()

        asyncio.run_coroutine_threadsafe(close(), self._loop).result(5)

    # The server

    def _app(self) -> Starlette:
        return Starlette(
            routes=[
                WebSocketRoute("/ws/control", self._control),
                WebSocketRoute("/ws/video", self._video),
                Route("/api/captures", self._list_captures),
                Route("/api/captures/{name}", self._capture, methods=["GET", "DELETE"]),
                Mount("/", StaticFiles(directory=WEB, html=True)),
            ]
        )

    async def _tell_all(self, text: str) -> None:
        for socket in list(self._sockets.values()):
            with contextlib.suppress(RuntimeError, WebSocketDisconnect):
                await socket.send_text(text)

    async def _control(self, socket: WebSocket) -> None:
        if self.refuses:
            await socket.close()
            return
        await socket.accept()
        self._sessions += 1
        session = self._sessions
        self._sockets[session] = socket
        ticker = asyncio.create_task(self._tick(socket, session))
        try:
            async for text in socket.iter_text():
                await self._take(socket, session, json.loads(text))
        except WebSocketDisconnect:
            pass
        finally:
            ticker.cancel()
            del self._sockets[session]
            if self.state["lease"]["holder_id"] == session:
                self._lease(holder_id=None, holder_name="")

    async def _tick(self, socket: WebSocket, session: int) -> None:
        while True:
            if session != self.silent_session:
                await socket.send_text(json.dumps(self.state))
            await asyncio.sleep(0.1)

    async def _take(self, socket: WebSocket, session: int, message: Json) -> None:
        messages.from_page.validate_python(message)
        with self._heard:
            self.received.append({**message, "session": session})
            self._heard.notify_all()
        if session == self.silent_session:
            return
        answer = self._answer(session, message)
        await socket.send_text(json.dumps(answer))
        if message["type"] in ("lease_request", "lease_release", "emergency_stop", "emergency_reset"):
            await self._tell_all(json.dumps(self.state))

    def _answer(self, session: int, message: Json) -> Json:
        seq = message["seq"]
        match message["type"]:
            case "hello":
                return self._welcome(session, seq)
            case "ping":
                now_ns = time.monotonic_ns()
                return {"type": "pong", "seq": seq, "client_ms": message["client_ms"], "server_ns": now_ns}
            case "lease_request" if self.state["lease"]["holder_id"] is None:
                self._lease(holder_id=session, holder_name="Linux PC")
            case "lease_request":
                self._lease(asked_by_id=session, asked_by_name="Linux PC")
            case "lease_release":
                self._lease(holder_id=None, holder_name="")
            case "emergency_stop":
                self.state["emergency_stop"] = "Linux PC, 12:04:31"
            case "emergency_reset":
                self.state["emergency_stop"] = ""
            case "tap" | "guide_tap" if self.tap_refusal:
                return {"type": "ack", "seq": seq, "ok": False, "reason": self.tap_refusal, "sent": None}
        return {"type": "ack", "seq": seq, "ok": True, "reason": "", "sent": None}

    def _welcome(self, session: int, seq: int) -> Json:
        width, height = self.size
        camera = {
            "width": width,
            "height": height,
            "fx": 0.9 * width,
            "fy": 0.9 * width,
            "cx": width / 2 - 0.5,
        }
        camera |= {"cy": height / 2 - 0.5, "pitch_deg": 18.0, "rate_hz": 30.0}
        return messages.Welcome.model_validate(
            {"seq": seq, "session_id": session, "robot": "Rover", "camera": camera}
            | {"max_linear": 0.3, "max_angular": 1.2, "frozen_after_ms": self.frozen_after_ms}
            | {"lessons": self.lessons}
        ).model_dump()

    def _lease(self, **facts: Any) -> None:
        self.state["lease"] = {**self.state["lease"], **facts}

    async def _video(self, socket: WebSocket) -> None:
        if self.refuses:
            await socket.close()
            return
        await socket.accept()
        try:
            async for frame_id in self._frame_ids():
                await socket.send_bytes(self._frame(frame_id))
                while (text := json.loads(await socket.receive_text())) != {"ack": frame_id}:
                    assert "ack" in text, text
                with self._heard:
                    self.acked.append(frame_id)
                    self._heard.notify_all()
        except WebSocketDisconnect:
            pass

    async def _frame_ids(self) -> AsyncIterator[int]:
        while True:
            await asyncio.sleep(1 / 30)
            if self.sends_frames:
                self._frame_id += 1
                yield self._frame_id

    def _frame(self, frame_id: int) -> bytes:
        jpeg = stamped_jpeg(self.background, frame_id)
        height, width = self.background.shape[:2]
        captured_ns = time.monotonic_ns() - self.capture_delay_ns
        return video_message(frame_id, captured_ns, jpeg, (width, height), self.markers, self.base, self.path)

    async def _list_captures(self, _: Request) -> Response:
        if self.refuses:
            return JSONResponse({"reason": "no token"}, status_code=403)
        return JSONResponse(self.captures)

    async def _capture(self, request: Request) -> Response:
        name = request.path_params["name"]
        if request.method == "DELETE":
            self.captures = [capture for capture in self.captures if capture["id"] != name]
            return JSONResponse({})
        return Response(stamped_jpeg(self.background, 1), media_type="image/jpeg")
