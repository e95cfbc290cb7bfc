#!/usr/bin/env bash
# Builds the wheel, installs it into an environment with nothing else in it, and runs the README's Python there.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
PYTHON=${PYTHON:-python3}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$PYTHON" -m pip wheel --quiet --disable-pip-version-check --no-deps --wheel-dir "$work" .
"$PYTHON" -m venv "$work/empty"
"$work/empty/bin/python" -m pip install --quiet --disable-pip-version-check "$work"/pvfiblets-*.whl
"$work/empty/bin/python" tests/docs/pages.py README.md "$work/page.py"
mkdir "$work/reader"
cd "$work/reader"
PATH="$work/empty/bin:$PATH" PYVISTA_OFF_SCREEN=true VTK_DEFAULT_OPENGL_WINDOW=vtkEGLRenderWindow MPLBACKEND=Agg \
    "$work/empty/bin/python" -W error ../page.py >/dev/null
"$work/empty/bin/python" - <<'END'
from importlib.resources import files

import pvfiblets

home = files("pvfiblets")
assert "site-packages" in str(home), home
for part in ("py.typed", "shaders"):
    assert home.joinpath(part).exists() or home.parent.joinpath(part).exists(), f"the wheel lacks {part}"
END
echo "The wheel works in an empty environment."
