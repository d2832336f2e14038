# The check of lab 8.
. "$COURSE/course.bash"

stream=$ROOT/bench/streams/teapot-bilinear.tri

compile()
{
    $CC -std=gnu11 -O1 -Wall -Wextra -Werror -I"$GIVEN" -o "$WORK/check" allocate.c "$GIVEN/check.c" &&
        "$TRIPTYCH" dump "$stream" --unit pixel --show hoist >"$WORK/program.txt"
}

# Values in slots in Triptych's own allocation, which has at most 13 registers.
own() # REGISTERS
{
    "$TRIPTYCH" dump "$stream" --unit pixel --engine specialize-8 --registers "$1" --show asm |
        sed -n 's/^== asm:.* \([0-9]*\) spilled.*/\1/p'
}

spills()
{
    local registers spilled slots before=
    "$WORK/check" table "$WORK/program.txt" >"$WORK/table" || { cat "$WORK/table" && return 1; }
    while read -r registers spilled slots; do
        echo "$registers registers: $spilled values in $slots slots, predicted $(predicted "values in slots with $registers");" \
            "Triptych spills $(own $((registers < 13 ? registers : 13)))"
        [[ -z $before ]] || ((spilled < before || spilled == 0)) || { echo 'expected fewer than with half the registers' && return 1; }
        before=$spilled
    done <"$WORK/table"
}

step 'the files compile' compile
step 'step 1: intervals' "$WORK/check" intervals
step 'step 2: each operand is in its place' "$WORK/check" places
step 'steps 3 and 4: few values in slots, in few slots' "$WORK/check" few
step 'predictions' predictions
step 'step 5: a pixel routine with 4, 8 and 16 registers' spills
