#!/bin/bash
# All engines draw the random cases of one seed equally, with one thread and with two. The cases are the same
# in each run. Given BUILD, TRIPTYCH and SLOW by tests/support/scripts/run.sh; slow builds draw fewer. Streams
# that show a difference are reduced and stored in BUILD/findings. `make soak` uses other seeds.
set -uo pipefail
cd "$(dirname "$0")/.."

count=2400
[[ -z ${SLOW-} ]] || count=300
name="$count random cases of seed 5 are drawn alike"
said=$("$TRIPTYCH" fuzz --seed 5 --count "$count" --output "$BUILD/findings" 2>&1)
status=$?
if ((status == 0)) && grep -qE "^$count cases, [0-9]+ engines, .*, 0 findings$" <<<"$said"; then
    printf 'ok %s\n' "$name"
else
    printf 'FAIL %s\n%s\nstatus %d\n' "$name" "$said" "$status"
    exit 1
fi
