#!/usr/bin/env bash
# Looks for Chromium, with which the tests open the pages of `pvfiblets serve`.
# Installs it where it may (Debian or Ubuntu, as root); else says what to install. Missing, it costs those tests only.
set -euo pipefail
PACKAGES="chromium fonts-dejavu-core"

opens() {
    for name in "${CHROMIUM:-}" /usr/bin/chromium /usr/bin/chromium-browser /usr/bin/google-chrome; do
        if [ -n "$name" ] && [ -x "$name" ] && "$name" --version >/dev/null 2>&1; then return 0; fi
    done
    return 1
}

if opens; then exit 0; fi
if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
    echo "Installing the browser for tests: $PACKAGES ..."
    apt-get update -qq || true
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq $PACKAGES >/dev/null || true
    if opens; then exit 0; fi
fi
{
    echo "There is no Chromium on this machine: tests that open pages in it are left out."
    echo "On Debian or Ubuntu install: sudo apt-get install $PACKAGES; or name one with CHROMIUM=..."
} >&2
