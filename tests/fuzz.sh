#!/bin/bash
# All engines draw the random cases of one seed equally, with one thread and with two. The cases are the same
# in each run. Given BUILD, TRIPTYCH and SLOW by tests/support/scripts/run.sh; slow builds draw fewer,
# without the variants of engines. Streams that show a difference are reduced and stored in BUILD/findings.
# `make soak` uses other seeds.
set -uo pipefail
cd "$(dirname "$0")/.."

failures=0

# draws_alike COUNT NAME [OPTION]...
draws_alike()
{
    local count=$1 name="$1 random cases of seed 5 are drawn alike$2" said status
    said=$("$TRIPTYCH" fuzz --seed 5 --count "$count" "${@:3}" --output "$BUILD/findings" 2>&1)
    status=$?
    if ((status == 0)) && grep -qE "^$count cases?, [0-9]+ engines?, .*, 0 findings$" <<<"$said"; then
        printf 'ok %s\n' "$name"
    else
        printf 'FAIL %s\n%s\nstatus %d\n' "$name" "$said" "$status"
        failures=1
    fi
}

variants=specialize-simple
for lanes in 1 4 8; do
    for option in allocate={none,hints,coloring} encode=text; do
        variants+=,specialize-$lanes:$option
    done
done
count=600 few=120
[[ -z ${SLOW-} ]] || count=50 few=10
draws_alike "$count" ''
draws_alike "$few" ' with spans' --set spans=always
[[ -z ${SLOW-} ]] || exit "$failures"
draws_alike "$few" ' by forms of the emulator' --engines emulate:files=array,emulate:decode=once,emulate:files=array:decode=once
draws_alike "$few" ' by joined steps' --engines batch:fuse=products,batch-8:fuse=products
draws_alike "$few" ' by variants of the specializer' --engines "$variants"
draws_alike "$few" ' with constants in code' --engines specialize-8:track=1,specialize-4:track=2,specialize-1:track=1:passes=none
draws_alike "$few" ' with second codes' --engines emulate,specialize-8:sixteen=1,specialize-8:sixteen=64
draws_alike "$few" ' with two blocks in a pass' --engines emulate,specialize-8x4,specialize-8x4:registers=6
exit "$failures"
