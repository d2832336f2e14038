# The check of lab 6.
. "$COURSE/course.bash"

compile()
{
    $CC -std=gnu11 -O1 -Wall -Wextra -Werror -Wno-unused-variable -ffp-contract=off -I"$GIVEN" -I"$ROOT/src" \
        -o "$WORK/check" passes.c "$GIVEN/check.c" -lm &&
        "$TRIPTYCH" dump "$ROOT/bench/streams/teapot-lit.tri" --unit vertex --show record >"$WORK/record.txt"
}

# A dead chain of 8 times the length must take about 8 times the instructions.
one_walk()
{
    local short long
    short=$(instructions "$WORK/check" run 300) && long=$(instructions "$WORK/check" run 2400) ||
        { echo "$short$long" && return 1; }
    echo "instructions for a dead chain of 300: $short, of 2,400: $long"
    ((long < 16 * short)) || { echo 'expected at most 16 times those for 8 times the length: one walk' && return 1; }
}

color()
{
    "$WORK/check" color "$WORK/record.txt" || return 1
    echo "predicted: $(predicted 'instructions that go') go, $(predicted 'instructions that remain') remain"
}

step 'the files compile' compile
step 'step 1: copies' "$WORK/check" copy "$WORK/record.txt"
step 'step 2: dead code' "$WORK/check" dead "$WORK/record.txt"
step 'step 3: one walk' one_walk
step 'predictions' predictions
step 'step 4: a lit vertex without its colour' color
