#!/bin/bash
# The behaviour of the command: its messages for bad input and usage, and the files that it writes.
# Given BUILD, TRIPTYCH and SANITIZE by tests/support/scripts/run.sh.
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
        printf 'FAIL %s\n     %s\n' "$1" "$2"
        sed 's/^/     stderr: /' "$work/err" | head -n 5
        failures=1
    fi
}

# Bad input or usage: exit status 2, nothing on stdout, one line on stderr that matches the pattern, and no
# new file.
refuses() # NAME PATTERN ARGUMENT...
{
    local name=$1 pattern=$2 status=0 problem=
    shift 2
    rm -rf "$work/out" && mkdir "$work/out"
    timeout 60 "$TRIPTYCH" "$@" >"$work/said" 2>"$work/err" </dev/null || status=$?
    if ((status != 2)); then
        problem="exit status $status, expected 2"
    elif (($(wc -l <"$work/err") != 1)); then
        problem="$(wc -l <"$work/err") lines on stderr, expected 1"
    elif ! grep -qE -- "$pattern" "$work/err"; then
        problem="stderr without \"$pattern\""
    elif grep -qE 'runtime error|AddressSanitizer' "$work/err"; then
        problem='a sanitizer complained'
    elif [[ -s $work/said ]]; then
        problem='something on stdout'
    elif [[ $(ls -A "$work/out") ]]; then
        problem="left behind: $(ls -A "$work/out")"
    fi
    verdict "$name" "$problem"
}

# Good usage: exit status 0, nothing on stderr, stdout matches the pattern.
answers() # NAME PATTERN ARGUMENT...
{
    local name=$1 pattern=$2 status=0 problem=
    shift 2
    timeout 300 "$TRIPTYCH" "$@" >"$work/said" 2>"$work/err" </dev/null || status=$?
    if ((status)); then
        problem="exit status $status, expected 0"
    elif [[ -s $work/err ]]; then
        problem='something on stderr'
    elif ! grep -qE -- "$pattern" "$work/said"; then
        problem="stdout without \"$pattern\""
    fi
    verdict "$name" "$problem"
}

# Good usage that prints nothing.
does() # NAME ARGUMENT...
{
    local name=$1 status=0 problem=
    shift
    timeout 300 "$TRIPTYCH" "$@" >"$work/said" 2>"$work/err" </dev/null || status=$?
    if ((status)); then
        problem="exit status $status, expected 0"
    elif [[ -s $work/err || -s $work/said ]]; then
        problem='something on stdout or stderr'
    fi
    verdict "$name" "$problem"
}

holds() # NAME COMMAND... : the command succeeds
{
    local name=$1
    shift
    if "$@" >"$work/said" 2>"$work/err"; then verdict "$name" ''; else verdict "$name" "failed: $*"; fi
}

stream() # FILE : standard input, after the first line
{
    { echo 'triptych 1' && cat; } >"$work/$1"
}

bad_stream() # NAME PATTERN : standard input is the stream without its first line
{
    stream bad.tri
    refuses "$1" "$2" render "$work/bad.tri" --engine emulate --out "$work/out/picture.png"
}

stream good.tri <<'END'
target 40 30
vertices corner position:float3 diffuse:color {
    -1 -1 0   0xffff0000
     0  1 0.5 0xff00ff00
     1 -1 1   0xff0000ff
}
state lighting false
state cullmode none
bind vertices corner
clear color 0.1 0.1 0.2 1 depth 1
draw triangles 0 1
frame
clear color 0 0 0 1 depth 1
frame
END
picture=$work/picture.png

# --- Usage --------------------------------------------------------------------------------------------------

answers 'help' 'usage: triptych' --help
answers 'help by its short name' 'usage: triptych' -h
answers 'help as a command' '^usage: triptych COMMAND ' help
answers 'version' '^triptych [0-9]+\.[0-9]+\.[0-9]+$' --version
for command in $("$TRIPTYCH" --help | sed -nE 's/^  ([a-z]+) .*/\1/p'); do
    answers "help of $command" "^usage: triptych $command " "$command" --help
    answers "help of $command by its short name" "^usage: triptych $command " "$command" -h
    answers "help of $command by the command" "^usage: triptych $command " help "$command"
    refuses "unknown option of $command" "triptych $command: unknown option --colour" "$command" --colour x
done
refuses 'unknown command' 'unknown command "paint".*render' paint
refuses 'misspelled command' 'did you mean "render"\?$' rendr
refuses 'misspelled command of help' 'COMMAND is "rendr".*did you mean "render"\?$' help rendr
refuses 'misspelled option' 'unknown option --eingine.*did you mean --engine\?$' render --eingine emulate
refuses 'misspelled option of the program' 'did you mean "--version"\?$' --versoin
refuses 'misspelled engine' 'did you mean "specialize"\?$' render "$work/good.tri" --engine specialise
refuses 'misspelled engine in a list' 'did you mean "stitch"\?$' verify "$work/good.tri" --engines emulate,stich
refuses 'misspelled action' 'did you mean "validate"\?$' shader valdate "$work/good.shader"
refuses 'unknown option in front of the command' 'unknown option "--verbose"' --verbose
refuses 'no operand' 'expected STREAM' render --out "$work/out/picture.png"
refuses 'too many operands' 'unexpected "b"' render a b
refuses 'option without its value' '--out has no value' render "$work/good.tri" --out
refuses 'number out of range' '--threads is "0", expected' render "$work/good.tri" --threads 0
refuses 'number that is none' '--threads is "two", expected' render "$work/good.tri" --threads two
refuses 'unknown engine' '--engine is "turbo", expected one of: emulate' \
    render "$work/good.tri" --engine turbo --out "$work/out/picture.png"
