#!/usr/bin/env bash
# A new row of a table without its definition does not compile, and the compiler names the row. The rows are
# added to copies of the tables, and only syntax is checked.
# Given BUILD by tests/support/scripts/run.sh.
set -u
cd "$(dirname "$0")/.." || exit 1
[[ -z ${SLOW-} ]] || { echo 'ok growth is checked by the plain build' && exit; }
BUILD=${BUILD:-build}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0

# compiles FILE: with the tables of the copy before those of the tree. A header is compiled by itself.
compiles()
{
    gcc -std=gnu17 -Wall -Wextra -Werror -I"$work" -Isrc -I. -I"$BUILD/include" -x c -fsyntax-only "$1" 2>"$work/said"
}

# expect_refused NAME FILE MESSAGE: the file does not compile, and the compiler names what is missing.
expect_refused()
{
    if compiles "$2"; then
        echo "FAIL $1: $2 compiles"
        failed=1
    elif ! grep -q -- "$3" "$work/said"; then
        echo "FAIL $1: expected '$3' from the compiler of $2"
        cat "$work/said" >&2
        failed=1
    else
        echo "ok $1"
    fi
}

# add_value KIND: writes the public enumerations with one more value, whose number is free.
add_value()
{
    mkdir -p "$work/tables"
    cp src/def/state/*.def "$work/tables/"
    local last
    last=$(sed -nE "s/^VALUE\($1,.*, *([0-9]+), *[A-Z]+\)$/\1/p" src/def/state/value.def | sort -n | tail -n 1)
    printf 'VALUE(%s, novel, %s, YES)\n' "$1" "$((last + 1))" >>"$work/tables/value.def"
    (cd "$work/tables" && awk -f "$OLDPWD/src/words.awk" kind.def state.def sampler_state.def stage_state.def \
        value.def fvf.def attribute.def vertex_type.def format.def depth_format.def) >"$work/triptych_words.h"
}

derive=src/render/derive
while read -r kind file word; do
    add_value "$kind"
    expect_refused "a value of $kind without a meaning" "$derive/$file" "TRIPTYCH_${word}_NOVEL.*not handled"
done <<'END'
TEXTUREOP derive_stage.c TEXTUREOP
ALPHAOP derive_stage.c TEXTUREOP
COMPARE translate.c COMPARE
STENCILOP translate.c STENCILOP
SRCBLEND translate.c BLEND
BLENDOP translate.c BLENDOP
CULLMODE translate.c CULL
FILTER translate.c FILTER
ADDRESS translate.c ADDRESS
FOGMODE translate.c FOG
FILLMODE derive_setup.c FILL
SHADEMODE derive_setup.c SHADE
VERTEXBLEND derive_vertex.c VERTEXBLEND
MATERIALSOURCE derive_vertex.c MATERIALSOURCE
END
rm -f "$work/triptych_words.h"

mkdir -p "$work/def"
{ cat src/def/stage.def && echo 'STAGE_OPERATION(NOVEL, 2, "new")'; } >"$work/def/stage.def"
expect_refused 'a stage operation without a definition in bytes' src/spec/pixel/stage.h 'STAGE_NOVEL.*not handled'
expect_refused 'a stage operation without a definition in binary32' src/spec/pixel/float_stage.h 'STAGE_NOVEL.*not handled'
rm -r "$work/def"

# The copies have no part in a failure: the tree itself compiles.
for file in "$derive"/{translate,derive_stage,derive_setup,derive_vertex}.c src/spec/pixel/{stage,float_stage}.h; do
    compiles "$file" || { echo "FAIL $file compiles without a new row"; cat "$work/said" >&2; failed=1; }
done
exit $failed
