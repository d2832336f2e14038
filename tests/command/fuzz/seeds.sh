#!/usr/bin/env bash
# Fills a folder with first inputs of a target: the repository's own small files of its format.
#
#   COMMAND=build/triptych tests/command/fuzz/seeds.sh TARGET FOLDER
set -uo pipefail
cd "$(dirname "$0")/../../.."
target=$1 folder=$2
mkdir -p "$folder"

copy() # FILE... : those of up to 16 KiB
{
    local file
    for file in "$@"; do
        [[ $(stat -Lc %s "$file") -gt 16384 ]] || cp "$file" "$folder/$(tr / - <<<"$file")"
    done
}

# A stream with a small target, so that it is played.
shrink() # FILE
{
    sed -E 's/^( *target) [0-9]+ [0-9]+/\1 16 16/; s/^( *viewport) ([^ ]+ ){4}/\1 0 0 16 16 /
        s/^( *scissor) ([^ ]+ ){3}[^ ]+/\1 0 0 16 16/' "$1"
}

# Small streams without files, each in turn in the folder's seed.tri.
each_stream() # COMMAND...
{
    local file
    for file in $(grep -LE 'file|bezier' tests/data/streams/*.tri tests/data/shading/*.tri); do
        [[ $(stat -c %s "$file") -le 8192 ]] || continue
        shrink "$file" >"$folder/seed.tri"
        "$@" "$folder/seed.tri" "$folder/$(basename "$file" .tri).trib" >/dev/null 2>&1
    done
    rm -f "$folder"/seed.*
}

record() # STREAM RECORDING
{
    TRIPTYCH_RECORD=$2 "$COMMAND" render "$1" --engine emulate --out "$1.png"
}

# The shaders of the tests and of glmark2, each after a byte of its stage.
shaders()
{
    local file
    for file in tests/front/glsl/corpus/*.{vert,frag} build/glmark2/shaders/*.{vert,frag}; do
        [[ -f $file ]] || continue
        { if [[ $file == *.vert ]]; then printf '\0'; else printf '\1'; fi && cat "$file"; } \
            >"$folder/$(tr / - <<<"$file")"
    done
}

# Programs: a byte of an engine, the vertex shader, a zero, the fragment shader.
programs()
{
    local file number=0
    for file in tests/front/glsl/corpus/*.vert build/glmark2/shaders/*.vert; do
        [[ -f ${file%.vert}.frag ]] || continue
        printf '%b' "\\x$((number++ % 3))" >"$folder/$(tr / - <<<"${file%.vert}")"
        { cat "$file" && printf '\0' && cat "${file%.vert}.frag"; } >>"$folder/$(tr / - <<<"${file%.vert}")"
    done
}

# Shaders as the numbers of their words (targets/gl/word.def). Names without a word get one of a letter.
numbers() # SHADER : reads the words, writes \xNN
{
    sed -nE 's/^(GLSL_KEYWORD|WORD)\("([^"]*)".*/\2/p' src/front/glsl/compile/keyword.def \
        tests/command/fuzz/targets/gl/word.def |
        awk 'FNR == NR { number[$0] = NR - 1; if ($0 ~ /^[a-w]$/) letters[++count] = NR - 1; next }
            { sub(/\/\/.*/, ""); sub(/^ *#.*/, ""); gsub(/\/\*.*\*\//, "")
              while (match($0, /[A-Za-z_][A-Za-z_0-9]*|[0-9]*\.?[0-9]+([eE][-+]?[0-9]+)?|[-+*\/]=|[<>=!]=|\+\+|--|&&|\|\||\^\^|[^ \t]/)) {
                  word = substr($0, RSTART, RLENGTH); $0 = substr($0, RSTART + RLENGTH)
                  if (!(word in number)) number[word] = word ~ /^[A-Za-z_]/ ? letters[1 + other++ % count] : word ~ /[.]/ ? number["1.0"] : number["2"]
                  printf "\\x%02x", number[word] } }' - "$1"
}

case $target in
glsl | preprocess) shaders ;;
program) programs ;;
gles) # any bytes: inputs become at most as long as the longest of the first ones
    for number in 1 2 3 4; do
        printf "$(awk -v number=$number 'BEGIN { for (i = 0; i < 768; i++) { number = (number * 1103515245 + 12345) % 2147483648
            printf "\\x%02x", int(number / 65536) % 256 } }')" >"$folder/any-$number"
    done
    ;;
grammar)
    for file in tests/front/glsl/corpus/*.{vert,frag} build/glmark2/shaders/*.{vert,frag}; do
        [[ -f $file ]] || continue
        { if [[ $file == *.vert ]]; then printf '\0'; else printf '\1'; fi && printf "$(numbers "$file")"; } \
            >"$folder/$(tr / - <<<"$file")"
    done
    ;;
text)
    rm -f "$folder"/small-*
    copy tests/*/*.tri bench/streams/*.tri
    for file in "$folder"/*.tri; do
        shrink "$file" >"$folder/small-${file##*/}"
    done
    ;;
container) each_stream "$COMMAND" convert ;;
recording) # the calls of the interface that drawing makes
    each_stream record
    find "$folder" -size +16k -delete
    ;;
shader) copy $(find tests/data/shaders -type f) ;;
bytecode)
    for file in $(find tests/data/shaders -type f); do
        "$COMMAND" shader assemble "$file" --out "$folder/$(basename "$file").o" >/dev/null 2>&1
    done
    ;;
png) copy $(find tests bench -name "*.png") ;;
dds) copy $(find tests bench -name '*.dds') ;;
model) # the format's number, the request for bones and materials, then the file
    formats=($(sed -n '/formats\[\] = {/,/};/p' tests/command/fuzz/targets/model.c | grep -oE '"[a-z0-9]+"' |
        tr -d '"'))
    for number in "${!formats[@]}"; do
        for file in $(find -L build/assimp/models -iname "*.${formats[number]}" -size -8k | sort |
            head -n 8); do
            { printf "\\x$(printf %02x "$number")\\3" && cat "$file"; } >"$folder/$(basename "$file")"
        done
    done
    ;;
bezier)
    for file in $(find bench -name '*.bez'); do
        { printf '\1\0\0\0\0' && head -n 40 "$file"; } >"$folder/$(basename "$file")"
    done
    ;;
esac
