#!/usr/bin/env bash
# Looks for Chromium, with which the tests open the pages of `pvfiblets serve`.
# Installs it where it may (Debian or Ubuntu, as root); else says what to install. Missing, it costs those tests only.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/wanted.sh"
PACKAGES="chromium fonts-dejavu-core"

opens() { any_runs "${CHROMIUM:-}" /usr/bin/chromium /usr/bin/chromium-browser /usr/bin/google-chrome; }

if wanted opens "the browser" "$PACKAGES"; then exit 0; fi
{
    echo "There is no Chromium on this machine: tests that open pages in it are left out."
    echo "On Debian or Ubuntu install: sudo apt-get install $PACKAGES; or name one with CHROMIUM=..."
} >&2
