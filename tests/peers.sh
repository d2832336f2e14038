#!/bin/bash
# The comparison of renderers (`make peers`) finds a wrong picture, a renderer that fails and one that is
# missing, and measures two engines on a few workloads without EGL.
# Given BUILD by tests/support/scripts/run.sh.
# Runs once.
set -uo pipefail
cd "$(dirname "$0")/.."

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

check() # NAME CONDITION...
{
    local name=$1
    shift
    if "$@"; then
        printf 'ok %s\n' "$name"
    else
        printf 'FAIL %s\n%s\n' "$name" "$(head -n 60 "$work/output")"
        failures=1
    fi
}

# A renderer that answers as bench/peers/peer.h defines, with a picture of one byte, or with an error to the
# command $2.
cat >"$work/fake" <<'FAKE'
#!/bin/bash
while read -r word first second; do
    [[ $word != "${2-}" ]] || { echo "error cannot $word" && continue; }
    case $word in
        hello) echo "ok fake" ;;
        open) echo "ok 1 1 1 -1" ;;
        measure) echo "ok 2 2" ;;
        image) head -c 4194304 /dev/zero | tr '\0' "$1" >"$second" && echo ok ;;
        *) echo ok ;;
    esac
done
FAKE
chmod +x "$work/fake"

drive() # WORKLOAD RENDERER... : the status of the driver
{
    local workload=$1
    shift
    printf '%s\n' "$@" | "$BUILD/peers/drive" --workload "$workload" --passes 2 --seconds 0.001 --budget 0 \
        --folder "$work" --text "$work/text" --json "$work/json" --csv "$work/csv" >"$work/output" 2>&1
}

engines=$("$BUILD/triptych" list engines | awk \
    '$1 ~ /^(emulate|specialize)$/ && $3 == "available" { print $1 }')
lines=()
for engine in $engines; do
    lines+=("$engine engine one $BUILD/peers/triptych $engine 1 bench/streams/micro")
done

drive new-shader "${lines[@]}" 'other peer one missing not installed'
check 'engines agree, and what is missing is told' \
    test "$? $(grep -c 'MISSING: not installed' "$work/output") $(grep -c ' 0 different, 0 failed' "$work/output")" = '0 1 1'
check 'the table is a file too' cmp -s "$work/output" "$work/text"
check 'every renderer has a value in the JSON' \
    test "$(grep -c '"value":' "$work/json")" = "${#lines[@]}"

check 'engines have lanes and an instruction set in the JSON' \
    test "$(grep -c '"instruction_set":' "$work/json")" = "${#lines[@]}"

drive 'flat*' "${lines[@]}" "llvmpipe peer one $work/fake \\377"
groups=$(python3 -c 'import json, sys
means = json.load(open(sys.argv[1]))["geometric_means"]
print(*sorted({(mean["group"], mean["workloads"]) for mean in means}))' "$work/json")
check 'hidden layers are in no mean but their own' \
    test "$groups" = "('core', 2) ('hidden', 1)"

drive page-text "llvmpipe peer one $work/fake \\377"
check 'pages are a group' grep -q '"group":.*"page"' "$work/json"

drive 'c[l]ear' "${lines[@]}" "fake peer one $work/fake \\377"
check 'a wrong picture fails the run' \
    test "$? $(grep -c '^DIFFERENT: fake draws clear' "$work/output")" = '1 1'

drive clear "one peer one $work/fake \\001" "two peer one $work/fake \\003"
check 'a picture that is near does not' test "$? $(grep -c '1 identical, 1 similar' "$work/output")" = '0 1'

drive clear "${lines[@]}" "fake peer one $work/fake \\001 measure"
check 'a renderer that fails fails the run' \
    test "$? $(grep -c '^FAILED: fake, clear: cannot measure' "$work/output")" = '1 1'

sed 's/ok 1 1 1 -1/ok none/' "$work/fake" >"$work/absent"
chmod +x "$work/absent"
drive clear "${lines[@]}" "absent special one $work/absent \\001"
check 'a renderer that has no part in a workload does not' \
    test "$? $(grep -c ' 0 different, 0 failed' "$work/output")" = '0 1'

drive clear "${lines[@]}" 'fake peer one /nonexistent/renderer'
check 'a renderer that does not start fails the run' \
    test "$? $(grep -c 'MISSING: the process ended' "$work/output")" = '1 1'

# A frame that scrolls by some pixels moves the rows that stay, and shades about as much a pixel of the strip
# as the last frame does a pixel of the page.
"$BUILD/peers/scroll" --check >"$work/output"
check 'a scrolled frame shades the pixels of what appears' awk '
    BEGIN { split("4 16 40 64 128 320", step); side = 1024; bar = 56 }
    $1 >= 1 && $1 <= 6 {
        strip = side * step[$1]
        good += $2 >= strip && $2 <= 1.4 * strip && $3 == side * (side - bar) - strip
    }
    $1 == 7 { good += $2 >= side * side && $2 <= 1.4 * side * side && $3 == 0 }
    END { exit good != 7 }' "$work/output"

drive nothing "${lines[@]}"
check 'a workload that there is not is an error' test "$? $(wc -l <"$work/output")" = '2 1'
exit $failures