refuses 'width that the engine has not' 'emulate has no width 5, expected one of: 4' \
    render "$work/good.tri" --engine emulate --width 5 --out "$work/out/picture.png"
refuses 'unknown engine in a list' 'unknown engine "turbo"' verify "$work/good.tri" --engines emulate,turbo
refuses 'engine listed twice' '"emulate" is listed twice' verify "$work/good.tri" --engines emulate,emulate
refuses 'bad list of threads' '"x" is not a number of threads' verify "$work/good.tri" --threads 1,x
refuses 'bad number of frames' '--frames is "some"' verify "$work/good.tri" --frames some
refuses 'unknown list' 'WHAT is "cats", expected one of: engines' list cats

# --- Lists --------------------------------------------------------------------------------------------------

answers 'list engines' '^emulate ' list engines
holds 'descriptions of engines are whole' python3 -c '
import json, subprocess, sys
run = lambda *more: subprocess.run([sys.argv[1], "list", "engines", *more], capture_output=True, text=True).stdout
cut = [row["engine"] for row in json.loads(run("--json")) if row["description"] + "\n" not in run()]
sys.exit(f"cut: {cut}" if cut else 0)' "$TRIPTYCH"
answers 'list states' '^zfunc +COMPARE +lessequal +SP +yes +the comparison' list states
answers 'list states of stages' '^texcoordindex +TEXCOORDINDEX +0, 1, 2, ... +VP ' list states
answers 'list words of states' '^CULLMODE +none cw ccw$' list states
answers 'list states counts them' "^$(grep -c '^STATE(' src/def/state/state.def) render states, [0-9]+ supported" list states
answers 'list formats' '^X4R4G4B4 +30 +2 +1 +rgba8 +texture target$' list formats
answers 'list shaders' '^mad dst, a, b, c( +1){13} *$' list shaders
answers 'list shaders as JSON' '"ps_1_4":.*2' list shaders --json
answers 'list cpu' '^avx2 +(yes|no) ' list cpu
answers 'list passes' '^pass +meaning' list passes
answers 'list rules' '^fuse +pass reduce ' list rules
answers 'list allocators' '^none +no registers' list allocators
answers 'list as JSON' '"state":' list states --json
refuses 'list in two forms' 'expected one of them' list states --json --markdown
refuses 'list that is not a page' '[-]-markdown is for states and shaders only' list cpu --markdown

page_is_the_tables() # WHAT
{
    "$TRIPTYCH" list "$1" --markdown | diff "docs/$1.md" - && return
    echo "docs/$1.md is old: triptych list $1 --markdown > docs/$1.md" >&2
    return 1
}
holds 'docs/states.md is what the command writes' page_is_the_tables states
holds 'docs/shaders.md is what the command writes' page_is_the_tables shaders

full_disk_is_noticed()
{
    local status=0
    "$TRIPTYCH" list states >/dev/full 2>"$work/full" || status=$?
    ((status == 2)) && grep -q 'standard output' "$work/full"
}
holds 'a full disk is noticed on standard output' full_disk_is_noticed

# --- Shaders ------------------------------------------------------------------------------------------------

printf 'ps_1_4\n+MAD_x2 r0.rgb, -t1_bx2, c2.a, 1 - r3 ; comment\n' >"$work/good.shader"
answers 'assemble a shader' '^0xffff0104 0x40000004 0x81070000 0xb5e40001 0xa0ff0002 0x86e40003$' \
    shader assemble "$work/good.shader"
does 'assemble a shader to a file' shader assemble "$work/good.shader" --out "$work/good.code"
answers 'disassemble a shader' '^\+mad_x2 r0.xyz, -t1_bx2, c2.w, 1-r3$' shader disassemble "$work/good.code"
answers 'tokens as JSON' '"0x40000004"' shader assemble "$work/good.code" --json
answers 'text as JSON' '"model":.*"ps_1_4"' shader disassemble "$work/good.code" --json
printf 'ps_2_0\ndcl t0.xy\ndcl_2d s0\ntexld r0, t0, s0\nmov oC0, r0\n' >"$work/valid.shader"
answers 'validate a shader' '^valid ps_2_0: 4 instructions, 2 slots$' shader validate "$work/valid.shader"
answers 'validate as JSON' '"slots":.*2' shader validate "$work/valid.shader" --json
refuses 'shader that breaks a rule' 'good.code: token 1: found \+ without an instruction to pair with' \
    shader validate "$work/good.code" --json --out "$work/out/report"
