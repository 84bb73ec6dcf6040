"""Host, Origin and token, in every combination, on requests and on sockets."""

from http.cookies import SimpleCookie

import httpx
import pytest
from websockets.asyncio.client import connect
from websockets.exceptions import InvalidStatus

from tapreach.server.access import AccessPolicy

TOKEN = "right-token"
LOOPBACK = AccessPolicy()
LAN = AccessPolicy(TOKEN, host_names=["robot.local"])
PATHS = ["/", "/snapshot.jpg", "/stream.mjpg", "/api/captures", "/api/captures/x.jpg", "/nothing"]


@pytest.mark.parametrize(
    ("policy", "host", "is_served"),
    [
        (LOOPBACK, "localhost:8080", True),
        (LOOPBACK, "127.0.0.1:8080", True),
        (LOOPBACK, "[::1]:8080", True),
        (LOOPBACK, "LOCALHOST", True),
        (LOOPBACK, "192.168.1.7:8080", False),
        (LOOPBACK, "evil.example:8080", False),
        (LOOPBACK, "localhost.evil.example", False),
        (LOOPBACK, "localhost@evil.example", False),
        (LOOPBACK, "", False),
        (LOOPBACK, None, False),
        (LOOPBACK, "[", False),
        (LAN, "192.168.1.7:8080", True),
        (LAN, "robot.local:8080", True),
        (LAN, "evil.example:8080", False),
    ],
)
def test_host_that_dns_rebinding_could_bring_is_refused(policy, host, is_served):
    reason = policy.host_refusal(host)
    assert (reason == "") == is_served
    assert is_served or repr(host) in reason


@pytest.mark.parametrize(
    ("origin", "is_served"),
    [
        (None, True),
        ("http://localhost:8080", True),
        ("http://LOCALHOST:8080", True),
        ("http://localhost:9999", False),
        ("https://localhost:8080", False),
        ("http://evil.example", False),
        ("null", False),
        ("", False),
    ],
)
def test_origin_must_be_the_very_page(origin, is_served):
    assert (LOOPBACK.origin_refusal(origin, "localhost:8080") == "") == is_served


@pytest.mark.parametrize(
    ("cookie", "query", "is_served"),
    [
        (None, None, False),
        (None, TOKEN, True),
        (f"tapreach_token={TOKEN}", None, True),
        (f"other=1; tapreach_token={TOKEN}", "wrong", True),
        ("tapreach_token=wrong", None, False),
        ("tapreach_token=", None, False),
        ("garbage;;=", None, False),
        (None, TOKEN[:-1], False),
        (None, "é", False),
    ],
)
def test_token_in_cookie_or_query(cookie, query, is_served):
    reason = LAN.token_refusal(cookie, query)
    assert (reason == "") == is_served
    assert TOKEN not in reason


async def status(url: str, headers: dict[str, str] | None = None) -> int:
    async with httpx.AsyncClient() as client, client.stream("GET", url, headers=headers) as response:
        return response.status_code


async def socket_status(url: str, **options: object) -> int:
    try:
        async with connect(url, compression=None, **options):
            return 101
    except InvalidStatus as error:
        return error.response.status_code


def test_every_path_checks_host_and_origin_on_loopback(play):
    async def scenario(here):
        for path in PATHS:
            url = f"http://{here.host}{path}"
            assert await status(url, {"Host": "evil.example"}) == 421, path
            assert await status(url, {"Origin": "http://evil.example"}) == 403, path
            assert await status(url) in (200, 404), path
            assert await status(url, {"Origin": f"http://{here.host}"}) in (200, 404), path

    async def run(here):
        await here.clock.advance(50_000_000)
        await scenario(here)

    play(run)


@pytest.mark.parametrize("path", ["/ws/control", "/ws/video"])
def test_sockets_check_host_and_origin(play, path):
    async def scenario(here):
        url = f"ws://{here.host}{path}"
        assert await socket_status(url) == 101
        assert await socket_status(url, origin=f"http://{here.host}") == 101
        assert await socket_status(url, origin="http://evil.example") == 403
        evil = "ws://evil.example" + path
        assert await socket_status(evil, host="127.0.0.1", port=here.port) == 403

    play(scenario)


def test_every_path_needs_the_token_on_a_network(play):
    async def scenario(here):
        await here.clock.advance(50_000_000)
        for path in PATHS:
            url = f"http://{here.host}{path}"
            assert await status(url) == 401, path
            assert await status(f"{url}?token=wrong") == 401, path
            assert await status(url, {"Cookie": f"tapreach_token={TOKEN}"}) in (200, 404), path
            if path != "/":
                assert await status(f"{url}?token={TOKEN}") in (200, 404), path

    play(scenario, policy=LAN)


@pytest.mark.parametrize("path", ["/ws/control", "/ws/video"])
def test_sockets_need_the_token_on_a_network(play, path):
    async def scenario(here):
        url = f"ws://{here.host}{path}"
        assert await socket_status(url) == 403
        assert await socket_status(f"{url}?token=wrong") == 403
        assert await socket_status(f"{url}?token={TOKEN}") == 101
        cookie = {"Cookie": f"tapreach_token={TOKEN}"}
        assert await socket_status(url, additional_headers=cookie) == 101
        assert await socket_status(url, additional_headers=cookie, origin="http://evil.example") == 403

    play(scenario, policy=LAN)


def test_printed_address_pairs_the_browser_and_hides_the_token(play):
    async def scenario(here):
        async with httpx.AsyncClient() as client:
            response = await client.get(f"http://{here.host}/?token={TOKEN}")
        assert (response.status_code, response.headers["location"]) == (303, "/")
        assert response.headers["cache-control"] == "no-store"
        cookie = SimpleCookie(response.headers["set-cookie"])["tapreach_token"]
        assert cookie.value == TOKEN
        assert cookie["httponly"]
        assert cookie["samesite"].lower() == "strict"

    play(scenario, policy=LAN)


def test_delete_from_a_foreign_page_is_refused(play):
    async def scenario(here):
        async with httpx.AsyncClient() as client:
            url = f"http://{here.host}/api/captures/20260101-000000-f1"
            response = await client.delete(url, headers={"Origin": "http://evil.example"})
        assert response.status_code == 403

    play(scenario)


def test_tokens_are_compared_in_constant_time(monkeypatch):
    compared = []
    monkeypatch.setattr(
        "tapreach.server.access.hmac.compare_digest", lambda a, b: compared.append((a, b)) or a == b
    )
    assert AccessPolicy(TOKEN).is_token(TOKEN)
    assert compared == [(TOKEN.encode(), TOKEN.encode())]
