"""The recipes for proxies in the docs, run as they stand there but for ports, certificates and names of programs.

Each runs where its program is installed.
"""

import asyncio
import contextlib
import os
import re
import shutil
import socket
import ssl
import subprocess
import sys
import time
from pathlib import Path

import aiohttp
import pytest

from tests.web.visitors import TOKEN, gate

DOCS = (Path(__file__).parents[2] / "docs" / "serving.md").read_text(encoding="utf-8")
NAME = "lab.example"
# Not where a user's programs are: where the system's are, and what was unpacked for the tests.
PLACES = os.pathsep.join([os.environ.get("PATH", ""), "/usr/sbin", "/usr/local/sbin", str(Path(sys.executable).parent)])
pytestmark = [
    pytest.mark.more,
    pytest.mark.skipif(sys.platform != "linux", reason="a second address of loopback"),
    pytest.mark.skipif(shutil.which("openssl") is None, reason="openssl makes the certificate"),
]


def recipe(language, start):
    """Return a block of the docs that begins so."""
    blocks = re.findall(rf"```{language}\n(.*?)```", DOCS, re.DOTALL)
    return next(block for block in blocks if block.startswith(start))


def free_port():
    with socket.create_server(("127.0.0.1", 0)) as found:
        return found.getsockname()[1]


def replaced(text, *changes):
    for old, new in changes:
        assert old in text, f"the recipe has no {old!r} any more"
        text = text.replace(old, str(new))
    return text


def certificate(folder):
    key, cert = folder / "key.pem", folder / "cert.pem"
    subprocess.run(
        ["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-keyout", key, "-out", cert, "-days", "2",
         "-subj", f"/CN={NAME}"], check=True, capture_output=True,
    )  # fmt: skip
    return cert, key


def nginx(folder, upstream, port):
    cert, key = certificate(folder)
    block = replaced(
        recipe("nginx", "upstream"), ("127.0.0.1:8080", f"127.0.0.1:{upstream}"), ("443", port),
        ("/etc/ssl/lab.example.pem", cert), ("/etc/ssl/lab.example.key", key),
    )  # fmt: skip
    places = "".join(
        f"{kind}_temp_path {folder}/{kind};\n" for kind in ("client_body", "proxy", "fastcgi", "uwsgi", "scgi")
    )
    (folder / "nginx.conf").write_text(
        f"daemon off; pid {folder}/pid; error_log {folder}/error.log;\nevents {{}}\n"
        f"http {{ access_log off;\n{places}{block}}}\n"
    )
    return ["nginx", "-c", folder / "nginx.conf", "-p", folder, "-e", folder / "error.log"]


def caddy(folder, upstream, port):
    block = replaced(
        recipe("text", "lab.example"), ("127.0.0.1:8080", f"127.0.0.1:{upstream}"),
        ("lab.example {", "lab.example {\n  tls internal"),
    )  # fmt: skip
    options = f"admin off\n https_port {port}\n auto_https disable_redirects\n skip_install_trust"
    (folder / "Caddyfile").write_text(f"{{\n {options}\n storage file_system {folder}/data\n}}\n{block}")
    return ["caddy", "run", "--adapter", "caddyfile", "--config", folder / "Caddyfile"]


def configurable_http_proxy(folder, upstream, port):
    cert, key = certificate(folder)
    line = replaced(
        recipe("sh", "configurable-http-proxy"), ("127.0.0.1:8080", f"127.0.0.1:{upstream}"), ("443", port),
        ("0.0.0.0", "127.0.0.1"), ("/etc/ssl/lab.example.pem", cert), ("/etc/ssl/lab.example.key", key), ("\\\n", " "),
    )  # fmt: skip
    return [*line.split(), "--api-port", str(free_port())]


def trusting():
    """Return how to speak TLS to a server whose certificate nobody has signed."""
    trust = ssl.create_default_context()
    trust.check_hostname, trust.verify_mode = False, ssl.CERT_NONE
    return trust


