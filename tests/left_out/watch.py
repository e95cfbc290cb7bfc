"""Sees what a scene asks of OpenGL, without asking the program: it stands between the program and moderngl."""

import functools
import re

import moderngl
import numpy as np

from pvfiblets.engine.gl import moderngl_extras, shaders

SWITCHED_ON = re.compile(r"^#define FEATURE_(\w+) 1$", re.MULTILINE)
STAGES = ("vertex", "fragment", "geometry", "tess_control", "tess_evaluation", "task", "mesh")


class Watch:
    """Counts buffers and textures that are alive, and notes which programs run.

    Make one before anything is drawn. Framebuffers and vertex arrays hold no data of their own and are not counted.

    Attributes
    ----------
    ran : set of str
        Shader files of the programs that ran since :meth:`forget`.
    features : set of str
        Switches that were on in the text of those programs.
    made : int
        Buffers, textures and programs made since :meth:`forget`.
    """

    def __init__(self) -> None:
        self.ran: set[str] = set()
        self.features: set[str] = set()
        self.made = 0
        self._alive: dict[tuple[str, int], int] = {}
        self._names: dict[str, str] = {}
        self._programs: dict[int, tuple[frozenset[str], frozenset[str]]] = {}
        self._watch_memory()
        self._watch_programs()

    def forget(self) -> None:
        """Begin to note anew what runs."""
        self.ran.clear()
        self.features.clear()
        self.made = 0

    @property
    def nbytes(self) -> int:
        """Bytes of what is alive."""
        return sum(self._alive.values())

    def _watch_memory(self) -> None:
        for name in (
            "buffer",
            "texture",
            "texture3d",
            "texture_array",
            "texture_cube",
            "depth_texture",
            "renderbuffer",
            "depth_renderbuffer",
        ):
            _after(moderngl.Context, name, self._born)
        for kind in (
            moderngl.Buffer,
            moderngl.Texture,
            moderngl.Texture3D,
            moderngl.TextureArray,
            moderngl.Renderbuffer,
        ):
            _after(kind, "release", lambda _, thing: self._alive.pop(_key(thing), None))
        _after(moderngl_extras.GLExtras, "add_levels", lambda _, gl, texture, levels: self._grown(texture, levels))

    def _born(self, thing, *_, **__) -> None:
        self._alive[_key(thing)] = _size(thing)
        self.made += 1

    def _grown(self, texture, levels: int) -> None:
        sides = texture.size
        each = self._alive[_key(texture)] // (sides[0] * sides[1])
        self._alive[_key(texture)] = sum(each * max(1, sides[0] >> n) * max(1, sides[1] >> n) for n in range(levels))

    def _watch_programs(self) -> None:
        _after(shaders, "assemble", lambda text, name, *_, **__: self._names.__setitem__(text.strip(), name))
        _after(moderngl.Context, "compute_shader", lambda made, _, source: self._linked(made, [source]))
        _after(
            moderngl.Context,
            "program",
            lambda made, _, **given: self._linked(made, [given.get(f"{stage}_shader") for stage in STAGES]),
        )
        for name in ("run", "run_indirect"):
            _after(moderngl.ComputeShader, name, lambda _, program, *__, **___: self._run(program))
        for name in ("render", "render_indirect", "transform"):
            _after(moderngl.VertexArray, name, lambda _, array, *__, **___: self._run(array.program))

    def _linked(self, program, sources) -> None:
        texts = [source.strip() for source in sources if source]
        names = frozenset(self._names.get(text, "a program without a file") for text in texts)
        features = frozenset(feature for text in texts for feature in SWITCHED_ON.findall(text))
        self._programs[program.glo] = names, features
        self.made += 1

    def _run(self, program) -> None:
        names, features = self._programs[program.glo]
        self.ran |= names
        self.features |= features


def _key(thing) -> tuple[str, int]:
    """What OpenGL knows it by: it is alive until it is released, whether Python still holds it or not."""
    return type(thing).__name__, thing.glo


def _size(thing) -> int:
    if isinstance(thing, moderngl.Buffer):
        return thing.size
    sides = thing.size if isinstance(thing.size, tuple) else (thing.size,)
    samples = max(1, getattr(thing, "samples", 0))
    return int(np.prod(sides)) * thing.components * int(thing.dtype[-1]) * samples


def _after(owner, name: str, note) -> None:
    """Have `note` be called with the result and the arguments of a function after each call."""
    function = getattr(owner, name)

    @functools.wraps(function)
    def watched(*arguments, **keywords):
        result = function(*arguments, **keywords)
        note(result, *arguments, **keywords)
        return result

    setattr(owner, name, watched)
