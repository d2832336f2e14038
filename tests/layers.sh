#!/usr/bin/env bash
# The layers of docs/architecture.md: who may include whom. Engines include nothing of one another, the specification
# includes nothing at all, and nothing below the command knows it.
set -u
cd "$(dirname "$0")/.." || exit 1
failed=0

# check NAME FOLDER ALLOWED...: every quoted include of FOLDER's files begins with an allowed prefix.
check() {
    local name=$1 folder=$2 pattern
    shift 2
    pattern=$(printf '|%s' "$@")
    local found bad
    found=$(grep -rHoE '^ *#include "[^"]+"' --include='*.[ch]' "$folder")
    bad=$(printf '%s\n' "$found" | grep -vE "\"(${pattern#|})")
    if [ -z "$found" ] || [ -n "$bad" ]; then
        echo "FAIL $name"
        echo "${bad:-no includes found in $folder}" >&2
        failed=1
    else
        echo "ok $name"
    fi
}

check "base includes base and its own table" src/base base/ def/cpu.def triptych.h
check "tables include tables and layouts" src/def def/ draw/call.h draw/key.h shader/program.h
check "shaders know tables and the base" src/shader base/ def/ shader/
check "debugging knows the base and its own table" src/debug base/ debug/ def/debug.def
check "the renderer includes no engine" src/draw base/ debug/ def/ draw/ shader/ triptych.h
check "the container knows the renderer and no engine" src/container base/ container/ def/ draw/ shader/ triptych.h
check "the interface knows engines by their list" src/api api/ base/ container/ draw/ engines.h shader/
check "the recording includes no engine" src/ir ir/ base/ def/ draw/ shader/program.h spec/
check "the emulator and the batch interpreter include no other engine" emu emu/ ir/ base/ def/ draw/ shader/program.h spec/
check "the stitcher includes no other engine" src/stitch stitch/ base/ debug/code.h def/ draw/ shader/program.h spec/
check "the external engine includes no other engine" src/external external/ ir/ base/ def/ draw/ shader/program.h spec/
check "the specializer includes no other engine" src/jit jit/ ir/ base/ debug/code.h def/ draw/ shader/program.h spec/

check "tiers know the two engines they are of" src/tiered tiered/ base/ def/ draw/ shader/program.h stitch/stitch.h jit/jit.h

if grep -rn '#include' src/spec/*.h | grep -v '^src/spec/spec.h:' >&2; then
    echo "FAIL the specification includes nothing"
    failed=1
else
    echo "ok the specification includes nothing"
fi
exit $failed
