"""The camera's source: known kinds only, and errors that list them with the line of the file."""

import pytest

from tapreach.errors import ConfigError, InputError
from tapreach.resources import resource_path
from tapreach.robot.camera_source import SourceKind, parse_source
from tapreach.robot.config import RobotDescription
from tapreach.robot.toml_file import parse_validated

FILE = (resource_path("robots") / "fake.toml").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("text", "kind", "address"),
    [
        ("v4l2:/dev/video0", SourceKind.V4L2, "/dev/video0"),
        ("v4l2:/dev/v4l/by-id/usb-a:b-index0", SourceKind.V4L2, "/dev/v4l/by-id/usb-a:b-index0"),
        ("http://192.168.240.1:8080/?action=stream", SourceKind.HTTP, None),
        ("http://[::1]:8080/stream", SourceKind.HTTP, None),
        ("rtsp://anna:secret@camera.example/live", SourceKind.RTSP, None),
    ],
)
def test_source_of_a_known_kind_is_taken_as_it_stands(text, kind, address):
    source = parse_source(text)
    assert source.kind is kind
    assert source.address == (address or text)


def test_label_keeps_user_and_password_to_itself():
    user = "anna:s@cret"
    source = parse_source(f"http://{user}@camera.example:81/s?x=1")
    assert source.label == "http://camera.example:81/s?x=1"


@pytest.mark.parametrize(
    "text",
    [
        "", "0", "/dev/video0", "usb:/dev/video0", "https://camera.example/", "HTTP://camera.example/",
        "v4l2:", "v4l2:video0", "v4l2:/dev/", "http:", "http://", "http:/camera.example/", "http://:80/",
        "http://camera.example:0/", "http://camera.example:70000/", "http://camera.example:x/",
        "http://[::1/", "rtsp://camera.example/a b", "http://camera.example/\r\nX: y", " v4l2:/dev/video0",
    ],
)  # fmt: skip
def test_other_source_is_refused_and_the_message_says_what_would_be_right(text):
    with pytest.raises(InputError, match="v4l2:/dev/video0"):
        parse_source(text)


def test_robot_file_with_an_unknown_source_is_refused_with_line_and_known_kinds():
    text = FILE.replace("[camera]", '[camera]\nsource = "usb0"', 1)
    line = text.splitlines().index('source = "usb0"') + 1
    with pytest.raises(ConfigError, match=rf"fake.toml:{line}: camera.source: .*'usb0'; known are .*rtsp://"):
        parse_validated(text, "fake.toml", RobotDescription)


def test_robot_file_with_a_source_keeps_it():
    text = FILE.replace("[camera]", '[camera]\nsource = "v4l2:/dev/video2"', 1)
    assert parse_validated(text, "fake.toml", RobotDescription).camera.source == "v4l2:/dev/video2"
