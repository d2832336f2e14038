#!/bin/bash
# Recordings of a few routines are those of tests/data/recordings, so that a change of a recording is seen
# in its review. Lines of the specification are left out. `UPDATE=1 bash tests/recordings.sh` writes them
# again.
# Given TRIPTYCH by tests/support/scripts/run.sh.
set -uo pipefail
cd "$(dirname "$0")/.."
TRIPTYCH=${TRIPTYCH:-build/triptych}

failures=0
check() # NAME STREAM UNIT
{
    local golden=tests/data/recordings/$1.txt got
    got=$("$TRIPTYCH" dump "$2" --unit "$3" --show key,record | sed 's/    ; .*//') ||
        { printf 'FAIL recording %s\ndump failed\n' "$1" && failures=1 && return; }
    [[ -z ${UPDATE-} ]] || printf '%s\n' "$got" >"$golden"
    if difference=$(diff "$golden" - <<<"$got"); then
        printf 'ok recording %s\n' "$1"
    else
        printf 'FAIL recording %s\n%s\n' "$1" "$(head -n 12 <<<"$difference")"
        failures=1
    fi
}

check pixel-flat bench/streams/teapot-flat.tri pixel
check pixel-bilinear bench/streams/teapot-bilinear.tri pixel
check setup-smooth bench/streams/teapot-bilinear.tri setup
check vertex-lit bench/streams/teapot-lit.tri vertex
check shader-loop bench/flow/integers.tri pixel
exit $failures
