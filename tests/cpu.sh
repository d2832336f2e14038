#!/bin/bash
# Features of the processor that TRIPTYCH_CPU hides are not used. They are listed as hidden, engines that need
# them report why they cannot run, other engines draw the same bytes, and an invalid list is refused. Given
# BUILD, TRIPTYCH and SANITIZE by tests/support/scripts/run.sh.
set -uo pipefail
cd "$(dirname "$0")/.."
unset TRIPTYCH_CPU

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0
stream=tests/data/streams/lights.tri

test_case() # NAME COMMAND... : the command's output is shown only if it fails
{
    local name=$1
    shift
    if "$@" >"$work/said" 2>&1; then
        echo "ok $name"
    else
        echo "FAIL $name"
        cat "$work/said"
        failures=1
    fi
}

hidden() # FEATURE MASK
{
    TRIPTYCH_CPU=$2 "$TRIPTYCH" list cpu | grep -E "^$1 +hidden "
}

verifies() # MASK : prints the engines that did
{
    TRIPTYCH_CPU=$1 "$TRIPTYCH" verify "$stream" --frames 1 --threads 2
}

same_bytes() # MASK : as without
{
    local digest
    digest=$("$TRIPTYCH" verify "$stream" --frames 1 --threads 2 | grep -oE 'xxh3 [0-9a-f]{16}') || return
    verifies "$1" | grep -F "$digest"
}

refuses() # PATTERN COMMAND... : status 2, nothing on standard output, one line on standard error
{
    local pattern=$1 status=0
    shift
    "$@" >"$work/out" 2>"$work/err" || status=$?
    cat "$work/err"
    ((status == 2)) && [[ ! -s $work/out ]] && (($(wc -l <"$work/err") == 1)) && grep -qE -- "$pattern" "$work/err"
}

needs_avx2() # ENGINE
{
    TRIPTYCH_CPU=-avx2 refuses "engine $1 cannot run here: needs AVX2 and FMA, which TRIPTYCH_CPU hides" \
        "$TRIPTYCH" render "$stream" --engine "$1" --out "$work/picture.png" && [[ ! -e $work/picture.png ]]
}

needs_avx512() # ENGINE : all of what it needs
{
    local feature
    for feature in avx512f avx512dq avx512bw avx512vl; do
        TRIPTYCH_CPU=-$feature refuses \
            "engine $1 cannot run here: needs AVX-512 F, DQ, BW and VL, which TRIPTYCH_CPU hides" \
            "$TRIPTYCH" render "$stream" --engine "$1" --out "$work/picture.png" || return
    done
    [[ ! -e $work/picture.png ]]
}

# Registers that only AVX-512 has: zmm, xmm16 and above, masks.
makes_no_avx512() # ENGINE
{
    local unit code
    for unit in vertex setup pixel; do
        code=$(TRIPTYCH_CPU=-avx512f "$TRIPTYCH" dump "$stream" --engine "$1" --unit "$unit") || return
        grep -qE '^[0-9a-f ]+ ret' <<<"$code" || { echo "no code for $unit" && return 1; }
        ! grep -E '\b(zmm[0-9]+|[xy]mm(1[6-9]|2[0-9]|3[01])|k[0-7])\b' <<<"$code" || return
    done
}

# Without any feature, only the two interpreters can run, on every processor.
interpreters_only()
{
    verifies -avx | tee "$work/verified" | grep -E '^1 stream, 2 engines, identical$' &&
        ! grep '^left out' "$work/verified" | grep -v 'needs AVX2 and FMA'
}

engines=$("$TRIPTYCH" list engines | awk '$3 == "available" && $1 ~ /^(stitch|specialize|external)/ { print $1 }')
for engine in $engines; do
    test_case "$engine does not run without AVX2" needs_avx2 "$engine"
    if [[ $engine == specialize-16 ]]; then
        test_case "$engine does not run without AVX-512" needs_avx512 "$engine"
    else
        test_case "$engine makes no code of AVX-512 where it is hidden" makes_no_avx512 "$engine"
    fi
done
for feature in $("$TRIPTYCH" list cpu | awk '$2 == "yes" { print $1 }'); do
    test_case "$feature can be hidden" hidden "$feature" "-$feature"
    test_case "the same bytes without $feature" same_bytes "-$feature"
done
if grep -qE '^avx512bw +yes ' < <("$TRIPTYCH" list cpu); then
    test_case 'what builds on AVX-512 is hidden with it' hidden avx512bw -avx512f
fi
test_case 'interpreters run everywhere' interpreters_only
TRIPTYCH_CPU=avx512f test_case 'a list that is not understood is refused' \
    refuses '^triptych: TRIPTYCH_CPU is "avx512f", expected what to hide, .*-avx512f' "$TRIPTYCH" list cpu
exit $failures
