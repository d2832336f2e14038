#!/bin/bash
# The laboratory of bench/claims: its registry is complete, errors are one line, experiments run, fail, stop
# and resume, and the report has everything.
# Given TRIPTYCH and SANITIZE by tests/support/scripts/run.sh.
set -uo pipefail
cd "$(dirname "$0")/.." || exit 1
[[ -z ${SANITIZE-} ]] || { echo 'ok the claims are tested by the plain build' && exit; }

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0

check() # NAME COMMAND...
{
    local name=$1
    shift
    if "$@" >"$work/output" 2>&1; then
        echo "ok $name"
    else
        echo "FAIL $name"
        head -n 40 "$work/output" >&2
        failed=1
    fi
}

claims() # ARGUMENT...: the laboratory with the registry of the test
{
    python3 bench/claims --triptych "$TRIPTYCH" --registry "$work/registry" --results "$work/results" "$@"
}

registry() # writes the registry of the test: standard input, after a good beginning
{
    rm -rf "$work/registry" "$work/results"
    mkdir -p "$work/registry/figures"
    cat - >"$work/registry/test.claims"
}

beginning='chapter test
title A test
source nowhere

experiment one
about Counts to three.
takes 1
run numbers: echo "{\"n\": 3, \"runs\": [1, 2, 3], \"names\": [{\"name\": \"a\", \"x\": 1}, {\"name\": \"b\", \"x\": 2}]}"
'
claim='
claim C1
source 1.1
kind speed
words Three is more than two.
value n - = {one.numbers: n}
holds n > 2
part n > 1
reasons It is.
'

refused() # TEXT STATUS ARGUMENT...: one line on stderr with the text, and this status
{
    local text=$1 expected=$2 status=0
    shift 2
    claims "$@" >"$work/said" 2>"$work/errors" || status=$?
    cat "$work/errors"
    ((status == expected)) && [[ $(wc -l <"$work/errors") == 1 && ! -s $work/said ]] && grep -qF -- "$text" "$work/errors"
}

wrong() # NAME TEXT: the registry of the test on standard input is refused with the text
{
    registry
    check "$1 is refused" refused "$2" 2 --check
}

# --- The registry of the project ----------------------------------------------------------------------------

check 'the registry is valid' "$TRIPTYCH" claims --check
# The reader has ended when the list is written.
{ sleep 0.5 && "$TRIPTYCH" claims --list 2>"$work/piped"; } | true
check 'a reader that ends early is no error' test ! -s "$work/piped"
all=$("$TRIPTYCH" claims --list | awk '{ print $1 }')
expected=$(printf '%s\n' C{1..176} S{1..17} R{1..23} G{1..10})
check 'every claim of the four texts is in the registry once' diff <(echo "$all") <(echo "$expected")
check 'all experiments take at most an hour' test "$(awk '$1 == "takes" { sum += $2 } END { print sum + 0 }' bench/claims/*.claims)" -le 3600
check 'an unknown claim is refused' bash -c '! "$1" claims --only C1,C999 2>"$2" && [[ $(wc -l <"$2") == 1 ]] && grep -q "no claim C999" "$2"' \
    - "$TRIPTYCH" "$work/errors"
"$TRIPTYCH" claims --only C999 2>/dev/null
check 'and the status is 2' test $? = 2

# --- Formats ------------------------------------------------------------------------------------------------

