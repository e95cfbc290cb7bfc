"""What browsers send and may not: paths, hosts, origins, tokens, sizes and states, one function at a time."""

import os
from dataclasses import replace

import pytest

from pvfiblets.web.scene.files.confined import Confined, ConfinedError
from pvfiblets.web.server.access import LARGEST_MESSAGE, Access, RefusedError, check_message
from pvfiblets.web.server.options import Options, is_loopback
from pvfiblets.web.server.rpc_allowlist import AllowedCalls, MalformedError, plain, pointer_event, view_size

TOKEN = "correct-horse-battery"


@pytest.fixture
def root(tmp_path):
    home = tmp_path / "home"
    (home / "sub").mkdir(parents=True)
    (home / "a.trk").write_bytes(b"12345")
    (home / "sub" / "b.tck").write_bytes(b"1")
    (home / ".hidden").write_bytes(b"1")
    (tmp_path / "secret.trk").write_bytes(b"secret")
    (home / "out.trk").symlink_to(tmp_path / "secret.trk")
    (home / "up").symlink_to(tmp_path)
    (home / "in.trk").symlink_to(home / "a.trk")
    return home


@pytest.mark.parametrize(
    "path",
    [
        "../secret.trk", "sub/../../secret.trk", "/etc/passwd", "out.trk", "up/secret.trk", "up", "a\0.trk", "a\\b",
        "C:/x", 7,
    ],
)  # fmt: skip
def test_paths_out_of_the_root_are_refused(root, path):
    with pytest.raises(ConfinedError):
        Confined(root).resolve(path)


def test_paths_out_of_the_root_are_refused_and_links_in_it_found(root):
    confined = Confined(root)
    assert confined.existing("in.trk") == confined.existing("a.trk") == root / "a.trk"
    assert confined.resolve("") == root
    with pytest.raises(ConfinedError, match="no file"):
        confined.existing("nothing.trk")
    found = [(entry.name, entry.folder, entry.size) for entry in Confined(root).listing("")]
    assert found == [("sub", True, 0), ("a.trk", False, 5), ("in.trk", False, 5)]
    assert [entry.path for entry in Confined(root).listing("sub")] == ["sub/b.tck"]
    assert confined.writable("sub/new.trk", (".trk",)) == root / "sub" / "new.trk"
    for name in ("a.trk", "new.py", "none/new.trk", "../new.trk", ".trk/../../new.trk"):
        with pytest.raises(ConfinedError):
            confined.writable(name, (".trk",))
    os.mkfifo(root / "pipe.trk")
    (root / "loop.trk").symlink_to(root / "loop.trk")
    assert [entry.name for entry in Confined(root).listing("")] == ["sub", "a.trk", "in.trk"]


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"host": "0.0.0.0"}, "token none"),
        ({"host": "192.168.1.5"}, "token none"),
        ({"token": "short"}, "at least 8"),
        ({"port": 70000}, "70000"),
        ({"limit": 0}, "limit 0"),
        ({"timeout": 0.0}, "timeout 0"),
        ({"codec": "gif"}, "gif"),
        ({"connections": 2}, "connections 2"),
        ({"by_address": 0}, "connections-by-address 0"),
        ({"proxies": ["lab.example"]}, "lab.example"),
    ],
)
def test_options_that_cannot_be_are_named(tmp_path, changes, named):
    with pytest.raises(ValueError, match=named):
        replace(Options(root=str(tmp_path)), **changes).checked()


def test_missing_files_and_roots_are_named(tmp_path):
    with pytest.raises(FileNotFoundError, match="nothing.trk"):
        Options(files=[str(tmp_path / "nothing.trk")], root=str(tmp_path)).checked()
    with pytest.raises(NotADirectoryError, match="--root"):
        Options(root=str(tmp_path / "nowhere")).checked()


@pytest.mark.parametrize("host", ["127.0.0.1", "127.8.8.8", "localhost", "::1", "[::1]"])
def test_loopback_is_known(host):
    assert is_loopback(host)
    assert not is_loopback("10.0.0.1")
    assert not is_loopback("example.org")


def access(**options):
    return Access(Options(token=TOKEN, **options), b"key of this run")


def test_names_origins_and_paths_that_are_known_pass():
    for host in ("127.0.0.1:8080", "localhost", "[::1]:80"):
        access().check_host(host)
    access(origins=["https://lab.example"]).check_host("lab.example")
    access(host="0.0.0.0").check_host("machine.lab:8080")
    access().check_origin("http://127.0.0.1:8080", "127.0.0.1:8080")
    access().check_origin("https://lab.example", "lab.example")  # a proxy that ends TLS
    access(origins=["https://lab.example/"]).check_origin("https://lab.example", "127.0.0.1:8080")
    for path in ("/", "/index.html?reconnect=auto", "/__trame_rca_2.11.8/style.css", "/a..b", "/download/x%20y"):
        access().check_path(path)


def test_tokens_and_passes_are_compared():
    ours = access()
    assert ours.is_token(TOKEN)
    assert not ours.is_token(TOKEN + "x")
    assert not ours.is_token(None)
    assert ours.is_pass(ours.pass_cookie())
    assert not ours.is_pass(TOKEN)
    assert not ours.is_pass(None)
    assert TOKEN not in ours.pass_cookie()
    assert not Access(Options(token=TOKEN), b"another run").is_pass(ours.pass_cookie())


HOSTS = ("evil.example", "evil.example:8080", "10.0.0.1", "localhost.evil.example", "", "a b", None)
ORIGINS = (
    None, "null", "http://evil.example", "http://127.0.0.1:9999", "http://127.0.0.1", "file://",
    "https://127.0.0.1:8080.evil",
)  # fmt: skip
CLIMBING = (
    "/../etc/passwd", "/a/%2e%2e/b", "/a/%252e%252e/b", "/a/..%2fb", "/a\\..\\b", "/%00", "/..", "/a/%5c..%5cb",
    "/" + "a" * 9000,
)  # fmt: skip


