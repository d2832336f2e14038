# Functions of the labs' checks. A check is a bash script that sources this file. It runs in the folder of the
# student's files and has these variables:
#
#   GIVEN    the lab's files that the student does not change
#   WORK     a folder for what the check builds; it is kept
#   ROOT     the top of the repository
#   BUILD    the folder of the project's own build, absolute
#   TRIPTYCH its command
#   CC       the C compiler
#
# A check performs its steps in order and ends at the first that fails.

# Reports a step: "ok TITLE", or "not yet TITLE", what COMMAND printed, and the end of the check.
step() # TITLE COMMAND...
{
    local title=$1 output
    shift
    if output=$("$@" 2>&1); then
        echo "ok       $title"
        [[ -z $output ]] || sed 's/^/             /' <<<"$output"
    else
        echo "not yet  $title"
        [[ -z $output ]] || sed 's/^/             /' <<<"$output"
        exit 1
    fi
}

# Fails if a line of predictions.txt has no number after its last colon.
predictions()
{
    local line
    [[ -f predictions.txt ]] || { echo 'expected a file predictions.txt' && return 1; }
    while IFS= read -r line; do
        [[ $line != '#'* && -n $line ]] || continue
        [[ ${line##*:} =~ ^\ *-?[0-9]+(\.[0-9]+)?\ *$ ]] ||
            { echo "predictions.txt: expected a number at the end of \"$line\"" && return 1; }
    done <predictions.txt
}

# The number of the prediction whose line begins with WORDS.
predicted() # WORDS
{
    sed -n "s/^$1.*: *\(-\{0,1\}[0-9.]*\) *$/\1/p" predictions.txt
}

# Executed instructions of a command, by valgrind.
instructions() # COMMAND...
{
    local report
    report=$(valgrind --tool=callgrind --callgrind-out-file=/dev/null "$@" 2>&1 >/dev/null) || {
        tail -n 3 <<<"$report"
        return 1
    }
    sed -n 's/.*Collected : *\([0-9]*\).*/\1/p' <<<"$report"
}

# Executed instructions of one repetition, for a command whose last argument is the number of repetitions:
# the difference between REPETITIONS and three times as many, 1000 by default.
instructions_each() # COMMAND...
{
    local repetitions=${REPETITIONS:-1000} once thrice
    once=$(instructions "$@" "$repetitions") && thrice=$(instructions "$@" $((3 * repetitions))) || return 1
    echo $(((thrice - once) / (2 * repetitions)))
}
