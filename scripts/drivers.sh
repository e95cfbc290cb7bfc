#!/usr/bin/env bash
# Runs the pictures of all pipelines, tubes, halos, volumes and the mapper on three drivers: this machine's own OpenGL, Mesa's
# newest llvmpipe (with mesh shaders), and zink, which compiles through SPIR-V (scripts/newer_mesa.sh makes the last two).
#
#   scripts/drivers.sh            all of them, some 20 minutes on two cores
#   scripts/drivers.sh --part     what continuous integration runs: mesh shaders on the newest llvmpipe, and a choice on zink
#
# Nothing may be skipped on the newer drivers; what a compiler beside the driver says of shaders is not asked there.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
PYTHON=${PYTHON:-python3}
NEWER=scripts/newer_mesa.sh
export LEAST=4.3 GALLIVM_PERF=nopt

PIPELINES="tests/engine/test_pipelines.py tests/engine/test_census.py tests/engine/test_limits.py"
PICTURES="tests/engine/test_thin_lines.py tests/engine/test_wide_lines.py tests/engine/test_line_tubes.py tests/engine/test_two_phase.py
    tests/engine/test_clip_planes.py tests/engine/test_clip_regions.py tests/engine/test_tube_pictures.py tests/engine/test_halo_pictures.py
    tests/engine/test_gathering.py tests/engine/test_filter_textures.py tests/engine/test_volume.py tests/engine/test_volume_clip.py"
MAPPER="tests/mappers/test_picture.py tests/mappers/test_passes.py tests/mappers/test_tubes.py tests/mappers/test_halos.py tests/mappers/test_volume.py
    tests/plotting/test_steady_frames.py"

# Unoptimised, which is quicker to compile, but for zink: there LLVM 22.1 dies of it (docs/limits.md).
run() { # run DRIVER COMMAND ... FILES
    local driver=$1 log
    shift
    echo "== $driver"
    log=$(mktemp)
    if [ "$driver" = zink ]; then export GALLIVM_PERF=; fi
    PVFIBLETS_DRIVER=$driver "$@" -m pytest -q -p no:cacheprovider --numprocesses=auto --maxprocesses=8 -rs \
        -k "not stages_link" $files | tee "$log"
    if [ "$driver" != system ] && grep -q "^SKIPPED" "$log"; then
        echo "tests were skipped on $driver" >&2
        rm -f "$log"
        return 1
    fi
    rm -f "$log"
}

if [ "${1:-}" = --part ]; then
    files="$PIPELINES tests/engine/test_thin_lines.py tests/engine/test_tube_pictures.py tests/mappers/test_picture.py
        tests/plotting/test_steady_frames.py"
    run newer "$NEWER" python
    files="tests/engine/test_thin_lines.py tests/engine/test_halo_pictures.py tests/engine/test_volume_clip.py"
    run zink "$NEWER" --zink python
else
    files="$PIPELINES $PICTURES $MAPPER"
    run system "$PYTHON"
    run newer "$NEWER" python
    run zink "$NEWER" --zink python
fi