refuses 'unknown action' 'ACTION is "compile", expected one of: assemble' shader compile "$work/good.shader"
refuses 'no shader' 'expected ACTION' shader assemble
refuses 'missing shader' 'none.shader: .*No such file' shader assemble "$work/none.shader"
printf 'vs_1_1\nmov r0\n' >"$work/bad.shader"
refuses 'bad text of a shader' 'bad.shader:2:7: found the end of the line, expected' \
    shader assemble "$work/bad.shader" --out "$work/out/code"
head -c 20 "$work/good.code" >"$work/bad.code"
refuses 'bytecode cut off' 'bad.code: token 5: found the end of the data' \
    shader disassemble "$work/bad.code" --out "$work/out/text"

# --- Rendering ----------------------------------------------------------------------------------------------

does 'render a PNG' render "$work/good.tri" --engine emulate --out "$picture"
holds 'the PNG has the right size' bash -c "file '$picture' 2>/dev/null | grep -q '40 x 30' ||
    [[ \$(od -An -tx1 -j16 -N8 '$picture' | tr -d ' \n') == 000000280000001e ]]"
does 'render an EXR' render "$work/good.tri" --engine emulate --out "$work/picture.exr"
does 'render four targets as an EXR' render tests/data/streams/targets.tri --out "$work/targets.exr"
holds 'it has the channels of the fourth' grep -q 'target3\.R' "$work/targets.exr"
holds 'the EXR begins as one' bash -c "[[ \$(od -An -tx1 -N4 '$work/picture.exr' | tr -d ' ') == 762f3101 ]]"
does 'render another frame' render "$work/good.tri" --engine emulate --frame 1 --out "$work/black.png"
refuses 'frame that the stream has not' 'no frame 2, its last is 1' \
    render "$work/good.tri" --engine emulate --frame 2 --out "$work/out/picture.png"
answers 'equal pictures are identical' '^identical$' compare "$picture" "$picture"

# The same triangle with both origins of the window: no centre is on an edge.
for origin in upper lower; do
    cat >"$work/$origin.tri" <<EOF
triptych 1
target 24 17 depth d24s8 color A32B32G32R32F
vertices v position:float3 diffuse:color {
    -0.83 -0.71 0.2  ffff0000
     0.13  0.91 0.5  ff00ff00
     0.77 -0.31 0.9  ff0000ff
}
convention windoworigin $origin
state lighting false
state cullmode none
bind vertices v
clear color 0.1 0.1 0.1 1 depth 1
draw triangles 0 1
frame
EOF
done
has_one_picture() # SUFFIX OPTION: the pictures of both are identical
{
    local origin
    for origin in upper lower; do
        "$TRIPTYCH" "${@:3}" "$work/$origin.tri" "$2" "$work/$origin.$1" >"$work/told" || return
    done
    cmp "$work/upper.$1" "$work/lower.$1"
}
holds 'a picture begins with its upper row, with either origin' has_one_picture png --out render --engine emulate
holds 'so does one of depths and numbers' has_one_picture exr --out render --engine emulate
holds 'so does the map of overdraw' has_one_picture heat.png --overdraw inspect

different_pictures_differ()
{
    local status=0
    "$TRIPTYCH" compare "$picture" "$work/black.png" --difference "$work/painted.png" >"$work/told" || status=$?
    ((status == 1)) && grep -qE '^different: pixel \(0, 0\): RGBA [0-9a-f]{8} and 000000ff; of 1200 pixels 1200 ' \
        "$work/told" && "$TRIPTYCH" compare "$work/painted.png" "$work/painted.png"
}
holds 'different pictures differ, and the difference is painted' different_pictures_differ

does 'render an animation' render "$work/good.tri" --engine emulate --frames all --out "$work/both.apng"
does 'render an animation of one frame' render "$work/good.tri" --engine emulate --out "$work/one.apng"
refuses 'picture of an unknown kind' 'expected .png, .exr, .apng or .y4m' \
    render "$work/good.tri" --engine emulate --out "$work/out/picture.jpg"
refuses 'rate of a picture' '--rate is given for a picture, expected an animation: .apng or .y4m$' \
    render "$work/good.tri" --engine emulate --rate 30 --out "$work/out/picture.png"
does 'rate of an animation' render "$work/good.tri" --engine emulate --rate 30 --frames all --out "$work/rate.apng"
refuses 'picture not named' '--out is missing, expected FILE.png, FILE.exr, FILE.apng or FILE.y4m$' render "$work/good.tri" --engine emulate
refuses 'output in a missing folder' "$work/out/none/picture.png: .*No such file" \
    render "$work/good.tri" --engine emulate --out "$work/out/none/picture.png"
mkdir "$work/folder.png"
refuses 'output that is a folder' 'folder.png: ' \
    render "$work/good.tri" --engine emulate --out "$work/folder.png"
ln -s /dev/full "$work/full.png"
refuses 'output on a full disk' 'full.png: .*No space left' \
    render "$work/good.tri" --engine emulate --out "$work/full.png"
