#!/bin/bash
# Checks that every compiler gives the same bytes, at every level of optimisation, with and without AVX-512:
#
#   tests/support/scripts/matrix.sh BUILD
#
# Builds the command in BUILD/COMPILER-LEVEL for each combination, with all warnings as errors. Each build
# draws the first frame of all streams with all engines and two threads (`triptych verify` compares them), and
# compares the emulator's pictures with the goldens. At level 2 it also draws some streams with the external
# engine, which then uses the same compiler. The digests that verify prints include all bytes of a frame:
# colours of every target and sample, depths, stencils and the counts of queries. They must be the same in all
# combinations.
#
# Prints a row for each combination, and writes the table to results/matrix.txt. Ends non-zero after any
# difference.
set -uo pipefail
cd "$(dirname "$0")/../../.."

build=$1
streams=(bench/streams/*.tri tests/data/streams/*.tri tests/data/scenes/*.tri tests/data/shading/*.tri)
some=(bench/streams/teapot-bilinear.tri tests/data/streams/{lights,multisampling,queries,shaders}.tri)
table=results/matrix.txt
mkdir -p "$build" results
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

row() # COMPILER LEVEL HIDDEN ENGINES STREAMS GOLDENS EXTERNAL BYTES SECONDS
{
    printf '%-13s %-5s %-9s %7s %7s %7s %8s  %-17s %7s\n' "$@" | tee -a "$work/table"
}

failed() # WHAT FILE : shows the file's end
{
    printf 'FAIL %s\n' "$1"
    tail -n 40 "$2"
    failures=$((failures + 1))
}

# The digests that differ from those of the first combination, for the same streams.
compare_digests() # NAME : prints a digest of digests
{
    local digests=$work/$1.digests
    sed -nE 's/^([^ ]+): identical, .* xxh3 ([0-9a-f]{16})$/\1 \2/p' "$work/verified" >"$digests"
    [[ -f $work/first ]] || cp "$digests" "$work/first"
    cmp -s "$work/first" "$digests" || diff "$work/first" "$digests" >"$work/difference"
    sha256sum <"$digests" | cut -c1-16
}

run() # COMPILER LEVEL HIDDEN
{
    local compiler=$1 level=$2 hidden=$3 name=$1-O$2${3:+-$3} started=$SECONDS goldens external=- bytes
    local command=$build/$1-O$2/triptych
    export TRIPTYCH_CPU=$hidden
    rm -f "$work/difference"
    "$command" verify "${streams[@]}" --frames 1 --threads 2 >"$work/verified" 2>&1 ||
        failed "$name: verify" "$work/verified"
    TRIPTYCH=$command tests/goldens.sh >"$work/goldens" 2>&1 || failed "$name: goldens" "$work/goldens"
    goldens=$(grep -c '^ok ' "$work/goldens")
    if ((level == 2)); then
        if TRIPTYCH_CC=$compiler "$command" verify "${some[@]}" --frames 1 --threads 2 --engines external \
            >"$work/external" 2>&1; then
            external=${#some[@]}
        else
            failed "$name: external" "$work/external"
        fi
    fi
    bytes=$(compare_digests "$name")
    [[ ! -f $work/difference ]] || failed "$name: other bytes than the first combination's" "$work/difference"
    row "$compiler $("$compiler" -dumpversion)" "-O$level" "${hidden:-nothing}" \
        "$(sed -nE '$s/.* ([0-9]+) engines, .*/\1/p' "$work/verified")" \
            "$(grep -c ': identical, ' "$work/verified")" \
        "$goldens" "$external" "$bytes" $((SECONDS - started))
}

row compiler level hidden engines streams goldens external bytes seconds
combinations=0
for compiler in gcc clang; do
    for level in 0 2 3; do
        if ! make BUILD="$build/$compiler-O$level" CC="$compiler" CFLAGS="-O$level -g" all >"$work/made" \
            2>&1; then
            failed "$compiler -O$level: the build" "$work/made"
            continue
        fi
        masks=('')
        ! grep -qE '^avx512f +yes ' < <("$build/$compiler-O$level/triptych" list cpu) || masks+=(-avx512f)
        for mask in "${masks[@]}"; do
            run "$compiler" "$level" "$mask"
            combinations=$((combinations + 1))
        done
    done
done

if ((failures == 0)); then
    verdict="$combinations combinations, the same bytes"
    {
        printf '%s, %s\n\n' "$(git describe --always --dirty)" \
            "$("$build/gcc-O2/triptych" list cpu | sed -n 's/^model *\(.*[^ ]\)  *brand.*/\1/p')"
        cat "$work/table"
        printf '\n%s\n' "$verdict"
    } >"$table"
    printf '%s\n' "$verdict"
else
    printf '%d combinations, %d failures\n' "$combinations" "$failures"
fi
((failures == 0))
