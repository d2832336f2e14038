#!/bin/bash
# The measurements of `make bench-passes`, written to results/ (RESULTS):
#
#   bench/passes.sh [OPTION of triptych bench]...
#
#   passes.json   frames of fixed-function streams, shaders and loops, with all passes, without each of them,
#                 with unrolled loops, with the passes of the thesis, and with none
#   parts.json    the parts of a build over the routines of all streams, of the same variants
#
# The variants' pictures are compared first; the run fails when they differ.
set -euo pipefail
cd "$(dirname "$0")/.."

triptych=${BUILD:-build}/triptych
results=${RESULTS:-results}
engine=specialize-8

engines=$engine
for pass in phi condition copy fold reduce common dead invariant preamble hoist preload; do
    engines+=,$engine:without=$pass
done
engines+=,$engine:unroll,specialize-thesis,specialize-none

shopt -s nullglob
streams=(bench/streams/{bunny,teapot-bilinear,street}.tri tests/data/shading/{bricks,water,solids,fractals,rays}.tri
    bench/flow/{defined,unrolled}.tri)
all=({bench/streams,bench/streams/micro,bench/flow,tests/data/streams,tests/data/scenes,tests/data/shading,tests/data/regressions}/*.tri)
((${#all[@]})) || { echo 'bench: no draw streams' >&2 && exit 1; }
mkdir -p "$results"

"$triptych" verify "${streams[@]}" --engines "$engines" --frames 1 --threads 1 | tail -n 1
"$triptych" bench --parts "${all[@]}" --engines "$engines" --repetitions 5 --json "$results/parts.json"
"$triptych" bench "${streams[@]}" --engines "$engines" --frames 1 --repetitions 25 --seconds 1.2 \
    --json "$results/passes.json" "$@"
