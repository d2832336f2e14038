# The check of lab 5.
. "$COURSE/course.bash"

compile()
{
    $CC -std=c11 -O2 -Wall -Wextra -Werror -Wno-unused-function -ffp-contract=off -I"$GIVEN" -o "$WORK/check" range.c reduce.c \
        "$GIVEN/check.c" -lm
}

counterexamples()
{
    local name answer rules=0
    while read -r name answer; do
        [[ -n $name && $name != '#'* ]] || continue
        "$WORK/check" rule "$name" "$answer" || return 1
        ((++rules))
    done <counterexamples.txt
    ((rules == 6)) || { echo "counterexamples.txt has $rules rules, expected 6" && return 1; }
}

step 'the files compile' compile
step 'step 1: inputs that break the rules' counterexamples
step 'step 2: ranges' "$WORK/check" range
step 'step 3: the reduction' "$WORK/check" reduce
