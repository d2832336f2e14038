# The check of lab 10.
. "$COURSE/course.bash"

compile()
{
    $CC -std=c11 -O1 -Wall -Wextra -Werror -I"$GIVEN" -o "$WORK/check" letters.c translate.c "$GIVEN/check.c"
}

# Fails if the first two predictions differ from what the translations give.
counts()
{
    local name pixel component
    while read -r name pixel component; do
        echo "$name: $pixel with one pixel a register, $component with one component a register"
        [[ $name != add ]] ||
            [[ $(predicted 'add.*one pixel') == "$pixel" && $(predicted 'add.*one component') == "$component" ]] ||
            { echo 'the first two lines of predictions.txt: expected other numbers' && return 1; }
        [[ $name != shader ]] ||
            awk "BEGIN { printf \"shader: %.1f times, predicted %s\n\", $pixel / $component, \"$(predicted 'the shader')\" }"
    done < <("$WORK/check" count)
}

step 'the files compile' compile
step 'step 1: letters' "$WORK/check" letters
step 'step 2: one pixel a register' "$WORK/check" pixel
step 'step 3: one component a register' "$WORK/check" component
step 'predictions' predictions
step 'step 4: counts' counts
