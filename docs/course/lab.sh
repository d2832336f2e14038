#!/bin/bash
# One lab of the course, for `make lab N`:
#
#   docs/course/lab.sh N [FOLDER]
#
# Without FOLDER it is labs/NN-NAME. If the folder does not exist, it is made with the starting files, and
# that is all: those of start/, and copies of the project's files that the lab's file `sources` names, changed
# by start.patch. Otherwise the lab's check judges its files. Status: 0 the check passes, or the folder was
# made; 1 a step of the check fails; 2 no such lab. The check builds in WORK, by default build/labs/NN-NAME.
set -euo pipefail
course=$(cd "$(dirname "$0")" && pwd)
number=${1-}
labs=("$course"/[0-9][0-9]-*)
last=$(basename "${labs[-1]}" | cut -c1-2)

[[ $number =~ ^[0-9]{1,2}$ ]] && lab=$(printf '%s\n' "${labs[@]}" | grep "/$(printf %02d "$((10#$number))")-") || {
    echo "lab ${number:-without a number}: expected the number of a lab, at most $last: make lab 1" >&2
    exit 2
}

export ROOT=${course%/docs/course} COURSE=$course GIVEN=$lab/given CC=${CC:-cc}
BUILD=${BUILD:-build}
[[ $BUILD == /* ]] || BUILD=$ROOT/$BUILD
export BUILD TRIPTYCH=$BUILD/triptych
folder=$(realpath -m "${2:-$ROOT/labs/$(basename "$lab")}")
page=${lab#"$ROOT"/}/README.md

if [[ ! -e $folder ]]; then
    mkdir -p "$(dirname "$folder")"
    cp -r "$lab/start" "$folder"
    [[ ! -f $lab/sources ]] || (cd "$ROOT" && xargs cp --parents -t "$folder" <"$lab/sources")
    [[ ! -f $lab/start.patch ]] || patch -s -p1 -d "$folder" <"$lab/start.patch"
    echo "$folder has the starting files. Follow $page, then run this command again."
    exit 0
fi

export WORK=${WORK:-$BUILD/labs/$(basename "$lab")}
mkdir -p "$WORK"
cd "$folder"
exec bash "$lab/check.bash"
