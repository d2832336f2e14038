#!/bin/bash
# Many pictures in one process: frames, draws, animations, contact sheets; standard streams as files;
# comparison with tolerance and with goldens.
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

holds() # NAME COMMAND... : the command succeeds
{
    local name=$1
    shift
    if "$@" >"$work/said" 2>"$work/err"; then verdict "$name" ''; else verdict "$name" "failed: $*"; fi
}

# Bad usage: exit status 2, nothing on stdout, one line on stderr that holds the pattern, and no new file.
refuses() # NAME PATTERN ARGUMENT...
{
    local name=$1 pattern=$2 status=0
    shift 2
    mkdir -p "$work/out"
    timeout 60 "$TRIPTYCH" "$@" >"$work/said" 2>"$work/err" </dev/null || status=$?
    if ((status != 2)) || [[ $(wc -l <"$work/err") != 1 || -s $work/said || $(ls -A "$work/out") ]]; then
        verdict "$name" "status $status, $(wc -l <"$work/err") lines, stdout: $(head -c 80 "$work/said"), files: $(ls -A "$work/out")"
    elif grep -qE -- "$pattern" "$work/err"; then
        verdict "$name" ''
    else
        verdict "$name" "stderr without \"$pattern\""
    fi
}

# Four frames, each with three draws of one colour from left to right.
{
    printf 'triptych 1\ntarget 24 16\nstate lighting false\nvertices strip position:float3 diffuse:color {\n'
    for color in ffff0000 ff00ff00 ff0000ff; do
        printf -- '-1 -1 0 0x%s\n-1 1 0 0x%s\n-0.4 -1 0 0x%s\n-0.4 1 0 0x%s\n' $color $color $color $color
    done
    printf '}\nstate cullmode none\nbind vertices strip\n'
    for frame in 0 1 2 3; do
        printf 'clear color 0 0 0.%d 1 depth 1\n' $frame
        for draw in 0 1 2; do
            printf 'transform world translate %s 0 0\ndraw strip %d 2\n' "$(awk "BEGIN { print 0.7 * $draw }")" $((4 * draw))
        done
        echo frame
    done
} >"$work/four.tri"
render=("$TRIPTYCH" render "$work/four.tri" --engine emulate)
for frame in 0 1 2 3; do "${render[@]}" --frame $frame --out "$work/one-$frame.png" || failures=1; done

# --- Frames and draws ---------------------------------------------------------------------------------------

holds 'all frames are rendered in one process' "${render[@]}" --frames all --out "$work/f%04d.png"
for frame in 0 1 2 3; do
    holds "frame $frame is the same as by itself" cmp "$work/one-$frame.png" "$work/f000$frame.png"
done
holds 'a range is numbered like its frames' "${render[@]}" --frames 2-3 --out "$work/range-%d.exr"
holds 'a range writes no more than its frames' test "$(cd "$work" && echo range-*)" = 'range-2.exr range-3.exr'
holds 'a width is filled with spaces' "${render[@]}" --frames 1 --out "$work/wide %3d.png"
holds 'the number has that width' cmp "$work/wide   1.png" "$work/one-1.png"
holds 'one frame needs no number' "${render[@]}" --frames 3 --out "$work/single.png"
holds 'a name is not a pattern without --frames' "${render[@]}" --frame 3 --out "$work/50%.png"
holds 'and is written as it is' cmp "$work/50%.png" "$work/one-3.png"

holds 'a picture after each draw' "${render[@]}" --frame 2 --draws 0..2 --out "$work/d%d.png"
holds 'a range of draws' "${render[@]}" --frame 2 --draws 1 --out "$work/r%d.png"
holds 'has the draws before it' cmp "$work/r1.png" "$work/d1.png"
holds 'the last draw completes the frame' cmp "$work/d2.png" "$work/one-2.png"
awk '/^clear/ { frame++ } /^frame/ || (/^draw/ && (frame < 3 || ++draws > 2)) { next } frame < 4' "$work/four.tri" \
    >"$work/two-draws.tri"
holds 'a stream that ends after the second draw' "$TRIPTYCH" render "$work/two-draws.tri" --engine emulate --out "$work/two.png"
holds 'draws the picture after the second draw' cmp "$work/two.png" "$work/d1.png"
holds 'draws of a container' bash -c "'$TRIPTYCH' convert '$work/four.tri' '$work/four.trib' &&
    '$TRIPTYCH' render '$work/four.trib' --engine emulate --draws 1-2 --frame 2 --out '$work/c%d.png' && cmp '$work/c1.png' '$work/d1.png'"

