#!/bin/bash
# Runs the tests of tests/fault with a fault at every request and every call, and checks that each place of
# src/ and emu/ that requests memory had a request refused.
#
#   tests/support/scripts/faults.sh BUILD
#
# A place is a line that calls one of the functions below. It had a refusal if the code of this line, or of a
# line next to it (a statement can have several lines), had one. EXCEPT names the files that the tests cannot
# reach, with the reason. Prints the tests' output, the places that never had a refusal, and a summary. Ends
# non-zero if something failed.
set -uo pipefail
cd "$(dirname "$0")/../../.."

build=$1
functions='malloc|calloc|realloc|aligned_alloc|posix_memalign|strdup|strndup|realpath|fopencookie|mmap|memfd_create|pthread_create|XXH3_createState'
except='src/engines/external/(compile|engine)\.c' # a compilation takes longer than all the rest: tests/engines/external has its refusals
except+='|src/engines/external/dump\.c|src/machine/code\.c' # code.c's calls are jumps: their callers were refused
except+='|src/debug/jitdump\.c' # files for perf, which are left out when they cannot be made
except+='|src/command/tool/bisect\.c|src/command/fuzz/' # drawing random cases: the campaign counts a process that is refused

sites=$(mktemp) places=$(mktemp) refused=$(mktemp)
trap 'rm -f "$sites" "$places" "$refused"' EXIT
failed=0

for name in device record command thread disk interrupt memory; do
    printf '%s\n' "$name"
    : >"$sites"
    TRIPTYCH_SOAK=1 TRIPTYCH_FAULT_SITES=$sites "$build/tests/fault/$name" || failed=1
    [[ -s $sites ]] || continue
    # These are return addresses: the call is before them.
    while read -r address; do printf '0x%x\n' $((address - 1)); done <"$sites" |
        addr2line -i -e "$build/tests/fault/$name" |
            sed -En 's/ \(discriminator.*//; s,^.*/((src|emu)/[^/]*/?[^/]*:[0-9]+)$,\1,p' >>"$refused"
done

grep -rnE "\b($functions)\(" --include='*.[ch]' src emu | grep -vE ':[0-9]+:( \*|/\*|.*//)' |
    sed -E 's/^([^:]+:[0-9]+):.*/\1/' | grep -vE "^($except)" >"$places"

never=0
while IFS=: read -r file line; do
    for ((near = line - 2; near <= line + 3; near++)); do
        grep -qxF "$file:$near" "$refused" && continue 2
    done
    printf 'never refused: %s:%s: %s\n' "$file" "$line" "$(sed -n "${line}s/^ *//p" "$file")"
    never=$((never + 1))
done <"$places"
printf '%d places that request memory, %d never refused\n' "$(wc -l <"$places")" "$never"
((!failed && !never))
