#!/bin/bash
# Every shader of tests/data/shaders follows the rules of its model, has a head comment on what it shows and
# what it needs, is used by a stream of tests/data/shading, and its bytecode disassembles to text that
# assembles to the same bytecode. Given BUILD, TRIPTYCH and SANITIZE by tests/support/scripts/run.sh.
set -uo pipefail
cd "$(dirname "$0")/.."

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
shopt -s nullglob globstar
shaders=(tests/data/shaders/**/*.[vp]sa)
((${#shaders[@]} >= 60)) || { echo 'FAIL there are sixty shaders' && exit 1; }

# The files of shaders that some stream shades with, a line each.
awk 'FNR == 1 { delete file }
    $1 == "shader" { file[$2] = $3 }
    $1 ~ /^(vertex|pixel)shader$/ && $2 in file { print file[$2] }' tests/data/shading/*.tri | sort -u >"$work/set"

examine() # SHADER : fails, or prints the error
{
    local stage=${1##*.}
    head -n 1 "$1" | grep -q '^; [[:alpha:]]' || { echo 'no comment at its head' && return; }
    grep -q '^; .*Inputs: ' "$1" || { echo 'no word of its inputs' && return; }
    grep -qE "^${stage%a}_[123]_[0-4x]$" "$1" || { echo "no model of ${stage%a}" && return; }
    grep -qxF "\"../${1#tests/data/}\"" "$work/set" || { echo 'no stream that uses it' && return; }
    "$TRIPTYCH" shader validate "$1" >/dev/null &&
        "$TRIPTYCH" shader assemble "$1" --out "$work/first" &&
        "$TRIPTYCH" shader disassemble "$work/first" >"$work/text" &&
        "$TRIPTYCH" shader assemble "$work/text" --out "$work/second" &&
        cmp "$work/first" "$work/second"
}

# Builds with sanitizers take every fourth shader.
failures=0 number=0
for shader in "${shaders[@]}"; do
    [[ ${SANITIZE-} ]] && ((number++ % 4)) && continue
    if said=$(examine "$shader" 2>&1) && [[ -z $said ]]; then
        printf 'ok %s\n' "$shader"
    else
        printf 'FAIL %s\n     %s\n' "$shader" "$said"
        failures=1
    fi
done
exit $failures
