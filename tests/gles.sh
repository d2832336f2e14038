#!/usr/bin/env bash
# A program of EGL and OpenGL ES under libglvnd, started by `triptych run`: a pbuffer, and a window if Xvfb is
# installed. Also the messages of `triptych run` for such programs.
# Given BUILD, TRIPTYCH and SLOW by tests/support/scripts/run.sh.
set -uo pipefail
cd "$(dirname "$0")/.."
[[ -z ${SLOW-} ]] || { echo 'ok programs of OpenGL ES run in the plain build' && exit; }

work=$(mktemp -d)
server=
trap '[[ -z $server ]] || kill "$server"; rm -rf "$work"' EXIT
failures=0
unset TRIPTYCH_ENGINE TRIPTYCH_THREADS TRIPTYCH_RECORD

verdict() # NAME STATUS : and what was printed, if it is not 0
{
    if (($2 == 0)); then
        echo "ok $1"
    else
        echo "FAIL $1"
        cat "$work"/{said,err,diff} 2>/dev/null
        failures=1
    fi
}

# expect NAME EXPECTED ARGUMENT... : the output of `triptych run ARGUMENT...`
expect()
{
    local name=$1 expected=$2
    shift 2
    timeout 60 "$TRIPTYCH" run "$@" >"$work/said" 2>"$work/err" </dev/null
    diff <(printf '%s\n' "$expected") "$work/said" >"$work/diff" 2>&1
    verdict "$name" $?
}

# The command without a library beside it.
mkdir "$work/bare" && cp "$TRIPTYCH" "$work/bare/triptych"
"$work/bare/triptych" run /bin/sh -c 'exit 5' >"$work/said" 2>"$work/err"
[[ $? == 2 ]] && grep -q '^triptych run: OpenGL ES is not built: ' "$work/err"
verdict 'a program of Linux needs the library' $?

make BUILD="$BUILD" "$BUILD/egl/libEGL_triptych.so.0" "$BUILD/egl/10_triptych.json" >"$work/said" 2>&1
verdict 'the library is built' $?
nm -D --defined-only "$BUILD/egl/libEGL_triptych.so.0" | grep -vw A >"$work/said"
[[ $(wc -l <"$work/said") == 1 ]] && grep -qw __egl_Main "$work/said"
verdict 'the library exports one name' $?

expect 'the environment names the library and the engine' "$(realpath "$BUILD")/egl/10_triptych.json stitch 2" \
    --engine stitch --threads 2 /bin/sh -c 'echo "$__EGL_VENDOR_LIBRARY_FILENAMES $TRIPTYCH_ENGINE $TRIPTYCH_THREADS"'

gcc -std=gnu17 -O1 -Wall -Wextra -Werror tests/front/egl/program/clear.c -lEGL -lGLESv2 -lX11 -o "$work/clear" >"$work/said" 2>&1
verdict 'the program is built with the libraries of libglvnd' $?

common='vendor Triptych
version OpenGL ES 2.0
pixels ff8040 0000ff
sync 30f6'
for engine in emulate stitch; do
    expect "a pbuffer is drawn with $engine" "$common
error 3000" --engine "$engine" "$work/clear"
done

gcc -std=gnu17 -O1 -Wall -Wextra -Werror tests/front/egl/program/fixed.c -lEGL -lGLESv1_CM -o "$work/fixed" \
    >"$work/said" 2>&1
verdict 'a program of version 1.1 is built with the libraries of libglvnd' $?
for engine in emulate specialize; do
    expect "lights, a palette and a logic operation of version 1.1 with $engine" 'version OpenGL ES-CM 1.1
pixels 804000 112233 eeddcc
error 0' --engine "$engine" --gl "$work/fixed"
done

expect 'a recording has the frame' "$common
error 3000" --record "$work/frames.trib" "$work/clear"
"$TRIPTYCH" render "$work/frames.trib" --out "$work/frame.png" >"$work/said" 2>"$work/err"
verdict 'a recording can be rendered' $?

