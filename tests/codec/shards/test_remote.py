"""Sets in shards at an address: only what is asked for is fetched, and kept within the cache's size; tries again."""

import re
import threading
import warnings
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import numpy as np
import pytest

import pvfiblets as pf
from pvfiblets.cli.command import main
from pvfiblets.codec.shards import store
from pvfiblets.codec.shards.store import Cache, Remote
from pvfiblets.codec.shards.write import write_shards
from pvfiblets.support.addresses import is_url

from ..samples import smooth

pytestmark = pytest.mark.more


class Server(ThreadingHTTPServer):
    """Files of a folder, by ranges; it can lose connections and serve other bytes."""

    daemon_threads = True

    def __init__(self, folder):
        super().__init__(("127.0.0.1", 0), Handler)
        self.folder, self.asked, self.sent = folder, [], 0
        self.lose, self.ranges, self.altered = 0, True, False


class Handler(BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    server: Server

    def log_message(self, *_):
        pass

    def do_HEAD(self):
        self.do_GET()

    def do_GET(self):
        path = self.server.folder / self.path.lstrip("/")
        if not path.is_file():
            self.send_error(404)
            return
        body = path.read_bytes()
        if self.server.altered and path.suffix == ".fiblets":
            body = body[:-1] + b"?"
        span = re.fullmatch(r"bytes=(\d+)-(\d*)", self.headers.get("Range") or "")
        if span and self.server.ranges:
            first, last = int(span[1]), min(int(span[2] or len(body) - 1), len(body) - 1)
            self.send_response(206)
            self.send_header("Content-Range", f"bytes {first}-{last}/{len(body)}")
            body = body[first : last + 1]
        else:
            self.send_response(200)
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        if self.command == "HEAD":
            return
        self.server.asked.append(self.path)
        if self.server.lose > 0 and self.path.endswith(".fiblets"):
            self.server.lose -= 1
            self.wfile.write(body[: len(body) // 2])
            self.close_connection = True
            return
        self.wfile.write(body)
        self.server.sent += len(body)


@pytest.fixture
def whole():
    return pf.compress(smooth(60, 80), exact=False)


@pytest.fixture
def server(whole, tmp_path):
    (tmp_path / "at").mkdir()
    write_shards(whole, tmp_path / "at" / "a.fiblets", whole.nbytes // 4)
    made = Server(tmp_path / "at")
    thread = threading.Thread(target=made.serve_forever, daemon=True)
    thread.start()
    yield made
    made.shutdown()
    made.server_close()
    thread.join(10)


@pytest.fixture
def url(server):
    return f"http://127.0.0.1:{server.server_address[1]}/a.fiblets"


@pytest.fixture
def cache(tmp_path, monkeypatch):
    monkeypatch.setattr(store, "PAUSE", 0.0)
    return Cache(tmp_path / "cache", 1 << 30)


def same(found, wanted):
    np.testing.assert_array_equal(found.decompress(dtype=np.float64).points, wanted.decompress(dtype=np.float64).points)


def test_a_set_at_an_address(url, cache, whole):
    same(pf.ShardedSet.open(url, cache=cache).gather(), whole)


def test_opening_by_address_alone(url, cache, whole, monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "home"))
    same(pf.FibletSet.open(url), whole)
    np.testing.assert_array_equal(pf.read(url).points, pf.read(tmp_path / "at" / "a.fiblets").points)
    assert list((tmp_path / "home" / "pvfiblets" / "shards").iterdir())


def test_only_what_is_asked_for_is_fetched(url, server, cache):
    shards = pf.ShardedSet.open(url, cache=cache)
    assert server.asked == ["/a.fiblets/manifest.json"]
    shards.shard(2)
    assert set(server.asked[1:]) == {"/a.fiblets/000002.fiblets"}
    before = len(server.asked)
    shards.shard(2)
    pf.ShardedSet.open(url, cache=cache).shard(2)
    assert server.asked[before:] == ["/a.fiblets/manifest.json"], "what is in the cache was fetched again"


def test_pieces(url, server, cache, whole, monkeypatch):
    monkeypatch.setattr(store, "PIECE", 1000)
    same(pf.ShardedSet.open(url, cache=cache).gather(), whole)
    assert server.asked.count("/a.fiblets/000000.fiblets") > 3


def test_a_server_without_ranges(url, server, cache, whole, monkeypatch):
    monkeypatch.setattr(store, "PIECE", 1000)
    server.ranges = False
    same(pf.ShardedSet.open(url, cache=cache).gather(), whole)
    assert server.asked.count("/a.fiblets/000000.fiblets") == 1


def test_a_lost_connection_is_reported_and_retried(url, server, cache, whole, monkeypatch):
    monkeypatch.setattr(store, "PIECE", 2000)
    shards = pf.ShardedSet.open(url, cache=cache)
    server.lose = 3
    size = shards.shards[0].fiblets.bytes
    with pytest.warns(UserWarning, match=r"000000\.fiblets: .*trying again"):
        shards.shard(0)
    assert server.sent < size + 20_000, "it began from its first byte again"
    same(shards.gather(), whole)


def test_a_dead_server_is_one_sentence(url, server, cache):
    shards = pf.ShardedSet.open(url, cache=cache)
    server.lose = 1000
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        with pytest.raises(OSError, match="cannot be fetched, in 5 tries"):
            shards.shard(0)
    assert not [p for p in cache.folder.iterdir() if p.name.startswith(".")], "half a file is left"


def test_other_bytes_are_refused(url, server, cache):
    server.altered = True
    with pytest.raises(pf.FormatError, match="other bytes than its manifest names"):
        pf.ShardedSet.open(url, cache=cache).shard(0)
    server.altered = False
    pf.ShardedSet.open(url, cache=cache).shard(0)


def test_no_set_there(url, cache):
    with pytest.raises(pf.FormatError, match=r"no manifest\.json"):
        pf.ShardedSet.open(url + "x", cache=cache)


def test_the_cache_keeps_to_its_size(url, tmp_path):
    shards = pf.ShardedSet.open(url, cache=Cache(tmp_path / "small", 1))
    n = len(shards.shards)
    kept = [shards.shard(number) for number in range(n)]
    assert len(list((tmp_path / "small").iterdir())) == 1
    assert [part.decompress().n_points for part in kept] == [s.points for s in shards.shards], "mapped files live on"
    two = Cache(tmp_path / "two", sum(sorted(s.fiblets.bytes for s in shards.shards)[-2:]))
    shards = pf.ShardedSet.open(url, cache=two)
    for number in (0, 1, 0, 2):
        shards.shard(number)
    left = {p.name.split("-")[1] for p in (tmp_path / "two").iterdir()}
    assert left == {"000000.fiblets", "000002.fiblets"}, "what was not used for longest goes first"
    with pytest.raises(ValueError, match="0 bytes holds nothing"):
        Cache(tmp_path, 0)


def test_another_file_system(whole, tmp_path, cache):
    import fsspec

    write_shards(whole, tmp_path / "b.fiblets", whole.nbytes // 3)
    memory = fsspec.filesystem("memory")
    try:
        memory.put(str(tmp_path / "b.fiblets"), "/sets/b.fiblets", recursive=True)
        same(pf.ShardedSet.open("memory://sets/b.fiblets", cache=cache).gather(), whole)
    finally:
        memory.store.clear()


def test_a_bucket(whole, tmp_path, cache, monkeypatch):
    """An object store that speaks S3, here on this machine."""
    import boto3
    from moto.server import ThreadedMotoServer

    for name in ("AWS_ACCESS_KEY_ID", "AWS_SECRET_ACCESS_KEY"):
        monkeypatch.setenv(name, "testing")
    monkeypatch.setenv("AWS_DEFAULT_REGION", "us-east-1")
    write_shards(whole, tmp_path / "b.fiblets", whole.nbytes // 3)
    served = ThreadedMotoServer(ip_address="127.0.0.1", port=0, verbose=False)
    served.start()
    try:
        host, port = served.get_host_and_port()
        client = boto3.client("s3", endpoint_url=f"http://{host}:{port}")
        client.create_bucket(Bucket="sets")
        for path in (tmp_path / "b.fiblets").iterdir():
            client.upload_file(str(path), "sets", f"b.fiblets/{path.name}")
        shards = pf.ShardedSet.open(
            "s3://sets/b.fiblets", cache=cache, client_kwargs={"endpoint_url": f"http://{host}:{port}"}
        )
        same(shards.gather(), whole)
    finally:
        served.stop()


def test_without_fsspec_the_extra_is_named(monkeypatch, cache):
    import sys

    monkeypatch.setitem(sys.modules, "fsspec", None)
    with pytest.raises(ImportError, match=r"pip install pvfiblets\[cluster\]"):
        Remote("https://example.org/a.fiblets", cache)


@pytest.mark.parametrize(
    ("place", "address"),
    [
        ("https://h/a", True),
        ("s3://b/a", True),
        ("a.fiblets", False),
        ("C:\\a", False),
        ("/x/y", False),
        ("c://x", False),
    ],
)
def test_what_is_an_address(place, address):
    assert is_url(place) is address


@pytest.mark.parametrize("work", [pf.read, pf.formats.info, lambda url: next(pf.iter_chunks(url))])
def test_other_formats_are_not_read_from_addresses(work):
    with pytest.raises(ValueError, match=r"https://example\.org/a\.tck is an address; .*fetch the file first"):
        work("https://example.org/a.tck")


def test_plotters_and_commands_take_addresses(url, monkeypatch, tmp_path, capsys):
    import pyvista as pv

    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "home"))
    plotter = pv.Plotter(off_screen=True, window_size=(80, 60))
    actor = plotter.add_fiblets(url)
    plotter.show(auto_close=False)
    picture = plotter.screenshot(None)
    told = actor.explain()
    assert told["share"] == 1.0
    plotter.close()
    plotter = pv.Plotter(off_screen=True, window_size=(80, 60))
    plotter.add_fiblets(tmp_path / "at" / "a.fiblets")
    np.testing.assert_array_equal(plotter.screenshot(None), picture)
    assert np.ptp(picture) > 50
    plotter.close()
    main(["screenshot", url, "-o", str(tmp_path / "a.png"), "--size", "80x60"])
    assert (tmp_path / "a.png").is_file()
    assert main(["screenshot", url.replace(".fiblets", ".tck"), "-o", str(tmp_path / "b.png")]) == 1
    assert "is an address" in capsys.readouterr().err
