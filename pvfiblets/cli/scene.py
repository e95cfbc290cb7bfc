"""Scenes of ``pvfiblets screenshot`` and ``show``: tracts, images, meshes, cuts and filters; or a session.

Options are named as in the equivalent Python: shapes and conditions are parsed as in sessions
(`pvfiblets.web.session.shapes`), all else goes to ``add_fiblets``, ``add_raycast_volume`` and ``add_mesh`` as it is,
which check it.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pyvista as pv

    from pvfiblets.query.regions.region import Region
    from pvfiblets.query.selection.predicates import Predicate
    from pvfiblets.web.scene.scene import Scene
    from pvfiblets.web.session.shapes import Load

KINDS = ("lines", "volumes", "meshes")  # what `--clip` cuts, by `of=`

Words = Sequence[Sequence[str]]
Wishes = Mapping[str, Any]  # options of `add_options` by their names


def add_options(parser: Any) -> None:
    """Declare the options on the command line."""
    words = {"nargs": "+", "action": "append", "default": []}
    for kind, call in zip(KINDS, ("add_fiblets", "add_raycast_volume", "add_mesh"), strict=True):
        parser.add_argument(
            f"--{kind}", metavar="NAME=VALUE", help=f"arguments of plotter.{call} for all {kind}, such as "
            f"{ {'lines': 'line_width=3', 'volumes': 'mode=isosurface values=70', 'meshes': 'opacity=0.3'}[kind] }",
            **words,
        )  # fmt: skip
    parser.add_argument(
        "--color-along", metavar="WORD",
        help="colour lines by a value for each position along their bundle: a table (.csv, .tsv, .npy) as `pvfiblets "
             "profile` writes, or an array or image whose profile is computed; then column=NAME ids=GROUP n=N",
        **words,
    )  # fmt: skip
    parser.add_argument(
        "--clip", metavar="WORD",
        help="keep the inside of a plane normal=X,Y,Z origin=X,Y,Z (the side that the normal points to), slab "
             "normal=X,Y,Z "
        "origin=X,Y,Z thickness=MM, box bounds=X0,X1,Y0,Y1,Z0,Z1, sphere center=X,Y,Z radius=MM, or mesh path=FILE; "
        "of=lines,volumes,meshes selects the objects to cut (default: all). Repeatable",
        **words,
    )  # fmt: skip
    parser.add_argument("--clip-away", metavar="WORD", help="keep the outside; words as of --clip", **words)
    parser.add_argument(
        "--include", metavar="WORD",
        help="only streamlines that pass through a shape of --clip, or labels path=FILE labels=N,N; ends_in, "
             "both_ends_in or stays_in before it replaces the default, passes. sampling=points tests the points "
             "only. Repeatable: all must hold",
        **words,
    )  # fmt: skip
    parser.add_argument("--exclude", metavar="WORD", help="hide these streamlines; words as of --include", **words)
    parser.add_argument(
        "--criterion", metavar=("NAME", "VALUE"),
        help="only streamlines, or parts of them, with length, curvature, ..., an array, or the value of an image "
             "between two numbers; - means unlimited",
        **words,
    )  # fmt: skip
    parser.add_argument("--groups", nargs="+", metavar="NAME", help="only streamlines in these groups")
    parser.add_argument(
        "--subset", metavar="AMOUNT", help="a share below 1, a number of streamlines, or every=N"
    )


def options_of(words: Words, option: str) -> dict[str, Any]:
    """Return all ``NAME=VALUE`` of an option."""
    found: dict[str, Any] = {}
    for word in (word for group in words for word in group):
        name, equals, value = word.partition("=")
        if not equals or not re.fullmatch(r"[a-z_]\w*", name):
            raise ValueError(f"{option} has {word!r}; give NAME=VALUE, and files before options")
        found[name] = value_of(value)
    return found


def value_of(text: str) -> Any:
    """Parse a word: JSON, a number such as .5, a list between commas, or text."""
    try:
        return json.loads(text)
    except ValueError:
        pass
    if re.fullmatch(r"[+-]?(\d+\.\d*|\.\d+)([eE][+-]?\d+)?", text):
        return float(text)
    if text in ("None", "True", "False"):
        return {"None": None, "True": True, "False": False}[text]
    return [value_of(part) for part in text.split(",")] if "," in text else text


def shape_of(words: Sequence[str], option: str, others: Sequence[str] = ()) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return a shape as sessions have it, and the values of some other names."""
    from pvfiblets.web.session.shapes import CUTTING, SHAPES, check_shape

    said = options_of([words[1:]], option)
    rest = {name: said.pop(name) for name in others if name in said}
    if isinstance(said.get("labels"), (int, float)):
        said["labels"] = [said["labels"]]
    if "path" in said:
        said["path"] = str(said["path"])
    kinds = CUTTING if "of" in others else SHAPES
    return check_shape({"kind": words[0], **said}, option, kinds), rest


