#!/usr/bin/env bash
# Looks for the programs beside which `make test-programs` runs pvfiblets: MRtrix3 and ParaView, and packages of Python.
# Installs them where it may (Debian or Ubuntu, as root; PyPI); what is missing costs its tests only, and is named.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/wanted.sh"
PYTHON=${PYTHON:-python3}

has_mrtrix() { command -v tckinfo >/dev/null; }
has_paraview() { command -v pvpython >/dev/null; }

wanted has_mrtrix "MRtrix3" mrtrix3 || echo "There is no MRtrix3 on this machine: its tests are left out." >&2
wanted has_paraview "ParaView" "paraview python3-paraview" || echo "There is no ParaView on this machine: its tests are left out." >&2
"$PYTHON" -m pip install --quiet --disable-pip-version-check dipy trx-python SimpleITK ||
    echo "PyPI has not answered: tests beside packages of Python that are not here are left out." >&2
