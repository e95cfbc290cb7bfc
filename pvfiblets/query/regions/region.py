"""Regions of space: expressions of shapes by ``&`` (both), ``|`` (either), ``~`` (not) and ``-`` (without).

An expression is a postfix program over its leaves, which are shapes (:mod:`.shapes`): ``k >= 0`` pushes leaf k,
:data:`AND` and :data:`OR` take two off the stack and push one, :data:`NOT` turns the top. The deeper operand always
comes first (Sethi and Ullman 1970, "The generation of optimal code for arithmetic expressions"), so that the stack
never holds more than `MAX_STACK`.

A position with a coordinate that is not finite lies in no region, not in ``~region`` either.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ...images.affines import affine, invert_affine
from .placement import Bounds, positions

if TYPE_CHECKING:
    from .fields import Field

Array = npt.NDArray[np.float64]
Flags = npt.NDArray[np.bool_]

AND, OR, NOT = -1, -2, -3

MAX_LEAVES = 32
"""On the GPU a uniform block holds the leaves: 32 of up to 256 bytes are half of the 16 KiB that OpenGL promises."""
MAX_OPS = 64
MAX_STACK = 6  # 64 words push at most 32 leaves; a stack of depth d needs at least 2^(d-1) of them


class Region:
    """A part of space: shapes joined by ``&``, ``|``, ``~`` and ``-``. Immutable; equal and hashed by content.

    Surfaces and label volumes are equal if they share their data and have the same placement.

    Parameters
    ----------
    leaves : tuple of Shape
        The shapes, without repetition.
    program : tuple of int
        Postfix expression of leaf numbers, :data:`AND`, :data:`OR` and :data:`NOT`; it is not checked.

    Raises
    ------
    ValueError
        If there are more than 32 shapes or 64 operations.
    """

    def __init__(self, leaves: tuple[Shape, ...], program: tuple[int, ...]) -> None:
        if len(leaves) > MAX_LEAVES or len(program) > MAX_OPS:
            raise ValueError(
                f"a region of {len(leaves)} shapes and {len(program)} operations is more than {MAX_LEAVES} and "
                f"{MAX_OPS}; use fewer shapes, or one label volume for many"
            )
        self._leaves = leaves
        self._program = program

    @property
    def leaves(self) -> tuple[Shape, ...]:
        """The shapes, each once."""
        return self._leaves

    @property
    def program(self) -> tuple[int, ...]:
        """Postfix: leaf numbers, :data:`AND`, :data:`OR`, :data:`NOT`."""
        return self._program

    def __and__(self, other: Region) -> Region:
        return _joined(self, other, AND) if isinstance(other, Region) else NotImplemented

    def __or__(self, other: Region) -> Region:
        return _joined(self, other, OR) if isinstance(other, Region) else NotImplemented

    def __sub__(self, other: Region) -> Region:
        return _joined(self, ~other, AND) if isinstance(other, Region) else NotImplemented

    def __invert__(self) -> Region:
        if self._program[-1] == NOT:
            return _made(self._leaves, self._program[:-1])
        return _made(self._leaves, (*self._program, NOT))

    def __bool__(self) -> bool:
        raise TypeError("a region is neither true nor false; combine regions with &, | and ~, not with and, or, not")

    def contains(self, points: npt.ArrayLike) -> Flags:
        """Return which positions lie in the region, in float64.

        Parameters
        ----------
        points : array_like
            ``(n, 3)`` mm, or one position ``(3,)``.

        Returns
        -------
        numpy.ndarray
            ``(n,)`` bool; False where a coordinate is not finite.

        Raises
        ------
        ValueError
            If the points are not three numbers each.
        """
        from .shape_kernels import evaluate

        places = np.ascontiguousarray(positions(points))
        known = [leaf.holds(places) for leaf in self._leaves]
        rows = [flags for flags in known if flags is not None]
        where = np.cumsum([flags is not None for flags in known]) - 1
        where[[flags is None for flags in known]] = -1
        found = np.empty(len(places), np.bool_)
        table = np.stack(rows) if rows else np.zeros((0, len(places)), np.bool_)
        evaluate(*pack_rows(self), table, where, places, found)
        return found

    def distance(self, points: npt.ArrayLike) -> Array:
        """Distances of positions from the region, 0 inside.

        Parameters
        ----------
        points : array_like
            ``(n, 3)`` mm, or one position ``(3,)``.

        Returns
        -------
        numpy.ndarray
            ``(n,)`` float64 mm; NaN where a coordinate is not finite. The shape's :meth:`apart` states the accuracy.

        Raises
        ------
        NotImplementedError
            For ``~`` and ``&``: the distance from those does not follow from the distances of their parts.
        """
        places = positions(points)
        if any(op in (AND, NOT) for op in self._program):
            raise NotImplementedError(
                "no distance from a region made with &, - or ~: it does not follow from the distances of its parts; "
                "ask for each part's distance, or join the parts with |"
            )
        finite = np.isfinite(places).all(axis=1)
        found = np.full(len(places), np.nan)
        some = places if finite.all() else places[finite]
        found[finite] = np.minimum.reduce([leaf.apart(some) for leaf in self._leaves])
        return found

    def moved(self, matrix: npt.ArrayLike) -> Region:
        """Return the region as placed by an invertible affine matrix.

        Parameters
        ----------
        matrix : array_like
            ``(4, 4)`` float64, column vectors: where a position of the region goes.

        Raises
        ------
        ValueError
            If the matrix is not a finite, invertible affine one.
        """
        given = affine(matrix, "matrix")
        invert_affine(given, "matrix")
        return _made(tuple(leaf.placed(given) for leaf in self._leaves), self._program)

    @property
    def bounds(self) -> Array:
        """``(6,)`` xmin, xmax, ymin, ymax, zmin, zmax in mm, infinite where unbounded; 1, -1, … if surely empty.

        An expression's bounds hold it, though not always tightly.
        """
        stack: list[tuple[Bounds, Bounds]] = []  # of the region, and of its complement
        for op in self._program:
            if op >= 0:
                stack.append(self._leaves[op].extents())
            elif op == NOT:
                stack.append(stack.pop()[::-1])
            else:
                b, a = stack.pop(), stack.pop()
                stack.append((a[0] & b[0], a[1] | b[1]) if op == AND else (a[0] | b[0], a[1] & b[1]))
        return stack[0][0].flat()

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Region):
            return NotImplemented
        return self._program == other._program and self._leaves == other._leaves

    def __hash__(self) -> int:
        return hash((self._program, self._leaves))

    def __repr__(self) -> str:
        stack: list[str] = []
        for op in self._program:
            if op >= 0:
                stack.append(repr(self._leaves[op]))
            elif op == NOT:
                stack.append(f"~{stack.pop()}")
            else:
                b, a = stack.pop(), stack.pop()
                stack.append(f"({a} {'&' if op == AND else '|'} {b})")
        return stack[0]


class Shape(Region, ABC):
    """One shape.

    Parameters
    ----------
    kind : int
        One of :data:`PLANE` … :data:`LABELS`.
    linear : numpy.ndarray
        ``(3, 3)``, ``A`` of :mod:`.shapes`.
    centre : numpy.ndarray
        ``(3,)`` mm, ``c`` of :mod:`.shapes`.
    """

    def __init__(self, kind: int, linear: Array, centre: Array) -> None:
        self._kind = kind
        self._linear = np.array(linear, np.float64) + 0.0  # no -0.0: it would make equal shapes differ by their bytes
        self._centre = np.array(centre, np.float64) + 0.0
        self._linear.flags.writeable = self._centre.flags.writeable = False
        super().__init__((self,), (0,))

    @property
    def kind(self) -> int:
        """Kind of unit shape."""
        return self._kind

    @property
    def linear(self) -> Array:
        """``(3, 3)`` float64, ``A`` of :mod:`.shapes`: unit coordinates per mm."""
        return self._linear

    @property
    def centre(self) -> Array:
        """``(3,)`` float64 mm, ``c`` of :mod:`.shapes`: the position whose unit coordinates are 0."""
        return self._centre

    @property
    def matrix(self) -> Array:
        """``(4, 4)`` float64: world mm to unit coordinates, column vectors."""
        found = np.eye(4)
        found[:3, :3] = self._linear
        found[:3, 3] = -(self._linear @ self._centre)
        return found

    @property
    def field(self) -> Field | None:
        """Signed distance bounds on a grid, for surfaces and labels; None for the others."""
        return None

    @property
    def _data(self) -> object:
        """Key among shapes of one kind and place; compared by identity."""
        return None

    def placed(self, matrix: Array) -> Shape:
        """Return the shape as placed by an affine ``(4, 4)`` matrix known to be good."""
        inverse = np.linalg.inv(matrix[:3, :3])
        other: Shape = object.__new__(type(self))
        other.__dict__.update(self._shared())
        Shape.__init__(other, self._kind, self._linear @ inverse, matrix[:3, :3] @ self._centre + matrix[:3, 3])
        return other

    def _shared(self) -> dict[str, Any]:
        """Return data that a moved copy shares with the shape."""
        return {}

    def _unit(self, points: Array) -> tuple[Array, Array, Array]:
        # Written out: a matrix product's order of summation is the library's, that of the kernels is this one.
        x, y, z = (points - self._centre).T
        a = self._linear
        return (
            a[0, 0] * x + a[0, 1] * y + a[0, 2] * z,
            a[1, 0] * x + a[1, 1] * y + a[1, 2] * z,
            a[2, 0] * x + a[2, 1] * y + a[2, 2] * z,
        )

    def holds(self, points: Array) -> Flags | None:  # noqa: ARG002 - of other shapes
        """Return ``(n,)`` bool: which points are in; None of shapes that the kernels of :mod:`.shape_kernels` know."""
        return None

    def spans(self, a: Array, b: Array) -> tuple[npt.NDArray[np.int64], Array] | None:  # noqa: ARG002 - of other shapes
        """Return where segments from ``a`` to ``b`` (m, 3) are in: (m + 1,) firsts of (n, 2) shares from 0 to 1.

        None of shapes that the kernels of :mod:`.segment_kernels` know.
        """
        return None

    @abstractmethod
    def apart(self, points: Array) -> Array:
        """Return ``(n,)`` mm: distances of finite points ``(n, 3)`` from the shape, 0 inside."""

    @abstractmethod
    def extents(self) -> tuple[Bounds, Bounds]:
        """Return bounds of the shape and of its complement."""

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Shape):
            return False if isinstance(other, Region) else NotImplemented
        return self._key() == other._key() and self._data is other._data

    def __hash__(self) -> int:
        return hash((*self._key(), id(self._data)))

    def _key(self) -> tuple[int, bytes, bytes]:
        return self._kind, self._linear.tobytes(), self._centre.tobytes()

    def __repr__(self) -> str:
        return f"{type(self).__name__}(centre={self._centre.tolist()})"


def pack_rows(region: Region) -> tuple[npt.NDArray[np.int32], Array]:
    """Return ``ops`` and ``rows`` as if no shape had a field."""
    rows = np.zeros((len(region.leaves), 20))
    for row, leaf in zip(rows, region.leaves, strict=True):
        row[0] = leaf.kind
        row[1:10] = leaf.linear.ravel()
        row[10:13] = leaf.centre
        row[13] = largest_stretch(leaf.linear)
        row[14:17] = np.linalg.norm(leaf.linear, axis=1) * (1.0 + 1e-12)
        row[17] = -1.0
    return np.array(region.program, np.int32), rows


def largest_stretch(linear: Array) -> float:
    """Return by how much a linear map stretches at most, its rounding included."""
    return float(np.linalg.svd(linear, compute_uv=False)[0]) * (1.0 + 1e-12)


def _depth(program: tuple[int, ...]) -> int:
    depth = deepest = 0
    for op in program:
        depth += 1 if op >= 0 else 0 if op == NOT else -1
        deepest = max(deepest, depth)
    return deepest


def _joined(a: Region, b: Region, op: int) -> Region:
    if _depth(b.program) > _depth(a.program):
        a, b = b, a
    leaves = list(a.leaves)
    places = {leaf: i for i, leaf in enumerate(leaves)}
    for leaf in b.leaves:
        if leaf not in places:
            places[leaf] = len(leaves)
            leaves.append(leaf)
    turned = tuple(places[b.leaves[word]] if word >= 0 else word for word in b.program)
    return _made(tuple(leaves), (*a.program, *turned, op))


def _made(leaves: tuple[Shape, ...], program: tuple[int, ...]) -> Region:
    return leaves[0] if program == (0,) else Region(leaves, program)
