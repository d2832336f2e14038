#!/bin/bash
# GDB and generated code: routines have names and lines, and GDB finds the caller at every instruction of a
# routine, for each engine that generates code. The tests in tests/debug check the same tables in the process;
# this test runs the debugger.
# Runs once.
set -uo pipefail
cd "$(dirname "$0")/.." || exit 1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# The leak checker cannot run in a process that is traced by a debugger.
export ASAN_OPTIONS=${ASAN_OPTIONS-}:detect_leaks=0
failed=0

# One triangle over one block of pixels.
cat >"$work/small.tri" <<'STREAM'
triptych 1
target 8 8
vertices one position:float2 diffuse:color {
    -1   1   ff8040ff
    -0.2 1   40ff80ff
    -1   0.2 8040ffff
}
state lighting false
clear color 0 0 0 1 depth 1
bind vertices one
draw triangles 0 1
STREAM

for engine in specialize stitch stitch-operation; do
    output=$work/$engine
    ENGINE=$engine gdb -nx -batch -x tests/support/routine/step.py --args "$TRIPTYCH" render "$work/small.tri" --engine "$engine" --threads 1 \
        --out "$work/small.png" >"$output" 2>&1 </dev/null
    grep -E '^(ok|FAIL) ' "$output"
    if grep -q '^FAIL' "$output" || (($(grep -c '^ok ' "$output") != 4)); then
        failed=1
        (($(grep -cE '^(ok|FAIL) ' "$output") == 4)) || echo "FAIL gdb stops early with $engine"
        tail -n 20 "$output" >&2
    fi
done
exit $failed
