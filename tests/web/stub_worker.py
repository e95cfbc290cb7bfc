"""A session's process that draws nothing and answers as a worker does: the front server is tested without OpenGL."""

import asyncio
import json
import os
import sys
from pathlib import Path

from aiohttp import web

from pvfiblets.web.worker import key_check


async def page(request):
    if request.path == "/crash":
        os._exit(3)
    if request.path == "/half":
        answer = web.StreamResponse(headers={"Content-Length": "1000000"})
        await answer.prepare(request)
        await answer.write(bytes(1000))
        os._exit(3)
    if request.path in ("/endless", "/tenth"):
        answer = web.StreamResponse()
        await answer.prepare(request)
        for _ in range(10 if request.path == "/tenth" else 10_000):
            await answer.write(bytes(2**20))
        return answer
    if request.path == "/noise":
        noise = (request.app["root"] / "noise").read_text()
        for _ in range(500):
            print(noise, file=sys.stderr, flush=True)
    if request.path == "/told":
        return web.json_response(request.app["told"])
    if request.path == "/kept":
        return web.Response(text=(request.app["folder"] / "restore.json").read_text())
    return web.json_response({"pid": os.getpid(), "path": request.raw_path, "cookie": request.headers.get("Cookie")})


async def upload(request):
    return web.Response(text=str(len(await request.read())))


async def socket(request):
    found = web.WebSocketResponse(max_msg_size=0)
    await found.prepare(request)
    async for message in found:
        await found.send_bytes(message.data)
    return found


async def main(told):
    if (failure := Path(told["options"]["root"]) / "fail").exists():
        print(json.dumps({"failure": failure.read_text()}), flush=True)
        sys.exit(1)
    if (doing := Path(told["options"]["root"]) / "abort").exists():  # as C++ does where memory runs out
        print(json.dumps({"doing": doing.read_text()}), flush=True)
        print("terminate called after throwing an instance of 'std::bad_alloc'", file=sys.stderr, flush=True)
        os.abort()
    (Path(told["folder"]) / "session.tmp").write_text(str(os.getpid()))
    (Path(told["folder"]) / "notes").write_text(str(Path(told["options"]["root"]) / ".pvfiblets-part"))
    app = web.Application(middlewares=[key_check(told["key"])], client_max_size=2**30)
    app["root"], app["folder"], app["told"] = Path(told["options"]["root"]), Path(told["folder"]), []
    app.router.add_get("/ws", socket)
    app.router.add_post("/upload", upload)
    app.router.add_post("/session", upload)
    app.router.add_get("/{path:.*}", page)
    runner = web.AppRunner(app)
    await runner.setup()
    await web.TCPSite(runner, "127.0.0.1", 0).start()
    print(json.dumps({"port": runner.addresses[0][1]}), flush=True)
    while line := await asyncio.to_thread(sys.stdin.readline):
        app["told"].append(json.loads(line))
    await runner.cleanup()


if __name__ == "__main__":
    asyncio.run(main(json.loads(sys.stdin.readline())))
