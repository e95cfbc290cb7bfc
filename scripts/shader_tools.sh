#!/usr/bin/env bash
# Looks for glslangValidator and spirv-val, by which the tests compile and check all shaders, also those that this machine's
# OpenGL cannot run (mesh, task). Installs them where it may (Debian or Ubuntu, as root); else says what to install. Missing,
# they cost those tests only.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/wanted.sh"
PACKAGES="glslang-tools spirv-tools"

compiles() {
    for tool in glslangValidator spirv-val; do
        command -v "$tool" >/dev/null && "$tool" --version >/dev/null 2>&1 || return 1
    done
}

if wanted compiles "the shader compiler and checker" "$PACKAGES"; then exit 0; fi
{
    echo "There is no glslangValidator or no spirv-val on this machine: tests that compile shaders with them are left out."
    echo "On Debian or Ubuntu install: sudo apt-get install $PACKAGES"
    echo "On Fedora: sudo dnf install glslang spirv-tools; on macOS: brew install glslang spirv-tools"
} >&2