holds 'the draws of a shadow volume' "$TRIPTYCH" render tests/data/scenes/shadow-volume.tri --engine emulate --draws all \
    --sheet 5 --out "$work/draws.png"
holds 'are those of the page: make gallery writes it' "$TRIPTYCH" compare "$work/draws.png" docs/images/draws.png
holds 'frames of a recording' bash -c "TRIPTYCH_RECORD='$work/recorded.trib' '$TRIPTYCH' render '$work/four.tri' --engine emulate \
    --frames all --out '$work/recording-%d.png' && '$TRIPTYCH' render '$work/recorded.trib' --engine emulate --frames 1-3 \
    --out '$work/again-%d.png' && cmp '$work/again-3.png' '$work/one-3.png'"
"$TRIPTYCH" render tests/data/streams/queries.tri --engine emulate --frames all --out "$work/q%d.png" >"$work/queries"
holds 'results of queries name their frames' grep -q '^frame 0: .* samples passed$' "$work/queries"

picture=$work/out/p.png
refuses 'several frames in one file' 'expected a name with a number, like f%04d.png, for 4 pictures' \
    "${render[@]:1}" --frames all --out "$picture"
refuses 'several frames to standard output' '"-", expected a name with a number' "${render[@]:1}" --frames all --out -
for pattern in '%s' '%d%d' '%%d' '%' '%x' '%5' '%ld' '%-3d' '%1000d' '%d%n'; do
    refuses "name $pattern" 'expected one number of the picture, like %d or %04d, and no other %' \
        "${render[@]:1}" --frames all --out "$work/out/$pattern.png"
done
refuses 'number in the name of an animation' 'expected a name without %d' \
    "${render[@]:1}" --frames all --out "$work/out/%d.apng"
for range in '' 4 2-1 0-4 -1 1- a 0-1-2 99999999999999999999; do
    refuses "frames \"$range\"" '[-]-frames is ("|empty)' "${render[@]:1}" "--frames=$range" --out "$work/out/%d.png"
done
refuses 'draws that the frame has not' '--draws is "0-3", expected all, N or A-B of numbers from 0 to 2' \
    "${render[@]:1}" --draws 0-3 --out "$work/out/%d.png"
refuses 'draws of several frames' '--frames and --draws are both given' \
    "${render[@]:1}" --draws all --frames all --out "$work/out/%d.png"
refuses 'frame and frames' '--frames and --frame are both given' \
    "${render[@]:1}" --frame 1 --frames all --out "$work/out/%d.png"
refuses 'misspelled extension' 'did you mean "png"\?$' "${render[@]:1}" --out "$work/out/p.pgn"
refuses 'folder that is missing' 'No such file' "${render[@]:1}" --frames all --out "$work/none/%d.png"

# --- One file for all ---------------------------------------------------------------------------------------

holds 'an animation as APNG' "${render[@]}" --frames all --rate 10 --out "$work/four.apng"
holds 'an animation as Y4M' "${render[@]}" --frames all --rate 10 --out "$work/four.y4m"
holds 'a contact sheet' "${render[@]}" --frames all --sheet 3 --out "$work/sheet.png"
holds 'an APNG under another name' "${render[@]}" --frames all --rate 10 --format apng --out "$work/apng.png"
holds 'has the same bytes' cmp "$work/apng.png" "$work/four.apng"

# Reads the files without the code that wrote them.
cat >"$work/read.py" <<'PY'
import struct, sys, zlib
work = sys.argv[1]

def chunks(path):
    data = open(path, "rb").read()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, result = 8, []
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        assert struct.unpack(">I", data[at + 8 + size:at + 12 + size])[0] == zlib.crc32(kind + body)
        result.append((kind, body))
        at += 12 + size
    assert result[-1] == (b"IEND", b"")
    return result

