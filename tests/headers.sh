#!/usr/bin/env bash
# Every header of src/ and emu/ compiles by itself, with gcc and clang, so it includes everything that it
# uses. Headers of the specification are compiled with the binding that does nothing (contract/language.h).
# Three headers are exceptions: emu/emulate/quad.h is the middle of bind.h, and vector.h and plain.h of
# src/engines/external are texts for the system's compiler. src/front/d3d9/pe is for Windows' compiler. The
# compilation database has an entry for every other C source and every header of the specification.
# Runs once.
set -u
cd "$(dirname "$0")/.." || exit 1
failed=0
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

compilers=()
for compiler in gcc clang; do
    command -v "$compiler" >/dev/null && compilers+=("$compiler")
done

# compile COMPILER HEADER: the header as the only include of a file.
compile() {
    printf '#include "%s"\n' "$2" |
        "$1" -std=gnu17 -Wall -Wextra -Werror -Isrc -I. -I"$BUILD/include" -x c -fsyntax-only - >"$scratch/$1.${2//\//_}" 2>&1 ||
        echo "$1 $2"
}
export -f compile
export scratch

# check NAME HEADER...: all of them compile with every compiler.
check() {
    local name=$1 bad
    shift
    for compiler in "${compilers[@]}"; do
        bad=$(printf '%s\n' "$@" | xargs -P "$(nproc)" -I{} bash -c 'compile "$0" "$1"' "$compiler" {})
        if [ -z "$bad" ] && [ $# -gt 0 ]; then
            echo "ok $name, $compiler"
            continue
        fi
        echo "FAIL $name, $compiler"
        printf '%s\n' "$bad" >&2
        printf '%s\n' "$bad" | head -3 | while read -r _ header; do cat "$scratch/$compiler.${header//\//_}"; done >&2
        failed=1
    done
}

mapfile -t specification < <(find src/spec -name '*.h' | sort)
check "each header of the specification compiles alone" "${specification[@]}"

mapfile -t others < <(find src emu -name '*.h' ! -path 'src/spec/*' \
    ! -path emu/emulate/quad.h ! -path src/engines/external/vector.h ! -path src/engines/external/plain.h ! -path 'src/front/d3d9/pe/*' | sort)
check "each other header compiles alone" "${others[@]}"

database=$BUILD/compile_commands.json
make -s BUILD="$BUILD" "$database" >"$scratch/make" 2>&1
missing=$(find src emu tests bench -name '*.c' -o -path 'src/spec/*.h' | grep -vE '^(src|tests)/front/d3d9/pe/|^tests/support/portable/|^bench/d3d9/' | while read -r file; do
    grep -qF "\"file\": \"$file\"" "$database" || echo "$file"
done)
if [ -z "$missing" ] && grep -q '^\]$' "$database"; then
    echo "ok the compilation database names every source"
else
    echo "FAIL the compilation database names every source"
    printf '%s\n' "$missing" >&2
    failed=1
fi
exit $failed