wrong 'a field that is unknown' "test.claims:12: 'colour' is unknown here" <<<"$beginning${claim/kind/colour}"
wrong 'a claim without words' 'claim C1: there is no field words' <<<"$beginning${claim/words Three is more than two./}"
wrong 'a kind that is unknown' "kind is 'spree'" <<<"$beginning${claim/kind speed/kind spree}"
wrong 'a claim that is there twice' 'claim C1: it is there twice' <<<"$beginning$claim$claim"
wrong 'an output that is unknown' 'no experiment has the output one.letters' <<<"$beginning${claim/one.numbers/one.letters}"
wrong 'a value without an expression' "the value 'n -' is not" <<<"$beginning${claim/ = \{one.numbers: n\}/}"
wrong 'an expression with an error' 'error of syntax' <<<"$beginning${claim/\{one.numbers: n\}/\{one.numbers: n\} +}"
wrong 'a rule of an unknown value' 'no value has the name m' <<<"$beginning${claim/holds n/holds m}"
wrong 'a rule that cannot fail' "the rule 'n >= 0' cannot fail" <<<"$beginning${claim/part n > 1/part n >= 0}"
wrong 'a rule that cannot be true' 'cannot be true' <<<"$beginning${claim/holds n > 2/holds n < 0}"
wrong 'a claim with a rule and a reason not to test it' 'expected one of the fields' <<<"$beginning${claim}cannot It is late."
wrong 'a claim without reasons' 'no field reasons' <<<"$beginning${claim/reasons It is./}"
wrong 'a figure that is unknown' 'there is no figure f' <<<"$beginning${claim}shows f"
wrong 'a figure with columns and pictures' 'expected columns' <<<"$beginning${claim}shows f
figure f
title F
column n = {one.numbers: n}
image F = {one.numbers}"
wrong 'an experiment without use' 'no claim and no figure uses it' <<<"$beginning"
wrong 'a run without a name' "the run 'true' is not NAME: COMMAND" <<<"${beginning/run numbers: echo*/run true}$claim"
wrong 'a file without records' 'expected one of chapter, experiment' <<<"hello"
wrong 'a claim before the first chapter' 'it is in no chapter' <<<"$claim"

# --- Runs ---------------------------------------------------------------------------------------------------

verdict_is() # ID VERDICT: in claims.json
{
    python3 -c 'import json, sys
found = [each["verdict"] for each in json.load(open(sys.argv[1]))["claims"] if each["id"] == sys.argv[2]]
print(found)
sys.exit(found != [sys.argv[3]])' "$work/results/claims.json" "$1" "$2"
}

registry <<<"$beginning$claim
claim C2
source 1.2
kind speed
words Three is more than four, or at least more than two.
value n - = {one.numbers: n}
holds n > 4
part n > 2
reasons It is in between.
shows bars
shows rows
shows square

claim C3
source 1.3
kind speed
words Three is less than three.
value n - = {one.numbers: n}
holds n < 3
reasons It is not.

claim C4
source 1.4
kind qual
words Nothing is measured.
cannot There is nothing to measure.

claim C5
source 1.5
kind qual
words It will be measured.
needs a clock.

figure bars
title Two bars.
plot bars
column name = {one.numbers: names[*].name}
column x = {one.numbers: names[*].x}

