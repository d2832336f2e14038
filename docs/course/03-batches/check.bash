# The check of lab 3.
. "$COURSE/course.bash"

compile()
{
    $CC -std=c11 -O1 -Wall -Wextra -Werror -ffp-contract=off -I"$GIVEN" -o "$WORK/check" batch.c "$GIVEN/naive.c" \
        "$GIVEN/check.c"
}

# Instructions of 512 elements in batches of SIZE.
each() # SIZE
{
    instructions_each "$WORK/check" run "$1"
}

counts()
{
    local naive few many
    naive=$(REPETITIONS=20 each 0) && few=$(REPETITIONS=20 each 4) && many=$(REPETITIONS=20 each 64) ||
        { echo "$naive$few$many" && return 1; }
    awk -v naive="$naive" -v few="$few" -v many="$many" -v four="$(predicted '.*of 4')" -v large="$(predicted '.*of 64')" 'BEGIN {
        printf "instructions for an element: %.0f one by one, %.0f in batches of 4, %.0f of 64\n", naive / 512, few / 512,
            many / 512
        printf "divided: %.1f, predicted %s; %.1f, predicted %s\n", naive / few, four, naive / many, large
        if (naive / many < 1.5) {
            print "expected less than two thirds of the instructions in batches of 64"
            exit 1
        }
    }'
}

# Simulated misses of a first-level cache of 32 KiB, for 512 elements, many times.
misses() # SIZE
{
    valgrind --tool=cachegrind --cache-sim=yes --D1=32768,8,64 --cachegrind-out-file=/dev/null \
        "$WORK/check" run "$1" 60 2>&1 | sed -n 's/.*D1 *misses: *\([0-9,]*\).*/\1/p' | tr -d ,
}

cache()
{
    local fits=$(predicted 'largest power') inside outside
    "$WORK/check" bytes || return 1
    inside=$(misses "$fits") && outside=$(misses $((fits * 4))) || { echo "$inside$outside" && return 1; }
    echo "misses of a cache of 32 KiB: $inside in batches of $fits, $outside in batches of $((fits * 4))"
    ((inside * 4 < outside)) ||
        { echo "expected at least four times the misses when a batch is four times the largest that fits" && return 1; }
    ((2 * $(misses $((fits * 2))) > outside)) ||
        { echo "a batch of $((fits * 2)) fits too: expected a larger number in predictions.txt" && return 1; }
}

step 'the files compile' compile
step 'step 1: batches, the same bits' "$WORK/check" same
step 'predictions' predictions
step 'step 2: instructions' counts
step 'step 3: the cache' cache
