"""What each scene is made of: the plain ones (``plain.py``), and the others by their differences (``changed.py``).

Whoever adds a pass or a buffer says there which scenes ask for it. Of modules a scene names only those that it loads
for itself; what these import when they are imported is found in their text.
"""

from .changed import CHANGED
from .imports import closure
from .plain import PLAIN


def expected(name: str, kind: str) -> set[str]:
    """Return what a scene has of one kind; of modules, those that it asks for and all that these import."""
    asked = asked_for(name, kind)
    return closure(asked) if kind == "modules" else asked


def asked_for(name: str, kind: str) -> set[str]:
    """Return what is written down of a scene."""
    if name in PLAIN:
        return PLAIN[name].names(kind)
    changed = CHANGED[name].names(kind)
    less = {part[1:] for part in changed if part.startswith("-")}
    base = PLAIN[plain_of(name)].names(kind)
    assert less <= base, f"{name} cannot lack {sorted(less - base)}"
    return (base - less) | {part for part in changed if not part.startswith("-")}


def plain_of(name: str) -> str:
    """Return the plain scene that a scene is a change of."""
    starts = {"spline tubes": "spline tubes", "halo": "halo lines", "volume": "volume: mip"}
    if name == "halos":
        return "plain"
    return next((plain for start, plain in starts.items() if name.startswith(start)), "plain")


COMPANIONS = {
    "__mp_main__", "_cffi_backend", "_cyutility", "cffi", "charset_normalizer", "cython_runtime", "llvmlite", "numpy",
    "pycparser", "scipy", "vtkmodules", "yaml",
}  # fmt: skip
"""What comes with numba, NumPy and VTK, which not every machine has all of."""
