"""What tests of streams of pictures share: slow ones, somebody who watches, and a hand that drags."""

import asyncio

from pvfiblets.web.view.stream import PictureStream


def slow_stream(plotter, seconds=1.0, **settings):
    """Return a stream whose frames seem to take some time."""
    stream = PictureStream(plotter, "view", **settings)
    stream.update_size("", {"w": 200, "h": 120, "p": 1.0})
    took = stream._pace.took
    stream._pace.took = lambda level, _, **moved: took(level, seconds * level.cost, **moved)
    return stream


class Streamer:
    """Notes what is sent."""

    def __init__(self):
        self.sizes = []
        self.qualities = []

    def push_content(self, _name, meta, _content):
        self.sizes.append((meta["w"], meta["h"]))
        self.qualities.append(meta["quality"])


def doing(stream):
    """Return the names of the coroutines in which a stream is, the outermost first."""
    names, coroutine = [], stream._task.get_coro()
    while hasattr(coroutine, "cr_code"):
        names.append(coroutine.cr_code.co_name)
        coroutine = coroutine.cr_await
    return names


async def rests(stream):
    """Wait until nothing more comes of a stream: it waits for something to happen, and nothing has."""
    async with asyncio.timeout(120):
        while stream._wanted.is_set() or doing(stream) != ["_run", "wait"]:
            await asyncio.sleep(0.002)


def drag(stream, streamer, moves=6):
    """Drag over the picture, a frame a move, let go and wait until nothing more comes."""

    def event(kind, x):
        keys = {"ctrlKey": False, "altKey": False, "shiftKey": False}
        return {"type": kind, "x": x, "y": 50, "w": 200, "h": 120, **keys}

    async def run():
        stream.set_streamer(streamer)
        stream.on_interaction("", event("LeftButtonPress", 40))
        for k in range(moves):
            sent = len(streamer.sizes)
            stream.on_interaction("", event("MouseMove", 40 + 4 * k))
            async with asyncio.timeout(120):
                while len(streamer.sizes) == sent:
                    await asyncio.sleep(0.002)
        stream.on_interaction("", event("LeftButtonRelease", 40 + 4 * moves))
        await rests(stream)
        await stream.close()

    asyncio.run(run())
