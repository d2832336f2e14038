#!/bin/bash
# The first frame of a stream equals its golden picture in every pixel. Streams and pictures are:
#   bench/streams, tests/data/streams   tests/data/goldens/STREAM.png, if it exists
#   tests/data/programs                 the same: recordings of programs (docs/opengles.md)
#   tests/data/scenes                   docs/images/gallery/STREAM.png, in the gallery
#   tests/data/shading                  docs/images/shaders/STREAM.png, in the shader gallery
#   bench/streams/pages                 docs/images/pages/STREAM.png, in docs/scenes.md
# Given BUILD, TRIPTYCH and SANITIZE by tests/support/scripts/run.sh.
#
#   GOLDENS=write TRIPTYCH=build/triptych tests/goldens.sh STREAM...    writes the pictures again: look at
# them
set -uo pipefail
cd "$(dirname "$0")/.."

golden_of() # STREAM
{
    local name=${1##*/}
    case $1 in
        tests/data/scenes/*) printf 'docs/images/gallery/%s.png' "${name%.*}" ;;
        tests/data/shading/*) printf 'docs/images/shaders/%s.png' "${name%.*}" ;;
        bench/streams/pages/*) printf 'docs/images/pages/%s.png' "${name%.*}" ;;
        *) printf 'tests/data/goldens/%s.png' "${name%.*}" ;;
    esac
}

if [[ ${GOLDENS-} == write ]]; then
    mkdir -p tests/data/goldens docs/images/{gallery,shaders,pages}
    for stream in "$@"; do
        "$TRIPTYCH" render "$stream" --engine emulate --compression 9 --out "$(golden_of "$stream")" || exit
    done
    exit
fi

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
shopt -s nullglob
pages=(tests/data/scenes/*.tri tests/data/shading/*.tri bench/streams/pages/*.trib)
streams=("${pages[@]}")
for golden in tests/data/goldens/*.png; do
    name=${golden##*/} name=${name%.png}
    stream=bench/streams/$name.tri
    [[ -f $stream ]] || stream=tests/data/streams/$name.tri
    [[ -f $stream ]] || stream=tests/data/programs/$name.trib
    streams+=("$stream")
done
((${#streams[@]})) || { echo 'FAIL there are golden pictures' && exit 1; }

failures=0
for stream in "${pages[@]}"; do
    case $stream in
        tests/data/scenes/*) page=docs/gallery.md ;;
        tests/data/shading/*) page=docs/shader-gallery.md ;;
        *) page=docs/scenes.md ;;
    esac
    if ! grep -qF "($(golden_of "$stream" | cut -d/ -f2-))" "$page"; then
        printf 'FAIL %s shows %s\n' "$page" "$stream"
        failures=1
    fi
done
# With sanitizers every ninth stream is drawn, and only one page. The plain build draws all of them.
number=0
for stream in "${streams[@]}"; do
    [[ ${SANITIZE-} ]] && ((number++ % 9)) && continue
    [[ ${SANITIZE-} && $stream == bench/streams/pages/page-[!t]* ]] && continue
    if said=$("$TRIPTYCH" render "$stream" --engine emulate --out "$work/picture.png" 2>&1 &&
        "$TRIPTYCH" compare "$(golden_of "$stream")" "$work/picture.png" 2>&1); then
        printf 'ok %s\n' "$stream"
    else
        printf 'FAIL %s: %s\n' "$stream" "$said"
        failures=1
    fi
done

# Frames that draw only what changes end in the picture that the last frame draws as a whole.
for name in list scroll; do
    [[ ${SANITIZE-} ]] && continue
    if said=$("$TRIPTYCH" render "bench/streams/pages/page-$name.trib" --frames all --engine emulate \
        --out "$work/$name-%d.png" 2>&1 &&
        "$TRIPTYCH" compare "$work/$name-6.png" "$work/$name-7.png" 2>&1); then
        printf 'ok page-%s by its damage is the whole page\n' "$name"
    else
        printf 'FAIL page-%s by its damage is the whole page: %s\n' "$name" "$said"
        failures=1
    fi
done
exit $failures
