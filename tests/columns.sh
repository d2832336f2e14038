#!/usr/bin/env bash
# No line of C or assembly has more than 110 columns, and no comment of a table, a script or the Makefile.
# Rows of tables, recipes and the texts that scripts print may be longer, since their parts belong together.
# Runs once.
set -u
cd "$(dirname "$0")/.." || exit 1

files() # PATTERN of names: tracked sources; without git, those of the folders that have any
{
    if [[ -e .git ]]; then
        git ls-files
    else
        find Makefile src asm emu bench tests -type f
    fi | grep -E "$1"
}

long=$({
    files '\.(c|h|cc|asm|inc|map)$' | LC_ALL=C.UTF-8 xargs grep -nE '^.{111,}$'
    files '(^Makefile|\.(sh|awk|def))$' | LC_ALL=C.UTF-8 xargs grep -nE '^ *(#|/\*| \*).{110,}$' | grep -vE '\.def:[0-9]+:/\*.*   .*   .*   '
})
if [[ -n $long ]]; then
    echo "FAIL no line has more than 110 columns"
    printf '%s lines are longer, among them:\n%s\n' "$(grep -c '' <<<"$long")" "$(head -20 <<<"$long")" >&2
    exit 1
fi
echo "ok no line has more than 110 columns"
