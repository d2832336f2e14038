#!/bin/bash
# Builds and runs a test program of the project; prints its lines FILE:LINE:NAME:PASS or FAIL. Failed tests
# are an output, so the status is 0 unless nothing ran.
#
#   bench/claims/tools/unit.sh TEST     without tests/ and .c; BUILD is the build
set -euo pipefail
program=$BUILD/tests/$1
${MAKE:-make} -s BUILD="$(realpath --relative-to=. "$BUILD")" "$(realpath -m --relative-to=. "$program")" >&2
"$program" || true
