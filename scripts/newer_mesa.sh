#!/usr/bin/env bash
# Runs a command with the newest Mesa that Debian has, in a root folder of its own: llvmpipe with GL_EXT_mesh_shader, and
# zink (OpenGL through Vulkan, here lavapipe), whatever drivers this machine has.
#
#   scripts/newer_mesa.sh [--zink] [--] COMMAND ...     COMMAND runs in this folder, with a Python that has pvfiblets' needs
#   scripts/newer_mesa.sh --make                        makes the folder only
#
# The folder is kept between runs: $NEWER_MESA, by default ~/.cache/pvfiblets/newer-mesa (2 GB). It needs apt-get, dpkg-deb and
# unshare, nothing else: packages are unpacked as files of whoever runs this, and are never installed. Who is not root enters the
# folder through a namespace of users that knows himself alone.
set -euo pipefail
HERE=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
ROOT=${NEWER_MESA:-${XDG_CACHE_HOME:-$HOME/.cache}/pvfiblets/newer-mesa}
MIRROR=${DEBIAN_MIRROR:-http://deb.debian.org/debian}
PACKAGES="base-files base-passwd bash ca-certificates coreutils dash findutils grep libc-bin sed python3 python3-venv
    libegl1 libegl-mesa0 libgl1 libglx-mesa0 libgl1-mesa-dri mesa-vulkan-drivers libx11-6 libxrender1 libgomp1"
READY=$ROOT/.ready

zink=
make_only=
while [ $# -gt 0 ]; do
    case $1 in
        --zink) zink=1; shift ;;
        --make) make_only=1; shift ;;
        --) shift; break ;;
        -*) echo "newer_mesa.sh knows --zink and --make, not $1" >&2; exit 2 ;;
        *) break ;;
    esac
