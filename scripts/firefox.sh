#!/usr/bin/env bash
# Looks for Firefox, with which the tests open pages as they do with Chromium (scripts/browser.sh); it draws under Xvfb
# (scripts/display.sh). Installs it where it may (Debian, as root); else says what to install. Missing, it costs those tests
# only; Ubuntu's package is a snap, which does not run in containers: there is nothing to install there.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/wanted.sh"
PACKAGES="--no-install-recommends firefox-esr"

opens() { any_runs "${FIREFOX:-}" /usr/bin/firefox-esr /usr/bin/firefox; }

if wanted opens "Firefox" "$PACKAGES"; then exit 0; fi
{
    echo "There is no Firefox on this machine: tests that open pages in it are left out."
    echo "On Debian install: sudo apt-get install firefox-esr; or name one with FIREFOX=..."
} >&2
