# The check of lab 11.
. "$COURSE/course.bash"

compile()
{
    nasm -f elf64 -o "$WORK/fragments.o" fragments.asm && nasm -f elf64 -o "$WORK/call.o" "$GIVEN/call.asm" &&
        $CC -std=c11 -O1 -Wall -Wextra -Werror -Wno-unused-function -ffp-contract=off -I"$GIVEN" -o "$WORK/check" \
            stitch.c "$GIVEN/record.c" "$GIVEN/check.c" "$WORK/fragments.o" "$WORK/call.o"
}

measure()
{
    local loop stitched
    loop=$(instructions_each "$WORK/check" run loop) && stitched=$(instructions_each "$WORK/check" run stitched) ||
        { echo "$loop$stitched" && return 1; }
    echo "a product of size 2, with the call: $loop instructions by the loop, $stitched stitched," \
        "predicted $(predicted 'instructions that the')"
    ((stitched < loop)) || { echo 'expected fewer instructions than by the loop' && return 1; }
}

step 'the files compile' compile
step 'step 1 and 2: fragments and their holes' "$WORK/check" holes
step 'step 3: the contract of each fragment' "$WORK/check" contract
step 'step 4: stitched products' "$WORK/check" stitch
step 'predictions' predictions
step 'step 5: executed instructions' measure
