#!/usr/bin/env bash
# No extern function or object without a use: each is referenced by an object that does not define it.
#
# The public interface is exempt, as are the variants of fragments with an operand in memory: the stitcher
# finds them by their position after the first variant. A name that only tests or checked builds use is an
# error, unless its declaration or the comment above it has "For tests:" or "For checks:" and the reason.
# Patches of tests/extend and the sides of Direct3D 9 that have other compilers count as sources.
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
    echo "ok unused names: not looked up in an instrumented build, whose objects refer to more than the sources do"
    exit 0
fi

# "FOLDER KIND NAME SOURCE" of every object whose source exists; KIND is D (defines) or U (uses).
symbols() # FOLDER...
{
    find "$@" -type f \( -name '*.c' -o -name '*.asm' \) | sort | while read -r source; do
        object=$build/object/${source%.*}.o
        [[ ! -f $object ]] || echo "$object $source"
    done >"$work/objects"
    awk '
    NR == FNR { source[$1] = $2; next }
    match($0, /:[0-9a-f ]* [A-Za-z] /) {
        print ($(NF - 1) ~ /^[Uvw]$/ ? "U" : "D"), $NF, source[substr($0, 1, RSTART - 1)]
    }' "$work/objects" <(cut -d ' ' -f 1 "$work/objects" | xargs -r nm -A --extern-only 2>/dev/null)
}
symbols src emu asm bench >"$work/sources"
# The objects of Flex and Bison have no source in the tree, and use names of those that have.
find "$build/object/front" -name '*.o' -exec nm --extern-only --undefined-only {} + |
    awk 'NF == 2 { print "U", $2, "generated" }' >>"$work/sources"
symbols tests >"$work/testing"

awk '
FILENAME == ARGV[1] && $1 == "U" { used[$2] = 1 }
FILENAME == ARGV[2] && $1 == "U" { tested[$2] = 1 }
FILENAME == ARGV[1] && $1 == "D" { source[$2] = $3 }
END {
    for (name in source)
        if (!(name in used) && name !~ /^(__|triptych_|main$|fragment_.*_memory$)/ && source[name] !~ /^bench\//)
            print (name in tested ? "tests" : "none"), name, source[name]
}' "$work/sources" "$work/testing" | sort >"$work/unused"

# A declaration with its comment: the lines from the last empty line on.
has_reason() # NAME
{
    grep -rlw --include='*.h' "$1" src emu | xargs -r awk -v name="$1" '
        function check() { if (block ~ "(^|[^a-z0-9_])" name "([^a-z0-9_]|$)" && block ~ /For[ \n*]+(tests|checks):/) found = 1 }
        /^$/ || FNR == 1 { check(); block = "" }
        { block = block "\n" $0 }
        END { check(); exit !found }'
}
for kind in none tests; do
    : >"$work/$kind"
    while read -r name source; do
        grep -qrw "$name" tests/extend/*/change.patch src/front/d3d9/{pe,unix32,server} 2>/dev/null || has_reason "$name" || echo "$source: $name"
    done < <(awk -v kind=$kind '$1 == kind { print $2, $3 }' "$work/unused") >"$work/$kind"
done
[[ -s $work/sources ]] || echo "no object has a name: is $build built?" >"$work/none"
report "every extern name is used outside its own file: others are static or removed" "$work/none"
report "a name that only tests use has its reason at its declaration" "$work/tests"
exit $failed
