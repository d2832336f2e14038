#!/bin/bash
# Recordings of programs under AddressSanitizer with UndefinedBehaviorSanitizer, and under ThreadSanitizer,
# drawn by specialize with two threads. The pictures equal those of stitch without sanitizers and with one
# thread. Exits with 1 if a sanitizer reports something or a picture differs.
#
#   bench/d3d9/sanitize.sh RECORDING...     FRAMES=A-B or all: the frames (0-19)
#
# BUILD is the build (build). Its variants are built in BUILD/sanitize and BUILD/thread.
set -uo pipefail
cd "$(dirname "$0")/../.."

build=${BUILD-build}
make BUILD="$build" "$build/triptych" &&
    make BUILD="$build/sanitize" SANITIZE=address "$build/sanitize/triptych" &&
    make BUILD="$build/thread" SANITIZE=thread "$build/thread/triptych" || exit

frames() # COMMAND ENGINE THREADS RECORDING : the digest of the pictures
{
    "$1" render "$4" --engine "$2" --threads "$3" --frames "${FRAMES-0-19}" --format y4m --out - | sha256sum
}

status=0
for recording in "$@"; do
    expected=$(frames "$build/triptych" stitch 1 "$recording") || status=1
    for variant in sanitize thread; do
        if got=$(frames "$build/$variant/triptych" specialize 2 "$recording") && [[ $got == "$expected" ]]; then
            printf 'ok %s %s\n' "$variant" "$recording"
        else
            printf 'FAIL %s %s\n' "$variant" "$recording"
            status=1
        fi
    done
done
exit $status
