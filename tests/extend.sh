#!/usr/bin/env bash
# Extension: each tests/extend/KIND adds one thing of a kind to a copy of the sources, in no more files than
# its limit.
#
#   change.patch   the addition, for `patch -p1` at the top of the repository
#   check.sh       exits with 0 if the addition works; runs at the top of the copy, with TRIPTYCH set to its
#                  command
#   limit          the most files that the patch may touch, and the folder whose files do not count, if there
#                  is one
#
# The sources are built once without optimization, in BUILD/extend; each copy begins with those objects, so it
# compiles only what its patch affects.
# Runs once.
set -u
cd "$(dirname "$0")/.." || exit 1
kinds=(api-call state-value render-state texture-format shader-instruction ir-operation pass engine)

if [[ -n ${SLOW:-} ]]; then
    echo "ok extend: not in an instrumented build, which would compile the same additions"
    exit 0
fi

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
build=${BUILD:-build}
build=${build#"$PWD"/}
[[ $build != /* ]] || build=build
export objects=$build/extend work

if ! nice make -j"$(nproc)" BUILD="$objects" CFLAGS=-O0 all >"$work/log" 2>&1; then
    echo "FAIL extend: the sources do not build without optimization"
    grep -v '^  ' "$work/log" | tail -20 >&2
    exit 1
fi

# Copies the sources with their times, so that make finds them older than the objects.
if [[ -e .git ]]; then
    git ls-files -z
else
    find Makefile src asm emu bench tests docs -type f -print0
fi | grep -zvE '^results/' | while IFS= read -r -d '' file; do
    [[ ! -e $file ]] || printf '%s\0' "$file"
done >"$work/files"

# Prints the files that a patch touches, one a line.
touched() # PATCH
{
    sed -nE 's/^(---|\+\+\+) [^/]+\/([^\t]+).*/\2/p' "$1" | grep -v '^dev/null$' | sort -u
}

try() # KIND
{
    local kind=$1 from=$PWD/tests/extend/$1 copy=$work/$1 most apart count
    fail() { printf 'FAIL extend %s: %s\n' "$kind" "$1"; tail -n 30 "$work/$kind.log" >&2; return 1; }
    : >"$work/$kind.log"
    for file in change.patch check.sh limit; do
        [[ -f $from/$file ]] || { fail "expected tests/extend/$kind/$file"; return 1; }
    done
    read -r most apart <"$from/limit"
    count=$(touched "$from/change.patch" | grep -cv "^${apart:-/}")
    ((count <= most)) || { fail "touches $count files, expected at most $most"; return 1; }

    mkdir "$copy"
    xargs -0 cp -a --parents -t "$copy" <"$work/files"
    mkdir -p "$copy/$objects" "$copy/build"
    cp -a "$objects/." "$copy/$objects"
    patch -d "$copy" -p1 --no-backup-if-mismatch <"$from/change.patch" >"$work/$kind.log" 2>&1 ||
        { fail 'the patch does not apply'; return 1; }
    make -C "$copy" BUILD="$objects" CFLAGS=-O0 all >"$work/$kind.log" 2>&1 || { fail 'does not build'; return 1; }
    (cd "$copy" && TRIPTYCH=$copy/$objects/triptych BUILD=$copy/$objects bash "$from/check.sh") \
        >"$work/$kind.log" 2>&1 || { fail 'its check fails'; return 1; }
    rm -rf "$copy"
    printf 'ok extend %s: %d files, at most %d\n' "$kind" "$count" "$most"
}
export -f try touched

failed=0
printf '%s\0' "${kinds[@]}" | nice xargs -0 -n 1 -P "$(nproc)" bash -c 'try "$1"' try || failed=1
for folder in tests/extend/*/; do
    kind=$(basename "$folder")
    [[ ! -d $folder || " ${kinds[*]} " == *" $kind "* ]] || { echo "FAIL extend $kind: not in the list of tests/extend.sh"; failed=1; }
done
exit $failed
