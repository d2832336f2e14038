#!/bin/bash
# Khronos' conformance suites dEQP-GLES2 and dEQP-EGL on Triptych and on Mesa's llvmpipe, for
# `make conformance-gles`. Nothing of the suites is kept in the repository, and nothing builds them.
#
# In the environment:
#   DEQP=folder      has bin/deqp-gles2, its data files bin/gles2, and lists/gles2.txt: names of cases, one a
#                    line. The program is a build of the suite for the target "surfaceless". In the same way
#                    it has bin/deqp-egl, for the target "nullws", and lists/egl.txt
#   SUITE="name.."   gles2 or egl. Default: both
#   ENGINE=name      the engine. Default: specialize
#   THREADS=n        threads of both renderers. Default: 1
#   CASES="glob.."   some of the cases, such as "functional.fbo.*". The report is then in
#                    build/conformance-gles
#   EVERY=n          every n-th case only. The report is then there, too
#   SIDES=name       triptych or llvmpipe. Default: both, if Mesa is installed
#   LIMIT=seconds    the longest time of one case. Default: 300
#
# Writes results/conformance-SUITE.json (RESULTS), and in build/conformance-gles the messages of each case.
# Ends with 1 if a case crashes or hangs on Triptych, or fails without a reason in bench/gles/reasons.txt.
# Ends with 2 if the folder does not have the program.
set -euo pipefail
cd "$(dirname "$0")/.."

build=${BUILD:-build}
work=$build/conformance-gles
results=${RESULTS:-results}
read -ra suites <<<"${SUITE:-gles2 egl}"
[[ -z ${CASES-}${EVERY-}${SIDES-} ]] || results=${RESULTS:-$work}
if [[ -z ${DEQP-} ]]; then
    echo 'conformance-gles: DEQP is not set, expected a folder with bin/deqp-gles2 and lists/gles2.txt' >&2
    exit 2
fi
set -f
status=0
for suite in "${suites[@]}"; do
    said=0
    # shellcheck disable=SC2086
    python3 bench/gles/conformance.py --suite "$suite" --deqp "$DEQP" --triptych "${TRIPTYCH:-$build/triptych}" \
        --engine "${ENGINE:-specialize}" --threads "${THREADS:-1}" --limit "${LIMIT:-300}" \
        --every "${EVERY:-1}" --sides "${SIDES:-triptych,llvmpipe}" --results "$results" --work "$work" \
        ${CASES-} || said=$?
    ((said <= status)) || status=$said
done
exit "$status"
