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

# add_value KIND NUMBER: writes the public enumerations with one more value.
add_value()
{
    mkdir -p "$work/tables"
    cp src/def/state/*.def "$work/tables/"
    printf 'VALUE(%s, novel, %s, YES)\n' "$1" "$2" >>"$work/tables/value.def"
    (cd "$work/tables" && awk -f "$OLDPWD/src/words.awk" kind.def state.def sampler_state.def stage_state.def \
        value.def fvf.def attribute.def vertex_type.def format.def depth_format.def) >"$work/triptych_words.h"
}

derive=src/render/derive
while read -r kind number file word; do
    add_value "$kind" "$number"
    expect_refused "a value of $kind without a meaning" "$derive/$file" "TRIPTYCH_${word}_NOVEL.*not handled"
done <<'END'
TEXTUREOP 27 derive_stage.c TEXTUREOP
ALPHAOP 27 derive_stage.c TEXTUREOP
COMPARE 9 translate.c COMPARE
STENCILOP 9 translate.c STENCILOP
SRCBLEND 18 translate.c BLEND
BLENDOP 6 translate.c BLENDOP
CULLMODE 4 translate.c CULL
FILTER 4 translate.c FILTER
ADDRESS 6 translate.c ADDRESS
FOGMODE 4 translate.c FOG
FILLMODE 4 derive_setup.c FILL
SHADEMODE 4 derive_setup.c SHADE
VERTEXBLEND 4 derive_vertex.c VERTEXBLEND
MATERIALSOURCE 3 derive_vertex.c MATERIALSOURCE
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
