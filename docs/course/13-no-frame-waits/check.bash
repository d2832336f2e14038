# The check of lab 13.
. "$COURSE/course.bash"

compile()
{
    $CC -std=c11 -O2 -Wall -Wextra -Werror -I"$GIVEN" -o "$WORK/check" policy.c "$GIVEN/replay.c" "$GIVEN/check.c"
}

# The table of policies, and what was predicted of it. The first number only needs the trace and a
# multiplication.
street()
{
    local table status=0 waits
    table=$("$WORK/check" play "$GIVEN/street.trace") || status=$?
    printf '%s\n' "$table"
    ((status == 0)) || return 1
    waits=$(awk '$2 == "external" && $3 == "wait" { print $4; exit }' <<<"$table")
    echo "a frame waits for external: $waits ms, predicted $(predicted 'worst frame in ms')"
    awk '$1 == "stitch," && $3 == "yours" { print "builds of " $2 ": " $7 }' <<<"$table" | head -n 1
    echo "  predicted $(predicted '.*stitch then specialize'); for stitch then external $(predicted '.*stitch then external')"
    awk '$1 == "batch," && $2 == "specialize" && $3 == "yours" { print "worst frame with batch, divided by warm: " $5 }' \
        <<<"$table"
    echo "  predicted $(predicted 'worst frame divided')"
    awk -v guess="$(predicted 'worst frame in ms')" -v found="$waits" \
        'BEGIN { exit !(guess > found / 2 && guess < 2 * found) }' || {
        echo "expected a prediction for external within a factor of two of $waits: count the routines of the first" \
            'frame, and multiply by the time of a build'
        return 1
    }
}

# Times of this machine, which are not judged, and counts of Triptych's tiers. The pictures are.
triptych()
{
    local stream=$ROOT/bench/streams/teapot-lit.tri
    "$TRIPTYCH" bench --cold --frames 6 --repetitions 3 --seconds 1 --engines stitch,specialize,tiered,external \
        "$stream" || return 1
    "$TRIPTYCH" bench --counts --frames 2 --engines tiered-swap,tiered:runs=100:wait "$ROOT/bench/streams/street.tri" |
        grep -E '^stream +engine +tier|(stitch|specialize) +[0-9]' || return 1
    "$TRIPTYCH" verify "$stream" --frames 1 --engines stitch,specialize,tiered,tiered-swap >"$WORK/verify" || {
        cat "$WORK/verify"
        return 1
    }
    echo 'all tiers give the same bytes'
}

step 'the files compile' compile
step 'step 1: when a build is worth its time' "$WORK/check" request
step 'step 2: the next build' "$WORK/check" next
step 'step 3: time in each frame' "$WORK/check" budget
step 'step 4: little memory' "$WORK/check" room
step 'predictions' predictions
step 'step 5: sixty frames of a street' street
step 'step 6: tiers of Triptych' triptych
