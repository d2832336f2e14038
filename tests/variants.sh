#!/bin/bash
# Variants of engines draw the same bytes: with few registers, without each pass, with no pass, and with
# unrolled loops, at each number of lanes; without each rule, at some; and mixtures with an engine for each
# unit. Given TRIPTYCH and SLOW by tests/support/scripts/run.sh; slow builds try the variants of eight lanes.
# Runs once.
set -uo pipefail
cd "$(dirname "$0")/.."

streams=(tests/data/streams/{multisampling,shaders}.tri tests/data/shading/light-loop.tri
    tests/data/regressions/anisotropic-words-and-numbers.tri)
engines='^specialize-(1|4|8|16|8x2)$'
if [[ ${SLOW-} ]]; then
    streams=(tests/data/streams/shaders.tri)
    engines='^specialize-8$'
fi

options=(registers={0,4,6,8} passes={none,thesis} passes=none:{unroll,with=fold} unroll registers=4:unroll
    allocate=none allocate=none:passes=none allocate=none:unroll
    allocate={hints,coloring} registers=4:allocate={hints,coloring} passes=none:allocate={hints,coloring}
    encode=text encode=text:passes=none encode=text:addresses=patched
    addresses={patched,shared} addresses=patched:registers=4 track=1 track=2:unroll track=1:calls=sampling
    sixteen=1 sixteen=1:registers=6)
calls=({sampling,shared} sampling:registers={0,4,8} sampling:passes={none,thesis} sampling:unroll
    sampling:allocate={none,hints,coloring} shared:addresses={patched,shared} sampling:encode=text)
for pass in $("$TRIPTYCH" list passes --json | sed -n 's/.*"pass":[^"]*"\([^"]*\)".*/\1/p'); do
    [[ $pass == split ]] || options+=("without=$pass")
done
rules=($("$TRIPTYCH" list rules --json | sed -n 's/.*"rule":[^"]*"\([^"]*\)".*/without=\1/p'))
failures=0

# An engine with each of the options. One command takes at most 15 of them.
compare() # ENGINE NAME OPTION...
{
    local engine=$1 name=$2 list said
    shift 2
    list=$(printf ",$engine:%s" "$@")
    if said=$("$TRIPTYCH" verify "${streams[@]}" --engines "${list#,}" --frames 1 --threads 1 2>&1) &&
        [[ ${said##*$'\n'} =~ ^"${#streams[@]} stream"s?", "[0-9]+" engine"s?", identical"$ ]]; then
        printf 'ok %s with %s\n' "$engine" "$name"
    else
        printf 'FAIL %s with %s\n%s\n' "$engine" "$name" "$said"
        failures=1
    fi
}

for engine in $("$TRIPTYCH" list engines | awk -v engines="$engines" '$1 ~ engines && $3 == "available" { print $1 }'); do
    compare "$engine" options "${options[@]}"
    [[ $engine =~ -(4|8x2)$ ]] || compare "$engine" 'a rule left out' "${rules[@]}"
    compare "$engine" calls "${calls[@]/#/calls=}"
    [[ $engine != specialize-16 ]] || compare "$engine" 'more registers' registers=16 registers=28:unroll
done

compare batch options fuse={none,products}
compare batch-16 options fuse=products
compare emulate options files=array decode=once files=array:decode=once files=typed:decode=each

mixtures=mixed,mixed:vertex=batch:setup=specialize-4:pixel=stitch,mixed:vertex=stitch-operation:setup=tiered
mixtures+=,mixed:vertex=specialize-8+registers=4:setup=emulate:pixel=batch-16
mixtures+=,mixed:vertex=emulate:setup=emulate:pixel=specialize-4+passes=none
if said=$("$TRIPTYCH" verify "${streams[@]}" --engines "emulate,$mixtures" --frames 1 --threads 1 2>&1) &&
    [[ ${said##*$'\n'} =~ ^"${#streams[@]} stream"s?", 6 engines, identical"$ ]]; then
    echo 'ok an engine for each unit'
else
    printf 'FAIL an engine for each unit\n%s\n' "$said"
    failures=1
fi

# Addresses in code: one copy, for which threads wait, and several copies.
patched='^specialize(-1|-4|-8|-16|-8x2)?$'
if [[ ${SLOW-} ]]; then
    patched='^specialize-8x2$'
else
    streams+=(bench/streams/street.tri)
fi
for engine in $("$TRIPTYCH" list engines | awk -v engines="$patched" '$1 ~ engines && $3 == "available" { print $1 }'); do
    if said=$("$TRIPTYCH" verify "${streams[@]}" --frames 1 --threads 2 \
        --engines "specialize-8,$engine:addresses=patched,$engine:addresses=shared" 2>&1) &&
        [[ ${said##*$'\n'} =~ " stream"s?", 3 engines, identical"$ ]]; then
        printf 'ok %s with addresses in code, two threads\n' "$engine"
    else
        printf 'FAIL %s with addresses in code\n%s\n' "$engine" "$said"
        failures=1
    fi
done
exit $failures
