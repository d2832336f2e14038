#!/bin/bash
# A campaign in shards is that of one run: a shard is killed and continued, and the merged results are
# compared byte for byte. Given BUILD, TRIPTYCH and SLOW by tests/support/scripts/run.sh.
# Runs once.
set -uo pipefail
cd "$(dirname "$0")/.."

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

verdict() # NAME PROBLEM : ok when there is none
{
    if [[ -z $2 ]]; then
        printf 'ok %s\n' "$1"
    else
        printf 'FAIL %s: %s\n' "$1" "$2"
        sed 's/^/     /' "$work/said" | head -n 5
        failures=1
    fi
}

# The command ends with the status, and prints a line that matches the pattern.
expect() # NAME STATUS PATTERN ARGUMENT...
{
    local name=$1 expected=$2 pattern=$3 status=0 problem=
    shift 3
    timeout 300 "$TRIPTYCH" "$@" >"$work/said" 2>&1 </dev/null || status=$?
    if ((status != expected)); then
        problem="exit status $status, expected $expected"
    elif [[ $pattern ]] && ! grep -qE -- "$pattern" "$work/said"; then
        problem="no \"$pattern\""
    fi
    verdict "$name" "$problem"
}

same() # NAME FILE FILE
{
    verdict "$1" "$(cmp "$2" "$3" 2>&1)"
}

field() # NAME FILE : a number or a text of the JSON
{
    sed -nE "s/^\t\"$1\":\t\"?([^\",]*)\"?,?$/\1/p" "$2"
}

# --- Random cases ------------------------------------------------------------------------------------------

fuzz=(fuzz --seed 11 --first 100 --count 40 --output "$work/findings")
expect 'one run draws 40 cases' 0 '^40 cases' "${fuzz[@]}" --json "$work/one.json"
for i in 1 2 4; do
    expect "shard $i of 4 draws 10" 0 '^10 cases' "${fuzz[@]}" --shard "$i/4" --resume "$work/part-$i.json"
done

# The third is killed when it has reported its first cases. A fast machine may complete it before: try again.
part=$work/part-3.json
for attempt in 1 2 3 4 5 6 7 8; do
    rm -f "$part"
    "$TRIPTYCH" "${fuzz[@]}" --shard 3/4 --resume "$part" --checkpoint 0 >"$work/said" 2>&1 </dev/null &
    shard=$!
    while [[ ! -e $part ]] && kill -0 "$shard" 2>/dev/null; do sleep 0.01; done
    kill -KILL "$shard" 2>/dev/null
    wait "$shard" 2>/dev/null
    [[ -e $part && $(field interrupted "$part") == true ]] && break
done
drawn=$(field cases "$part")
verdict 'a killed shard has reported some of its cases' \
    "$( ((drawn > 0 && drawn < 10)) || echo "$drawn cases, expected 1 to 9")"
expect 'its other cases are missing' 1 '^missing: cases? 1[2-3][0-9]' merge "$work/merged.json" "$work"/part-[1234].json
expect 'it is continued' 0 '^10 cases' "${fuzz[@]}" --shard 3/4 --resume "$part"
expect 'a complete shard draws nothing' 0 '^10 cases' "${fuzz[@]}" --shard 3/4 --resume "$part"

expect 'the shards are merged' 0 '40 of 40 units' merge --canonical "$work/merged.json" "$work"/part-{3,1,4,2}.json
expect 'so is the one run' 0 '40 of 40 units' merge --canonical "$work/whole.json" "$work/one.json"
same 'the normal forms are equal byte for byte' "$work/merged.json" "$work/whole.json"
expect 'a shard that is there twice' 1 '^twice: cases 110-119$' merge "$work/twice.json" "$work"/part-{1,2,2,3,4}.json
verdict 'of which nothing is written' "$([[ ! -e $work/twice.json ]] || echo written)"
expect 'another shard is not continued' 2 'shard is "3/4", expected "2/4"' "${fuzz[@]}" --shard 2/4 --resume "$part"
expect 'nor another campaign' 2 'seed is 11, expected 12' fuzz --seed 12 "${fuzz[@]:3}" --shard 3/4 --resume "$part"
expect 'standard streams' 0 '"cases":.40,' merge - "$work/merged.json"

