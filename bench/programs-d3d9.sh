#!/bin/bash
# Programs for Windows that use Direct3D 9, on Triptych and on Wine's own Direct3D 9 over llvmpipe, for
# `make programs-d3d9`: SDL, Panda3D and ANGLE from wheels of the Python package index, Irrlicht from Debian's
# source package. Nothing of them is kept in the repository.
#
# In the environment:
#   ENGINE=name      the engine. Default: specialize
#   NAMES="..."   some of sdl panda gles irrlicht. The report is then in build/programs.
#   PASSES=n         measurements of each program. Default: 3
#   SIDES=name       triptych or wine. Default: both
#
# Writes results/programs.json (RESULTS) and in build/programs the pictures and recordings. Ends with 1 if a
# program fails, its picture differs, or Triptych is not ahead (bench/d3d9/programs.py, problems).
set -euo pipefail
cd "$(dirname "$0")/.."

build=${BUILD:-build}
work=$build/programs
results=${RESULTS:-results}
[[ -z ${NAMES-}${SIDES-} ]] || results=${RESULTS:-$work}

bench/d3d9/wheels.sh "$work"
bench/d3d9/irrlicht.sh "$work"
. bench/d3d9/desktop.sh
trap desktop_end EXIT
desktop_begin "$work"
# shellcheck disable=SC2086
python3 bench/d3d9/programs.py --folder "$work" --triptych "${TRIPTYCH:-$build/triptych}" \
    --engine "${ENGINE:-specialize}" --passes "${PASSES:-3}" --sides "${SIDES:-triptych,wine}" --results "$results" \
    ${NAMES-}
