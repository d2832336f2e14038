#!/usr/bin/env bash
# bench/gles/conformance.py: its counts of a program that passes, fails, crashes and hangs. A script is used
# instead of the suite.
# Runs once.
# Given BUILD, TRIPTYCH and SLOW by tests/support/scripts/run.sh.
set -uo pipefail
cd "$(dirname "$0")/.."
[[ -z ${SLOW-} ]] || { echo 'ok conformance suites run in the plain build' && exit; }

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

verdict() # NAME STATUS : and what was printed, if it is not 0
{
    if (($2 == 0)); then
        echo "ok $1"
    else
        echo "FAIL $1"
        cat "$work/said" "$work"/results/conformance-*.json 2>/dev/null
        failures=1
    fi
}

run() # ARGUMENT... : the runner on that script. Gives its exit status
{
    python3 bench/gles/conformance.py --deqp "$work/deqp" --triptych "$work/triptych" --sides triptych --limit 3 \
        --results "$work/results" --work "$work/cases" "$@" >"$work/said" 2>&1
}

# The command: `run --gl --engine E --threads N PROGRAM ARGUMENT...`, and a measurement of a frame.
cat >"$work/triptych" <<'END'
#!/bin/bash
if [[ $1 == bench ]]; then
    for ((i = 1; i < $#; i++)); do [[ ${!i} != --json ]] || { i=$((i + 1)) && path=${!i}; }; done
    echo '{"streams": [{"engines": [{"lanes": "4/4/4", "instruction_set": "SSE2"}]}]}' >"$path"
else
    shift 6
    exec "$@"
fi
END

# The suite: the last word of a case's name is what happens.
mkdir -p "$work/deqp/bin" "$work/deqp/lists"
cat >"$work/deqp/bin/deqp-gles2" <<'END'
#!/bin/bash
cases=() log=/dev/null
for each in "$@"; do
    case $each in
    --deqp-caselist-file=*) mapfile -t cases <"${each#*=}" ;;
    --deqp-case=*) cases=("${each#*=}") ;;
    --deqp-log-filename=*) log=${each#*=} ;;
    esac
done
for each in "${cases[@]}"; do
    echo "Test case '$each'.."
    case ${each##*.} in
    vendor) echo '<Text>Triptych</Text>' >"$log" && echo '  Pass (Pass)' ;;
    crash) kill -SEGV $$ ;;
    hang) sleep 60 ;;
    fail) echo '  Fail (Image comparison failed)' ;;
    absent) echo '  NotSupported (No extension)' ;;
    *) echo '  Pass (Pass)' ;;
    esac
done
END
chmod +x "$work/triptych" "$work/deqp/bin/deqp-gles2"
cp -p "$work/deqp/bin/deqp-gles2" "$work/deqp/bin/deqp-egl"
cat >"$work/deqp/lists/gles2.txt" <<'END'
dEQP-GLES2.info.vendor
dEQP-GLES2.functional.fbo.first
dEQP-GLES2.functional.fbo.crash
dEQP-GLES2.functional.fbo.absent
dEQP-GLES2.functional.clipping.hang
dEQP-GLES2.functional.clipping.fail
dEQP-GLES2.functional.clipping.last
END

run
[[ $? == 1 ]] && [[ $(cut -f1,2 "$work/cases/gles2-triptych.tsv" | sed 's/dEQP-GLES2.//;s/\t/ /') == 'info.vendor Pass
functional.fbo.first Pass
functional.fbo.crash Crash
functional.fbo.absent NotSupported
functional.clipping.hang Timeout
functional.clipping.fail Fail
functional.clipping.last Pass' ]]
verdict 'a crash and a hang are results, and the cases after them run' $?
[[ $(grep ^MISSED "$work/said" | sed 's/dEQP-GLES2.functional.//') == 'MISSED fbo.crash: Crash (SIGSEGV)
MISSED clipping.hang: Timeout (no line in 3 s)
MISSED clipping.fail: Fail (Image comparison failed)' ]]
verdict 'each of them misses the threshold, and so does a failure' $?

mkdir -p "$work/pages/docs" && cp docs/opengles.md "$work/pages/docs/"
python3 bench/figures --results "$work/results" --pages "$work/pages" write >"$work/said" 2>&1
grep -qF '| `functional.clipping` | 3 | 1 | 0 | 2 |' "$work/pages/docs/opengles.md" &&
    grep -qF '| all | 7 | 3 | 1 | 3 |' "$work/pages/docs/opengles.md"
verdict 'the table has the counts of each group' $?

run 'functional.fbo.[fa]*' 'info.*'
[[ $? == 0 && $(wc -l <"$work/cases/gles2-triptych.tsv") == 3 ]]
verdict 'some of the cases are chosen, and meet the threshold' $?
sed -i 's/>Triptych</>Another</' "$work/deqp/bin/deqp-gles2"
run 'info.*'
[[ $? == 1 ]] && grep -qx "MISSED the vendor that answers is 'Another', expected Triptych" "$work/said"
verdict 'another implementation that answers is found' $?
run 'nothing.*'
[[ $? == 2 ]] && grep -q 'no case of .*lists/gles2.txt has a name like nothing' "$work/said"
verdict 'a name that no case has is refused' $?
echo 'exit 1' >"$work/deqp/bin/deqp-gles2"
run
[[ $? == 2 ]] && grep -q 'begins no case' "$work/said"
verdict 'a program that begins no case is refused' $?
cat >"$work/deqp/lists/egl.txt" <<'END'
dEQP-EGL.info.vendor
dEQP-EGL.functional.image.first
dEQP-EGL.functional.image.fail
END
run --suite egl
[[ $? == 1 && $(grep ^MISSED "$work/said") == 'MISSED dEQP-EGL.functional.image.fail: Fail (Image comparison failed)' ]] &&
    [[ $(cut -f2 "$work/cases/egl-triptych.tsv" | xargs) == 'Pass Pass Fail' && -f $work/results/conformance-egl.json ]]
verdict 'the suite of EGL has a list and a report of its own' $?
cp -p "$work/deqp/bin/deqp-egl" "$work/deqp/bin/deqp-gles2"
DEQP=$work/deqp TRIPTYCH=$work/triptych RESULTS=$work/both BUILD=$work SIDES=triptych LIMIT=3 CASES='info.* *.first' \
    bench/conformance-gles.sh >"$work/said" 2>&1
[[ $? == 0 && $(cd "$work/both" && echo *) == 'conformance-egl.json conformance-gles2.json' ]]
verdict 'both suites run by default' $?
DEQP=$work/deqp TRIPTYCH=$work/triptych RESULTS=$work/one BUILD=$work SIDES=triptych LIMIT=3 SUITE=egl \
    bench/conformance-gles.sh >"$work/said" 2>&1
[[ $? == 1 && $(cd "$work/one" && echo *) == conformance-egl.json ]]
verdict 'SUITE chooses one of them, and its threshold is the status' $?
rm "$work/deqp/bin/deqp-gles2"
run
[[ $? == 2 && $(cat "$work/said") == "conformance-gles: $work/deqp/bin/deqp-gles2: not found, expected the program" ]]
verdict 'a folder without the program is refused' $?
DEQP='' bench/conformance-gles.sh >"$work/said" 2>&1
[[ $? == 2 && $(wc -l <"$work/said") == 1 ]] && grep -q 'DEQP is not set, expected a folder' "$work/said"
verdict 'so is no folder, in one line' $?
exit "$failures"
