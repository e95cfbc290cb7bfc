#!/usr/bin/env bash
# Looks for axe-core, with which the tests check that pages can be used without a mouse and a screen (client/package.json).
# Installs it where npm is or may be installed (Debian or Ubuntu, as root); else says what to install.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/wanted.sh"
cd "$(dirname "${BASH_SOURCE[0]}")/../client"

there() { [ -f node_modules/axe-core/axe.min.js ]; }
npm_runs() { any_runs "$(command -v npm || true)"; }

if there; then exit 0; fi
if wanted npm_runs "npm" "--no-install-recommends npm" && npm ci --silent --no-audit --no-fund && there; then exit 0; fi
{
    echo "There is no axe-core on this machine: pages are not checked for accessibility."
    echo "Install node and npm, then run: cd client && npm ci"
} >&2
