#!/usr/bin/env bash
# Makes the virtual environment $VENV: `environment.sh user` with the package, `web` with what serves pages, `dev` with what
# `make test` needs besides, `more` with what the rest of the tests needs. Each holds the ones before it.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
PYTHON=${PYTHON:-python3}
VENV=${VENV:-.venv}
case "${1:-dev}" in
    user) extras="" kinds="user" ;;
    web) extras="[web]" kinds="user web" ;;
    dev) extras="[web,dev]" kinds="user web dev" ;;
    more) extras="[web,dev,more]" kinds="user web dev more" ;;
    *) echo "environment.sh: '$1' is no kind of environment; use user, web, dev or more" >&2; exit 1 ;;
esac

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
echo "Installing pvfiblets$extras and its dependencies into $VENV ..."
# Python compiles the modules that are used when they are first imported: pip would compile all of them.
"$VENV/bin/python" -m pip install --quiet --no-compile --disable-pip-version-check --editable ".$extras"
if [ "$kinds" != user ]; then
    echo "Compiling the kernels of codec and painted regions (a minute, once per machine) ..."
    env -u PYTHONDONTWRITEBYTECODE "$VENV/bin/python" -m pvfiblets.precompile
fi
for kind in $kinds; do touch "$VENV/.ready-$kind"; done
