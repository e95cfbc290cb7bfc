#!/usr/bin/env bash
# Looks for Chromium, with which the tests open the pages of `pvfiblets serve`.
# Installs it where it may (Debian or Ubuntu, as root); else says what to install. Missing, it costs those tests only.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/wanted.sh"
PACKAGES="chromium fonts-dejavu-core"

opens() {
    local name
    for name in "${CHROMIUM:-}" /usr/bin/chromium /usr/bin/chromium-browser /usr/bin/google-chrome; do
        if [ -n "$name" ] && [ -x "$name" ] && "$name" --version >/dev/null 2>&1; then return 0; fi
    done
    return 1
}

if wanted opens "the browser" "$PACKAGES"; then exit 0; fi
{
    echo "There is no Chromium on this machine: tests that open pages in it are left out."
    echo "On Debian or Ubuntu install: sudo apt-get install $PACKAGES; or name one with CHROMIUM=..."
} >&2
