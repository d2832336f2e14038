#!/usr/bin/env bash
# Extern names: each begins with a prefix of its folder's row in src/README.md.
#
# A name belongs to the row with the longest prefix that it begins with. That row must be the row of the
# folder that defines it. Exceptions: engine_NAME objects are engines, command_NAME objects are subcommands,
# names that triptych.h declares are the public interface, Direct3D 9's methods are in the front end's table
# of calls, OpenGL's commands gl_NAME are in src/front/gl/calls, and names with two underscores belong to the
# system's interfaces.
set -u
cd "$(dirname "$0")/.." || exit 1
build=${BUILD:-build}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0

report() # NAME FILE: the file holds the violations; none may be left
{
    if [[ -s $2 ]]; then
        echo "FAIL $1"
        cat "$2" >&2
        failed=1
    else
        echo "ok $1"
    fi
}

if [[ -n ${SLOW:-} ]]; then
    echo "ok extern names: not looked up in an instrumented build, whose objects have names of the instrumentation"
    exit 0
fi

# Rows as "FOLDER PREFIX...".
awk -F'|' '/^\| `/ { gsub(/[` ]+/, " ", $2); gsub(/`/, "", $5); print $2, $5 }' src/README.md >"$work/rows"

awk '{ for (i = 2; i <= NF; i++) { if ($i in row) print $i ": in the rows of " row[$i] " and " $1; row[$i] = $1 } }' \
    "$work/rows" >"$work/twice"
report "no prefix is in two rows" "$work/twice"

# Names as "FOLDER NAME OBJECT", of objects whose source exists.
find src emu asm -type f \( -name '*.c' -o -name '*.asm' \) | sort | while read -r source; do
    object=$build/object/${source%.*}.o
    [[ ! -f $object ]] || echo "$object $source"
done >"$work/objects"
awk '
NR == FNR { source[$1] = $2; next }
match($0, /:[0-9a-f ]* [A-Z] /) {
    from = source[substr($0, 1, RSTART - 1)]
    folder = from
    sub(/\/[^\/]*$/, "", folder)
    print folder, $NF, from
}' "$work/objects" <(cut -d ' ' -f 1 "$work/objects" | xargs -r nm -A --extern-only --defined-only 2>/dev/null) >"$work/names"

# Direct3D 9's methods, in whichever folder of the front end they are: d3d9_CLASS_NAME.
methods()
{
    sed -nE -e 's/^(METHOD|HOSTED|PROCEDURE)\(([a-z0-9_]+), [A-Za-z0-9]+, ([a-z0-9_]+)[,)].*/d3d9_\2_\3/p' \
        -e 's/^FUNCTION\(([a-z0-9_]+), ([a-z0-9_]+),.*/d3d9_\1_\2/p' src/front/d3d9/calls/*.def
}

awk '
FILENAME == ARGV[1] { for (i = 2; i <= NF; i++) owner[$i] = $1; next }
FILENAME == ARGV[2] { public[$1] = 1; next }
$2 ~ /^__/ || $2 == "main" || $2 ~ /^(engine|command)_/ || $2 ~ /^gl_[A-Z]/ || $2 in public { next }
{
    for (n = length($2); n > 0 && !(substr($2, 1, n) in owner); n--);
    found = n ? owner[substr($2, 1, n)] : ""
    if (found != $1)
        print $3 ": " $2 (found ? ", whose prefix belongs to " found : ", which has no prefix of the map")
}' "$work/rows" <(grep -oE '\btriptych_[a-z0-9_]+' src/triptych.h | sort -u; methods) "$work/names" >"$work/strange"
[[ -s $work/names ]] || echo "no object has a name: is $build built?" >"$work/strange"
report "every extern name begins with a prefix of its folder" "$work/strange"
exit $failed
