# The check of lab 2.
. "$COURSE/course.bash"
EMULATOR=-O2 # counted
. "$COURSE/own.bash"

OWN_TRIPTYCH=$WORK/triptych

compile()
{
    own_triptych
}

# Compares the bits of a picture with those of the project's renderer.
same() # INSTRUCTION
{
    "$GIVEN/stream.sh" 1 "$1" >"$WORK/one.tri" &&
        "$TRIPTYCH" render "$WORK/one.tri" --engine emulate --out "$WORK/expected.exr" &&
        "$OWN_TRIPTYCH" render "$WORK/one.tri" --engine emulate --out "$WORK/found.exr" || return 1
    cmp -s "$WORK/expected.exr" "$WORK/found.exr" ||
        { echo "$1: some pixel has other bits than expected, $WORK/found.exr" && return 1; }
}

instruction()
{
    same 'lrp r0, r1, r2, r3' && same 'lrp r0, r3, r0, r1' && same 'lrp_sat r0.xz, -r1, r2_abs.yzwx, r3.w' &&
        same 'lrp r0, r1, r2, r3_abs' && same 'lrp r0.w, r2.x, r1.y, r0.z'
}

agree()
{
    "$GIVEN/stream.sh" 10 'lrp r0.xyz, r1, r0, r3' >"$WORK/ten.tri" &&
        "$OWN_TRIPTYCH" verify "$WORK/ten.tri" --threads 1 --engines emulate,batch,specialize | tail -n 1
}

# Operations of the recording that 10 slots of an instruction add, divided by 10.
recorded() # INSTRUCTION
{
    local slots count=()
    for slots in 10 20; do
        "$GIVEN/stream.sh" $slots "$1" >"$WORK/slots.tri"
        count+=("$("$OWN_TRIPTYCH" dump "$WORK/slots.tri" --show record | grep -cE '^ *[0-9]+  (flt|itg|fix|msk) ')")
    done
    echo $(((count[1] - count[0]) / 10))
}

arithmetic()
{
    local whole one
    whole=$(recorded 'lrp r0, r1, r2, r3') one=$(recorded 'lrp r0.x, r1, r2, r3')
    ((whole == 4 * one)) ||
        { echo "lrp r0.x records $one operations, expected a quarter of those of lrp r0, $whole" && return 1; }
    [[ $(predicted 'arithmetic') == "$whole" ]] ||
        { echo 'predictions.txt, "arithmetic operations": expected another number; count the calls of your text' && return 1; }
}

# A profile of the emulator with SLOTS slots, by valgrind.
profile() # SLOTS
{
    "$GIVEN/stream.sh" "$1" 'lrp r0, r1, r2, r3' >"$WORK/slots.tri"
    valgrind --tool=callgrind --compress-pos=no --compress-strings=no --cache-sim=yes --branch-sim=yes \
        --callgrind-out-file="$WORK/profile-$1" \
        "$OWN_TRIPTYCH" render "$WORK/slots.tri" --engine emulate --threads 1 --out "$WORK/found.exr" >"$WORK/log" 2>&1 ||
        { tail -n 3 "$WORK/log" && return 1; }
}

count()
{
    profile 10 && profile 20 || return 1
    awk -v groups=256 -f "$GIVEN/profile.awk" "$WORK/profile-10" "$WORK/profile-20" | tee "$WORK/table"
    printf '%-30s %12s %8s %10s\n' predicted "$(predicted instructions)" "$(predicted loads)" "$(predicted decisions)"
    awk -v decisions="$(predicted decisions)" -v instructions="$(predicted instructions)" '$1 == "sum" {
        if (decisions * 3 < $4 || decisions > $4 * 3 || instructions * 3 < $2 || instructions > $2 * 3) {
            print "expected predictions of the instructions and decisions that are at most three times too small or too large"
            exit 1
        }
    }' "$WORK/table"
}

# Processor time of the emulator with SLOTS slots, in ms.
milliseconds() # SLOTS
{
    local TIMEFORMAT=%U
    "$GIVEN/stream.sh" "$1" 'lrp r0, r1, r2, r3' >"$WORK/slots.tri"
    { time "$OWN_TRIPTYCH" render "$WORK/slots.tri" --engine emulate --threads 1 --out "$WORK/found.exr" >/dev/null; } 2>&1 |
        tr -d .
}

# The difference of the times by the number of slots and groups of pixels.
times()
{
    local few many
    few=$(milliseconds 10) many=$(milliseconds 510)
    awk -v ms=$((10#$many - 10#$few)) -v predicted="$(predicted nanoseconds)" '$1 == "sum" {
        ns = ms * 1e6 / 500 / 256
        if (ns <= 0) {
            print "510 slots do not take more time than 10: run the check again when the machine has less to do"
            exit 1
        }
        printf "%.0f ns for one lrp and four pixels, predicted %s: %.1f instructions in a ns\n", ns, predicted, $2 / ns
    }' "$WORK/table"
}

step 'your renderer compiles' compile
step 'step 1: the instruction, bit by bit' instruction
step 'step 2: emulate, batch and specialize agree' agree
step 'predictions' predictions
step 'step 3: arithmetic' arithmetic
step 'step 4: instructions, loads, decisions' count
step 'step 5: time' times
