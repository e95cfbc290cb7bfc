"""The bundles of a tractogram as an editable list: its groups, each with a colour and a visibility.

A bundle *is* a group, so changes are saved in ``.fiblets`` and ``.trx`` files, and ``scalars="group"`` and
``groups_shown`` use them. Colour and visibility are data of the group (``per_group``): ``color``, three uint8, and
``visible``, one uint8 that only hidden bundles have.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ...codec.decompress import select_streamlines
from ..selection.predicates import Predicate
from .colours import as_colour, distinct_colours

if TYPE_CHECKING:
    from ...codec.fibletset import FibletSet
    from ...streamlines import Streamlines

Ints = npt.NDArray[np.int64]
Colour = tuple[float, float, float]
COLOR, VISIBLE = "color", "visible"


class Bundle:
    """One bundle of a list; usable as an index: ``fiblets[bundle]``.

    Its ``name``, ``color`` and ``visible`` can be set.
    """

    def __init__(self, bundles: Bundles, name: str) -> None:
        self._bundles, self._name = bundles, name

    def __repr__(self) -> str:
        return f"<Bundle {self.name!r}: {self.count:,} streamlines{'' if self.visible else ', hidden'}>"

    def __len__(self) -> int:
        return self.count

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> npt.NDArray[Any]:
        del copy  # numbers are small, and a copy is never wrong
        return np.array(self.ids, dtype)

    @property
    def name(self) -> str:
        """Name of the bundle; setting it renames the group."""
        return self._name

    @name.setter
    def name(self, name: str) -> None:
        self._bundles.rename(self._name, name)
        self._name = name

    @property
    def ids(self) -> Ints:
        """``(k,)`` int64: indices of its streamlines, in rising order."""
        return self._bundles.ids(self._name)

    @property
    def count(self) -> int:
        """Number of streamlines."""
        return len(self.ids)

    @property
    def color(self) -> Colour:
        """Red, green, blue, from 0 to 1."""
        return self._bundles.colors[self._name]

    @color.setter
    def color(self, color: Any) -> None:
        self._bundles.set_color(self._name, color)

    @property
    def visible(self) -> bool:
        """Whether the bundle is visible."""
        return self._name not in hidden_groups(self._bundles.data.per_group)

    @visible.setter
    def visible(self, visible: bool) -> None:
        self._bundles.set_visible(self._name, visible)


class Bundles:
    """The groups of a tractogram as an ordered, editable list.

    Parameters
    ----------
    data : FibletSet or Streamlines
        Its ``groups`` and ``per_group`` are read and changed in place.
    on_change : callable, optional
        Called after each change, without arguments.
    """

    def __init__(self, data: FibletSet | Streamlines, on_change: Callable[[], None] | None = None) -> None:
        self.data = data
        self._on_change = on_change

    def __len__(self) -> int:
        return len(self.data.groups)

    def __iter__(self) -> Iterator[Bundle]:
        return (Bundle(self, name) for name in list(self.data.groups))

    def __contains__(self, name: object) -> bool:
        return name in self.data.groups

    def __getitem__(self, key: str | int) -> Bundle:
        if isinstance(key, str):
            return Bundle(self, self._known(key))
        if not -len(self) <= key < len(self):
            raise IndexError(f"bundle {key} is not among the {len(self)} bundles")
        return Bundle(self, self.names[key])

    def __repr__(self) -> str:
        return f"Bundles({', '.join(f'{name!r}: {len(self.ids(name)):,}' for name in self.names)})"

    # ------------------------------------------------------------------------------------------------------ properties

    @property
    def names(self) -> list[str]:
        """Names of the bundles, in order."""
        return list(self.data.groups)

    def ids(self, name: str) -> Ints:
        """Return the streamlines of a bundle, ``(k,)`` int64, rising, each once."""
        return np.unique(np.asarray(self.data.groups[self._known(name)], np.int64))

    @property
    def colors(self) -> dict[str, Colour]:
        """Colour of each bundle, red, green, blue from 0 to 1; by default from its place in the list."""
        return group_colours(self.data.groups, self.data.per_group)

    @property
    def rest(self) -> Ints:
        """``(k,)`` int64: streamlines in no bundle."""
        free = np.ones(len(self.data), bool)
        for members in self.data.groups.values():
            free[np.asarray(members, np.int64)] = False
        return np.flatnonzero(free)

    # -------------------------------------------------------------------------------------------------------- changes

    def add(self, name: str, ids: Any, *, color: Any = None, visible: bool = True) -> Bundle:
        """Add a bundle at the end of the list.

        Parameters
        ----------
        name : str
            A new name.
        ids : array_like, slice, Predicate, Similar, Cluster or Bundle
            Its streamlines: numbers, a mask, a query's result, or a condition such as ``regions.passes(region)``.
        color : color-like, optional
            By default a distinct colour by its place in the list.
        visible : bool, default: True
            Whether the bundle is visible.

        Returns
        -------
        Bundle
            The new bundle.

        Raises
        ------
        ValueError
            If the name is taken or empty, or the colour is invalid.
        IndexError
            If a streamline is out of range.
        """
        self._free(name)
        members = self._members(ids)
        given = None if color is None else as_colour(color)
        self.data.groups[name] = members
        self.data.per_group.pop(name, None)
        if given is not None:
            self._put(name, COLOR, _bytes(given))
        if not visible:
            self._put(name, VISIBLE, np.zeros(1, np.uint8))
        self._changed()
        return Bundle(self, name)

    def add_all(self, groups: Mapping[str, Any]) -> None:
        """Add bundles from a dict of streamlines by name, such as :meth:`.Clusters.groups`; all or none."""
        members = {}
        for name, ids in groups.items():
            self._free(name)
            members[name] = self._members(ids)
        self.data.groups.update(members)
        for name in members:
            self.data.per_group.pop(name, None)
        self._changed()

    def remove(self, name: str) -> None:
        """Remove a bundle from the list; its streamlines stay in the set."""
        self._known(name)
        del self.data.groups[name]
        self.data.per_group.pop(name, None)
        self._changed()

    def rename(self, name: str, new: str) -> None:
        """Rename a bundle; its place in the list stays."""
        self._known(name)
        if new == name:
            return
        self._free(new)
        for held in (self.data.groups, self.data.per_group):
            rows = {new if key == name else key: value for key, value in held.items()}
            held.clear()
            held.update(rows)  # type: ignore[arg-type]  # of the same dict
        self._changed()

    def merge(self, names: Iterable[str], into: str, *, keep: bool = False) -> Bundle:
        """Merge bundles: the union of their streamlines.

        Parameters
        ----------
        names : iterable of str
            Bundles to merge.
        into : str
            Name of the result; it may be one of `names`. The result has the place and colour of the first.
        keep : bool, default: False
            Keep the merged bundles, and add the result at the end.

        Returns
        -------
        Bundle
            The result.

        Raises
        ------
        KeyError
            If no bundle has one of the names.
        ValueError
            If `names` is empty, or another bundle is called `into`.
        """
        parts = [self._known(name) for name in names]
        if not parts:
            raise ValueError("no bundles to merge; give the names of bundles")
        if into not in parts or keep:
            self._free(into)
        ids = np.unique(np.concatenate([self.ids(name) for name in parts]))
        if keep:
            self.data.groups[into] = ids
        else:
            first = parts[0]
            facts = self.data.per_group.get(first)
            order = [into if name == first else name for name in self.names if name == first or name not in parts]
            groups = {name: ids if name == into else self.data.groups[name] for name in order}
            for name in parts:
                self.data.per_group.pop(name, None)
            if facts:
                self.data.per_group[into] = facts
            self.data.groups.clear()
            self.data.groups.update(groups)
        self._changed()
        return Bundle(self, into)

    def subtract(self, name: str, others: str | Iterable[str], *, into: str | None = None) -> Bundle:
        """Remove the streamlines of other bundles from a bundle.

        Parameters
        ----------
        name : str
            Bundle to reduce.
        others : str or iterable of str
            Bundles whose streamlines are removed.
        into : str, optional
            Name of a new bundle for the result. By default the bundle itself is changed.

        Returns
        -------
        Bundle
            The result.

        Raises
        ------
        KeyError
            If no bundle has one of the names.
        ValueError
            If a bundle `into` exists.
        """
        left = self.ids(name)
        for other in [others] if isinstance(others, str) else others:
            left = np.setdiff1d(left, self.ids(other))
        if into is not None:
            return self.add(into, left)
        self.data.groups[name] = left
        self._changed()
        return Bundle(self, name)

    def set_ids(self, name: str, ids: Any) -> None:
        """Replace the streamlines of a bundle; `ids` as for :meth:`add`."""
        self.data.groups[self._known(name)] = self._members(ids)
        self._changed()

    def reorder(self, names: Iterable[str]) -> None:
        """Move the named bundles to the front, in this order."""
        first = [self._known(name) for name in names]
        if len(set(first)) != len(first):
            raise ValueError(f"the order {first} names a bundle twice")
        groups = {name: self.data.groups[name] for name in [*first, *(n for n in self.names if n not in first)]}
        self.data.groups.clear()
        self.data.groups.update(groups)
        self._changed()

    def set_color(self, name: str, color: Any) -> None:
        """Give a bundle a `color`: ``"#rrggbb"``, a name, or three numbers."""
        self._put(self._known(name), COLOR, _bytes(as_colour(color)))
        self._changed()

    def set_visible(self, name: str, visible: bool) -> None:
        """Show or hide a bundle."""
        self._known(name)
        if visible:
            self.data.per_group.get(name, {}).pop(VISIBLE, None)
        else:
            self._put(name, VISIBLE, np.zeros(1, np.uint8))
        self._changed()

    def show_only(self, names: str | Iterable[str]) -> None:
        """Hide all bundles except the named ones."""
        wanted = {self._known(name) for name in ([names] if isinstance(names, str) else names)}
        for name in self.names:
            if name in wanted:
                self.data.per_group.get(name, {}).pop(VISIBLE, None)
            else:
                self._put(name, VISIBLE, np.zeros(1, np.uint8))
        self._changed()

    # --------------------------------------------------------------------------------------------------------- files

    def export(self, path: str | os.PathLike[str], *, suffix: str = ".tck", hidden: bool = True) -> list[Path]:
        """Write the bundles to one file each, or to one file with groups.

        Parameters
        ----------
        path : str or PathLike
            A ``.trx`` or ``.fiblets`` file, which keeps groups, receives all streamlines that are in a bundle. An
            existing folder, or a path without a suffix, receives one file per bundle; it is created if missing.
        suffix : str, default: ".tck"
            Format of the files in a folder.
        hidden : bool, default: True
            Write hidden bundles as well.

        Returns
        -------
        list of Path
            The written files.

        Raises
        ------
        ValueError
            If there is no bundle to write, or the file's format keeps no groups.
        UnknownFormatError
            If no writable format has this suffix.
        """
        from ...formats import registry

        chosen = [bundle for bundle in self if hidden or bundle.visible]
        if not chosen:
            raise ValueError("there is no bundle to write")
        target = Path(path).expanduser()
        if target.suffix and not target.is_dir():
            if target.suffix.lower() not in (".trx", ".fiblets"):
                raise ValueError(f"{target.suffix} files keep no groups; give a .trx or .fiblets file, or a folder")
            ids = np.unique(np.concatenate([bundle.ids for bundle in chosen]))
            _save(self._part(ids, [bundle.name for bundle in chosen]), target)
            return [target]
        if suffix != ".fiblets":
            registry.module_for(f"bundle{suffix}", "write")
        target.mkdir(parents=True, exist_ok=True)
        written: list[Path] = []
        for bundle in chosen:
            file = target / f"{_file_name(bundle.name, [p.stem for p in written])}{suffix}"
            _save(self._part(bundle.ids, [bundle.name]), file)
            written.append(file)
        return written

    def _part(self, ids: Ints, names: list[str]) -> Any:
        part: Any = self.data[ids]
        for held in (part.groups, part.per_group):
            for name in [name for name in held if name not in names]:
                del held[name]
        return part

    # -------------------------------------------------------------------------------------------------------- inside

    def _known(self, name: str) -> str:
        if name not in self.data.groups:
            there = ", ".join(map(repr, self.names)) or "none"
            raise KeyError(f"there is no bundle {name!r}; there are: {there}")
        return name

    def _free(self, name: str) -> None:
        if not isinstance(name, str) or not name.strip():
            raise ValueError(f"a bundle's name is {name!r}; give some text")
        if name in self.data.groups:
            raise ValueError(f"there is a bundle {name!r} already; give another name, or remove that one first")

    def _members(self, ids: Any) -> Ints:
        if isinstance(ids, Predicate):
            ids = self.data.select(ids)  # type: ignore[union-attr]  # only sets evaluate conditions
        return np.unique(select_streamlines(len(self.data), getattr(ids, "ids", ids)))

    def _put(self, name: str, key: str, value: npt.NDArray[Any]) -> None:
        self.data.per_group.setdefault(name, {})[key] = value

    def _changed(self) -> None:
        if self._on_change is not None:
            self._on_change()


def group_colours(groups: Iterable[str], per_group: Mapping[str, Mapping[str, Any]]) -> dict[str, Colour]:
    """Colour of each group: its own, or one by its place, red, green, blue from 0 to 1."""
    names = list(groups)
    found: dict[str, Colour] = {}
    for name, usual in zip(names, distinct_colours(len(names)).tolist(), strict=True):
        own = own_colour(per_group.get(name, {}))
        found[name] = (usual[0], usual[1], usual[2]) if own is None else own
    return found


def own_colour(facts: Mapping[str, Any]) -> Colour | None:
    """Colour in a group's data, None if there is none or it is invalid."""
    values = np.asarray(facts.get(COLOR, ())).ravel()
    if values.size < 3 or values.dtype.kind not in "iuf":
        return None
    parts = values[:3].astype(np.float64) / (255.0 if values.dtype.kind in "iu" or values.max() > 1.0 else 1.0)
    red, green, blue = np.clip(parts, 0.0, 1.0).tolist()
    return (red, green, blue) if np.isfinite(parts).all() else None


