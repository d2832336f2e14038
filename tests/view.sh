#!/bin/bash
# `triptych view`: its pictures are those of `render` with every engine, files are read again, and the keys of
# a real window do what --keys does. Most tests use SDL's driver without a display, one uses Xvfb and xdotool.
# GOLDENS=write only writes the pictures of docs/viewer.md.
# Given BUILD, TRIPTYCH and SLOW by tests/support/scripts/run.sh.
set -uo pipefail
cd "$(dirname "$0")/.."

work=$(mktemp -d)
display= number=
trap '[[ -z $display ]] || kill "$display"; rm -rf "$work"' EXIT
failures=0
export SDL_VIDEODRIVER=dummy
# Memory that SDL and the libraries of X never free.
[[ -z ${SANITIZE-} ]] || export ASAN_OPTIONS=${ASAN_OPTIONS-}:detect_leaks=0

verdict() # NAME PROBLEM : ok when there is none
{
    if [[ -z $2 ]]; then
        printf 'ok %s\n' "$1"
    else
        printf 'FAIL %s\n     %s\n' "$1" "$2"
        sed 's/^/     stderr: /' "$work/err" | head -n 5
        failures=1
    fi
}

view() # ARGUMENT... : prints to $work/out
{
    timeout 120 "$TRIPTYCH" view "$@" >"$work/out" 2>"$work/err" </dev/null
}

hash_of() # ACTION : of the first line of this action
{
    sed -n "s/^$1: .*hash \([0-9a-f]*\).*/\1/p" "$work/out" | head -n 1
}

same() # NAME FIRST SECOND
{
    verdict "$1" "$([[ -n $2 && $2 == "$3" ]] || echo "\"$2\" and \"$3\" differ")"
}

differ() # NAME FIRST SECOND
{
    verdict "$1" "$([[ -n $2 && $2 != "$3" ]] || echo "\"$2\" and \"$3\" are the same")"
}

if [[ ${GOLDENS-} == write ]]; then
    mkdir -p docs/images/viewer
    for mode in overdraw triangles; do
        view tests/data/scenes/mirror.tri --plain --threads 1 --keys "left,left,up,tiles,$mode,shot" --shots "$work/$mode"
        mv "$work/$mode-1.png" "docs/images/viewer/$mode.png"
    done
    view tests/data/scenes/mirror.tri --threads 1 --keys help,shot --shots "$work/help"
    mv "$work/help-1.png" docs/images/viewer/help.png
    exit
fi

# --- Pictures -----------------------------------------------------------------------------------------------

scene=tests/data/streams/stencil-shadow.tri
"$TRIPTYCH" render $scene --engine emulate --out "$work/render.png"
view $scene --plain --zoom 1 --keys shot,engine,width,threads --shots "$work/shot"
"$TRIPTYCH" compare "$work/render.png" "$work/shot-1.png" >"$work/compare" 2>&1
verdict 'the window shows the picture of render' "$( (($? == 0)) || head -n 1 "$work/compare")"
same 'another engine shows the same picture' "$(hash_of begin)" "$(hash_of engine)"
same 'another number of lanes shows the same picture' "$(hash_of begin)" "$(hash_of width)"
same 'another number of threads shows the same picture' "$(hash_of begin)" "$(hash_of threads)"
differ 'the engine has changed' "$(sed -n 's/^begin: \([^,]*\),.*/\1/p' "$work/out")" \
    "$(sed -n 's/^engine: \([^,]*\),.*/\1/p' "$work/out")"

view $scene --plain --keys left,home,up,nearer,home
differ 'the camera turns' "$(hash_of begin)" "$(hash_of left)"
same 'the camera returns' "$(hash_of begin)" "$(hash_of home)"

view $scene --plain --keys previous_draw,next_draw,previous_draw,all_draws
differ 'one draw less is another picture' "$(hash_of begin)" "$(hash_of previous_draw)"
same 'all draws are the first picture' "$(hash_of begin)" "$(hash_of all_draws)"
verdict 'the draw is named' "$(grep -q 'previous_draw: .* up to draw 2 of 4' "$work/out" || head -n 2 "$work/out")"

