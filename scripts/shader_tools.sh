#!/usr/bin/env bash
# Looks for glslangValidator, by which the tests compile shaders that this machine's OpenGL cannot (mesh, task).
# Installs it where it may (Debian or Ubuntu, as root); else says what to install. Missing, it costs those tests only.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/wanted.sh"
PACKAGE=glslang-tools

compiles() {
    command -v glslangValidator >/dev/null && glslangValidator --version >/dev/null 2>&1
}

if wanted compiles "the shader compiler" "$PACKAGE"; then exit 0; fi
{
    echo "There is no glslangValidator on this machine: tests that compile mesh shaders with it are left out."
    echo "On Debian or Ubuntu install: sudo apt-get install $PACKAGE"
    echo "On Fedora: sudo dnf install glslang; on macOS: brew install glslang"
} >&2