def hidden_groups(per_group: Mapping[str, Mapping[str, Any]]) -> set[str]:
    """Names of the groups that are hidden."""
    return {
        name
        for name, facts in per_group.items()
        if VISIBLE in facts and not np.asarray(facts[VISIBLE]).ravel()[:1].any()
    }


def _bytes(colour: Colour) -> npt.NDArray[np.uint8]:
    return np.round(np.array(colour) * 255.0).astype(np.uint8)


def _file_name(name: str, taken: list[str]) -> str:
    """A name that every file system takes, and no other bundle has."""
    stem = re.sub(r"[^\w.+-]+", "_", name).strip("._") or "bundle"
    candidates = [stem, *(f"{stem}_{i}" for i in range(2, len(taken) + 3))]
    return next(candidate for candidate in candidates if candidate.lower() not in [t.lower() for t in taken])


def _save(part: Any, path: Path) -> None:
    if hasattr(part, "save"):
        part.save(path)
        return
    from ...formats import write

    write(path, part)


def first_groups(fiblets: FibletSet) -> npt.NDArray[np.float64]:
    """Return for each streamline the number of its first group that is shown, else of a hidden one; NaN without."""
    numbers = np.full(fiblets.n_streamlines, np.nan)
    hidden = hidden_groups(fiblets.per_group)
    order = sorted(enumerate(fiblets.groups), key=lambda item: item[1] in hidden)
    for index, name in reversed(order):
        numbers[np.asarray(fiblets.groups[name])] = index
    return numbers
