#!/bin/bash
# All engines, widths and thread counts draw every stream alike, byte for byte.
# Given BUILD, TRIPTYCH and SANITIZE by tests/support/run.sh; with sanitizers fewer frames are drawn.
set -uo pipefail
cd "$(dirname "$0")/.."

shopt -s nullglob
streams=(bench/streams/*.tri tests/streams/*.tri tests/scenes/*.tri)
((${#streams[@]})) || { echo 'FAIL there are draw streams' && exit 1; }

options=()
[[ -z ${SANITIZE-} ]] || options=(--frames 1 --threads 2)
failures=0
for stream in "${streams[@]}"; do
    if said=$("$TRIPTYCH" verify "$stream" "${options[@]}" 2>&1) &&
        [[ ${said##*$'\n'} =~ ^1\ streams,\ [0-9]+\ engines,\ identical$ ]]; then
        printf 'ok %s\n' "$stream"
    else
        printf 'FAIL %s\n%s\n' "$stream" "$said"
        failures=1
    fi
done
exit $failures
