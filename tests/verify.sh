#!/bin/bash
# All engines and widths draw the same bytes for every stream.
# Given BUILD, TRIPTYCH and SLOW by tests/support/scripts/run.sh. Slow builds draw one frame, and only every
# 17th stream of the tests; goldens.sh draws others in these builds.
set -uo pipefail
cd "$(dirname "$0")/.."

shopt -s nullglob
streams=(bench/streams/*.tri tests/data/streams/*.tri tests/data/scenes/*.tri tests/data/shading/*.tri tests/data/regressions/*.tri
    tests/data/programs/*.trib bench/streams/pages/*.trib)
[[ -z ${SLOW-} ]] || streams=(tests/data/streams/*.tri tests/data/regressions/*.tri)
((${#streams[@]})) || { echo 'FAIL there are draw streams' && exit 1; }

# The number of threads alternates by stream: tests/threads.sh compares numbers of threads.
options=(--frames 2)
[[ -z ${SLOW-} ]] || options=(--frames 1)
failures=0
for ((number = 0; number < ${#streams[@]}; number++)); do
    ((number % 17)) && [[ ${SLOW-} ]] && continue
    stream=${streams[number]}
    if said=$("$TRIPTYCH" verify "$stream" "${options[@]}" --threads $((1 + number % 2)) 2>&1) &&
        [[ ${said##*$'\n'} =~ ^1\ stream,\ [0-9]+\ engines,\ identical$ ]]; then
        printf 'ok %s\n' "$stream"
    else
        printf 'FAIL %s\n%s\n' "$stream" "$said"
        failures=1
    fi
done

# The span reading of all whole blocks of the class.
spans=(tests/data/streams/{spans,gradients,texture-addressing,texture-changes}.tri
    bench/streams/micro/rectangle-{blend,nearest,bilinear,two-textures}.tri)
[[ -z ${SLOW-} ]] || spans=(tests/data/streams/spans.tri)
if said=$("$TRIPTYCH" verify "${spans[@]}" --set spans=always --frames 1 --threads 2 2>&1); then
    printf 'ok the span reading\n'
else
    printf 'FAIL the span reading\n%s\n' "$said"
    failures=1
fi

# Each frame has another key whose rows of texels are stretched.
if said=$("$TRIPTYCH" verify tests/data/streams/stretched-rows.tri --set spans=always --threads 2 2>&1); then
    printf 'ok stretched rows\n'
else
    printf 'FAIL stretched rows\n%s\n' "$said"
    failures=1
fi

# These engines are left out above because they are slow. They run only if they are named. Almost all of the
# time of external is that of the system's compiler, so it draws half of these streams.
names='batch-4|batch-256|external'
[[ -z ${SLOW-} ]] || names='batch-4|batch-256'
few=(bench/streams/teapot-bilinear.tri tests/data/streams/{lights,multisampling,queries,rectangles,render-to-texture}.tri
    tests/data/scenes/cube-map.tri tests/data/streams/shaders.tri tests/data/shading/light-loop.tri
    tests/data/regressions/anisotropic-words-and-numbers.tri)
[[ -z ${SLOW-} ]] || few=(tests/data/streams/{multisampling,shaders}.tri tests/data/scenes/cube-map.tri)
for engine in $("$TRIPTYCH" list engines | awk -v names="^($names)\$" '$1 ~ names && $3 == "available" { print $1 }'); do
    drawn=("${few[@]}")
    [[ $engine != external ]] || drawn=("${few[@]:5}")
    if said=$("$TRIPTYCH" verify "${drawn[@]}" --engines "$engine" --frames 1 --threads 2 2>&1); then
        printf 'ok %s\n' "$engine"
    else
        printf 'FAIL %s\n%s\n' "$engine" "$said"
        failures=1
    fi
done
exit $failures
