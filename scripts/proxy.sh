#!/usr/bin/env bash
# Looks for nginx, through which the tests reach `pvfiblets serve` by the recipe in the docs.
# Unpacks it beside the environment's programs (Debian or Ubuntu; no root, no service is started); else says what to install.
# Missing, it costs those tests only.
set -euo pipefail
VENV=${VENV:-.venv}
PATH=$PATH:/usr/sbin:/usr/local/sbin:$VENV/bin

answers() {
    command -v "${1:-nginx}" >/dev/null && "${1:-nginx}" -v >/dev/null 2>&1
}

unpacked() {
    command -v apt-get >/dev/null && command -v dpkg >/dev/null || return 1
    if [ "$(id -u)" = 0 ]; then apt-get update -qq || true; fi
    local folder
    folder=$(mktemp -d)
    (cd "$folder" && apt-get download -qq nginx && dpkg -x nginx*.deb there) >/dev/null 2>&1 || true
    if answers "$folder/there/usr/sbin/nginx"; then install "$folder/there/usr/sbin/nginx" "$VENV/bin/nginx"; fi
    rm -rf "$folder"
    answers
}

if answers || unpacked; then exit 0; fi
{
    echo "There is no nginx on this machine: tests that serve through it are left out."
    echo "On Debian or Ubuntu install: sudo apt-get install nginx-light"
} >&2
