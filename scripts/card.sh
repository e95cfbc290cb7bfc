#!/usr/bin/env bash
# Measures a graphics card from one command: does it draw right (pvfiblets gl --check), and how fast (pvfiblets report --only speed).
# For a bare machine with a card, its driver's EGL, and Python with moderngl, glcontext, numpy and numba; no VTK, no display.
#
#   scripts/card.sh DIR [--quick] [--minutes M]      PYTHON=... to name another Python
#   scripts/card.sh --first DIR [--quick] [--minutes M]
#
# --first is for a card that is there for minutes, 8 unless said otherwise: checks and measurements in order of value, saved one by
# one (pvfiblets report --only card). With --quick it is a rehearsal of small sets.
# Writes check.zip, report.json and report.md into DIR; the report is saved as it grows, so that a run that is cut short leaves
# what it has. PVFIBLETS_BRAINS names a folder that keeps the synthetic brains for the next run, 12 GB of them in a whole one.
set -euo pipefail
first=
if [ "${1:-}" = --first ]; then
    first=1
    shift
fi
folder=$(realpath -m "${1:?names no folder to write into}")
shift
cd "$(dirname "${BASH_SOURCE[0]}")/.."
PYTHON=${PYTHON:-python3}
export PYTHONPATH="$PWD${PYTHONPATH:+:$PYTHONPATH}" PYTHONUNBUFFERED=1

missing=$("$PYTHON" - <<'CODE'
from importlib.util import find_spec

print(*(name for name in ("moderngl", "glcontext", "numpy", "numba") if find_spec(name) is None))
CODE
)
if [ -n "$missing" ]; then
    echo "missing: $missing. Install them: $PYTHON -m pip install $missing" >&2
    exit 1
fi
mkdir -p "$folder"
if [ -n "$first" ]; then exec "$PYTHON" -m pvfiblets report --only card -o "$folder" --minutes 8 "$@"; fi
"$PYTHON" -m pvfiblets gl --check --segments -o "$folder/check.zip" || echo "The card does not draw all of it right; check.zip says what." >&2
exec "$PYTHON" -m pvfiblets report --only speed -o "$folder" "$@"
