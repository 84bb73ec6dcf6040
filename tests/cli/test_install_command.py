"""`tapreach install`: what it writes is read back, and judged by systemd's own checker."""

import configparser
import http.client
import itertools
import os
import re
import shutil
import signal
import stat
import subprocess
from contextlib import closing

import pytest
from tests.scenarios.running import tapreach_run
from typer.testing import CliRunner

from tapreach.cli.deployment.files import PlannedFile, write_file
from tapreach.cli.deployment.hotspot import CONNECTION_PATH, Hotspot, keyfile_text
from tapreach.cli.deployment.secret_text import LENGTH, LETTERS, secret_text
from tapreach.cli.deployment.unit import TOKEN_PATH, UNIT_PATH, Service, unit_text
from tapreach.cli.main import app
from tapreach.errors import InputError
from tapreach.resources import resource_path

MOST_EXPOSURE = 30
"""Of systemd's own score from 0 to 100; a unit without any hardening has 96."""
needs_systemd = pytest.mark.skipif(
    shutil.which("systemd-analyze") is None and not os.environ.get("CI"),
    reason="needs systemd-analyze (Debian: apt-get install systemd)",
)


def invoked(*arguments):
    return CliRunner().invoke(app, ["install", "--robot", "rover-pi", "--user", "daemon", *arguments])


@pytest.fixture
def applied(tmp_path):
    done = invoked("--apply", "--root", str(tmp_path))
    assert done.exit_code == 0, done.output
    return tmp_path, done.stdout


def keyfile(root):
    parser = configparser.ConfigParser(interpolation=None, delimiters=("=",), comment_prefixes=("#",))
    parser.optionxform = str
    parser.read_string((root / CONNECTION_PATH).read_text(encoding="utf-8"))
    return parser


def analyzed(*words):
    return subprocess.run(["systemd-analyze", *words], capture_output=True, text=True, timeout=60)


def test_dry_run_shows_every_file_and_writes_none(tmp_path):
    done = invoked("--root", str(tmp_path))
    assert done.exit_code == 0, done.output
    assert list(tmp_path.iterdir()) == []
    for path in (UNIT_PATH, TOKEN_PATH, CONNECTION_PATH):
        assert str(tmp_path / path) in done.stdout
    assert done.stdout.count("drawn by --apply, shown once") == 2
    assert "Nothing was written" in done.stdout


def test_connection_file_is_read_back_as_a_closed_network(applied):
    root, shown = applied
    told = keyfile(root)
    assert told["connection"]["type"] == "wifi"
    assert (told["wifi"]["mode"], told["wifi"]["ssid"]) == ("ap", "tapreach")
    security = told["wifi-security"]
    assert (security["key-mgmt"], security["proto"], security["pairwise"]) == ("wpa-psk", "rsn;", "ccmp;")
    assert told["ipv4"]["method"] == "shared"
    assert len(security["psk"]) == LENGTH
    assert shown.count(security["psk"]) == 1


def test_token_is_shown_once_in_an_address_and_handed_to_the_service(applied):
    root, shown = applied
    token = (root / TOKEN_PATH).read_text(encoding="ascii").strip()
    assert shown.count(f"http://10.42.0.1:8080/?token={token}") == 1
    unit = (root / UNIT_PATH).read_text(encoding="utf-8")
    assert "LoadCredential=pairing-token:/etc/tapreach/pairing-token" in unit
    assert "--lan --token-file %d/pairing-token" in unit
    assert token not in unit


def test_secrets_are_for_root_alone(applied):
    root, _ = applied
    modes = {path: stat.S_IMODE((root / path).stat().st_mode) for path in (TOKEN_PATH, CONNECTION_PATH)}
    assert set(modes.values()) == {0o600}
    assert stat.S_IMODE((root / UNIT_PATH).stat().st_mode) == 0o644
    assert list(root.rglob(".tapreach-*")) == []


def test_second_time_keeps_the_secrets_unless_new_ones_are_asked_for(applied):
    root, _ = applied
    before = {path: (root / path).read_text() for path in (TOKEN_PATH, CONNECTION_PATH)}
    done = invoked("--apply", "--root", str(root), "--port", "8181")
    assert "kept" in done.stdout and "shown this once" not in done.stdout
    assert {path: (root / path).read_text() for path in before} == before
    assert "--port 8181" in (root / UNIT_PATH).read_text()
    invoked("--apply", "--root", str(root), "--new-secrets")
    assert all((root / path).read_text() != text for path, text in before.items())


def test_two_robots_never_share_a_password(tmp_path):
    passwords = set()
    for number in range(5):
        assert invoked("--apply", "--root", str(tmp_path / str(number))).exit_code == 0
        passwords.add(keyfile(tmp_path / str(number))["wifi-security"]["psk"])
    assert len(passwords) == 5


