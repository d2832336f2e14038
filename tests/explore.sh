#!/bin/bash
# The pages of `triptych explore`: their structure, and their agreement with `triptych dump`, for units with
# and without shaders and for every kind of engine. `make check-explore` uses them in a browser. Given BUILD,
# TRIPTYCH and SANITIZE by tests/support/scripts/run.sh.
# Runs once.
set -uo pipefail
cd "$(dirname "$0")/.."

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

report() # NAME REASON... : an empty reason is success
{
    if [[ -z ${2-} ]]; then
        printf 'ok %s\n' "$1"
    else
        printf 'FAIL %s\n     %s\n' "$1" "$2"
        failures=1
    fi
}

check() # NAME STREAM OPTION... : makes a page and checks it
{
    local name=$1 stream=$2 said
    shift 2
    said=$("$TRIPTYCH" explore "$stream" "$@" --out "$work/page.html" 2>&1 &&
        python3 tests/explore/check.py "$work/page.html" 2>&1) && said=
    report "$name" "$said"
}

agree() # NAME ENGINE STREAM OPTION... : compares the page with the dump
{
    local name=$1 engine=$2 stream=$3 said
    shift 3
    said=$("$TRIPTYCH" explore "$stream" --engines "$engine" "$@" --out "$work/page.html" 2>&1 &&
        "$TRIPTYCH" dump "$stream" --engine "$engine" "$@" --show all >"$work/dump" 2>&1 &&
        python3 tests/explore/check.py "$work/page.html" "$engine" "$work/dump" 2>&1) && said=
    report "$name" "$said"
}

teapot=bench/streams/teapot-bilinear.tri
shaded=tests/data/shading/fractals.tri
engines() # PATTERN: the available ones whose names match
{
    "$TRIPTYCH" list engines | awk -v pattern="$1" '$1 ~ pattern && $3 == "available" { print $1 }'
}

# Instrumented builds are slow: one engine of each kind.
specializers='^specialize(-(1|4|8x2|thesis|simple))?$'
[[ -z ${SLOW-} ]] || specializers='^specialize-8$'
for engine in $(engines "$specializers"); do
    for unit in vertex setup pixel; do
        agree "the page of $engine has the programs and the code of the dump, $unit" "$engine" "$teapot" \
            --unit "$unit"
    done
    agree "also of a shader with loops, $engine" "$engine" "$shaded"
done
for engine in $(engines '^(stitch|stitch-operation|batch|batch-4|external|tiered)$'); do
    check "a page of $engine" "$teapot" --engines "$engine"
done
check 'a page of two engines' "$teapot" --engines stitch-operation,batch
check 'a page of a shader' "$shaded" --engines batch

# A path, a name and a shader that would end the element that has the data, and then run a script.
hostile="$work/</script><script>alert(1)<!--&amp;\"\\ü.tri"
mkdir -p "$(dirname "$hostile")"
cat >"$hostile" <<'STREAM'
triptych 1
target 16 16
vertices square position:float3 {
    -1  1 0
     1  1 0
     1 -1 0
    -1 -1 0
}
shader plain {
vs_2_0
dcl_position v0
mov oPos, v0
}
shader hostile {
ps_2_0
def c0, 1, 0, 0.5, 1 ; </script><script>alert(1)</script> <!-- ]]> &lt;
mov oC0, c0          ; "\u003c \\
}
state cullmode none
state zenable false
bind vertices square
vertexshader plain
pixelshader hostile
draw fan 0 2
STREAM
check 'names and shaders that are HTML stay text' "$hostile" --engines batch
grep -qF 'def c0, 1, 0, 0.5, 1 ; \u003c/script\u003e' "$work/page.html" && said= || said='the comment is not in the page'
report 'the text of a shader is the written one' "$said"

refuses() # NAME TEXT ARGUMENT... : status 2, the text on stderr, no file
{
    local name=$1 text=$2 status=0
    shift 2
    rm -f "$work/none.html"
    "$TRIPTYCH" explore "$@" --out "$work/none.html" >"$work/stdout" 2>"$work/stderr" || status=$?
    if [[ $status == 2 && ! -e $work/none.html ]] && grep -qF -- "$text" "$work/stderr"; then
        report "$name"
    else
        report "$name" "status $status: $(<"$work/stderr")"
    fi
}
refuses 'an engine that builds nothing is refused' 'engine emulate has nothing to show' "$teapot" --engines emulate
refuses 'a missing draw is refused' 'frame 0 has no draw 7' "$teapot" --draw 7 --engines batch
refuses 'a missing frame is refused' 'no frame 9' "$teapot" --frame 9 --engines batch

status=0
"$TRIPTYCH" explore "$teapot" --engines batch --out /dev/full >"$work/stdout" 2>"$work/stderr" || status=$?
[[ $status == 2 ]] && grep -q 'No space left' "$work/stderr" && said= || said="status $status: $(<"$work/stderr")"
report 'a full disk is reported' "$said"
exit $failures
