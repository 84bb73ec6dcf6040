"""The address that `tapreach run` prints, and what a script makes of it."""

import pytest

from tapreach.client.address import ServerAddress
from tapreach.errors import InputError


@pytest.mark.parametrize(
    ("text", "host", "port", "token"),
    [
        ("http://localhost:8080/", "localhost", 8080, None),
        ("localhost:8080", "localhost", 8080, None),
        ("http://192.168.1.7:8080/?token=a-b_c", "192.168.1.7", 8080, "a-b_c"),
        ("http://rover.test", "rover.test", 80, None),
        ("http://[::1]:99/", "::1", 99, None),
    ],
)
def test_address_is_read_as_it_is_printed(text, host, port, token):
    assert ServerAddress.parse(text) == ServerAddress(host, port, token)


def test_token_travels_with_every_request_and_is_not_shown_to_people():
    address = ServerAddress.parse("http://[::1]:99/?token=a%26b")
    assert address.control_socket == "ws://[::1]:99/ws/control?token=a%26b"
    assert address.path("/snapshot.jpg") == "/snapshot.jpg?token=a%26b"
    assert address.page == "http://[::1]:99/"


@pytest.mark.parametrize(
    "text",
    ["", "http://", "https://localhost/", "ftp://rover.test", "http://localhost:port/", "localhost:99999"],
)
def test_address_of_no_server_shows_a_right_one(text):
    with pytest.raises(InputError, match="http://localhost:8080/"):
        ServerAddress.parse(text)
