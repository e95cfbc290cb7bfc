#!/usr/bin/env bash
# Checks, by drawing, that this machine has the OpenGL libraries that headless rendering needs.
# Installs them where it may (Debian or Ubuntu, as root); else says what to install.
set -euo pipefail
PYTHON=${PYTHON:-python3}
export LEAST=${LEAST:-3.3} # drawing needs 3.3, the tests 4.3
PACKAGES="libegl1 libegl-mesa0 libgl1 libglx-mesa0 libgl1-mesa-dri libx11-6 libxrender1"

draws() {
    "$PYTHON" - <<'CODE' 2>"$log"
import os
import sys

import moderngl
import pyvista

plotter = pyvista.Plotter(off_screen=True, window_size=(64, 64))
plotter.add_mesh(pyvista.Sphere(), color="white")
picture = plotter.screenshot(None)
version = moderngl.create_context().version_code
if picture.max() == picture.min():
    sys.exit("a white sphere came out as an empty picture")
least = os.environ["LEAST"]
if version < round(100 * float(least)):
    sys.exit(f"OpenGL {version / 100:.1f} was found, {least} is needed")
CODE
}

log=$(mktemp)
trap 'rm -f "$log"' EXIT
if draws; then exit 0; fi

if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
    echo "Installing the OpenGL libraries: $PACKAGES ..."
    apt-get update -qq || true
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq $PACKAGES >/dev/null
    if draws; then exit 0; fi
fi
{
    echo "Headless OpenGL $LEAST does not work on this machine. The attempt said:"
    tail -n 5 "$log" | sed 's/^/    /'
    echo "On Debian or Ubuntu install: sudo apt-get install $PACKAGES"
    echo "On Fedora: sudo dnf install mesa-libEGL mesa-libGL mesa-dri-drivers libX11 libXrender"
} >&2
exit 1