TRIPTYCH_RECORD=/dev/full refuses 'recording on a full disk' '^triptych render: /dev/full: .*No space left' \
    render "$work/good.tri" --engine emulate --out "$work/recorded.png"
refuses 'picture that is none' 'good.tri' compare "$work/good.tri" "$picture"
head -c 60 "$picture" >"$work/short.png"
refuses 'picture cut off' 'short.png' compare "$picture" "$work/short.png"

for pair in "$work/both.apng $picture" "$picture $work/both.apng"; do
    refuses 'animation to compare' 'both.apng: found an animation of 2 frames, expected one picture$' compare $pair
done
answers 'an animation of one frame is a picture' '^identical$' compare "$work/one.apng" "$picture"
mkdir "$work/goldens" && cp "$work/both.apng" "$work/goldens/good.png"
holds 'a golden that is an animation is refused' bash -c '"$0" verify "$1" --frames 1 --engines batch --golden "$2" 2>&1 |
    grep -q "good.png: found an animation of 2 frames, expected one picture$"' "$TRIPTYCH" "$work/good.tri" "$work/goldens"
refuses 'a difference that is not a PNG' 'd.jpg: unknown kind of picture, expected .png$' \
    compare "$picture" "$work/black.png" --difference "$work/out/d.jpg"

stream_from_a_pipe()
{
    mkfifo "$work/pipe.tri"
    for ((i = 0; i < 5; i++)); do
        cat "$work/good.tri" >"$work/pipe.tri" &
        timeout 60 "$TRIPTYCH" render "$work/pipe.tri" --engine emulate --out "$work/piped.png" &&
            cmp "$picture" "$work/piped.png" || return
        wait
    done
}
holds 'a stream may come from a pipe' stream_from_a_pipe

# --- Bad streams --------------------------------------------------------------------------------------------

refuses 'missing stream' 'none.tri: .*No such file' \
    render "$work/none.tri" --engine emulate --out "$work/out/picture.png"
refuses 'stream that is a folder' "$work" render "$work" --engine emulate --out "$work/out/picture.png"
head -c 100 /dev/urandom >"$work/noise.tri"
refuses 'stream that is noise' 'noise.tri:1:' render "$work/noise.tri" --engine emulate --out "$work/out/picture.png"
: >"$work/empty.tri"
refuses 'stream that is empty' 'empty.tri' render "$work/empty.tri" --engine emulate --out "$work/out/picture.png"
bad_stream 'unknown call' 'bad.tri:3:1: .*"?tessellate"?' <<'END'
target 40 30
tessellate 3
frame
END
head -c 90 "$work/good.tri" >"$work/cut.tri"
refuses 'stream cut off' 'cut.tri:[0-9]+' render "$work/cut.tri" --engine emulate --out "$work/out/picture.png"
bad_stream 'missing asset' 'nowhere.ply' <<'END'
target 40 30
mesh thing file "nowhere.ply"
frame
END
bad_stream 'target of two gigapixels' 'bad.tri:2:' <<'END'
target 65536 32768
frame
END
bad_stream 'index past the buffer' 'bad.tri:' <<'END'
target 40 30
vertices corner position:float3 {
    -1 -1 0
     0  1 0
     1 -1 0
}
indices list 16 { 0 1 2 0 1 3 }
bind vertices corner
bind indices list
clear color 0 0 0 1
draw-indexed triangles 0 0 2
frame
END
bad_stream 'matrix with a NaN' 'bad.tri:3:' <<'END'
target 40 30
transform world matrix nan 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1
frame
END
bad_stream 'matrix beyond binary32' 'bad.tri:3:' <<'END'
target 40 30
transform world matrix 1e39 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1
frame
END
bad_stream 'state value that is none' 'bad.tri:3:' <<'END'
target 40 30
state zfunc sometimes
frame
END
bad_stream 'draw without a target' 'bad.tri:2:' <<'END'
clear color 0 0 0 1
frame
END
refuses 'verify of a bad stream' 'bad.tri:2:' verify "$work/bad.tri" --json "$work/out/verify.json"
refuses 'bench of a bad stream' 'bad.tri:2:' bench "$work/bad.tri" --csv "$work/out/bench.csv"

# --- Verification and measurement
# ----------------------------------------------------------------------------

refuses 'report into a missing folder' 'none/x.json: cannot be written: No such file' \
    bench "$work/good.tri" --json "$work/out/none/x.json"
refuses 'report that is a folder' 'folder.png: ' verify "$work/good.tri" --json "$work/folder.png"
answers 'verify ends with its sum' '^1 stream, [0-9]+ engines?, identical$' \
    verify "$work/good.tri" --frames all --json "$work/verify.json"
answers 'one engine is one, and the reference is not among them' '^1 stream, 1 engine, identical$' \
    verify "$work/good.tri" --engines batch --frames 1
answers 'the same of random cases' '^1 case, 1 engine, 1 number of threads: .*, 0 findings$' \
    fuzz --count 1 --engines batch --threads 1 --output "$work/found"
answers 'the reference counts if it is named' '^2 cases, 2 engines, 2 numbers of threads: ' \
    fuzz --count 2 --engines batch,emulate --output "$work/found"
