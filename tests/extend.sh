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
# One copy gets all additions, so it is built once; their parts must not disturb each other. With EXTEND=each,
# every addition has a copy of its own, which names the one that is wrong when the copy of all does not build.
# Clang builds the copy with its measurements, so that this is also the test that clang accepts every source.
# `make test` builds the rest with gcc, but test programs with clang in the plain build.
# Runs once.
set -u
cd "$(dirname "$0")/.." || exit 1
export CC=clang
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
objects=$build/extend

# The files of a copy.
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

# Checks the number of files that the patch of a kind touches.
count_files() # KIND
{
    local from=tests/extend/$1 most apart count file
    for file in change.patch check.sh limit; do
        [[ -f $from/$file ]] || { echo "expected tests/extend/$1/$file" >"$work/reason"; return 1; }
    done
    read -r most apart <"$from/limit"
    count=$(touched "$from/change.patch" | grep -cv "^${apart:-/}")
    counted="$count files, at most $most"
    ((count <= most)) || { echo "touches $count files, expected at most $most" >"$work/reason"; return 1; }
}

# Makes a copy with the additions and builds it. Leaves the kind and the reason if one fails.
grow() # COPY KIND...
{
    local copy=$1 kind
    shift
    rm -rf "$copy" && mkdir -p "$copy"
    xargs -0 cp -a --parents -t "$copy" <"$work/files"
    mkdir -p "$copy/$objects" "$copy/build"
    for kind; do
        patch -d "$copy" -p1 --no-backup-if-mismatch <"tests/extend/$kind/change.patch" >"$work/reason" 2>&1 ||
            { failing=$kind; echo 'the patch does not apply' >>"$work/reason"; return 1; }
    done
    failing=${kinds[*]}
    (($# > 1)) || failing=$1
    nice make -C "$copy" -j"$(nproc)" BUILD="$objects" CFLAGS=-O0 all objects >"$work/reason" 2>&1 || {
        (($# == 1)) || echo 'the copy with all additions does not build; EXTEND=each tests/extend.sh builds one copy each' \
            >>"$work/reason"
        return 1
    }
}

check() # COPY KIND
{
    (cd "$1" && TRIPTYCH=$1/$objects/triptych BUILD=$1/$objects nice bash "tests/extend/$2/check.sh") >"$work/reason" 2>&1
}

report() # KIND: fails with the reason
{
    printf 'FAIL extend %s\n' "$1"
    tail -n 30 "$work/reason" >&2
    failed=1
}

failed=0 grown=
if [[ ${EXTEND-} != each ]]; then
    grow "$work/all" "${kinds[@]}" || { report "$failing"; exit 1; }
    grown=$work/all
fi
for kind in "${kinds[@]}"; do
    if count_files "$kind" && { [[ $grown ]] || grow "$work/one" "$kind"; } && check "${grown:-$work/one}" "$kind"; then
        echo "ok extend $kind: $counted"
    else
        report "$kind"
    fi
done
for folder in tests/extend/*/; do
    kind=$(basename "$folder")
    [[ ! -d $folder || " ${kinds[*]} " == *" $kind "* ]] || { echo "FAIL extend $kind: not in the list of tests/extend.sh"; failed=1; }
done
exit $failed