@contextlib.contextmanager
def running(command, port):
    process = subprocess.Popen(list(map(str, command)), stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    try:
        for _ in range(300):
            # Caddy listens before its certificate is made, and ends handshakes until then.
            with (
                contextlib.suppress(OSError),
                socket.create_connection(("127.0.0.1", port), 5.0) as link,
                trusting().wrap_socket(link, server_hostname=NAME),
            ):
                break
            if process.poll() is not None:
                pytest.fail(f"{command[0]} ended: {process.stdout.read().decode()}")
            time.sleep(0.1)
        else:
            pytest.fail(f"{command[0]} does not listen")
        yield
    finally:
        process.terminate()
        try:
            process.wait(10)
        finally:
            process.kill()
            process.stdout.close()


class Near(aiohttp.abc.AbstractResolver):
    """Every name is this machine."""

    async def resolve(self, host, port=0, family=socket.AF_INET):
        return [{"hostname": host, "host": "127.0.0.1", "port": port, "family": family, "proto": 0, "flags": 0}]

    async def close(self):
        pass


@pytest.mark.parametrize("proxy", [nginx, caddy, configurable_http_proxy], ids=lambda proxy: proxy.__name__)
def test_a_recipe_passes_on_all_that_a_browser_needs(tmp_path, caplog, proxy):
    program = proxy.__name__.replace("_", "-")
    if (found := shutil.which(program, path=PLACES)) is None:
        pytest.skip(f"{program} is not installed")
    folder, root = tmp_path / "proxy", tmp_path / "root"
    folder.mkdir()
    root.mkdir()

    async def visits(port):
        connector = aiohttp.TCPConnector(ssl=trusting(), resolver=Near(), local_addr=("127.0.0.2", 0))
        base, origin = f"https://{NAME}:{port}", {"Host": NAME, "Origin": f"https://{NAME}"}
        async with aiohttp.ClientSession(connector=connector, headers=origin) as http:
            async with http.get(f"{base}/?token=wrong-one-altogether") as answer:
                assert answer.status == 401
            async with http.get(f"{base}/?token={TOKEN}", allow_redirects=False) as answer:
                assert (answer.status, answer.headers["Location"]) == (303, "/")
            async with http.get(base) as answer:
                assert "/begin" in await answer.text()
            async with http.ws_connect(f"{base}/begin") as begin:
                assert (await begin.receive()).data == "ready"
            async with http.ws_connect(f"{base}/ws", max_msg_size=0) as link:
                for size in (10, 700_000):
                    sent = b"id__" + bytes(4) + size.to_bytes(4, "little") + bytes(size)
                    await link.send_bytes(sent)
                    assert (await link.receive()).data == sent

            async def slow():
                for _ in range(8):
                    yield bytes(2**19)
                    await asyncio.sleep(0.05)

            async with http.post(
                f"{base}/upload?name=a.trk", data=slow(), headers={"Content-Length": str(2**22)}
            ) as answer:
                assert (answer.status, await answer.text()) == (200, str(2**22))
            async with http.post(f"{base}/upload?name=a.trk", headers={"Origin": "https://evil.example"}) as answer:
                assert answer.status == 403
            async with http.get(f"{base}/index.html") as answer:
                assert answer.headers["Content-Security-Policy"]

    async def test():
        options = {"origins": [f"https://{NAME}"], "proxies": ["127.0.0.1"]}
        async with gate(root, **options) as server:
            port = free_port()
            command = [found, *proxy(folder, server.port, port)[1:]]
            manager = running(command, port)
            await asyncio.to_thread(manager.__enter__)
            try:
                await visits(port)
            finally:
                await asyncio.to_thread(manager.__exit__, None, None, None)

    asyncio.run(asyncio.wait_for(test(), 90))
    refused = [record.getMessage() for record in caplog.records if "a wrong token" in record.getMessage()]
    assert refused
    assert all("from 127.0.0.2" in line for line in refused)  # the browser's address, and not the proxy's