def pixels(data, width, height):
    raw, rows, above = zlib.decompress(data), [], bytes(4 * width)
    stride = 4 * width + 1
    assert len(raw) == stride * height
    for y in range(height):
        row = bytearray(raw[y * stride + 1:(y + 1) * stride])
        for x in range(4 * width):
            a = row[x - 4] if x >= 4 else 0
            b, c = above[x], above[x - 4] if x >= 4 else 0
            p = a + b - c
            nearest = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            row[x] = row[x] + (0, a, b, (a + b) // 2, nearest)[raw[y * stride]] & 255
        rows.append(bytes(row))
        above = bytes(row)
    return rows

def picture(path):
    list_ = chunks(path)
    width, height = struct.unpack(">II", list_[0][1][:8])
    return pixels(b"".join(body for kind, body in list_ if kind == b"IDAT"), width, height)

def apng():
    list_ = chunks(work + "/four.apng")
    assert [kind for kind, body in list_[:2]] == [b"IHDR", b"acTL"]
    assert list_[1][1] == struct.pack(">II", 4, 0)
    frames, sequence = [], 0
    for kind, body in list_[2:-1]:
        if kind == b"fcTL":
            assert body == struct.pack(">IIIIIHHBB", sequence, 24, 16, 0, 0, 1, 10, 0, 0), body
            frames.append(b"")
            sequence += 1
        elif kind == b"fdAT":
            assert struct.unpack(">I", body[:4])[0] == sequence and len(frames) > 1
            frames[-1] += body[4:]
            sequence += 1
        else:
            assert kind == b"IDAT" and len(frames) == 1
            frames[-1] += body
    assert len(frames) == 4
    for number, data in enumerate(frames):
        assert pixels(data, 24, 16) == picture("%s/one-%d.png" % (work, number))

def y4m():
    file = open(work + "/four.y4m", "rb")
    assert file.readline() == b"YUV4MPEG2 W24 H16 F10:1 Ip A1:1 C444 XCOLORRANGE=LIMITED\n"
    for number in range(4):
        assert file.readline() == b"FRAME\n"
        planes = [file.read(24 * 16) for plane in range(3)]
        for y, row in enumerate(picture("%s/one-%d.png" % (work, number))):
            for x in range(24):
                r, g, b = row[4 * x:4 * x + 3]
                luma = 0.299 * r + 0.587 * g + 0.114 * b
                exact = 16 + 219 * luma / 255, 128 + 112 * (b - luma) / 255 / 0.886, 128 + 112 * (r - luma) / 255 / 0.701
                for plane, value in zip(planes, exact):
                    assert abs(plane[y * 24 + x] - value) < 0.51, (x, y, row[4 * x:4 * x + 4], value)
    assert file.read() == b""

def sheet():
    rows = picture(work + "/sheet.png")
    assert len(rows) == 32 and len(rows[0]) == 4 * 72
    for number in range(4):
        x, y = number % 3 * 24, number // 3 * 16
        assert [row[4 * x:4 * (x + 24)] for row in rows[y:y + 16]] == picture("%s/one-%d.png" % (work, number))
    assert not any(any(row[4 * 24:]) for row in rows[16:])

globals()[sys.argv[2]]()
PY
holds 'the frames of the APNG are the pictures' python3 "$work/read.py" "$work" apng
holds 'the frames of the Y4M are the pictures in BT.601' python3 "$work/read.py" "$work" y4m
holds 'the sheet has the pictures in rows' python3 "$work/read.py" "$work" sheet
refuses 'animation whose frames have several sizes' 'picture 2 has 48 x 64 pixels, expected 64 x 48, like the first' \
    render tests/data/streams/frames.tri --engine emulate --frames all --out "$work/out/a.apng"
refuses 'sheet of another form' 'a contact sheet is a PNG picture' "${render[@]:1}" --sheet 2 --out "$work/out/s.exr"
ln -s /dev/full "$work/full.apng"
refuses 'animation on a full disk' 'full.apng: .*No space left' "${render[@]:1}" --frames all --out "$work/full.apng"

# --- Standard streams ---------------------------------------------------------------------------------------

holds 'a stream from standard input, a picture to standard output' bash -c "cat '$work/four.tri' |
    '$TRIPTYCH' render - --engine emulate --out - | cmp - '$work/one-0.png'"
holds 'standard input that is a file' bash -c "'$TRIPTYCH' render - --engine emulate --out - <'$work/four.tri' | cmp - '$work/one-0.png'"
holds 'standard output that is a file is appended to' bash -c "printf before >'$work/appended' &&
    '$TRIPTYCH' render - --engine emulate --out - <'$work/four.tri' >>'$work/appended' &&
    { printf before && cat '$work/one-0.png'; } | cmp - '$work/appended'"
holds 'an EXR to standard output' bash -c "'$TRIPTYCH' render '$work/four.tri' --engine emulate --out - --format exr |
    head -c 4 | od -An -tx1 | grep -q '76 2f 31 01'"
holds 'an animation to standard output' bash -c "'${render[0]}' render '$work/four.tri' --engine emulate --frames all --rate 10 --out - --format y4m |
    cmp - '$work/four.y4m'"
holds 'a picture from standard input' bash -c "'$TRIPTYCH' compare - '$work/one-0.png' <'$work/one-0.png' | grep -qx identical"
holds 'a report to standard output, and only that' bash -c "'$TRIPTYCH' verify '$work/four.tri' --engines batch --json - 2>'$work/report' |
    python3 -c 'import json, sys; assert json.load(sys.stdin)[\"identical\"]' && grep -q identical '$work/report'"
holds 'a converted stream to standard output' bash -c "'$TRIPTYCH' convert '$work/four.tri' - | '$TRIPTYCH' convert - '$work/back.tri' &&
    '$TRIPTYCH' convert '$work/four.tri' '$work/canonical.tri' && cmp '$work/back.tri' '$work/canonical.tri'"
holds 'a container through pipes' bash -c "'$TRIPTYCH' convert '$work/four.tri' - --format trib | '$TRIPTYCH' convert - - |
    cmp - '$work/canonical.tri'"
holds 'a dump of standard input' bash -c "'$TRIPTYCH' dump - --engine stitch --unit pixel <'$work/four.tri' | grep -q ret || ! grep -q avx2 /proc/cpuinfo"
printf 'ps_2_0\nmov oC0, c0\n' >"$work/shader"
holds 'a shader through pipes' bash -c "'$TRIPTYCH' shader assemble - --out - <'$work/shader' | '$TRIPTYCH' shader disassemble - | grep -qx 'mov oC0, c0'"
holds 'files of a stream from standard input are relative to the current folder' bash -c "cd '$work' &&
    printf 'triptych 1\ntarget 4 4\ntexture t file \"one-0.png\"\nclear color 0 0 0 1 depth 1\n' |
    '$(realpath "$TRIPTYCH")' render - --engine emulate --out relative.png"
refuses 'two files on standard output' 'standard output has another use' verify "$work/four.tri" --json - --json=-
refuses 'two files on standard input' 'SECOND is "-", expected a file: standard input has another use' compare - -
full_output_is_noticed()
{
    local status=0
    "${render[@]}" --out - >/dev/full 2>"$work/full" || status=$?
    ((status == 2)) && grep -q '/dev/stdout: .*No space left' "$work/full"
}
holds 'standard output that is full is noticed' full_output_is_noticed
# script(1) is not everywhere; python makes the terminal.
terminal_is_refused()
{
    python3 - "${render[@]}" --out - <<'PY'
import os, pty, sys
child, terminal = pty.fork()
if child == 0:
    os.execvp(sys.argv[1], sys.argv[1:])
seen = b""
try:
    while True:
        seen += os.read(terminal, 4096)
except OSError:
    pass
assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 2 and b"a picture is not for a terminal" in seen, seen
PY
}
holds 'a picture is not written to a terminal' terminal_is_refused
holds 'progress is shown on a terminal only' python3 - "${render[@]}" --frames all --out "$work/f%d.png" <<'PY'
import os, pty, subprocess, sys
assert not subprocess.run(sys.argv[1:], stderr=subprocess.PIPE, check=True).stderr
terminal, end = pty.openpty()
assert subprocess.run(sys.argv[1:], stderr=end).returncode == 0
os.close(end)
seen = b""
try:
    while True:
        seen += os.read(terminal, 4096)
except OSError:
    pass
assert b"frame 3, of 0 to 3" in seen and seen.endswith(b"\r\x1b[K"), seen
PY

# --- Comparison ---------------------------------------------------------------------------------------------

status_of() # STATUS PATTERN ARGUMENT... : exit status, and a pattern of the output
{
    local status=0 expected=$1 pattern=$2
    shift 2
    "$TRIPTYCH" "$@" >"$work/compared" 2>&1 || status=$?
    cat "$work/compared"
    ((status == expected)) && grep -qE -- "$pattern" "$work/compared"
}
# The frames differ in the blue of the background.
a=$work/one-0.png b=$work/one-1.png
holds 'pictures that differ have a ratio' status_of 1 '^different: .*; PSNR [0-9]+\.[0-9]+ dB$' compare "$a" "$b"
pixels=$(sed -nE 's/.* pixels ([0-9]+) differ in colour.*/\1/p' "$work/compared")
largest=$(sed -nE 's/.* by at most ([0-9]+) of 255.*/\1/p' "$work/compared")
holds 'a tolerance of the largest difference suffices' status_of 0 '^similar: ' compare "$a" "$b" --tolerance "$largest"
holds 'less does not' status_of 1 "^different: .*; $pixels by more than $((largest - 1))$" compare "$a" "$b" --tolerance $((largest - 1))
holds 'the pixels that differ can be allowed' status_of 0 '^similar: ' compare "$a" "$b" --allow "$pixels"
holds 'one less cannot' status_of 1 '^different: ' compare "$a" "$b" --allow $((pixels - 1))
"$TRIPTYCH" compare "$a" "$b" --json "$work/compare.json" --difference "$work/difference.png" >/dev/null
holds 'the report has the ratio' python3 - "$work/compare.json" "$pixels" "$largest" <<'PY'
import json, math, sys
report = json.load(open(sys.argv[1]))
pixels, largest = int(sys.argv[2]), int(sys.argv[3])
mean = pixels * largest ** 2 / (24 * 16 * 4)
assert report["result"] == "different" and report["pixels"] == pixels and report["largest"] == largest
assert abs(report["mean_square"] - mean) < 1e-9 and abs(report["psnr"] - 10 * math.log10(255 ** 2 / mean)) < 1e-9
PY
holds 'and the differences are a picture' "$TRIPTYCH" compare "$work/difference.png" "$work/difference.png"

# --- Goldens ------------------------------------------------------------------------------------------------

verify=(verify "$work/four.tri" --engines batch --frames all --golden "$work/goldens")
holds 'goldens are written' status_of 0 '^4 goldens written to .*/goldens$' "${verify[@]}" --update
holds 'they are the pictures' cmp "$work/goldens/four-2.png" "$work/one-2.png"
holds 'goldens that are equal' status_of 0 '^4 goldens, 0 differ or are missing$' "${verify[@]}"
cp "$work/one-3.png" "$work/goldens/four-2.png"
holds 'a golden that differs' status_of 1 '^four: frame 2: golden .*/four-2.png: pixel .*; PSNR ' "${verify[@]}" \
    --difference "$work/differences" --json "$work/golden.json"
holds 'its difference is a picture' test -s "$work/differences/four-golden-frame-2.png"
holds 'its report names it' python3 - "$work/golden.json" <<'PY'
import json, sys
goldens = json.load(open(sys.argv[1]))["streams"][0]["goldens"]
assert [golden["result"] for golden in goldens] == ["identical", "identical", "different", "identical"]
PY
holds 'a golden within the tolerance' status_of 0 '^4 goldens, 0 differ' "${verify[@]}" --tolerance 30
rm "$work/goldens/four-2.png"
holds 'a frame other than the first needs no golden' status_of 0 '^3 goldens, 0 differ' "${verify[@]}"
rm "$work/goldens/four-0.png"
holds 'the first frame needs one' status_of 1 '^four: frame 0: golden .*/four.png: is missing$' "${verify[@]}"
cp "$work/one-0.png" "$work/goldens/four.png"
holds 'its name may have no number' status_of 0 '^3 goldens, 0 differ' "${verify[@]}"
cp "$work/sheet.png" "$work/goldens/four.png"
holds 'a golden of another size' status_of 1 'four.png: 72 x 32 pixels, the frame has 24 x 16$' "${verify[@]}"
refuses 'goldens in a missing folder' 'none: cannot be read: No such file' verify "$work/four.tri" --golden "$work/none"
mkdir "$work/broken" && echo >"$work/broken/four.png"
refuses 'a golden that is not a picture' 'four.png: ' verify "$work/four.tri" --engines batch --golden "$work/broken"
refuses 'tolerance without goldens' '--tolerance is given without --golden' verify "$work/four.tri" --tolerance 3

exit $failures
