# The check of lab 7.
. "$COURSE/course.bash"

compile()
{
    nasm -f elf64 -I "$GIVEN/" -I ./ -o "$WORK/frc.o" "$GIVEN/frc.asm" &&
        $CC -std=c11 -O2 -o "$WORK/check" "$GIVEN/check.c" "$WORK/frc.o" -lm
}

# Fails if a macro of frc.inc has no instruction, or more than LIMIT.
count() # MACRO LIMIT
{
    local number
    number=$(awk -v macro="$1" '
        $1 == "%macro" && $2 == macro { inside = 1; next }
        $1 == "%endmacro" { inside = 0 }
        inside { sub(/;.*/, ""); if (NF) number++ }
        END { print number + 0 }' frc.inc)
    ((number >= 1 && number <= $2)) || { echo "$1 has $number instructions, expected 1 to $2" && return 1; }
}

sequence() # MACRO LIMIT ROUTINE
{
    local status=0
    count "$1" "$2" || return 1
    "$WORK/check" "$3" || status=$?
    ((status != 3)) || echo 'this processor cannot execute it: not compared'
    ((status == 0 || status == 3))
}

old()
{
    count FRC_MMX 13 || return 1
    "$WORK/check" old >"$WORK/old" || { cat "$WORK/old" && return 1; }
}

# The predictions about step 1 must be right; the sequence can be wrong only where it is.
limits()
{
    local differences first
    read -r differences first <"$WORK/old"
    [[ $(predicted 'inputs from 0') == "$first" ]] ||
        { echo 'the first line of predictions.txt: expected another number. What does cvttps2pi do with large numbers?' && return 1; }
    [[ $(predicted 'number of bit') == "$differences" ]] ||
        { echo "the second line of predictions.txt: expected another number. Count patterns by exponent; what of -0?" && return 1; }
}

times()
{
    "$WORK/check" time mmx avx2 >"$WORK/times" || { echo 'this processor cannot execute AVX2: not measured' && return 0; }
    echo "$(<"$WORK/times") times, predicted $(predicted 'nanoseconds of step 1')"
}

step 'the sequences assemble' compile
step 'step 1: 13 instructions, right between -2^31 and 2^31' old
step 'predictions' predictions
step 'step 2: where step 1 is wrong' limits
step 'step 3: SSE4.1, all 2^32 inputs' sequence FRC_SSE41 3 sse41
step 'step 4: AVX2, all 2^32 inputs' sequence FRC_AVX2 2 avx2
step 'step 5: AVX-512, all 2^32 inputs' sequence FRC_AVX512 2 avx512
step 'step 6: time' times