figure rows
title A table of means.
column name = names(list(\"a\", \"b\", \"a\"))
column mean = geomeans(list(\"a\", \"b\", \"a\"), list(2, 5, 8))

figure square
title A picture.
image a square = {square.svg}

experiment square
about Writes a picture.
takes 1
run svg: echo \"<svg xmlns='http://www.w3.org/2000/svg'/>\"
"
cat >"$work/registry/figures/bars.gnuplot" <<'GNUPLOT'
set terminal svg
set output ARG2
set datafile separator comma
set yrange [0:*]
plot ARG1 skip 1 using 0:2 with boxes notitle
GNUPLOT
check 'a run has status 0' claims
check 'a rule that is true holds' verdict_is C1 holds
check 'a weaker rule that is true holds in part' verdict_is C2 'holds in part'
check 'a rule that is false does not hold' verdict_is C3 'does not hold'
check 'a claim without means cannot be tested' verdict_is C4 'cannot be tested here'
check 'a claim that needs something is not yet tested' verdict_is C5 'not yet'
check 'the report has every claim' test "$(grep -o '<article class="claim[^>]*>' "$work/results/report/index.html" | wc -l)" = 5
check 'the report contains the figure' grep -q '<figure id="figure-bars"><svg' "$work/results/report/index.html"
check 'the report contains the table' grep -q '<tr><td>a</td><td class="number">4</td></tr>' "$work/results/report/index.html"
check 'the report contains the picture' grep -q 'src="data:image/svg+xml;base64,' "$work/results/report/index.html"
check 'the report needs no other file' bash -c '! grep -oE "(src|href)=\"(https?:|[^#\"]*\.(css|js|svg|png))[^\"]*\"" "$1"' - "$work/results/report/index.html"
check 'the data of a figure is beside it' diff <(printf 'name,x\na,1\nb,2\n') "$work/results/report/bars.csv"

before=$(stat -c %y.%i "$work/results/claims/one/run.json")
claims --resume >/dev/null 2>&1
check 'a resumed run keeps outputs' test "$before" = "$(stat -c %y.%i "$work/results/claims/one/run.json")"
claims >/dev/null 2>&1
check 'a new run does not' test "$before" != "$(stat -c %y.%i "$work/results/claims/one/run.json")"
age() # writes the output of experiment one as if another commit had made it
{
    PYTHONPATH=bench/claims python3 -c 'import experiment, json, sys
path = sys.argv[1]
report = json.load(open(path))
report["machine"]["commit"] = "0000000"
report["digest"] = experiment.Machine(sys.argv[2]).digest(report["commands"], "0000000")
experiment.write_json(path, report)' "$work/results/claims/one/run.json" "$TRIPTYCH"
    before=$(stat -c %y.%i "$work/results/claims/one/run.json")
}
age
claims --older >/dev/null 2>&1
check 'outputs of an older commit are kept if that is requested' test "$before" = "$(stat -c %y.%i "$work/results/claims/one/run.json")"
check 'the report names their commit' grep -q 'commit 0000000' "$work/results/report/index.html"
claims --resume >/dev/null 2>&1
check 'but not by a resumed run' test "$before" != "$(stat -c %y.%i "$work/results/claims/one/run.json")"
rm "$work/results/claims/one/run.json"
claims --resume >/dev/null 2>&1
check 'an experiment that did not end is run again' test -s "$work/results/claims/one/run.json"
sed -i 's/"n": 3\|\\"n\\": 3/\\"n\\": 5/' "$work/registry/test.claims"
claims --resume >/dev/null 2>&1
check 'and so is one whose command has changed' verdict_is C2 holds
rm -rf "$work/results"
check 'some claims write no report' bash -c '! [[ -e $1/report || -e $1/claims.json ]]' - "$work/results"
check 'the verdicts are printed as JSON' bash -c '"$@" 2>/dev/null | python3 -c "import json, sys; json.load(sys.stdin)"' - \
    python3 bench/claims --triptych "$TRIPTYCH" --registry "$work/registry" --results "$work/results" --only C1 --json

fails() # the run has status 1, and C1 has no verdict
{
    local status=0
    claims || status=$?
    ((status == 1)) && verdict_is C1 'no verdict'
}

registry <<<"${beginning/echo/exit 3; echo}$claim"
check 'a failing experiment leaves no verdict' fails
registry <<<"${beginning/echo/echo hello; true}$claim"
check 'an output without the value leaves no verdict' fails
registry <<<"$beginning${claim/\{one.numbers: n\}/\{one.numbers: n\} \/ 0}"
check 'a division by zero leaves no verdict' fails

# A real experiment, from the command to the verdict.
registry <<<"chapter test
title A test
source nowhere

experiment picture
about All engines draw one small stream.
takes 2
run verify: triptych verify tests/data/streams/quads.tri --frames 1 --threads 1 --json \"\$OUT\"

claim S15
source 1
kind speed
words All engines draw the same.
value same - 0..1 = least({picture.verify: streams[*].identical})
value engines - = count({picture.verify: engines[*].engine})
holds same == 1 and engines >= 2
reasons They do.
"
check 'an experiment runs the command' claims
check 'and has a verdict' verdict_is S15 holds

# --- Units --------------------------------------------------------------------------------------------------

python3 tests/claims/unit.py || failed=1
exit $failed
