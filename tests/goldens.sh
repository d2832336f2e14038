#!/bin/bash
# The first frame of every stream, of bench/streams or tests/streams, that has a golden picture,
# tests/goldens/STREAM.png, equals it pixel for pixel.
# Given BUILD, TRIPTYCH and SANITIZE by tests/support/run.sh.
#
#   GOLDENS=write TRIPTYCH=build/triptych tests/goldens.sh STREAM...    makes the pictures anew: look at them
set -uo pipefail
cd "$(dirname "$0")/.."

if [[ ${GOLDENS-} == write ]]; then
    mkdir -p tests/goldens
    for stream in "$@"; do
        name=${stream##*/}
        "$TRIPTYCH" render "$stream" --engine emulate --out "tests/goldens/${name%.*}.png" || exit
    done
    exit
fi

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
shopt -s nullglob
goldens=(tests/goldens/*.png)
((${#goldens[@]})) || { echo 'FAIL there are golden pictures in tests/goldens' && exit 1; }

failures=0
for golden in "${goldens[@]}"; do
    name=${golden##*/} name=${name%.png}
    stream=bench/streams/$name.tri
    [[ -f $stream ]] || stream=tests/streams/$name.tri
    if said=$("$TRIPTYCH" render "$stream" --engine emulate --out "$work/$name.png" 2>&1 &&
        "$TRIPTYCH" compare "$golden" "$work/$name.png" 2>&1); then
        printf 'ok %s\n' "$name"
    else
        printf 'FAIL %s: %s\n' "$name" "$said"
        failures=1
    fi
done
exit $failures