refuses 'an update without goldens' '^triptych verify: --update is given without --golden, expected both$' \
    verify "$work/good.tri" --update
holds 'verify writes JSON' grep -q '"identical":' "$work/verify.json"
refuses 'verify of the reference against itself' 'expected another engine or number of threads' \
    verify "$work/good.tri" --engines emulate --threads 1
for command in 'verify good.tri --difference' 'fuzz --count 1 --output'; do
    read -ra words <<<"${command/good.tri/$work/good.tri}"
    refuses "${words[0]}: pictures and findings in a file" 'good.tri: is not a folder' "${words[@]}" "$work/good.tri"
    refuses "${words[0]}: pictures and findings in a missing folder" 'none/x: cannot make the folder: No such file' \
        "${words[@]}" "$work/none/x"
    mkdir "$work/own"
    answers "${words[0]} finds nothing to put into a folder" '' "${words[@]}" "$work/own"
    holds 'and leaves the folder, which is not its own' rmdir "$work/own"
    answers "${words[0]} makes a folder" '' "${words[@]}" "$work/own"
    holds 'and leaves none that is empty' test ! -e "$work/own"
done
answers 'bench prints, and writes JSON and CSV' '^ +geometric mean ' bench "$work/good.tri" --repetitions 3 \
    --seconds 1 --engines emulate,batch,stitch,specialize --json "$work/bench.json" --csv "$work/bench.csv"
holds 'the CSV has one width' awk -F, 'NR == 1 { n = NF } NF != n { bad = 1 } END { exit bad || NR < 2 }' "$work/bench.csv"
# The first frame, in the warm-up, builds the routines. The measured frames find them in the cache, with any
# number of repetitions.
holds 'the hit rate is that of the runs measured' awk -F, '
    NR == 1 { for (i = 1; i <= NF; i++) if ($i == "hit_rate") column = i }
    NR > 1 && $column != 100 { bad = 1 }
    END { exit bad || NR < 2 || !column }' "$work/bench.csv"
answers 'bench compares with the fastest engine' '^  (emulate|specialize) +[0-9.]+ +[0-9.]+ +[0-9.]+ +(slower|no difference shown)$' \
    bench "$work/good.tri" --engines emulate,specialize --repetitions 5 --seconds 1 --frames 1 \
    --json "$work/a.json" --chart "$work/chart.svg,$work/chart.png"
holds 'the chart is an SVG' grep -q '^<svg' "$work/chart.svg"
holds 'the chart names stream and engine' bash -c 'grep -q ">good<" "$0" && grep -q ">specialize<" "$0"' "$work/chart.svg"
holds 'and a PNG' grep -qa 'PNG' "$work/chart.png"
refuses 'chart of another kind' '[-]-chart is ".*x.gif", expected files whose names end with .svg or .png' \
    bench "$work/good.tri" --chart "$work/out/x.gif"
holds 'without gnuplot the chart is refused before anything is measured' bash -c '
    PATH=/nonexistent "$0" bench "$1" --chart "$2/none.svg" >/dev/null 2>"$2/err"
    [[ $? == 2 && ! -e $2/none.svg ]] && IFS= read -r line <"$2/err" &&
    [[ $line == "triptych bench: --chart needs gnuplot, which is not in PATH"* ]]' "$TRIPTYCH" "$work/good.tri" "$work"
answers 'a measurement compared with itself shows no difference' '^good +specialize +.* no difference shown$' \
    bench --compare "$work/a.json" "$work/a.json" --json "$work/compare.json"
holds 'and writes JSON' grep -q '"b_is":.*"no difference shown"' "$work/compare.json"
python3 -c 'import json, sys
a = json.load(open(sys.argv[1]))
def write(path, samples, frames):
    for run in a["streams"][0]["engines"]: run["samples"]["frame_ms"] = samples
    a["streams"][0]["frames"] = frames
    json.dump(a, open(path, "w"))
write(sys.argv[2], [0.5, 0.55, 0.6, 0.65, 0.7], 1)
write(sys.argv[3], [1, 1.1, 1.2, 1.3, 1.4], 7)
write(sys.argv[1], [1, 1.1, 1.2, 1.3, 1.4], 1)' "$work/a.json" "$work/half.json" "$work/frames.json"
answers 'half the time is faster' '^good +emulate +1[.]200 +0[.]600 +2[.]000 +1[.]571 +2[.]545 +faster$' \
    bench --compare "$work/a.json" "$work/half.json"
answers 'twice the time is slower' '^B is faster 0 times, slower 2 times, no difference is shown 0 times' \
    bench --compare "$work/half.json" "$work/a.json"
answers 'twice the time is slower, with an interval' '^crate +stitch +1[.]150 +2[.]150 +0[.]535 +0[.]4[0-9]+ +0[.]6[0-9]+ +slower$' \
    bench --compare tests/data/measurements/before.json tests/data/measurements/after.json
answers 'two runs are too few' '^crate +specialize +0[.]550 +0[.]550 +1[.]000 +- +- +too few runs$' \
    bench --compare tests/data/measurements/before.json tests/data/measurements/after.json
