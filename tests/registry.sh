#!/usr/bin/env bash
# The tables of OpenGL ES are those of the Khronos registry: src/front/gl/calls/registry.py writes the same
# files again. The registry is Debian's package khronos-api.
# Runs once.
set -u
cd "$(dirname "$0")/.." || exit 1
registry=/usr/share/khronos-api/gl.xml
[[ -e $registry ]] || { echo "ok the tables of OpenGL ES are not compared: $registry is not installed" && exit; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0

python3 -B src/front/gl/calls/registry.py --registry "$registry" "$work" || failed=1
for table in core extension constant; do
    if diff -u "src/front/gl/calls/$table.def" "$work/$table.def" >&2; then
        echo "ok $table.def is what the registry gives"
    else
        echo "FAIL $table.def is what the registry gives"
        failed=1
    fi
done
exit "$failed"
