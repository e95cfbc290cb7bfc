#!/usr/bin/env bash
# Looks for Xvfb and what Qt wants of X, with which the tests open real windows.
# Installs them where it may (Debian or Ubuntu, as root); else says what to install. Missing, they cost those tests only.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/wanted.sh"
PACKAGES="xvfb libgl1 libegl1 libxkbcommon-x11-0 libxcb-cursor0 libxcb-icccm4 libxcb-image0 libxcb-keysyms1 libxcb-render-util0 libxcb-shape0"

there() {
    command -v Xvfb >/dev/null && { ldconfig -p 2>/dev/null || /sbin/ldconfig -p; } | grep -q libxcb-cursor
}

if wanted there "what opens windows" "$PACKAGES"; then exit 0; fi
{
    echo "There is no Xvfb on this machine: tests that open windows are left out."
    echo "On Debian or Ubuntu install: sudo apt-get install $PACKAGES"
} >&2
