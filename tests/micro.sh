#!/bin/bash
# All engines and widths draw the same bytes for every stream of bench/streams/micro, with one thread and with
# two by turns. The streams have many layers of a megapixel; here their targets are smaller, and no multiple
# of a tile. They must also equal the output of their generator.
# Given BUILD, TRIPTYCH and SLOW by tests/support/scripts/run.sh; slow builds draw the last frames of every
# fifth stream.
# Runs once.
set -uo pipefail
cd "$(dirname "$0")/.."

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/again"
failures=0

awk -v folder="$work/again" -f bench/generate-micro.awk
if diff -r bench/streams/micro "$work/again" >"$work/difference"; then
    printf 'ok bench/generate-micro.awk writes bench/streams/micro\n'
else
    printf 'FAIL bench/generate-micro.awk writes bench/streams/micro\n%s\n' "$(head -n 20 "$work/difference")"
    failures=1
fi

options=(--frames all)
edits=(-e 's/^target 1024 1024 /target 168 136 /')
[[ -z ${SLOW-} ]] || edits+=(-e '/^# The measured frame/,/^# The same work/d')
number=0
for stream in bench/streams/micro/*.tri; do
    number=$((number + 1))
    [[ ${SLOW-} ]] && ((number % 5)) && continue
    small=$work/${stream##*/}
    sed "${edits[@]}" "$stream" >"$small"
    if said=$("$TRIPTYCH" verify "$small" "${options[@]}" --threads $((1 + number % 2)) 2>&1) &&
        grep -q '^target 168 136 ' "$small" && [[ ${said##*$'\n'} == '1 stream, '*' engines, identical' ]]; then
        printf 'ok %s\n' "$stream"
    else
        printf 'FAIL %s\n%s\n' "$stream" "$said"
        failures=1
    fi
done
exit $failures
