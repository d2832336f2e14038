# The check of lab 15.
. "$COURSE/course.bash"
streams=(bilinear two-textures bilinear-perspective multiply-add)

compile()
{
    $CC -std=gnu11 -O2 -Wall -Wextra -Werror -I"$GIVEN" -o "$WORK/check" balance.c "$GIVEN/check.c" -lm &&
        $CC -std=gnu17 -O2 -I"$ROOT" -I"$ROOT/src" -I"$ROOT/bench/peers" -I"$BUILD/include" -o "$WORK/rates" \
            "$GIVEN/rates.c" "$ROOT/bench/peers/limits.c"
}

# The instructions of the pixel routine, each with its address.
listing() # STREAM
{
    "$TRIPTYCH" dump "$ROOT/bench/streams/micro/$1.tri" --frame 1 --engine specialize-8 --show asm |
        awk '/^== asm/ { code = 1; next } code && $1 ~ /^[0-9a-f]+$/ && $2 != "constant" { sub(/ *(;.*)?$/, ""); print }'
}

# Those of the inner loop, without addresses: from the target of the first jump back to this jump.
loop() # STREAM
{
    listing "$1" | awk '{ address[NR] = $1; text = $0; sub(/^ *[0-9a-f]+ +/, "", text); line[NR] = text }
        $2 ~ /^j/ { target = substr($3, 3); for (i = 1; i < NR; i++) if (address[i] == target) {
            for (; i <= NR; i++) print line[i]; exit } }'
}

# Triptych counts the same with a disassembler.
whole()
{
    local stream count loads stores own
    for stream in "${streams[@]}"; do
        read -r count _ loads stores <<<"$(listing "$stream" | sed 's/^ *[0-9a-f]* *//' | "$WORK/check" count)"
        "$TRIPTYCH" bench "$ROOT/bench/streams/micro/$stream.tri" --code --engines specialize-8 --json "$WORK/code" \
            >/dev/null || return 1
        own=$(awk -F'[:,]' '/"unit"/ { pixel = $2 ~ /pixel/ } pixel && /"(instructions|reads|writes)"/ { printf "%d ", $2 }' \
            "$WORK/code")
        echo "$stream: $count instructions, $loads loads, $stores stores"
        [[ "$count $loads $stores " == "$own" ]] || { echo "expected $own" && return 1; }
    done
}

least() # FIELD: its first value in the report of bench
{
    sed -n "s/.*\"$1\":[^0-9]*\([0-9.]*\).*/\1/p" "$WORK/bench" | head -n 1
}

measure() # STREAM THREADS
{
    "$TRIPTYCH" bench "$ROOT/bench/streams/micro/$1.tri" --engines specialize-8 --threads "$2" --repetitions 5 --seconds 1 \
        --json "$WORK/bench" >/dev/null
}

# True if FOUND is within a factor of GUESS.
within() # FACTOR GUESS FOUND
{
    awk -v factor="$1" -v guess="$2" -v found="$3" 'BEGIN { exit !(guess * factor >= found && guess <= factor * found) }'
}

# Times are printed. The bound is judged, because nothing can be much faster: the clock of the core can
# change between the measurements, so a half is allowed. Predictions of counts must be right to a third.
sheet()
{
    local stream bottleneck bound count arithmetic loads stores ns guess rates
    rates=$("$WORK/rates" | tee "$WORK/rates.txt")
    [[ -n $rates ]] || return 1
    echo "$rates" | awk '{ print "in a ns: " $1 " instructions, " $2 " arithmetic, " $3 " loads, " $4 " stores; " $5 " bytes to memory" }'
    printf '%-20s %5s %6s %6s %6s  %-12s %8s %11s %6s\n' loop instr arith loads stores bottleneck bound-ns measured-ns factor
    for stream in "${streams[@]}"; do
        read -r count arithmetic loads stores <<<"$(loop "$stream" | "$WORK/check" count)"
        read -r bottleneck bound <<<"$(loop "$stream" | "$WORK/check" bound $rates)"
        measure "$stream" 1 || return 1
        ns=$(least pixel_ns_least)
        printf '%-20s %5d %6d %6d %6d  %-12s %8.2f %11.2f %6.2f\n' "$stream" "$count" "$arithmetic" "$loads" "$stores" \
            "$bottleneck" "$bound" "$ns" "$(awk "BEGIN { print $ns / $bound }")"
        awk "BEGIN { exit !($ns > $bound / 2) }" || { echo 'a pixel is much faster than its bound: expected a lower bound' && return 1; }
        guess=$(predicted "instructions for a block of $stream")
        [[ -z $guess ]] || within 1.34 "$guess" "$count" || {
            echo "predictions.txt: $guess instructions for a block of $stream, expected $count to a third: write the" \
                'steps of a pixel down, with the instructions of each'
            return 1
        }
        guess=$(predicted "ns of a pixel of $stream")
        [[ -z $guess ]] || echo "    predicted: $guess ns; $(awk "BEGIN { printf \"%.2f\", $guess / $ns }") of the measured time"
        [[ -z $guess ]] || within 10 "$guess" "$bound" || {
            echo "predictions.txt: $guess ns for a pixel of $stream, and a bound of $bound: expected the same unit, and 8" \
                'pixels in a block'
            return 1
        }
    done
}

# Overdraw and threads. Layers of bilinear-blend all pass; the target is cleared before.
frames()
{
    local row stream layers threads bound rates
    rates=$(<"$WORK/rates.txt")
    printf '%-20s %6s %7s %8s %11s\n' stream layers threads bound-ms measured-ms
    for row in 'bilinear-one 1 1' 'bilinear-one 1 2' 'bilinear-blend 16 1' 'bilinear-blend 16 2'; do
        read -r stream layers threads <<<"$row"
        bound=$(loop "$stream" | "$WORK/check" time $rates 1048576 "$layers" 12 "$threads" "$(nproc)")
        measure "$stream" "$threads" || return 1
        printf '%-20s %6d %7d %8.2f %11.2f\n' "$stream" "$layers" "$threads" "$bound" "$(least frame_ms_least)"
    done
}

step 'the files compile' compile
step 'step 1: what an instruction needs' "$WORK/check" rules
step 'step 1: whole routines' whole
step 'step 2: the time of a block' "$WORK/check" block
step 'step 3: the time of a frame' "$WORK/check" frame
step 'predictions' predictions
step 'step 4: the balance sheet' sheet
step 'step 5: overdraw and threads' frames
