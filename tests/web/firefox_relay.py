"""Stands between Playwright and a Firefox that is older than it: to be run as if it were Firefox.

Playwright speaks WebDriver BiDi to stock Firefox, and for each context asks for what only the newest ones know, such as
overrides of media features, even where a test wants none. Distributions have releases with extended support: those
answer "unknown command", with which all ends. Here commands of the module `emulation` that Firefox does not know are
answered as if done, and downloads of what a page itself has made, which those releases do not number, go by their
address. All else is passed on as it is.
"""

import asyncio
import json
import re
import socket
import sys

from aiohttp import ClientSession, WSMsgType, web

LISTENS = re.compile(rb"WebDriver BiDi listening on (ws://\S+)")


def forgiven(text: str, asked: dict[int, str]) -> str:
    """Return Firefox's message, or what is said instead of it."""
    message = json.loads(text)
    method = asked.pop(message.get("id"), "")
    if message.get("error") == "unknown command" and method.startswith("emulation."):
        return json.dumps({"type": "success", "id": message["id"], "result": {}})
    if message.get("method", "").startswith("browsingContext.download") and message["params"]["navigation"] is None:
        message["params"]["navigation"] = message["params"]["url"]
        return json.dumps(message)
    return text


async def relay(url: str, request: web.Request) -> web.WebSocketResponse:
    """Pass messages both ways until one side closes."""
    here = web.WebSocketResponse(max_msg_size=0)
    await here.prepare(request)
    asked: dict[int, str] = {}
    async with ClientSession() as session, session.ws_connect(url + request.path, max_msg_size=0) as there:

        async def asks() -> None:
            async for message in here:
                if message.type is WSMsgType.TEXT:
                    command = json.loads(message.data)
                    asked[command["id"]] = command["method"]
                    await there.send_str(message.data)

        async def answers() -> None:
            async for message in there:
                if message.type is WSMsgType.TEXT:
                    await here.send_str(forgiven(message.data, asked))

        sides = [asyncio.ensure_future(asks()), asyncio.ensure_future(answers())]
        _, open_yet = await asyncio.wait(sides, return_when=asyncio.FIRST_COMPLETED)
        for side in open_yet:
            side.cancel()
    await here.close()
    return here


async def serve(url: str) -> int:
    """Listen on a port of its own for who would speak to Firefox, and return it."""
    application = web.Application()
    application.router.add_get("/{path:.*}", lambda request: relay(url, request))
    runner = web.AppRunner(application)
    await runner.setup()
    ours = socket.create_server(("127.0.0.1", 0))
    await web.SockSite(runner, ours).start()
    return ours.getsockname()[1]


async def main(command: list[str]) -> int:
    """Run Firefox, tell Playwright the relay's address instead of Firefox's, and return how it ended."""
    firefox = await asyncio.create_subprocess_exec(*command, stderr=asyncio.subprocess.PIPE)
    async for line in firefox.stderr:
        if found := LISTENS.search(line):
            line = b"WebDriver BiDi listening on ws://127.0.0.1:%d\n" % await serve(found[1].decode())
        sys.stderr.buffer.write(line)
        sys.stderr.buffer.flush()
    return await firefox.wait()


if __name__ == "__main__":
    sys.exit(asyncio.run(main(sys.argv[1:])))
