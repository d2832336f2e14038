# The check of lab 1.
. "$COURSE/course.bash"

compile()
{
    $CC -std=c11 -O1 -Wall -Wextra -Werror -ffp-contract=off -I"$GIVEN" -o "$WORK/check" \
        product.c record.c generate.c "$GIVEN/encode.c" "$GIVEN/check.c" -lm
}

# One product's instructions, for each kind, beside the prediction.
measure()
{
    local generic written generated
    generic=$(instructions_each "$WORK/check" run generic) &&
        written=$(instructions_each "$WORK/check" run written-out) &&
        generated=$(instructions_each "$WORK/check" run generated) || { echo "$generic$written$generated" && return 1; }
    echo "instructions, with the call:   measured  predicted"
    printf '%-30s %8d %10s\n' generic "$generic" "$(predicted 'instructions that one generic')" \
        written-out "$written" "$(predicted 'instructions that one written-out')" \
        generated "$generated" "$(predicted 'instructions of the generated')"
    ((written * 2 < generic)) || { echo "expected less than half the instructions of generic in written-out" && return 1; }
    ((generated * 2 < generic)) || { echo "expected less than half the instructions of generic in generated" && return 1; }
}

step 'the files compile' compile
step 'step 1: the product that is written out' "$WORK/check" written-out
step 'steps 2 and 3: the recording' "$WORK/check" record
step 'step 4: the generated code' "$WORK/check" generate
step 'predictions' predictions
step 'step 5: executed instructions' measure