refuses 'comparison of other work' 'stream good: another frames, expected the same in both files' \
    bench --compare "$work/a.json" "$work/frames.json"
refuses 'comparison of one file' '[-]-compare has 1 operands, expected two files' bench --compare "$work/a.json"
refuses 'comparison with a stream' 'good.tri: has no streams, expected a file that triptych bench' \
    bench --compare "$work/a.json" "$work/good.tri"
refuses 'comparison with a missing file' 'none.json: ' bench --compare "$work/a.json" "$work/none.json"
answers 'bench of builds prints a row of sets for each engine' '^stitch +8 +AVX2 +set +1 ' bench "$work/good.tri" --builds \
    --engines stitch,emulate --repetitions 3 --json "$work/builds.json"
holds 'and writes JSON' grep -q '"first_p99_us":' "$work/builds.json"
holds 'the burst of a draw is the sum of its three routines' python3 -c '
import json, sys
rows = {row["what"]: row for row in json.load(open(sys.argv[1]))["builds"] if row["engine"] == "stitch"}
whole = sum(rows[unit]["most_us"] for unit in ("vertex", "setup", "pixel"))
assert rows["burst"]["count"] == 1 and abs(rows["burst"]["most_us"] - whole) < 1e-6, rows' "$work/builds.json"
answers 'bench of code prints the instructions of each unit' '^specialize-1 +pixel +1 +1[.]0 +[0-9.]+ +[1-9]' \
    bench "$work/good.tri" --code --engines specialize-1,specialize-8,emulate --json "$work/code.json"
holds 'and writes a row for each routine' test "$(grep -c '"frame":' "$work/code.json")" = 9
answers 'bench of parts prints a row for each part' '^dead +[0-9.]+ +[0-9.]+ +[0-9.]+ +[1-9]' bench "$work/good.tri" --parts \
    --engines specialize-8,specialize-8:unroll --repetitions 3 --json "$work/parts.json"
holds 'and writes an object for each engine and unit' test "$(grep -c '"recorded":' "$work/parts.json")" = 8
refuses 'parts of an engine without them' 'engine emulate has no parts, expected specialize' \
    bench "$work/good.tri" --parts --engines emulate
refuses 'an option that no engine has' 'engine specialize-8:unrol: found the option "unrol", .* did you mean "unroll"\?$' \
    verify "$work/good.tri" --engines specialize-8:unrol
refuses 'an engine without options' 'engine stitch:unroll: stitch takes no options$' verify "$work/good.tri" --engines stitch:unroll
refuses 'registers that the engine does not have' 'registers is "14", expected a whole number from 0 to 13$' \
    dump "$work/good.tri" --engine specialize-8 --registers 14
refuses 'a misspelled pass' '[-]-without is "comon", .* did you mean "common"\?$' fuzz --count 1 --without comon
refuses 'registers of engines without options' 'none of the engines takes --registers' \
    verify "$work/good.tri" --engines emulate,batch --registers 4
answers 'options apply to the engines that take them' '^1 stream, 3 engines, identical$' verify "$work/good.tri" --frames 1 \
    --engines batch,specialize-8,specialize-4:unroll --registers 5 --without fold --without common
answers 'options are listed' '^without +a pass ' list options
answers 'bench of cold frames prints a row for each stream and engine' '^good +tiered +[0-9.]+ +[0-9.]+ ' \
    bench "$work/good.tri" --cold --engines tiered --repetitions 3 --json "$work/cold.json"
holds 'and writes JSON too' grep -q '"thread_first":' "$work/cold.json"
holds 'the JSON has lanes and instruction set of each engine' \
    test "$(grep -c '"lanes":' "$work/bench.json")" = "$(grep -c '"instruction_set":' "$work/bench.json")"
holds 'the JSON names the machine' grep -q '"commit":' "$work/bench.json"

# --- Models -------------------------------------------------------------------------------------------------

cat >"$work/model.obj" <<'END'
mtllib model.mtl
v 0 0 0
v 2 0 0
v 0 1 -3
usemtl red
f 1 2 3
usemtl blue
f 1 3 2
END
printf 'newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\nmap_Kd none.png\n' >"$work/model.mtl"
printf 'v 0 0 0\nv 1 0 0\nf 1 2 3\n' >"$work/short.obj"
answers 'mesh counts vertices and triangles' '^  [0-9]+ vertices, 2 triangles$' mesh --info "$work/model.obj"
answers 'mesh prints bounds' '^  x 0 to 2, y 0 to 1, z -3 to 0$' mesh "$work/model.obj" --json "$work/mesh.json"
answers 'mesh prints materials and missing textures' '^  blue +1 +0 +0 +1 +1 +.*/none.png .missing.$' mesh "$work/model.obj"
holds 'mesh writes JSON' python3 -c 'import json, sys
mesh = json.load(open(sys.argv[1]))["meshes"][0]
assert mesh["triangles"] == 2 and mesh["low"] == [0, 0, -3] and mesh["high"] == [2, 1, 0]
assert [m["name"] for m in mesh["materials"]] == ["red", "blue"]
assert mesh["materials"][0]["diffuse"] == [1, 0, 0, 1] and mesh["materials"][1]["exists"] is False' "$work/mesh.json"
answers 'mesh counts patches' '^  128 vertices, 56 triangles, 28 patches$' mesh bench/streams/assets/teapot.bez
refuses 'mesh of a bad model' 'short.obj:3:7: found .3., expected the number of a vertex from 1 to 2' mesh "$work/short.obj"
printf 'ps_1_4\nmov r0, v0\n' >"$work/none.psh"
refuses 'mesh of another file' 'none.psh: found no model that Assimp reads, expected one: ' mesh "$work/none.psh"
refuses 'mesh of a missing file' 'none.obj: cannot open' mesh "$work/none.obj"

