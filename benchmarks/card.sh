#!/usr/bin/env bash
# Measures a graphics card from one command: does it draw right, and how fast (benchmarks/card.py says what).
# For a bare machine with a card, its driver's EGL, and Python with moderngl, glcontext, numpy and numba; no VTK, no display.
#
#   benchmarks/card.sh [--small] [--total SECONDS] [--folder DATA --resume] [--output FOLDER] ...      PYTHON=... to name another Python
#
# Writes card-CARD.json, .md and .png into docs/benchmarks (or --output), after every cell. --resume goes on where an earlier run
# was cut short; with --folder it finds that run's brains (12 GB) and pictures.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
PYTHON=${PYTHON:-python3}
export PYTHONPATH="$PWD:$PWD/benchmarks${PYTHONPATH:+:$PYTHONPATH}" PYTHONUNBUFFERED=1

missing=$("$PYTHON" - <<'CODE'
from importlib.util import find_spec

print(*(name for name in ("moderngl", "glcontext", "numpy", "numba") if find_spec(name) is None))
CODE
)
if [ -n "$missing" ]; then
    echo "missing: $missing. Install them: $PYTHON -m pip install $missing" >&2
    exit 1
fi
exec "$PYTHON" benchmarks/card.py --output docs/benchmarks "$@"
