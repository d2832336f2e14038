#!/bin/bash
# Every function that asm/ exports is called through the checked trampoline by a test.
#
# A function is covered when a test passes its name to trampoline_call() or trampoline_call_with(). The
# fragments in asm/ are data for the joiner; tests/engines/stitch/contract.c runs each of them.
set -uo pipefail
cd "$(dirname "$0")/.." || exit 1
build=${BUILD:-build}
failed=0

report() # NAME STATUS
{
    if (($2 == 0)); then
        echo "ok $1"
    else
        echo "FAIL $1"
        failed=1
    fi
}

# Functions of an assembly object: global symbols in executable sections.
exported()
{
    find "$build/object/asm" -name '*.o' -exec nm --extern-only --defined-only {} + | awk '$2 == "T" { print $3 }' | sort -u
}

covered() # FUNCTION
{
    cat $(find tests -name '*.c') | tr '\n' ' ' | grep -qE "trampoline_call(_with)?\((\([a-z_ *]*\))*$1,"
}

functions=$(exported)
[[ -n $functions ]]
report "asm/ exports functions" $?
for function in $functions; do
    covered "$function"
    report "$function is called through the trampoline" $?
done
covered no_such_function && status=1 || status=0
report "a function without a test is found" $status
exit $failed