# --- Dumps --------------------------------------------------------------------------------------------------

for engine in $("$TRIPTYCH" list engines | awk 'NR > 1 && $1 !~ /^(emulate|batch)/ && $3 == "available" { print $1 }'); do
    for unit in vertex setup pixel; do
        # Vertices of mixed are those of emulate, which has no code.
        [[ $engine,$unit == mixed,vertex ]] && continue
        answers "dump of $engine, $unit" '[0-9a-f]+ +ret' dump "$work/good.tri" --engine "$engine" --unit "$unit"
    done
done
answers 'bisect of engines that agree' 'the routines of emulate and batch agree on every call' \
    bisect "$work/good.tri" --engines emulate,batch
answers 'bisect of one draw and pixel' 'agree on every call' \
    bisect "$work/good.tri" --engines emulate,batch --draw 0 --pixel 3,4
refuses 'bisect of one engine' '--engines names 1, expected two' bisect "$work/good.tri" --engines emulate
refuses 'bisect of a missing draw' 'good.tri: there is no draw 1, the stream has 1' \
    bisect "$work/good.tri" --engines emulate,batch --draw 1
refuses 'bisect of half a pixel' '--pixel is "3", expected X,Y' \
    bisect "$work/good.tri" --engines emulate,batch --pixel 3
refuses 'bisect of a missing stream' 'none.tri' bisect "$work/none.tri" --engines emulate,batch
refuses 'dump of an engine without code' 'emulate makes no code' dump "$work/good.tri" --engine emulate
refuses 'dump of a unit of mixed without code' 'emulate makes no code' dump "$work/good.tri" --engine mixed --unit vertex
if grep -q '^specialize .* available ' < <("$TRIPTYCH" list engines); then
    holds 'stages of tiers leave out the code without stages' bash -c '"$0" dump "$1" --engine tiered --show key >"$2/tiers" &&
        ! grep -q " ret$" "$2/tiers" && grep -q "^== key" "$2/tiers"' "$TRIPTYCH" "$work/good.tri" "$work"
    answers 'dump of every stage' '== asm' dump "$work/good.tri" --show all
    answers 'a pass that changes nothing is reported' '^nothing changed' dump "$work/good.tri" --show phi
    answers 'dump of the parts of a build' '^encode +[0-9.]+ ' dump "$work/good.tri" --show parts
    answers 'a pass that an engine leaves out is reported' '^== hoist: this engine does not run it' \
        dump "$work/good.tri" --show hoist --engine specialize-thesis
    for stage in record dead asm; do
        answers "lines of a shader precede what they become, $stage" '^; shader:[0-9]+: mad r1.y, r1.y, c28.w, r0.y$' \
            dump tests/data/shading/fractals.tri --show $stage
    done
    answers 'dump of the span reading' ' again ' dump bench/streams/rectangles/copy.tri --spans --show separate \
        --engine specialize-8
    answers 'a loop of blocks that gets stretched rows' ' stretch ' dump bench/streams/micro/mix-16.tri \
        --frame 1 --spans --engine specialize-8 --show stretch
    answers 'a loop of blocks that is too long for stretched rows' '^nothing changed' \
        dump bench/streams/micro/mix-64.tri --frame 1 --spans --engine specialize-8 --show stretch
    answers 'dump of the reading for joined rectangles' ' unit  *;' \
        dump bench/streams/pages/page-text.trib --draw 1 --joined --show record
    refuses 'dump of two readings' '--joined is a reading of its own' \
        dump bench/streams/pages/page-text.trib --draw 1 --joined --spans
    refuses 'dump of the span reading of vertices' '--spans is for pixel routines, found --unit vertex' \
        dump "$work/good.tri" --spans --unit vertex
    refuses 'dump of the span reading with samples' 'has no span reading, expected one sample' \
        dump tests/data/streams/multisampling.tri --spans
    answers 'dump of the span reading of white' ' span=1$' \
        dump bench/streams/rectangles/modulate.tri --white --show key
    refuses 'dump of the span reading of white, without the diffuse colour' \
        '--white is for draws that read the diffuse colour' dump bench/streams/rectangles/copy.tri --white
    refuses 'dump of a missing draw' 'frame 0 has no draw 1, it has 1' dump "$work/good.tri" --draw 1
    refuses 'dump of a missing frame' 'no frame 7, its last is 1' dump "$work/good.tri" --frame 7
    refuses 'dump of an unknown unit' '--unit is "texel", expected one of: vertex, setup, pixel' \
        dump "$work/good.tri" --unit texel
    refuses 'dump of an unknown stage' '[-]-show has "asm2", expected key, record, a pass, intervals, asm, text, parts or all' dump "$work/good.tri" --show asm2
    refuses 'dump of an unknown stage of external' 'expected key, vector, text, whole, asm or all' \
        dump "$work/good.tri" --engine external --show text,asm2
    answers 'dump of the text that is compiled' '^void routine\(const char \*call\)' \
        dump "$work/good.tri" --engine external --show text
    TRIPTYCH_CC=no-such-compiler refuses 'external without a compiler' 'external cannot run here: needs a C compiler' \
        render "$work/good.tri" --engine external --out "$work/out/external.png"
    refuses 'dump of a stage that stitching has not' '--show is "asm", expected none' \
        dump "$work/good.tri" --engine stitch --show asm
