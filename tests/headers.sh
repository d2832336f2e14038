#!/usr/bin/env bash
# Every header of src/ and emu/ compiles by itself, so it includes everything that it uses. The build shows it
# for a header that the source of the same name includes first. Headers of the specification are compiled with
# the binding that does nothing (contract/language.h), which no object contains.
# Three headers are exceptions: emu/emulate/quad.h is the middle of bind.h, and vector.h and plain.h of
# src/engines/external are texts for the system's compiler. src/front/d3d9/pe is for Windows' compiler. The
# compilation database has an entry for every other C source and every header of the specification.
# Runs once.
set -u
cd "$(dirname "$0")/.." || exit 1
failed=0
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# check NAME HEADER...: for each header, a file that only includes it compiles.
check() {
    local name=$1 header file flags=(-std=gnu17 -Wall -Wextra -Werror -Isrc -I. -I"$BUILD/include" -fsyntax-only)
    shift
    rm -rf "$scratch/only" && mkdir "$scratch/only"
    for header; do
        file=$scratch/only/${header//\//_}.c
        printf '#include "%s"\n' "$header" >"$file"
    done
    if [ $# -gt 0 ] && find "$scratch/only" -name '*.c' -print0 |
        xargs -0 -P "$(nproc)" -n 8 gcc "${flags[@]}" >"$scratch/said" 2>&1; then
        echo "ok $name"
        return
    fi
    echo "FAIL $name"
    head -n 40 "$scratch/said" >&2
    failed=1
}

mapfile -t specification < <(find src/spec -name '*.h' | sort)
check "each header of the specification compiles alone" "${specification[@]}"

# is_built HEADER: whether the build has an object of a source that includes it first
is_built() {
    local source=${1%.h}.c first
    [[ -e $source && -e $BUILD/object/${1%.h}.o ]] && first=$(grep -m 1 '^#include' "$source") && [[ $first == "#include \"${1#src/}\"" ]]
}

others=()
while IFS= read -r header; do
    is_built "$header" || others+=("$header")
done < <(find src emu -name '*.h' ! -path 'src/spec/*' ! -path emu/emulate/quad.h ! -path src/engines/external/vector.h \
    ! -path src/engines/external/plain.h ! -path 'src/front/d3d9/pe/*' | sort)
check "each other header compiles alone" "${others[@]}"

database=$BUILD/compile_commands.json
make -s BUILD="$BUILD" "$database" >"$scratch/make" 2>&1
missing=$(comm -23 <(find src emu tests bench -name '*.c' -o -path 'src/spec/*.h' |
    grep -vE '^(src|tests)/front/d3d9/pe/|^tests/front/egl/program/|^tests/support/portable/|^bench/d3d9/' | sort) \
    <(sed -n 's/.*"file": "\([^"]*\)".*/\1/p' "$database" | sort))
if [ -z "$missing" ] && grep -q '^\]$' "$database"; then
    echo "ok the compilation database names every source"
else
    echo "FAIL the compilation database names every source"
    printf '%s\n' "$missing" >&2
    failed=1
fi
exit $failed
