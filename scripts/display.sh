#!/usr/bin/env bash
# Looks for Xvfb and what Qt wants of X, with which the tests open real windows.
# Installs them where it may (Debian or Ubuntu, as root); else says what to install. Missing, they cost those tests only.
set -euo pipefail
PACKAGES="xvfb libgl1 libegl1 libxkbcommon-x11-0 libxcb-cursor0 libxcb-icccm4 libxcb-image0 libxcb-keysyms1 libxcb-render-util0 libxcb-shape0"

there() {
    command -v Xvfb >/dev/null && { ldconfig -p 2>/dev/null || /sbin/ldconfig -p; } | grep -q libxcb-cursor
}

if there; then exit 0; fi
if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
    echo "Installing what opens windows for tests: Xvfb ..."
    apt-get update -qq || true
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq $PACKAGES >/dev/null || true
    if there; then exit 0; fi
fi
{
    echo "There is no Xvfb on this machine: tests that open windows are left out."
    echo "On Debian or Ubuntu install: sudo apt-get install $PACKAGES"
} >&2