@pytest.mark.parametrize(
    ("kind", "value"),
    [(kind, value) for kind, values in (("host", HOSTS), ("origin", ORIGINS), ("path", CLIMBING)) for value in values],
)
def test_foreign_hosts_and_origins_and_climbing_paths_are_refused(kind, value):
    with pytest.raises(RefusedError):
        getattr(access(), f"check_{kind}")(value, *(["127.0.0.1:8080"] if kind == "origin" else []))


NO_JSON = (
    float("nan"), float("inf"), {"a": {"b": {"c": {"d": {"e": {"f": {"g": {"h": 1}}}}}}}}, "x" * 2_000_000, b"bytes",
    [0] * 200_000,
)  # fmt: skip
NO_EVENTS = (
    None, [], {}, {"type": "ExitEvent"}, {"type": "MouseMove", "x": "1"}, {"type": "MouseMove", "x": float("nan")},
    {"type": "Pinch", "positions": {"1": 5}}, {"type": "Pan", "translation": [1]},
    {"type": "MouseWheel", "spinY": 1e99},
)  # fmt: skip


@pytest.mark.parametrize(("read", "value"), [*((plain, v) for v in NO_JSON), *((pointer_event, v) for v in NO_EVENTS)])
def test_values_and_events_that_are_none_are_refused(read, value):
    with pytest.raises(MalformedError):
        read(value)


def chunk(offset, total, content):
    return b"id__" + offset.to_bytes(4, "little") + total.to_bytes(4, "little") + content


def test_sizes_of_messages_and_of_the_view_are_bounded():
    check_message(chunk(0, 5, b"hello"))
    check_message(chunk(0, LARGEST_MESSAGE, b"part"))
    for bad in (chunk(0, 4 * 2**30 - 1, b"x"), chunk(0, 9, b"x" * LARGEST_MESSAGE), b"short", chunk(4, 5, b"hello")):
        with pytest.raises(RefusedError):
            check_message(bad)
    assert view_size({"w": 640, "h": 480, "p": 2}) == (640, 480, 2.0)
    assert view_size({"w": 0, "h": 0}) == (16, 16, 1.0)
    for size in ({"w": 1e9, "h": 1}, {"w": -5, "h": 5}, {"w": 5}, None, {"w": 5, "h": 5, "p": 99}):
        with pytest.raises(MalformedError):
            view_size(size)


class Table:
    """What wslink has: methods by name, with the object that they are of."""

    def __init__(self):
        self.calls = []
        self.complaints = []
        known = ("trame.state.update", "trame.state.get", "trame.trigger", "trame.lifecycle.update", "trame.rca.event",
                 "trame.rca.size", "trame.force.push", "unknown.method")  # fmt: skip
        self.functions = {name: (self, self.make(name)) for name in known}
        AllowedCalls({"tab": str, "dark": bool, "share": float}, {"go"}.__contains__, self.complaints.append).guard(
            self.functions
        )

    def make(self, name):
        def call(target, *arguments):
            if arguments[:1] == ("go",) and arguments[1] == ["fail"]:
                raise ValueError("no such layer")
            target.calls.append((name, *arguments))

        return call

    def __call__(self, name, *arguments):
        import asyncio

        target, function = self.functions[name]
        asyncio.run(function(target, *arguments))
        return self.calls


def test_only_methods_that_the_page_needs_are_left_and_keys_never_reach_vtk():
    table = Table()
    assert "unknown.method" not in table.functions
    assert "trame.force.push" not in table.functions
    table("trame.rca.event", "view", "me", {"type": "KeyPress", "key": "q"})
    assert not table.calls
    table("trame.rca.event", "view", "me", {"type": "MouseMove", "x": 1, "y": 2})
    assert table.calls == [("trame.rca.event", "view", "me", {"type": "MouseMove", "x": 1, "y": 2})]


def test_browsers_set_their_own_state_only(caplog):
    table = Table()
    table(
        "trame.state.update",
        [{"key": "tab", "value": "info"}, {"key": "share", "value": 5}, {"key": "trame__busy", "value": 1}],
    )
    assert table.calls == [("trame.state.update", [{"key": "tab", "value": "info"}, {"key": "share", "value": 5.0}])]
    secret = "swordfish"
    for changes in (
        [{"key": "script", "value": secret}], [{"key": "tab", "value": 5}], [{"key": "dark", "value": 1}],
        [{"value": secret}], "tab", [{"key": "tab", "value": "x"}] * 100, [{"key": "tab", "value": {"deep": secret}}],
        [{"key": "tab", "value": secret * 500}],
    ):  # fmt: skip
        table("trame.state.update", changes)
    assert len(table.calls) == 1
    assert caplog.text.count("refused") == 8
    assert secret not in caplog.text


def test_triggers_are_known_ones_and_their_errors_become_sentences():
    table = Table()
    table("trame.trigger", "go", [1, "two"], {})
    table("trame.trigger", "away", [], {})
    table("trame.trigger", "go", "text", {})
    table("trame.trigger", "go", [float("nan")], {})
    table("trame.trigger", "go", [], {"named": 1})
    table("trame.trigger")
    assert table.calls == [("trame.trigger", "go", [1, "two"], {})]
    assert len(table.complaints) == 5
    assert all("refused" in one for one in table.complaints)
    table("trame.trigger", "go", ["fail"])
    assert table.complaints[-1] == "no such layer"