# --- Shards by the environment -----------------------------------------------------------------------------

expect 'auto without a launcher' 2 'SLURM_ARRAY_TASK_ID' "${fuzz[@]}" --shard auto
SLURM_ARRAY_TASK_ID=2 SLURM_ARRAY_TASK_MIN=1 SLURM_ARRAY_TASK_MAX=4 SLURM_ARRAY_TASK_COUNT=4 \
    expect 'auto as task of an array' 0 '^10 cases' "${fuzz[@]}" --shard auto --json "$work/auto.json"
verdict 'is its part' "$([[ $(field done "$work/auto.json") == 110-119 ]] || field done "$work/auto.json")"

# --- Verification and measurement --------------------------------------------------------------------------

streams=(tests/data/streams/{frames,lines,queries}.tri)
verify=(verify "${streams[@]}" --engines emulate,batch,stitch --frames 2)
expect 'one run verifies' 0 '^3 streams, 3 engines, identical' "${verify[@]}" --json "$work/one.json"
for i in 1 2 3 4; do
    expect "shard $i of 4 verifies" 0 'engines, identical' "${verify[@]}" --shard "$i/4" --resume "$work/verify-$i.json"
done
expect 'its shards are merged' 0 '9 of 9 units' merge --canonical "$work/merged.json" "$work"/verify-{4,3,2,1}.json
expect 'and the one run' 0 '9 of 9 units' merge --canonical "$work/whole.json" "$work/one.json"
same 'the verifications are equal' "$work/merged.json" "$work/whole.json"
expect 'a missing shard of them' 1 '^missing: stream tests/data/streams/lines.tri with batch, stitch$' \
    merge "$work/gap.json" "$work"/verify-{1,2,4}.json

bench=(bench "${streams[@]}" --engines emulate,batch --frames 1 --repetitions 3 --seconds 1)
expect 'one run measures' 0 '' "${bench[@]}" --json "$work/one.json"
for i in 1 2; do
    expect "shard $i of 2 measures" 0 '' "${bench[@]}" --shard "$i/2" --resume "$work/bench-$i.json"
done
expect 'its measurements are merged' 0 '3 of 3 units' merge --canonical "$work/merged.json" "$work"/bench-{2,1}.json
expect 'and those of the one run' 0 '3 of 3 units' merge --canonical "$work/whole.json" "$work/one.json"
same 'the measurements are of the same work' "$work/merged.json" "$work/whole.json"
expect 'merged measurements have the builds' 0 '3 of 3 units' merge "$work/merged.json" "$work"/bench-{2,1}.json
verdict 'of all streams' "$(grep -q '"code_bytes":.{' "$work/merged.json" || echo none)"
expect 'results of other commands are not merged' 2 'command is' merge "$work/gap.json" "$work/bench-1.json" "$work/verify-1.json"
expect 'a summary of all streams is not for a shard' 2 'csv and --shard' "${bench[@]}" --shard 1/2 --csv "$work/a.csv"

# --- Animations ------------------------------------------------------------------------------------------

render=(render tests/data/streams/queries.tri --engine emulate --frames all)
mkdir "$work/one" "$work/parts"
expect 'one run renders' 0 '' "${render[@]}" --out "$work/one/%d.png"
for i in 1 2 3; do
    expect "shard $i of 3 renders" 0 '' "${render[@]}" --out "$work/parts/%d.png" --shard "$i/3"
done
verdict 'the pictures are the same' "$(diff -r "$work/one" "$work/parts" 2>&1)"
expect 'a shard of an animation in one file' 2 'a file for each picture' "${render[@]}" --out "$work/a.apng" --shard 1/3

exit "$failures"
