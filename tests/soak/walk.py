"""A random walk over all that a plotter offers: no error of OpenGL, and nothing that grows.

Every round opens a plotter, does one to three random acts before each frame (:mod:`.acts`: adding, removing, styles,
cuts, filters, selections, picking, widgets, VTK's passes, picture effects, resizing, second windows), and ends by
removing everything. Then OpenGL is asked for its remaining objects, by their names and bytes, and once the windows are
closed the process for its memory. An error is reported with the acts that led to it; the same seed repeats them.
"""

from __future__ import annotations

import ctypes
import gc
import sys
from collections import Counter
from pathlib import Path
from typing import Any

import moderngl
import numpy as np
import pyvista as pv

from pvfiblets.engine.gl.gl_loader import loader
from pvfiblets.mappers.frames import windows

from . import gpu_memory
from .acts import WEIGHTS, Data

MOST_ACTORS = 4
OURS = (moderngl.Buffer, moderngl.ComputeShader, moderngl.Framebuffer, moderngl.Program, moderngl.Query,
        moderngl.Renderbuffer, moderngl.Sampler, moderngl.Texture, moderngl.Texture3D, moderngl.TextureArray,
        moderngl.VertexArray)  # fmt: skip

REPORTED = 40
"""Acts reported of those that led to an error."""

KINDS = ("Texture", "Buffer", "Framebuffer", "Renderbuffer", "VertexArray", "Query", "Sampler", "Program")


class SoakError(AssertionError):
    """What went wrong, and after which acts."""


class Window:
    """A plotter, and what was added to it."""

    def __init__(self, size: int, shape: tuple[int, int]) -> None:
        self.plotter = pv.Plotter(off_screen=True, window_size=(size, size), shape=shape)
        self.actors: list[tuple[str, Any]] = []
        self.drawn = False

    def of(self, *kinds: str) -> list[Any]:
        """Return the actors that these methods of the plotter have added."""
        return [actor for kind, actor in self.actors if kind in kinds]

    def clear(self) -> None:
        """Remove everything that can be."""
        self.plotter.fiblets.clear_widgets()
        self.plotter.clear()
        self.actors.clear()

    def draw(self) -> str:
        """Draw a frame, and return what OpenGL says of it."""
        if not self.drawn:
            self.plotter.show(auto_close=False, interactive=False)
            self.drawn = True
        self.plotter.render()
        self.plotter.render_window.MakeCurrent()
        return error_of_current()

    def close(self) -> None:
        """Close the window."""
        self.plotter.close()
        self.actors.clear()


class Soak:
    """A random walk over scenes.

    Parameters
    ----------
    seed : int
        The same seed makes the same walk.
    size : int
        Largest side of windows, pixels.

    Attributes
    ----------
    windows : list of Window
        One or two.
    log : list of str
        What was done, frame by frame.
    acts : collections.Counter
        How often each act was.
    refused : collections.Counter
        What was said by acts that do not go with what there is, such as a number of layers too many: the scene must
        go on as it was.
    """

    def __init__(self, seed: int, size: int) -> None:
        self.seed, self.size = seed, size
        self.data = Data(seed)
        gc.collect()
        self._others = alive(), sum(unreleased().values())  # of whatever else this process has drawn
        self.windows: list[Window] = []
        self.log: list[str] = []
        self.acts: Counter[str] = Counter()
        self.refused: Counter[str] = Counter()
        self.frames = 0
        self._rng = np.random.default_rng(seed)
        self._kinds = list(WEIGHTS)
        weights = np.array(list(WEIGHTS.values()), float)
        self._shares = weights / weights.sum()

    def open(self, shape: tuple[int, int] = (1, 1)) -> Window:
        """Open another window."""
        self.windows.append(Window(self.size, shape))
        return self.windows[-1]

    def window(self, rng: np.random.Generator) -> Window:
        """Return one of the windows."""
        window = self.windows[int(rng.integers(0, len(self.windows)))]
        n, m = window.plotter.shape if len(window.plotter.renderers) > 1 else (1, 1)
        window.plotter.subplot(int(rng.integers(0, n)), int(rng.integers(0, m)))
        return window

    def add(self, method: str, *what: Any, **how: Any) -> str | None:
        """Add something to a window that has room for it."""
        window = self.window(self._rng)
        if len(window.actors) >= MOST_ACTORS:
            return None
        window.actors.append((method, getattr(window.plotter, method)(*what, **how)))
        shown = {name: value for name, value in how.items() if not isinstance(value, np.ndarray)}
        return f"{method} {shown}"

    def frame(self) -> None:
        """Do one to three acts, and draw all windows.

        Raises
        ------
        SoakError
            If anything but a refusal is raised, or OpenGL reports an error.
        """
        self.frames += 1
        for _ in range(int(self._rng.integers(1, 4))):
            act = self._kinds[int(self._rng.choice(len(self._kinds), p=self._shares))]
            self._watched(act.__name__, lambda act=act: act(self, self._rng))
        self._draw()

    def _draw(self) -> None:
        for i, window in enumerate(self.windows):
            said = self._watched(f"draw window {i}", window.draw)
            if said != "GL_NO_ERROR":
                raise self._failed(f"OpenGL says {said} in window {i}")

    def _watched(self, name: str, act: Any) -> Any:
        try:
            done = act()
        except (ValueError, KeyError) as error:
            if name.startswith("draw"):
                raise self._failed(f"{type(error).__name__}: {error}") from error
            self.refused[f"{name}: {error}"] += 1
            done = f"{name}, refused: {error}"
        except Exception as error:
            self.log.append(f"{self.frames}: {name} failed")
            raise self._failed(f"{type(error).__name__}: {error}") from error
        if not name.startswith("draw") and done is not None:
            self.log.append(f"{self.frames}: {done}")
            self.acts[name] += 1
        return done

    def _failed(self, what: str) -> SoakError:
        acts = "\n  ".join(self.log[-REPORTED:])
        return SoakError(f"frame {self.frames} of seed {self.seed}: {what}; after\n  {acts}")

    def round(self, frames: int) -> dict[str, Any]:
        """Draw frames in a new plotter, take all away, and return what is left.

        Returns
        -------
        dict
            ``before`` and ``after``: objects of OpenGL by kind, and bytes, of the empty window, VTK's own among them;
            ``ours``: those of the engine; ``contexts``: how many mappers still keep something in a window; ``actors``:
            of ours that are still alive; ``resident_mb``: of the process, all windows closed.
        """
        first = self.open()
        self._draw()
        before = opengl_objects()
        start = len(self.log)
        for _ in range(frames):
            self.frame()
        self.log.append(f"{self.frames}: the end of a round")
        while len(self.windows) > 1:
            self.windows.pop().close()
        first.clear()
        undo(first.plotter, self.size)
        self._draw()
        gc.collect()
        self._draw()
        after, ours = opengl_objects(), unreleased()
        contexts = sum(len(context.slots) for context in windows._contexts.values())
        self.windows.pop().close()
        del first
        gc.collect()
        actors, objects = self._others
        return {
            "frames": self.frames, "size": self.size, "acts": len(self.log) - start,
            "before": before, "after": after, "ours": sum(ours.values()) - objects,
            "contexts": contexts, "actors": alive() - actors, "resident_mb": resident(),
            "objects": len(gc.get_objects()),
        }  # fmt: skip


