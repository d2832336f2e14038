#!/bin/bash
# The first frame of every stream, of bench/streams or tests/streams, that has a golden picture,
# tests/goldens/STREAM.png, equals it pixel for pixel; so does that of every scene of tests/scenes its picture on the
# gallery's page, docs/images/gallery/STREAM.png.
# Given BUILD, TRIPTYCH and SANITIZE by tests/support/run.sh.
#
#   GOLDENS=write TRIPTYCH=build/triptych tests/goldens.sh STREAM...    makes the pictures anew: look at them
set -uo pipefail
cd "$(dirname "$0")/.."

golden_of() # STREAM
{
    local name=${1##*/}
    case $1 in
        tests/scenes/*) printf 'docs/images/gallery/%s.png' "${name%.*}" ;;
        *) printf 'tests/goldens/%s.png' "${name%.*}" ;;
    esac
}

if [[ ${GOLDENS-} == write ]]; then
    mkdir -p tests/goldens docs/images/gallery
    for stream in "$@"; do
        "$TRIPTYCH" render "$stream" --engine emulate --out "$(golden_of "$stream")" || exit
    done
    exit
fi

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
shopt -s nullglob
streams=(tests/scenes/*.tri)
for golden in tests/goldens/*.png; do
    name=${golden##*/} name=${name%.png}
    stream=bench/streams/$name.tri
    [[ -f $stream ]] || stream=tests/streams/$name.tri
    streams+=("$stream")
done
((${#streams[@]})) || { echo 'FAIL there are golden pictures' && exit 1; }

failures=0
for stream in tests/scenes/*.tri; do
    if ! grep -qF "($(golden_of "$stream" | cut -d/ -f2-))" docs/gallery.md; then
        printf 'FAIL docs/gallery.md shows %s\n' "$stream"
        failures=1
    fi
done
for stream in "${streams[@]}"; do
    if said=$("$TRIPTYCH" render "$stream" --engine emulate --out "$work/picture.png" 2>&1 &&
        "$TRIPTYCH" compare "$(golden_of "$stream")" "$work/picture.png" 2>&1); then
        printf 'ok %s\n' "$stream"
    else
        printf 'FAIL %s: %s\n' "$stream" "$said"
        failures=1
    fi
done
exit $failures
