"""`/api/captures`: list, download, delete."""

import asyncio
from collections.abc import Callable

from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Route

from tapreach.errors import TapreachError
from tapreach.recording.captures import CaptureFolder


class CapturesApi:
    """REST over a folder of captures; files are touched in a thread, never in the event loop."""

    def __init__(self, folder: CaptureFolder, on_change: Callable[[], None]) -> None:
        self._folder = folder
        self._on_change = on_change

    def routes(self) -> list[Route]:
        """Return the routes."""
        return [
            Route("/api/captures", self._list, methods=["GET"]),
            Route("/api/captures/{name}.jpg", self._picture, methods=["GET"]),
            Route("/api/captures/{name}.json", self._facts, methods=["GET"]),
            Route("/api/captures/{name}", self._delete, methods=["DELETE"]),
        ]

    async def _list(self, _: Request) -> Response:
        return JSONResponse(await asyncio.to_thread(self._folder.listed))

    async def _picture(self, request: Request) -> Response:
        return await self._answer(request, self._folder.picture, "image/jpeg")

    async def _facts(self, request: Request) -> Response:
        return await self._answer(request, self._folder.facts, "application/json")

    async def _answer(self, request: Request, read: Callable[[str], bytes], media_type: str) -> Response:
        try:
            content = await asyncio.to_thread(read, request.path_params["name"])
        except TapreachError as error:
            return JSONResponse({"reason": str(error)}, status_code=404)
        return Response(content, media_type=media_type)

    async def _delete(self, request: Request) -> Response:
        try:
            await asyncio.to_thread(self._folder.delete, request.path_params["name"])
        except TapreachError as error:
            return JSONResponse({"reason": str(error)}, status_code=404)
        self._on_change()
        return JSONResponse({"deleted": request.path_params["name"]})
