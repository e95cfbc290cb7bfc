#!/usr/bin/env bash
# Makes the virtual environment $VENV with the package, its web extra and the tools for tests.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
PYTHON=${PYTHON:-python3}
VENV=${VENV:-.venv}

if ! command -v "$PYTHON" >/dev/null; then
    echo "There is no $PYTHON here: install Python 3.11 or newer, or name one with PYTHON=..." >&2
    exit 1
fi
if ! "$PYTHON" -c 'import sys; sys.exit(sys.version_info < (3, 11))'; then
    echo "$("$PYTHON" --version) is too old: Python 3.11 or newer is needed; name one with PYTHON=..." >&2
    exit 1
fi
if [ ! -x "$VENV/bin/python" ] || ! "$VENV/bin/python" -m pip --version >/dev/null 2>&1; then
    if ! "$PYTHON" -c 'import ensurepip, venv' 2>/dev/null; then
        if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
            echo "Installing python3-venv ..."
            apt-get update -qq
            DEBIAN_FRONTEND=noninteractive apt-get install -y -qq python3-venv >/dev/null
        else
            echo "Python's venv module is missing. Install it, then run make again:" >&2
            echo "    sudo apt-get install python3-venv" >&2
            exit 1
        fi
    fi
    echo "Making the environment in $VENV ..."
    "$PYTHON" -m venv --clear "$VENV"
fi
echo "Installing pvfiblets and what it needs into $VENV ..."
"$VENV/bin/python" -m pip install --quiet --disable-pip-version-check --editable '.[web,dev]'
echo "Compiling what codes streamlines and tells those of painted regions ..."
"$VENV/bin/python" -m pvfiblets.precompile
