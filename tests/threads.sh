#!/bin/bash
# Any number of threads draws every stream equally, in any order of batches and tiles. In the build with the
# thread sanitizer (SANITIZE=thread) a race between threads is a failure too. The sanitizer checks the C code
# and the interpreters, but not generated code, so builds with sanitizers draw with an engine of each kind,
# every fourth stream. Given BUILD, TRIPTYCH and SANITIZE by tests/support/scripts/run.sh; THOROUGH=1 draws
# all streams (make check-threads).
set -uo pipefail
cd "$(dirname "$0")/.."

shopt -s nullglob
streams=(tests/data/streams/*.tri)
seeds=(1)
[[ -z ${THOROUGH-} ]] || seeds=(1 2)
if [[ ${SANITIZE-} ]]; then
    all=("${streams[@]}") streams=()
    for ((i = 0; i < ${#all[@]}; i += 4)); do streams+=("${all[i]}"); done
else
    # Streams with many batches and tiles.
    streams+=(bench/streams/{bunny,street}.tri tests/data/scenes/{particles,shadow-volume}.tri tests/data/shading/light-loop.tri)
fi
names='emulate|batch|stitch|specialize'
[[ -z ${SANITIZE-} ]] || names='batch|specialize'
engines=$("$TRIPTYCH" list engines | awk -v names="^($names)\$" '$1 ~ names && $3 == "available" { print $1 }' |
    paste -sd,)

failures=0
verify() # NAME ARGUMENT...
{
    local name=$1 said
    shift
    if said=$("$TRIPTYCH" verify --frames 1 "$@" 2>&1) && [[ ${said##*$'\n'} == *', identical' ]]; then
        printf 'ok %s\n' "$name"
    else
        printf 'FAIL %s\n%s\n' "$name" "$said"
        failures=1
    fi
}

# Enough triangles that threads share out the linking of bins, in a small target.
crowd=$(mktemp --suffix=.tri)
trap 'rm -f "$crowd"' EXIT
sed "s|^target .*|target 320 256|; s|\"../assets|\"$PWD/bench/streams/assets|" bench/streams/threads/tori.tri >"$crowd"
verify 'a frame of 100,000 triangles with 4 threads' "$crowd" --engines specialize --threads 4 --shuffle 1

if [[ ${THOROUGH-} ]]; then
    for stream in bench/streams/*.tri tests/data/{streams,scenes,shading}/*.tri; do
        verify "$stream" "$stream" --engines "$engines" --threads 2,4 --shuffle 1
    done
else
    for seed in "${seeds[@]}"; do
        verify "${#streams[@]} streams with 3 threads, shuffled by $seed" "${streams[@]}" --engines "$engines" --threads 3 \
            --shuffle "$seed"
    done
fi
exit $failures