done
if [ -z "$make_only" ] && [ $# = 0 ]; then
    echo "Give a command to run with the newer Mesa, or --make" >&2
    exit 2
fi

# What the folder and its Python were made from: when that changes they are made anew.
wanted_root() { echo $PACKAGES "$MIRROR"; } # on one line
wanted_python() { sed -n '/^dependencies/,/^]/p' "$HERE/pyproject.toml" | tr -d '\n'; }

needs() { # needs COMMAND PACKAGE
    command -v "$1" >/dev/null || { echo "$1 is missing, which $2 has (Debian and Ubuntu)" >&2; return 1; }
}

# apt resolves what the packages need from lists of its own, for a system that has none yet; dpkg-deb unpacks them as files of
# this user. Installing them would give some files to other users, for which namespaces need a range of ids.
make_root() {
    local apt=$ROOT.apt keys=/usr/share/keyrings/debian-archive-keyring.gpg signed mirror=$MIRROR deb
    needs apt-get apt && needs dpkg-deb dpkg || return 1
    rm -rf "$apt"
    mkdir -p "$apt/lists/partial" "$apt/archives/partial"
    touch "$apt/status"
    signed="signed-by=$keys"
    if [ ! -f $keys ]; then signed="trusted=yes" mirror=${MIRROR/#http:/https:}; fi # as debootstrap has it
    echo "deb [$signed] $mirror sid main" >"$apt/sources.list"
    # A mirror that stands still for a week or two is good enough.
    local settings=(-q -o "Dir::Etc::sourcelist=$apt/sources.list" -o Dir::Etc::sourceparts=- -o Dir::Etc::preferences=/dev/null
        -o Dir::Etc::preferencesparts=/dev/null -o "Dir::State::lists=$apt/lists" -o "Dir::State::status=$apt/status"
        -o "Dir::State::extended_states=$apt/extended" -o "Dir::Cache=$apt" -o "Dir::Cache::archives=$apt/archives" -o Dir::Log=$apt
        -o "APT::Sandbox::User=$(id -un)" -o Acquire::Check-Valid-Until=false -o Acquire::Languages=none -o Debug::NoLocking=true)
    apt-get "${settings[@]}" -o APT::Update::Post-Invoke= update || return 1
    # shellcheck disable=SC2086 - several packages
    apt-get "${settings[@]}" --yes --no-install-recommends --download-only install $PACKAGES || return 1
    # Its links lead from /lib to /usr/lib, so it comes before all others.
    for deb in "$apt"/archives/base-files_*.deb "$apt"/archives/*.deb; do
        dpkg-deb --extract "$deb" "$ROOT" || return 1
    done
    # What scripts of these packages would have done, as far as it is used here.
    mkdir -p "$ROOT/tmp" "$ROOT/var/cache/numba"
    cp "$ROOT/usr/share/base-passwd/passwd.master" "$ROOT/etc/passwd"
    cp "$ROOT/usr/share/base-passwd/group.master" "$ROOT/etc/group"
    if [ ! -e "$ROOT/usr/bin/sh" ]; then ln -s dash "$ROOT/usr/bin/sh"; fi
    rm -rf "$apt"
}

# Runs what comes after it inside the folder, in a mount namespace that goes when it ends: nothing stays mounted.
inside() {
    local own=()
    if [ "$(id -u)" != 0 ]; then own=(--user --map-root-user); fi
    unshare "${own[@]}" --mount true || {
        echo "This machine lets you make no namespaces (containers want --privileged; Ubuntu from 24.04 on wants" \
            "sudo sysctl kernel.apparmor_restrict_unprivileged_userns=0)" >&2
        return 1
    }
    unshare "${own[@]}" --mount --propagation private /bin/bash -c '
        set -e
        PATH=$PATH:/usr/sbin:/sbin # of chroot, for users
        root=$1 here=$2
        shift 2
        mkdir -p "$root$here" "$root/dev/shm"
        mount --rbind /proc "$root/proc"
        mount --rbind /sys "$root/sys"
        mount --rbind /dev "$root/dev"
        mount --bind "$here" "$root$here"
        for extra in $NEWER_MESA_MOUNTS; do
            mkdir -p "$root$extra"
            mount --bind "$extra" "$root$extra"
        done
        cp -L /etc/resolv.conf "$root/etc/resolv.conf" 2>/dev/null || true
        cp /etc/hosts "$root/etc/hosts" 2>/dev/null || true
        exec chroot "$root" /usr/bin/env -C "$here" "$@"
    ' inside "$ROOT" "$HERE" "$@"
}

install_python() {
    # pip's own settings, certificates and folders of wheels of this machine hold inside too.
    mkdir -p "$ROOT/etc" "$ROOT/etc/ssl/certs"
    for file in /etc/pip.conf "$HOME/.config/pip/pip.conf" "$HOME/.pip/pip.conf"; do
        if [ -f "$file" ]; then cp "$file" "$ROOT/etc/pip.conf"; fi
    done
    if [ -f /etc/ssl/certs/ca-certificates.crt ]; then cp -L /etc/ssl/certs/ca-certificates.crt "$ROOT/etc/ssl/certs/"; fi
    inside python3 -m venv --clear /opt/pvfiblets
    inside /opt/pvfiblets/bin/python - <<'CODE' >"$ROOT/opt/needs.txt"
import tomllib

with open("pyproject.toml", "rb") as file:
    project = tomllib.load(file)["project"]
tests = ("pytest", "hypothesis")
print("\n".join(project["dependencies"] + [need for need in project["optional-dependencies"]["dev"] if need.startswith(tests)]))
CODE
    inside /opt/pvfiblets/bin/python -m pip install --quiet --disable-pip-version-check --requirement /opt/needs.txt pillow \
        2> >(grep -v "is ignored: it is neither" >&2)
}

# Folders of this machine that pip is told to install from.
NEWER_MESA_MOUNTS=$({ env | grep '^PIP_'; cat /etc/pip.conf "$HOME/.config/pip/pip.conf" "$HOME/.pip/pip.conf"; } 2>/dev/null |
    grep -oE '(file://)?/[^ "=]+' | sed 's|^file://||' | while read -r folder; do
        if [ -d "$folder" ]; then echo "${folder%/simple}"; fi # an index names files beside itself
    done | sort -u || true)
export NEWER_MESA_MOUNTS
if [ "$(cat "$READY" 2>/dev/null)" != "$(wanted_root)" ]; then
    echo "Making a folder with the newest Mesa in $ROOT (two minutes) ..." >&2
    rm -rf --one-file-system "$ROOT"
    mkdir -p "$ROOT"
    make_root >"$ROOT.log" 2>&1 || { tail -n 5 "$ROOT.log" >&2; exit 1; }
    inside /usr/sbin/ldconfig # Python's find_library reads what it writes
    wanted_root >"$READY"
fi
if [ "$(cat "$READY.python" 2>/dev/null)" != "$(wanted_python)" ]; then
    install_python
    wanted_python >"$READY.python"
fi
if [ -n "$make_only" ]; then exit 0; fi

settings=(PATH=/opt/pvfiblets/bin:/usr/bin:/bin HOME=/root LC_ALL=C.UTF-8 PYTHONPATH="$HERE" PYTHONDONTWRITEBYTECODE=1
    NUMBA_CACHE_DIR=/var/cache/numba VTK_DEFAULT_OPENGL_WINDOW=vtkEGLRenderWindow LIBGL_ALWAYS_SOFTWARE=1)
if [ -n "$zink" ]; then settings+=(MESA_LOADER_DRIVER_OVERRIDE=zink GALLIUM_DRIVER=zink); fi
for name in GALLIVM_PERF LEAST PVFIBLETS_CI PVFIBLETS_DRIVER; do
    if [ -n "${!name:-}" ]; then settings+=("$name=${!name}"); fi
done
inside env -i "${settings[@]}" "$@"