def undo(plotter: Any, size: int) -> None:
    """Take back what acts did to the window itself."""
    plotter.subplot(0, 0)
    plotter.picture.reset()
    for name in ("disable_ssao", "disable_depth_peeling", "disable_eye_dome_lighting", "disable_anti_aliasing"):
        getattr(plotter, name)()
    plotter.window_size = (size, size)


def error_of_current() -> str:
    """Return the name of the current context's error, and clear it."""
    code = int(ctypes.CFUNCTYPE(ctypes.c_uint)(loader()("glGetError"))())
    names = {0x0500: "GL_INVALID_ENUM", 0x0501: "GL_INVALID_VALUE", 0x0502: "GL_INVALID_OPERATION",
             0x0505: "GL_OUT_OF_MEMORY", 0x0506: "GL_INVALID_FRAMEBUFFER_OPERATION"}  # fmt: skip
    return names.get(code, hex(code)) if code else "GL_NO_ERROR"


def opengl_objects() -> dict[str, int]:
    """Return how many objects of each kind the current context has, and the bytes of them."""
    address_of = loader()
    found = {}
    for kind in KINDS:
        is_one = ctypes.CFUNCTYPE(ctypes.c_ubyte, ctypes.c_uint)(address_of(f"glIs{kind}"))
        found[kind] = sum(bool(is_one(name)) for name in range(1, gpu_memory.MOST_NAMES))
    found["bytes"] = gpu_memory.allocated() or 0
    error_of_current()  # it asks textures for levels that they lack
    return found


def alive() -> int:
    """Return how many actors and mappers of ours there are."""
    return sum(
        str(type(thing).__module__).startswith(("pvfiblets.plotting", "pvfiblets.mappers"))
        and type(thing).__name__.endswith(("Actor", "Mapper"))
        and not type(thing).__name__.startswith("_")  # the place of a setting, of which there is one
        for thing in gc.get_objects()
    )


def unreleased() -> dict[str, int]:
    """Return how many of the engine's objects of OpenGL were not given back, by kind, in all windows."""
    found: Counter[str] = Counter()
    for thing in gc.get_objects():
        name = type(thing).__name__
        if type(thing) in OURS and type(thing.mglo) is not moderngl.InvalidObject:
            found[name] += not (name == "Framebuffer" and thing.glo == 0)
    return dict(found)


def resident() -> float:
    """Return the process's resident memory, MB, after giving back to the system what can be."""
    if not sys.platform.startswith("linux"):
        return 0.0
    ctypes.CDLL(None).malloc_trim(0)
    status = dict(line.split(":", 1) for line in Path("/proc/self/status").read_text(encoding="utf-8").splitlines())
    return int(status["VmRSS"].split()[0]) / 1024


def walk(frames: int, per_round: int, seed: int, size: int) -> tuple[Soak, list[dict[str, Any]]]:
    """Draw so many frames in rounds; return the walk, and what was left after each round."""
    soak = Soak(seed, size)
    rounds = []
    while soak.frames < frames:
        rounds.append(soak.round(min(per_round, frames - soak.frames)))
        print({key: value for key, value in rounds[-1].items() if key not in ("before", "after")})
    return soak, rounds