def test_secret_is_drawn_letter_by_letter_by_what_is_handed_in():
    letters = itertools.cycle("ab9")
    asked = []
    assert secret_text(lambda text: asked.append(text) or next(letters), 7) == "ab9ab9a"
    assert set(asked) == {LETTERS}
    assert not set("0O1lIo") & set(LETTERS)


def test_without_a_hotspot_there_is_no_connection_file(tmp_path):
    done = invoked("--apply", "--root", str(tmp_path), "--no-hotspot")
    assert done.exit_code == 0, done.output
    assert not (tmp_path / CONNECTION_PATH).exists()
    assert "nmcli" not in done.stdout


def service(folder, name="rover.toml", user="daemon"):
    command = folder / "tapreach"
    command.write_text("#!/bin/sh\n")
    command.chmod(0o755)
    return Service("My 100% rover", command, folder / name, user, 8080)


def written_unit(folder, made):
    path = folder / "tapreach.service"
    path.write_text(unit_text(made), encoding="utf-8")
    return str(path)


@needs_systemd
@pytest.mark.parametrize("name", ["rover.toml", 'my "odd" $rover 100%.toml'])
def test_systemd_accepts_the_unit(tmp_path, name):
    done = analyzed("verify", "--man=no", written_unit(tmp_path, service(tmp_path, name)))
    # It also complains about units of this machine that are not ours.
    ours = [line for line in (done.stdout + done.stderr).splitlines() if "tapreach" in line]
    assert ours == []


@needs_systemd
def test_systemd_complains_where_the_unit_is_wrong(tmp_path):
    text = unit_text(service(tmp_path)).replace("Restart=always", "Restart=sometimes")
    path = tmp_path / "tapreach.service"
    path.write_text(text, encoding="utf-8")
    done = analyzed("verify", "--man=no", str(path))
    assert re.search("tapreach.service.*restart specifier", done.stdout + done.stderr)


@needs_systemd
def test_systemd_finds_little_exposure(tmp_path):
    path = written_unit(tmp_path, service(tmp_path))
    done = analyzed("security", "--offline=true", "--no-pager", f"--threshold={MOST_EXPOSURE}", path)
    assert done.returncode == 0, done.stdout[-300:] + done.stderr


@pytest.mark.parametrize("user", ["root", "a b", "x\nUser=root", "1st", ""])
def test_user_that_cannot_be_one_is_refused(tmp_path, user):
    with pytest.raises(InputError, match="user"):
        unit_text(service(tmp_path, user=user))


@pytest.mark.parametrize(
    "hotspot",
    [Hotspot("", "wlan0"), Hotspot("a;b", "wlan0"), Hotspot("x" * 33, "wlan0"), Hotspot("a\npsk=b", "wlan0"),
     Hotspot("ok", "wlan0\n"), Hotspot("ok", "")],
)  # fmt: skip
def test_hotspot_that_cannot_be_one_is_refused(hotspot):
    with pytest.raises(InputError, match=r"--ssid|--interface"):
        keyfile_text(hotspot, "x")


def test_file_is_whole_or_not_there(tmp_path):
    target = tmp_path / "etc"
    write_file(tmp_path, PlannedFile(target.relative_to(tmp_path) / "a", "one\n", 0o600))
    write_file(tmp_path, PlannedFile(target.relative_to(tmp_path) / "a", "two\n", 0o644))
    assert [p.name for p in target.iterdir()] == ["a"]
    assert (target / "a").read_text() == "two\n"


def status(port, query):
    with closing(http.client.HTTPConnection("127.0.0.1", port, timeout=10)) as link:
        link.request("GET", f"/{query}")
        return link.getresponse().status


def test_run_lets_in_who_has_the_token_of_the_file_and_does_not_print_it(tmp_path):
    path = tmp_path / "token"
    path.write_text("abcdefghijklmnop\n", encoding="ascii")
    words = "--robot", "fake", "--lan", "--token-file", str(path)
    with tapreach_run(tmp_path / "captures", *words) as running:
        port = int(re.search(r":(\d+)/", running.address).group(1))
        answers = [status(port, query) for query in ("", "?token=wrong", "?token=abcdefghijklmnop")]
        printed = running.end(signal.SIGINT)
    assert answers[:2] == [401, 401]
    assert answers[2] in (200, 302, 303, 307)
    assert "abcdefghijklmnop" not in printed
    assert str(path) in printed.replace("\n", "")


def test_run_takes_its_token_from_a_file_that_holds_one(tmp_path):
    path = tmp_path / "token"
    robot = str(resource_path("robots") / "fake.toml")
    for text in ("short", "with blanks in it", "", "ü" * 20):
        path.write_text(text, encoding="utf-8")
        done = CliRunner().invoke(app, ["run", "--robot", robot, "--lan", "--token-file", str(path)])
        assert isinstance(done.exception, InputError)
        assert str(path) in str(done.exception)
    done = CliRunner().invoke(app, ["run", "--robot", robot, "--token-file", str(path)])
    assert "belongs to --lan" in str(done.exception)
