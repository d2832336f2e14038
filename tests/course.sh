#!/usr/bin/env bash
# The course: the check of each lab (docs/course/README.md) passes for its solution. It fails for the starting
# files, and for each planted mistake with the words that its patch expects. A patch begins with the line
# "expected: WORDS", and is applied to the solution. A solution replaces starting files, and changes them by
# change.patch if it has one.
#
#   tests/course.sh              the labs that take seconds: those without a file `slow`, with every other
#                                mistake. Of the others, only that their patches fit
#   LABS="1 4" tests/course.sh   these; LABS=all: all of them
#
# Runs once: the labs compile programs of their own.
set -u
cd "$(dirname "$0")/.." || exit 1
[[ -z ${SLOW:-} ]] || { echo 'ok course: not in an instrumented build, whose command the labs do not need' && exit 0; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0

# Judges FOLDER by the lab's check: the status, and the words if there are any.
judge() # LAB FOLDER STATUS NAME [WORDS]
{
    local lab=$1 folder=$2 expected=$3 name=$4 words=${5-} status=0
    WORK=$work/build/$lab docs/course/lab.sh "$lab" "$folder" >"$work/log" 2>&1 || status=$?
    if ((status != expected)); then
        echo "not ok course $lab: $name: status $status, expected $expected" && tail -n 5 "$work/log"
    elif [[ -n $words ]] && ! grep -qF -- "$words" "$work/log"; then
        echo "not ok course $lab: $name: expected \"$words\" in the check's output" && tail -n 5 "$work/log"
    else
        echo "ok course $lab: $name" && return
    fi
    failed=1
}

# Applies a patch to a folder.
change() # LAB FOLDER PATCH
{
    patch -s -d "$2" -p1 <"$3" || { echo "not ok course $1: $3 does not apply" && failed=1; }
}

# Makes the starting files and the solution.
make_solution() # LAB FROM
{
    rm -rf "$work/start" "$work/solution"
    docs/course/lab.sh "$1" "$work/start" >/dev/null || { echo "not ok course $1: no starting files" && failed=1; }
    cp -r "$work/start" "$work/solution" && cp -r "$2/solution/." "$work/solution"
    [[ ! -f $2/solution/change.patch ]] || change "$1" "$work/solution" "$2/solution/change.patch"
}

# Applies the patches of a lab.
fit() # LAB FROM
{
    local lab=$1 from=$2 patch before=$failed
    failed=0
    make_solution "$lab" "$from"
    for patch in "$from"/mistakes/*.patch; do
        rm -rf "$work/mistake" && cp -r "$work/solution" "$work/mistake"
        change "$lab" "$work/mistake" "$patch"
    done
    ((failed)) || echo "ok course $lab: the patches fit"
    failed=$((failed | before))
}

lab()
{
    local lab=$1 from=$2 patch words number=0
    make_solution "$lab" "$from"
    judge "$lab" "$work/start" 1 'the starting files do not pass'
    judge "$lab" "$work/solution" 0 'the solution passes'
    for patch in "$from"/mistakes/*.patch; do
        number=$((number + 1))
        rm -rf "$work/mistake" && cp -r "$work/solution" "$work/mistake"
        words=$(sed -n '1s/^expected: //p' "$patch")
        change "$lab" "$work/mistake" "$patch"
        [[ ${LABS-} ]] || ((number % 2)) || continue
        judge "$lab" "$work/mistake" 1 "the mistake $(basename "$patch" .patch)" "${words:?$patch: expected a first line \"expected: WORDS\"}"
    done
}

for from in docs/course/[0-9][0-9]-*; do
    number=$((10#$(basename "$from" | cut -c1-2)))
    if [[ ${LABS-} == all || " ${LABS-} " == *" $number "* || (-z ${LABS-} && ! -e $from/slow) ]]; then
        lab "$number" "$from"
    elif [[ -z ${LABS-} ]]; then
        fit "$number" "$from"
    fi
done
exit $failed
