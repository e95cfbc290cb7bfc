"""The state of a page, as one typed record; the server writes it, browsers may write a few of its fields."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field, fields
from typing import Any, cast

Record = dict[str, Any]


@dataclass
class Page:
    """The state of a page.

    The first block is the browser's: which panels are open, which tool is in hand. All else is a copy of what the
    server knows, and only the server writes it.
    """

    tab: str = "clip"
    tool: str = "rotate"
    left_open: bool = True
    right_open: bool = True
    dark: bool = True
    dialog: str = ""
    toast_open: bool = False
    toast: str = ""
    toast_kind: str = "error"
    expert_open: bool = False
    file_search: str = ""
    file_sort: str = "name"
    open_space: str = "RAS"  # of files of VTK that name none
    uploading: str = ""
    uploaded: float = 0.0  # per cent; below zero: unknown
    export_what: str = "selected"
    export_to: str = "folder"
    export_name: str = ""  # of the file; empty: after the layer
    show_regions: bool = True
    brush: float = 3.0  # radius, mm
    brush_deep: bool = False  # beyond the slice
    grow_share: float = 10.0  # per cent of the image's window
    painting_name: str = ""
    atlas_open: bool = False
    atlas_search: str = ""
    panes_open: bool = False
    like_mm: str = "8"  # distances of the tab Bundles, as they were typed
    cluster_mm: str = "10"
    models_folder: str = ""
    matrix_alone: bool = False  # in place of the frame

    toast_number: int = 0  # of the sentence: pages remember which they have shown
    layers: list[Record] = field(default_factory=list)
    chosen: str = ""
    chosen_name: str = ""
    chosen_kind: str = ""
    held: Record = field(default_factory=dict)  # the slider that is dragged, and its number
    groups: list[Record] = field(default_factory=list)  # of properties, as the panel draws them
    range_chart: str = ""  # SVG
    undo_label: str = ""
    redo_label: str = ""

    parallel: bool = False
    background: str = "#000000"
    picture: Record = field(default_factory=dict)  # the size of one to be saved
    edges: Record = field(default_factory=dict)  # anatomical letters at the picture's edges
    measuring: bool = False  # whether the first of two clicks was taken
    measured: list[str] = field(default_factory=list)  # distances, for people
    no_room: str = ""  # which colour bars are not shown

    clips: list[Record] = field(default_factory=list)
    filters: Record = field(default_factory=dict)
    marks: list[Record] = field(default_factory=list)  # regions over the picture
    placing: int = 0  # the row of the region that the next click places
    placing_name: str = ""
    selection: Record = field(default_factory=dict)
    bundles: Record = field(default_factory=lambda: {"layer": "", "rows": [], "count": 0})
    finding: Record = field(default_factory=lambda: {"open": False, "folders": [], "dipy": False})
    measures: Record = field(
        default_factory=lambda: {"open": False, "values": [], "value": "", "profile": {}, "table": {}}
    )
    matrix: Record = field(
        default_factory=lambda: {
            "open": False, "settings": True, "n": 0, "cell": "", "pair": [], "log": True,
            "form": {"labels": [], "names": [], "weights": [], "contrasts": [], "chosen": {}},
        }
    )  # fmt: skip
    matrix_image: str = ""  # the address of a PNG
    painting: Record = field(default_factory=lambda: {"regions": [], "active": ""})
    atlas: Record = field(default_factory=lambda: {"rows": [], "images": []})
    slicing: Record = field(
        default_factory=lambda: {"shown": False, "layout": "3d", "boxes": [], "volume": "", "series": []}
    )
    info: list[Record] = field(default_factory=list)
    frame: str = ""
    there: Record = field(default_factory=dict)  # the scene, where the browser draws it (client/browser_renderer.js)
    there_camera: Record = field(default_factory=dict)  # where from
    drawing: str = ""  # why the server draws

    download: Record = field(default_factory=dict)  # the latest export
    job: Record = field(default_factory=dict)
    folder: str = ""
    entries: list[Record] = field(default_factory=list)
    several: bool = True  # files may be chosen at once
    marked: list[str] = field(default_factory=list)  # chosen ones
    script: str = ""
    shared: bool = False
    upload_limit: int = 0
    keep: float = 300.0  # seconds that a session waits for its browser


WRITABLE: dict[str, type] = {
    "tab": str,
    "tool": str,
    "left_open": bool,
    "right_open": bool,
    "dark": bool,
    "dialog": str,
    "toast_open": bool,
    "toast": str,
    "toast_kind": str,
    "expert_open": bool,
    "file_search": str,
    "file_sort": str,
    "open_space": str,
    "uploading": str,
    "uploaded": float,
    "export_what": str,
    "export_to": str,
    "export_name": str,
    "show_regions": bool,
    "brush": float,
    "brush_deep": bool,
    "grow_share": float,
    "painting_name": str,
    "atlas_open": bool,
    "atlas_search": str,
    "panes_open": bool,
    "like_mm": str,
    "cluster_mm": str,
    "models_folder": str,
    "matrix_alone": bool,
}
"""Fields that browsers may write, and their types."""


def bind(state: Any) -> Page:
    """Return a page whose fields are keys of trame's state: reading and writing them reads and writes the state."""
    return cast("Page", _Bound(state))


class _Bound:
    """A :class:`Page` by its fields."""

    def __init__(self, state: Any) -> None:
        names = {item.name for item in fields(Page)}
        object.__setattr__(self, "_state", state)
        object.__setattr__(self, "_names", names)
        for name, value in asdict(Page()).items():
            state.setdefault(name, value)

    def __getattr__(self, name: str) -> Any:
        if name not in self._names:
            raise AttributeError(f"a page has no {name!r}")
        return self._state[name]

    def __setattr__(self, name: str, value: Any) -> None:
        if name not in self._names:
            raise AttributeError(f"a page has no {name!r}")
        self._state[name] = value
