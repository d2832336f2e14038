#!/bin/bash
# The measurements of `make bench-shaders`, written to results/ (RESULTS):
#
#   bench/shaders.sh [OPTION of triptych bench]...
#
#   shaders.txt, shaders.json   each shader of tests/data/shading with every engine: the time of its routine
#                               per vertex or pixel, build time, code size, spills; and the same by length
#   flow.txt, flow.json         flow control by constants and by values (bench/flow)
#
# The engines' pictures are compared first; the run fails when they differ.
set -euo pipefail
cd "$(dirname "$0")/.."

triptych=${BUILD:-build}/triptych
results=${RESULTS:-results}
engines=${ENGINES:-emulate,batch,stitch,specialize,specialize-8,specialize-thesis,external}

shopt -s nullglob
streams=(tests/data/shading/*.tri)
((${#streams[@]})) || { echo 'bench: no draw streams in tests/data/shading' >&2 && exit 1; }
mkdir -p "$results"

"$triptych" verify "${streams[@]}" bench/flow/*.tri --engines "$engines" --threads 1 | tail -n 1
"$triptych" bench "${streams[@]}" --shaders --engines "$engines" --repetitions 3 --seconds 0.3 \
    --json "$results/shaders.json" "$@" | sed -n '1,2p;/^shaders/,$p' | tee "$results/shaders.txt"
"$triptych" bench bench/flow/*.tri --shaders --engines stitch,specialize --repetitions 15 --seconds 3 \
    --json "$results/flow.json" "$@" |
    sed -n '1,2p;/^booleans\|^values\|^integers\|^defined\|^unrolled/,/^$/p' | tee "$results/flow.txt"
