# The check of lab 9.
. "$COURSE/course.bash"

compile()
{
    $CC -std=gnu11 -O1 -Wall -Wextra -Werror -ffp-contract=off -I"$GIVEN" -o "$WORK/check" encode.c generate.c \
        "$GIVEN/shader.c" "$GIVEN/allocate.c" "$GIVEN/check.c"
}

same() # LANES...
{
    local lanes
    for lanes; do
        "$WORK/check" same "$lanes" || return 1
    done
}

# The instructions that the code executes for 16 elements, those with the calls, and the moves.
counts()
{
    local lanes instructions moves bytes all called guess
    printf '%6s %13s %11s %6s %10s\n' lanes instructions with-calls moves predicted
    for lanes in 1 4 8 16; do
        read -r instructions moves bytes <<<"$("$WORK/check" code $lanes)"
        all=$((instructions * 16 / lanes)) guess=$(predicted "instructions for 16 elements, $lanes lane")
        called=$(REPETITIONS=200 instructions_each "$WORK/check" run $lanes) || { echo "$called" && return 1; }
        printf '%6d %13d %11d %6d %10s\n' $lanes $all "$called" $((moves * 16 / lanes)) "$guess"
        ((called >= all)) || { echo 'expected the processor to execute each instruction of the code' && return 1; }
        awk -v guess="$guess" -v all=$all -v lanes=$lanes 'BEGIN { exit lanes < 16 && (guess < 0.9 * all || guess > 1.1 * all) }' || {
            echo "predictions.txt: expected a prediction for $lanes lanes that is right to a tenth: count the operations" \
                'of the recording, and the calls'
            return 1
        }
    done
    echo "moves with 16 lanes: $moves, predicted $(predicted 'moves to and from')"
    ((moves > 0)) || { echo 'expected values in the frame: 16 lanes need two registers for each value' && return 1; }
}

# Instructions of Triptych's routine for a pixel of a teapot, for 16 pixels.
own() # ENGINE LANES
{
    local instructions
    instructions=$("$TRIPTYCH" dump "$ROOT/bench/streams/teapot-bilinear.tri" --engine "$1" --show asm |
        grep -cE '^ *[0-9a-f]+  [a-z]')
    echo $((instructions * 16 / $2))
}

triptych()
{
    local one four eight sixteen
    one=$(own specialize-1 1) four=$(own specialize-4 4) eight=$(own specialize-8 8) sixteen=$(own specialize-8x2 16)
    echo "instructions for 16 pixels: $one with 1 lane, $four with 4, $eight with 8, $sixteen with 16 in two registers"
    awk -v one="$one" -v eight="$eight" -v guess="$(predicted Triptych)" \
        'BEGIN { printf "1 lane divided by 8 lanes: %.1f, predicted %s\n", one / eight, guess }'
}

step 'the files compile' compile
step 'step 1: 4 and 8 lanes, the same bits as 1 lane' same 1 4 8
step 'step 2: two parts of each value' "$WORK/check" split
step 'step 3: 16 lanes, the same bits' same 16
step 'predictions' predictions
step 'step 4: instructions and moves' counts
step 'step 5: a routine of Triptych' triptych