view tests/data/streams/frames.tri --plain --keys next_frame,previous_frame
differ 'the next frame is another picture' "$(hash_of begin)" "$(hash_of next_frame)"
same 'the previous frame is the first picture' "$(hash_of begin)" "$(hash_of previous_frame)"

view $scene --plain --zoom 1 --keys overdraw,shot --shots "$work/heat"
"$TRIPTYCH" inspect $scene --overdraw "$work/inspect.png" >/dev/null
"$TRIPTYCH" compare "$work/inspect.png" "$work/heat-1.png" >"$work/compare" 2>&1
verdict 'overdraw is that of inspect' "$( (($? == 0)) || head -n 1 "$work/compare")"
view $scene --plain --keys triangles,triangles,tiles,tiles,text,text,help,help
differ 'triangles are shown' "$(hash_of begin)" "$(hash_of triangles)"
differ 'tiles are shown' "$(hash_of begin)" "$(hash_of tiles)"
differ 'text is shown' "$(hash_of begin)" "$(hash_of text)"
same 'everything can be hidden again' "$(hash_of begin)" "$(tail -n 1 "$work/out" | sed 's/.*hash \([0-9a-f]*\).*/\1/')"

# --- Files that change --------------------------------------------------------------------------------------

cat >"$work/shader.psh" <<'END'
ps_2_0
def c0, 1, 0, 0, 1
mov oC0, c0
END
cat >"$work/live.tri" <<'END'
triptych 1
target 64 48
shader red "shader.psh"
vertices v position:float3 {
    -1 -1 0.5
    -1 1 0.5
    1 -1 0.5
}
pixelshader red
bind vertices v
clear color 0 0 0 1
draw triangles 0 1
END

# Waits in the middle of a list of keys: the first line of output is the sign to change the file.
changes() # FILE TEXT : views $work/live.tri, replaces the file's text meanwhile
{
    : >"$work/out" # the loop below must not find the lines of an earlier call
    timeout 60 "$TRIPTYCH" view "$work/live.tri" --plain --keys wait,wait,wait,wait,wait,wait >"$work/out" 2>"$work/err" </dev/null &
    local pid=$!
    for ((i = 0; i < 200; i++)); do
        grep -q '^wait' "$work/out" && break
        sleep 0.05
    done
    printf '%s\n' "$2" >"$work/new" && mv "$work/new" "$1"
    wait "$pid"
}

last_hash()
{
    tail -n 1 "$work/out" | sed 's/.*hash \([0-9a-f]*\).*/\1/'
}

changes "$work/shader.psh" $'ps_2_0\ndef c0, 0, 1, 0, 1\nmov oC0, c0'
differ 'a shader that changes is read again' "$(hash_of begin)" "$(last_hash)"
verdict 'it is reported' "$(grep -q 'read again' "$work/out" || echo 'no line has it')"
changes "$work/shader.psh" $'ps_2_0\nmovv oC0, c0'
same 'a wrong shader keeps the picture' "$(hash_of begin)" "$(hash_of wait)"
verdict 'a wrong shader shows its line' "$(tail -n 1 "$work/out" | grep -q "shader.psh:2:1: found 'movv'" || tail -n 1 "$work/out")"
echo 'triptych 2' >"$work/wrong.tri"

# --- A real window ------------------------------------------------------------------------------------------

key() # KEY... : to the window that has the focus
{
    for k; do xdotool key "$k" && sleep 0.2; done
}

wait_for() # FILE
{
    for ((i = 0; i < 300; i++)); do
        [[ -s $1 ]] && return
        sleep 0.05
    done
    echo "no $1"
}

# Focuses the viewer's window. SDL may make its window anew for its renderer, so it is the one that two
# searches find and that has the focus afterwards.
focus() # sets window
{
    local before=
    for ((i = 0; i < 100; i++)); do
        window=$(xdotool search --onlyvisible --name stencil-shadow 2>/dev/null | head -n 1)
        if [[ -n $window && $window == "$before" ]] && timeout 5 xdotool windowfocus --sync "$window" 2>/dev/null &&
            [[ $(xdotool getwindowfocus 2>/dev/null) == "$window" ]]; then
            return
        fi
        before=$window
        sleep 0.5
    done
}