fi

# --- Compression --------------------------------------------------------------------------------------------

for level in 0 1 9; do
    does "render with --compression $level" \
        render "$work/good.tri" --engine emulate --compression $level --out "$work/level-$level.png"
    holds 'the picture is the same' "$TRIPTYCH" compare "$picture" "$work/level-$level.png"
done
holds 'level 1 is the default' cmp "$picture" "$work/level-1.png"
holds 'level 0 stores' test "$(stat -c %s "$work/level-0.png")" -gt $((40 * 30 * 4))
holds 'level 9 is smaller' test "$(stat -c %s "$work/level-9.png")" -lt "$(stat -c %s "$work/level-0.png")"
does 'an animation has a level too' \
    render "$work/good.tri" --frames all --engine emulate --compression 0 --out "$work/level-0.apng"
holds 'which stores its frames' test "$(stat -c %s "$work/level-0.apng")" -gt $((2 * 40 * 30 * 4))
for subcommand in render verify compare; do
    answers "$subcommand has the option --compression" '--compression LEVEL' "$subcommand" --help
done
refuses 'a level beyond the last' '--compression is "10", expected a whole number from 0 to 9' \
    render "$work/good.tri" --compression 10 --out "$work/out/a.png"

# --- Conversion ---------------------------------------------------------------------------------------------

does 'convert' convert "$work/good.tri" "$work/canonical.tri"
does 'convert what was converted' convert "$work/canonical.tri" "$work/again.tri"
holds 'canonical text stays as it is' cmp "$work/canonical.tri" "$work/again.tri"
does 'convert to a container' convert "$work/good.tri" "$work/good.trib"
does 'convert from a container' convert "$work/good.trib" "$work/back.tri"
holds 'a container comes back as the canonical text' cmp "$work/canonical.tri" "$work/back.tri"
does 'the converted stream is readable' \
    render "$work/canonical.tri" --engine emulate --out "$work/canonical.png"
holds 'and draws the same' "$TRIPTYCH" compare "$picture" "$work/canonical.png"
head -c -16 "$work/good.trib" >"$work/cut.trib"
answers 'salvaged frames are counted' '^[12] frames? kept$' convert "$work/cut.trib" "$work/salvaged.tri" --salvage
holds 'and are in the stream' test "$(grep -c '^frame$' "$work/salvaged.tri") frames kept" = "$(sed 's/frame kept/frames kept/' "$work/said")"
refuses 'conversion to an unknown kind' 'expected .tri' convert "$work/good.tri" "$work/out/good.bin"
cp "$work/good.tri" "$work/same.tri"
ln -s same.tri "$work/link.tri"
ln "$work/same.tri" "$work/hard.tri"
for path in same.tri ../"$(basename "$work")"/same.tri link.tri hard.tri; do
    refuses "conversion of a file to itself, $path" 'OUTPUT is ".*", the file of INPUT, expected another$' \
        convert "$work/same.tri" "$work/$path"
done
holds 'an output that is the standard input is refused' bash -c '
    "$0" convert - "$1" <"$1" 2>&1 | grep -qE "OUTPUT is \".*same.tri\", the file of INPUT, expected another$"' \
    "$TRIPTYCH" "$work/same.tri"
holds 'the file stays as it was' cmp "$work/good.tri" "$work/same.tri"
refuses 'a picture over its stream' '--out is ".*", the file of STREAM, expected another$' \
    render "$work/same.tri" --format png --out "$work/link.tri"
refuses 'a difference over a picture' '--difference is ".*", the file of SECOND, expected another$' \
    compare "$work/black.png" "$picture" --difference "$picture"
refuses 'a report over its stream' '--json is ".*", the file of STREAM, expected another$' \
    verify "$work/good.tri" "$work/same.tri" --json "$work/same.tri"
refuses 'merged results over a part' 'OUTPUT is ".*", the file of INPUT, expected another$' \
    merge "$work/a.json" "$work/b.json" "$work/a.json"
refuses 'conversion of a bad stream' 'bad.tri:2:' convert "$work/bad.tri" "$work/out/bad2.tri"
refuses 'conversion into a missing folder' 'No such file' convert "$work/good.tri" "$work/out/none/good.tri"

exit $failures
