"""The token: where it comes from, and that it is nowhere else."""

import os
import re
import signal
import stat
import subprocess
import sys
import urllib.request
from pathlib import Path

import pytest

from pvfiblets.web.server import tokens
from pvfiblets.web.server.tokens import chosen_token
from tests.web.visitors import STUB, TOKEN, Browser, gate

POSIX = pytest.mark.skipif(os.name != "posix", reason="modes of files")


def test_a_token_comes_from_a_file_before_the_environment_and_from_no_command_line(tmp_path, capsys):
    assert chosen_token("none") is None
    made = {chosen_token("auto") for _ in range(20)}
    assert len(made) == 20
    assert all(len(token) >= 32 for token in made)
    file = tmp_path / "token"
    tokens.write(file, "of-the-file")
    environment = {"PVFIBLETS_TOKEN": f" {TOKEN} "}
    assert chosen_token("auto", None, environment) == TOKEN
    assert chosen_token("auto", str(file), environment) == "of-the-file"
    assert chosen_token("none", None, environment) is None
    assert chosen_token("auto", None, {"PVFIBLETS_TOKEN": ""}) not in ("", None)
    with pytest.raises(ValueError, match="--token-file FILE") as caught:
        chosen_token(TOKEN)
    assert TOKEN not in str(caught.value)
    with pytest.raises(ValueError, match="leave one"):
        chosen_token("none", str(tmp_path / "token"))
    with pytest.raises(ValueError, match="not a file"):
        chosen_token("auto", str(tmp_path))


@POSIX
def test_a_token_file_is_made_once_and_for_nobody_else(tmp_path):
    file = tmp_path / "token"
    before = os.umask(0)
    try:
        token = chosen_token("auto", str(file))
    finally:
        os.umask(before)
    assert stat.S_IMODE(file.stat().st_mode) == 0o600
    assert file.read_text().strip() == token
    assert chosen_token("auto", str(file)) == token  # and kept


@POSIX
@pytest.mark.parametrize(
    ("content", "mode", "named"),
    [
        ("correct-horse", 0o644, "chmod 600"),
        ("correct-horse", 0o620, "chmod 600"),
        ("correct-horse", 0o640, "chmod 600"),
        ("", 0o600, "one line"),
        ("two lines\nof text", 0o600, "one line"),
        ("x" * 10_000, 0o600, "10000 bytes"),
    ],
)
def test_files_that_hold_no_token_are_refused(tmp_path, content, mode, named):
    file = tmp_path / "token"
    file.write_text(content)
    file.chmod(mode)
    with pytest.raises(ValueError, match=named) as caught:
        chosen_token("auto", str(file))
    assert "correct-horse" not in str(caught.value)


@POSIX
def test_a_token_is_kept_where_only_its_user_looks(tmp_path):
    for environment, folder in (({"XDG_RUNTIME_DIR": str(tmp_path)}, tmp_path), ({}, None)):
        file = tokens.keep(TOKEN, environment)
        assert file.read_text().strip() == TOKEN
        assert stat.S_IMODE(file.stat().st_mode) == 0o600
        assert stat.S_IMODE(file.parent.stat().st_mode) == 0o700
        assert folder is None or folder in file.parents
        tokens.forget(file)
        assert not file.parent.exists()


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
async def test_processes_of_sessions_are_told_nothing_in_public(tmp_path, monkeypatch):
    monkeypatch.setenv("PVFIBLETS_TOKEN", TOKEN)
    async with gate(tmp_path) as server, Browser(server) as browser:
        pid = await browser.enter()
        (session,) = server.launcher.sessions.values()
        for name in ("cmdline", "environ"):
            public = Path(f"/proc/{pid}/{name}").read_bytes()
            assert public
            for secret in (TOKEN, session.key, session.id):
                assert secret.encode() not in public


SERVE = """
import sys
from pvfiblets import cli
from pvfiblets.web.server import launcher, front as server

server.FrontServer.__init__.__defaults__ = (tuple(sys.argv[1:3]), *server.FrontServer.__init__.__defaults__[1:])
sys.exit(cli.main(["serve", "--port", "0", *sys.argv[3:]]))
"""


def serving(tmp_path, *arguments, **environment):
    return subprocess.Popen(
        [sys.executable, "-c", SERVE, *STUB, "--root", str(tmp_path), *arguments],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=os.environ | environment,
    )  # fmt: skip


def stopped(process):
    process.send_signal(signal.SIGTERM)
    out, err = process.communicate(timeout=120)
    assert process.returncode == 0, err
    return out + err


@pytest.mark.more
@POSIX
def test_what_is_no_terminal_is_told_where_the_token_is(tmp_path):
    runtime = tmp_path / "run"
    runtime.mkdir()
    server = serving(tmp_path, XDG_RUNTIME_DIR=str(runtime))
    try:
        address, place = re.fullmatch(r"Open (\S+) with the token of (.+)\n", server.stdout.readline()).groups()
        token = Path(place).read_text().strip()
        assert runtime in Path(place).parents
        browser = urllib.request.build_opener(urllib.request.HTTPCookieProcessor())
        with browser.open(f"{address}?token={token}") as answer:
            assert answer.status == 200
    finally:
        said = stopped(server)
    assert token not in said
    assert not list(runtime.iterdir())


@pytest.mark.more
@POSIX
def test_a_terminal_is_told_the_token_and_the_environment_keeps_its_own(tmp_path):
    import pty

    screen, keyboard = pty.openpty()
    server = subprocess.Popen(
        [sys.executable, "-c", SERVE, *STUB, "--root", str(tmp_path)],
        stdout=keyboard, stderr=subprocess.DEVNULL, env=os.environ | {"PVFIBLETS_TOKEN": TOKEN},
    )  # fmt: skip
    os.close(keyboard)
    try:
        said = ""
        while "\n" not in said:
            said += os.read(screen, 1000).decode()
        assert f"/?token={TOKEN}" in said
    finally:
        server.send_signal(signal.SIGTERM)
        server.wait(20)
        os.close(screen)
