#!/usr/bin/env bash
# Fills a folder with what a target may begin from: the repository's own small files of its format.
#
#   COMMAND=build/triptych tests/fuzz/seeds.sh TARGET FOLDER
set -uo pipefail
cd "$(dirname "$0")/../.."
target=$1 folder=$2
mkdir -p "$folder"

copy() # FILE... : those of up to 16 KiB
{
    local file
    for file in "$@"; do
        [[ $(stat -Lc %s "$file") -gt 16384 ]] || cp "$file" "$folder/$(tr / - <<<"$file")"
    done
}

case $target in
text) # with small targets, so that they are played
    copy tests/*/*.tri bench/streams/*.tri
    sed -i -E 's/^target [0-9]+ [0-9]+/target 16 16/' "$folder"/*
    ;;
container)
    for file in tests/streams/*.tri tests/shading/*.tri; do
        [[ $(stat -c %s "$file") -gt 8192 ]] || sed -E 's/^target [0-9]+ [0-9]+/target 16 16/' "$file" >"$folder/../seed.tri"
        "$COMMAND" convert "$folder/../seed.tri" "$folder/$(basename "$file" .tri).trib" >/dev/null 2>&1
    done
    rm -f "$folder/../seed.tri"
    ;;
shader) copy $(find tests/shaders -type f) ;;
bytecode)
    for file in $(find tests/shaders -type f); do
        "$COMMAND" shader assemble "$file" --out "$folder/$(basename "$file").o" >/dev/null 2>&1
    done
    ;;
png) copy $(find tests bench -name "*.png") ;;
dds) copy $(find tests bench -name '*.dds') ;;
model) # the format's number and whether there are bones, then the file
    formats=($(sed -n '/formats\[\] = {/,/};/p' tests/fuzz/targets/model.c | grep -oE '"[a-z0-9]+"' | tr -d '"'))
    for number in "${!formats[@]}"; do
        for file in $(find -L build/assimp/models -iname "*.${formats[number]}" -size -8k | sort | head -n 8); do
            { printf "\\x$(printf %02x "$number")\\1" && cat "$file"; } >"$folder/$(basename "$file")"
        done
    done
    ;;
bezier)
    for file in $(find bench -name '*.bez'); do
        { printf '\1\0\0\0\0' && head -n 40 "$file"; } >"$folder/$(basename "$file")"
    done
    ;;
esac