real_window()
{
    local -x DISPLAY=:$number SDL_VIDEODRIVER=x11
    local window viewer
    "$TRIPTYCH" view $scene --plain --zoom 1 --shots "$work/window" >"$work/out" 2>"$work/err" &
    viewer=$!
    focus
    key s
    verdict 'a key saves a picture' "$(wait_for "$work/window-1.png")"
    "$TRIPTYCH" compare "$work/render.png" "$work/window-1.png" >"$work/compare" 2>&1
    verdict 'it is the picture of render' "$( (($? == 0)) || head -n 1 "$work/compare")"
    key e Left s
    verdict 'other keys work' "$(wait_for "$work/window-2.png")"
    "$TRIPTYCH" compare "$work/render.png" "$work/window-2.png" >"$work/compare" 2>&1
    verdict 'the camera has turned' "$( (($? == 1)) || echo 'the same picture')"
    key Home s
    wait_for "$work/window-3.png" >/dev/null
    xdotool mousemove --window "$window" 100 100 mousedown 1 mousemove --window "$window" 140 100 mouseup 1
    key s
    verdict 'the mouse works' "$(wait_for "$work/window-4.png")"
    "$TRIPTYCH" compare "$work/window-3.png" "$work/window-4.png" >"$work/compare" 2>&1
    verdict 'the mouse turns the camera' "$( (($? == 1)) || echo 'the same picture')"
    kill -STOP "$viewer"
    key Home s
    kill -CONT "$viewer"
    wait_for "$work/window-5.png" >/dev/null
    "$TRIPTYCH" compare "$work/window-3.png" "$work/window-5.png" >"$work/compare" 2>&1
    verdict 'a picture contains the effect of keys that came with its own' "$( (($? == 0)) || head -n 1 "$work/compare")"
    key q
    wait "$viewer"
    verdict 'a key quits' "$( (($? == 0)) || echo "exit status $?")"
}

mkfifo "$work/number"
Xvfb -displayfd 3 -screen 0 1024x768x24 3>"$work/number" >"$work/xvfb" 2>&1 &
display=$!
read -r -t 30 number <"$work/number"
if [[ -n $number ]]; then
    real_window
else
    verdict 'a display' "Xvfb: $(tail -n 1 "$work/xvfb")"
fi

# --- Refusals -----------------------------------------------------------------------------------------------

refuses() # NAME PATTERN ARGUMENT...
{
    local name=$1 pattern=$2 status=0 problem=
    shift 2
    view "$@" || status=$?
    if ((status != 2)); then
        problem="exit status $status, expected 2"
    elif (($(wc -l <"$work/err") != 1)) || ! grep -qE -- "$pattern" "$work/err"; then
        problem="stderr is \"$(cat "$work/err")\", expected a line with \"$pattern\""
    fi
    verdict "$name" "$problem"
}

refuses 'an unknown key' '--keys has "spin", expected one of: engine, ' $scene --keys spin
refuses 'no such frame' 'has no frame 7, its last is 0' $scene --frame 7
refuses 'no such stream' 'missing.tri: cannot' "$work/missing.tri"
refuses 'a stream that is wrong' 'wrong.tri:1:' "$work/wrong.tri"
SDL_VIDEODRIVER= DISPLAY= WAYLAND_DISPLAY= XDG_RUNTIME_DIR= refuses 'a window where no display is named' \
    '^triptych view: no display for a window, expected DISPLAY or WAYLAND_DISPLAY, or --keys$' $scene
refuses 'a window without a display' 'no display for a window' $scene
SDL_VIDEODRIVER=none refuses 'no display' 'SDL cannot open a display' $scene --keys wait
: >"$work/libSDL2-2.0.so.0"
LD_LIBRARY_PATH=$work refuses 'no SDL' 'libSDL2-2.0.so.0 cannot be loaded, expected SDL 2 \(the Debian package libsdl2-2.0-0\)' \
    $scene --keys wait
exit "$failures"