timeout 60 "$TRIPTYCH" run --record "$work/frames.trib" "$work/clear" >"$work/said" 2>"$work/err"
[[ $? == 0 && ! -s $work/err ]]
verdict 'a recording that replaces another is noticed' $?
"$TRIPTYCH" run --record "$work/none.trib" sh -c 'exit 5' >"$work/said" 2>"$work/err"
[[ $? == 5 && ! -e $work/none.trib ]] && grep -qx "triptych run: $work/none.trib: nothing was recorded, because sh has .*" "$work/err"
verdict 'a program that draws nothing records nothing, which is reported' $?
"$TRIPTYCH" run --record "$work/none.trib" sh -c 'kill -TERM $$' >"$work/said" 2>"$work/err"
[[ $? == 143 ]]
verdict 'the status tells the signal that ended a recorded program' $?
"$TRIPTYCH" run --record "$work/none.trib" sh -c 'trap "exit 9" TERM; echo ready; while :; do sleep 0.1; done' \
    >"$work/said" 2>"$work/err" &
for ((i = 0; i < 100; i++)); do [[ -s $work/said ]] && break || sleep 0.1; done
kill -TERM $! && wait $!
[[ $? == 9 ]]
verdict 'a recorded program gets the signals of its command' $?

rm -f "$work"/killed*
"$TRIPTYCH" run --record "$work/killed.trib" "$work/clear" killed >"$work/said" 2>"$work/err"
[[ $? == 137 && $(cd "$work" && echo killed*) == killed.trib ]] &&
    grep -qxE "triptych run: $work/killed.trib: the program did not end by itself; the recording has its [0-9]{4,} whole frames" "$work/err" &&
    "$TRIPTYCH" render "$work/killed.trib" --out "$work/killed.png" 2>"$work/err" && cmp "$work/frame.png" "$work/killed.png"
verdict 'the recording of a program that is killed has its whole frames' $?

# bench/gles/frames.c, by which `make programs-gles` measures programs.
gcc -std=gnu17 -O1 -Wall -Wextra -Werror -shared -fPIC bench/gles/frames.c -o "$work/frames.so" >"$work/said" 2>&1
verdict 'the library that counts frames is built' $?
FRAMES_COUNT=1 FRAMES_PICTURE=$work/frame.ppm timeout 60 "$TRIPTYCH" run --gl --engine emulate \
    env LD_PRELOAD="$work/frames.so" "$work/clear" >"$work/said" 2>"$work/err"
[[ $(tail -1 "$work/said") =~ ^@frames\ 1\ start\ [0-9.]+\ first\ 0.000\ longest\ 0.000\ total\ 0.000\ cpu\ 0.000$ ]] &&
    [[ $(head -2 "$work/frame.ppm" | tr '\n' ' ') == 'P6 40 30 ' ]] &&
    [[ $(tail -c 3600 "$work/frame.ppm" | head -c 3 | od -An -tx1) == ' ff 80 40' ]] &&
    [[ $(tail -c 3 "$work/frame.ppm" | od -An -tx1) == ' 00 00 ff' ]]
verdict 'it ends a program after a frame, and writes its picture, the top row first' $?

if command -v Xvfb >/dev/null; then
    Xvfb -displayfd 3 -screen 0 320x240x24 3>"$work/display" 2>/dev/null &
    server=$!
    for ((i = 0; i < 100; i++)); do [[ -s $work/display ]] && break || sleep 0.1; done
    DISPLAY=:$(cat "$work/display") expect 'a window shows what is drawn, and the surface follows its size' "$common
top ff8040 bottom 0000ff
regions 0 3002 age 1 1 0 3002
grown 80x60
pixels ff8040 0000ff
error 3000" --engine emulate "$work/clear" window
fi
exit "$failures"
