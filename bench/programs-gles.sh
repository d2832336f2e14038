#!/bin/bash
# Programs for Linux that use OpenGL ES, on Triptych and on Mesa's llvmpipe, for `make programs-gles`:
# packages of Debian, run as they are, and one of OpenGL ES 1.1 (bench/gles/fixed.c). bench/gles/frames.c,
# loaded before their libraries, counts frames and takes pictures. bench/gles/compile.c measures the
# compilation of their programs.
#
# In the environment:
#   ENGINE=name      the engine. Default: specialize
#   NAMES="..."      some of the programs that bench/gles/programs.py has. The report is then in
#                    build/programs-gles
#   PASSES=n         measurements of each program. 0: pictures and recordings only. Default: 3
#   SIDES=name       triptych, llvmpipe or llvmpipe-newest. Default: all
#   PROFILE=1        counts instead the instructions of a frame by what they are for, with callgrind
#                    (bench/gles/profile.py, `make profile-gles`): results/profile-gles.json. SIDES=triptych
#                    counts llvmpipe not
#   MESA=folder      the folder of bench/mesa.sh, for llvmpipe-newest. Default: build/mesa. Without it, the
#                    newest Mesa is not measured
#
# Writes results/programs-gles.json and .png (RESULTS), and pictures and recordings in build/programs-gles.
# Ends with 1 if a program fails, its picture differs, or a recording differs between engines.
set -euo pipefail
cd "$(dirname "$0")/.."

build=${BUILD:-build}
work=$build/programs-gles
results=${RESULTS:-results}
[[ -z ${NAMES-}${SIDES-} ]] || results=${RESULTS:-$work}
mkdir -p "$work"

${CC:-gcc} -std=gnu17 -O2 -Wall -Wextra -Werror -shared -fPIC bench/gles/frames.c -o "$work/frames.so"
${CC:-gcc} -std=gnu17 -O2 -Wall -Wextra -Werror bench/gles/fixed.c -lEGL -lGLESv1_CM -lX11 -lm -o "$work/fixed"
${CC:-gcc} -std=gnu17 -O2 -Wall -Wextra -Werror bench/gles/compile.c -lEGL -lGLESv2 -o "$work/compile"
: >"$work/display" # an earlier run's number
Xvfb -displayfd 3 -screen 0 1024x768x24 -nolisten tcp -noreset 3>"$work/display" >/dev/null 2>&1 &
server=$!
trap 'kill "$server" 2>/dev/null; wait "$server" 2>/dev/null || true' EXIT
for _ in {1..100}; do
    [[ ! -s $work/display ]] || break
    sleep 0.1
done
[[ -s $work/display ]] || { echo 'programs-gles: the X server does not start' >&2 && exit 2; }
DISPLAY=:$(<"$work/display")
export DISPLAY
newest=() mesa=${MESA:-$build/mesa}
[[ ! -x $mesa/run ]] || newest=(--mesa "$mesa")
# shellcheck disable=SC2086
python3 "bench/gles/$([[ -n ${PROFILE-} ]] && echo profile || echo programs).py" --folder "$work" --triptych "${TRIPTYCH:-$build/triptych}" \
    --engine "${ENGINE:-specialize}" --passes "${PASSES:-3}" --sides "${SIDES:-triptych,llvmpipe,llvmpipe-newest}" \
    --results "$results" "${newest[@]}" ${NAMES-}
