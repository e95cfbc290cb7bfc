"""What tests of streams of pictures share: slow ones, somebody who watches, and a hand that drags."""

import asyncio

from pvfiblets.web.view.stream import REST, PictureStream


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
            async with asyncio.timeout(30):
                while len(streamer.sizes) == sent:
                    await asyncio.sleep(0.002)
        stream.on_interaction("", event("LeftButtonRelease", 40 + 4 * moves))
        async with asyncio.timeout(30):
            while streamer.sizes[-1] != (200, 120) or streamer.qualities[-1] != stream.still_quality:
                await asyncio.sleep(0.01)
        await asyncio.sleep(2 * REST)
        await stream.close()

    asyncio.run(run())
