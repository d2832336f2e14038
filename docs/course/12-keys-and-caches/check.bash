# The check of lab 12.
. "$COURSE/course.bash"

compile()
{
    $CC -std=c11 -O2 -Wall -Wextra -Werror -Wno-unused-function -I"$GIVEN" -o "$WORK/check" key.c cache.c \
        "$GIVEN/shade.c" "$GIVEN/check.c"
}

replay()
{
    local room fifo lru large= small=
    while read -r room fifo lru; do
        echo "room for $room routines: $fifo misses with FIFO, $lru with LRU"
        [[ $room != 32 ]] || large=$lru
        [[ $room != 16 ]] || small=$lru
    done < <("$WORK/check" replay)
    echo "predicted with LRU: $(predicted '.*for 32') for 32, $(predicted '.*for 16') for 16"
    awk -v predicted="$(predicted '.*for 32')" -v found="$large" 'BEGIN { exit !(predicted > found / 2 && predicted < 2 * found) }' ||
        { echo "expected a prediction for 32 within a factor of two of $large" && return 1; }
}

step 'the files compile' compile
step 'step 1: keys, all that is needed' "$WORK/check" needed
step 'step 2: keys, no more than that' "$WORK/check" tight
step 'step 3: the cache' "$WORK/check" cache
step 'predictions' predictions
step 'step 4: draws of a game' replay