def cut_and_filter(actors: Mapping[str, Sequence[Any]], wishes: Wishes) -> None:
    """Do to a scene's actors what ``--clip``, ``--include``, ``--criterion`` and so on say."""
    lines, load = actors["lines"], cache(_loader)
    for option, inside in (("--clip", True), ("--clip-away", False)):
        for words in wishes[option.strip("-").replace("-", "_")]:
            shape, rest = shape_of(words, option, ("of",))
            region = _region(shape, load())
            for kind in _kinds(rest.get("of"), option):
                for actor in actors[kind]:
                    _cut(actor, region, inside)
    filters = {name: wishes[name] for name in ("color_along", "include", "exclude", "criterion", "groups", "subset")}
    if not lines and (named := [name.replace("_", "-") for name, said in filters.items() if said]):
        raise ValueError(f"--{named[0]} applies to streamlines, but no FILE has any")
    for actor in lines:
        for words in filters["color_along"]:
            actor.color_along(words[0], **options_of([words[1:]], "--color-along"))
        for name in ("include", "exclude"):
            for words in filters[name]:
                getattr(actor, name)(_condition(words, f"--{name}", load()))
        for words in filters["criterion"]:
            actor.criterion(words[0], _ends(words))
        if filters["groups"]:
            actor.groups_shown = filters["groups"]
        if filters["subset"]:
            every = filters["subset"].partition("every=")
            amount = value_of(every[2] or every[0])
            actor.subset(**({"every": amount} if every[1] else {"amount": amount}))


def _condition(words: Sequence[str], option: str, load: Load) -> Predicate:
    from pvfiblets.web.session.shapes import HOWS, check_condition, make_predicate

    how, rest = (words[0], words[1:]) if words[0] in HOWS else ("passes", words)
    if not rest:
        raise ValueError(f"{option} says {how} and no shape; give one, such as sphere center=0,0,0 radius=20")
    shape, sampling = shape_of(rest, option, ("sampling",))
    return make_predicate(check_condition({"how": how, "region": shape, **sampling}, option), load)


def _region(shape: Mapping[str, Any], load: Load) -> Region:
    from pvfiblets.web.session.shapes import make_region

    return make_region(shape, load)


def _loader() -> Load:
    """Return what reads the files that shapes are made of, each once."""
    from pvfiblets.web.scene.files.loading import Files
    from pvfiblets.web.session.store import Store

    return Store(Files(None)).shape


def _kinds(given: Any, option: str) -> Sequence[str]:
    if given is None:
        return KINDS
    kinds = [given] if isinstance(given, str) else list(given)
    if unknown := [kind for kind in kinds if kind not in KINDS]:
        raise ValueError(f"{option} has of={unknown[0]}; choose of {', '.join(KINDS)}")
    return kinds


def _ends(words: Sequence[str]) -> tuple[float | None, float | None]:
    try:
        low, high = (None if word == "-" else float(word) for word in words[1:])
    except ValueError:
        raise ValueError(
            f"--criterion has {' '.join(words)!r}; give a name and two numbers; - means unlimited"
        ) from None
    return low, high


def _cut(actor: Any, region: Any, inside: bool) -> None:
    """Cut an actor of ours, or a mesh for good."""
    if hasattr(actor, "clip"):
        actor.clip(region, inside=inside)
        return
    from pvfiblets.plotting.cut_surfaces import cut_surface

    surface = actor.mapper.dataset
    actor.mapper.dataset = cut_surface(
        surface.extract_surface(algorithm="dataset_surface"), region if inside else ~region
    )


def open_session(plotter: pv.BasePlotter, path: str) -> Scene:
    """Draw a session, as ``pvfiblets serve`` saves it, and look at it from where it says; return its scene."""
    from pvfiblets.web.scene.scene import Scene
    from pvfiblets.web.session.files import load

    scene = Scene(plotter)
    try:
        load(scene, str(Path(path).resolve()))
    except BaseException:
        scene.close()
        raise
    plotter.renderer.reset_camera_clipping_range()
    return scene
