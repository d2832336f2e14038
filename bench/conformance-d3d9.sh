#!/bin/bash
# Wine's Direct3D 9 tests on Triptych and on Wine's own Direct3D 9 over llvmpipe, side by side, for
# `make conformance-d3d9`. The tests come from Debian's source package of Wine; nothing of it is kept in the
# repository.
#
# In the environment:
#   ENGINE=name     the engine. Default: specialize
#   THREADS=n       threads of both renderers. Default: 1
#   SUITES="name.." some of stateblock d3d9ex device visual. The report is then in build/conformance.
#   LIMIT=seconds   the longest time of one test function. Default: 300
#
# Writes results/conformance.md and results/conformance.json (RESULTS). Ends with 1 if a test function crashes
# or hangs on Triptych, or a threshold is missed (bench/d3d9/conformance.py, violations).
set -euo pipefail
cd "$(dirname "$0")/.."

build=${BUILD:-build}
work=$build/conformance
results=${RESULTS:-results}
[[ -z ${SUITES-} ]] || results=${RESULTS:-$work}

bench/d3d9/wine-tests.sh "$work"
. bench/d3d9/desktop.sh
trap desktop_end EXIT
desktop_begin "$work" modes
# shellcheck disable=SC2086
python3 bench/d3d9/conformance.py --tests "$work" --triptych "${TRIPTYCH:-$build/triptych}" --engine "${ENGINE:-specialize}" \
    --threads "${THREADS:-1}" --limit "${LIMIT:-300}" --results "$results" ${SUITES-}
