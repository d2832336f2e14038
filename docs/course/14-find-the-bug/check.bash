# The check of lab 14.
. "$COURSE/course.bash"
. "$COURSE/own.bash"

OWN_TRIPTYCH=$WORK/triptych PLANTED=$WORK/planted/triptych
STREAMS=(infinite fraction product exchange)
ENGINES=(batch specialize-1 specialize-4 specialize-8 specialize-thesis)
LAB=$(dirname "$GIVEN")

# The names of functions and the operands are those that gdb shows for these streams. All other facts but the file
# are computed from the renderer with the planted mistakes.
declare -A FUNCTION=([infinite]=execute_mul [fraction]=execute_frc [product]=execute_min [exchange]=execute_pass)
declare -A OPERAND=([infinite]=inf [fraction]=-11.0625 [product]=-1.46875)
declare -A FILE=([infinite]=src/engines/specialize/passes/reduce.c [fraction]=src/def/engine/select.def
    [product]=src/engines/specialize/passes/range.c [exchange]=src/engines/specialize/emit/move.c)

# The emulator is compiled without optimisation, for gdb.
compile()
{
    local name
    for name in "${STREAMS[@]}" zero factors; do
        "$GIVEN/stream.sh" $name >"$WORK/$name.tri" || return 1
    done
    OWN_MORE=object/emu/emulate/typed_each.o own_triptych
}

# Makes PLANTED: a renderer whose sources are the starting files.
plant()
{
    local folder=$WORK/planted-source
    rm -rf "$folder" && mkdir -p "$folder" "$WORK/planted" &&
        (cd "$ROOT" && xargs cp --parents -t "$folder" <"$LAB/sources") &&
        patch -s -p1 -d "$folder" <"$LAB/start.patch" && cd "$folder" && WORK=$WORK/planted own_triptych
}

# A text of a report of bisect.
fact() # NAME REPORT
{
    sed -n "s/^[[:space:]]*\"$1\":[[:space:]]*\"\(.*\)\",\{0,1\}$/\1/p" "$2"
}

# The engines of ENGINES that differ from emulate, with one of the two renderers.
differing() # COMMAND STREAM
{
    local list
    list=$(IFS=, && echo "${ENGINES[*]}")
    "$1" verify "$WORK/$2.tri" --threads 1 --engines "emulate,$list" |
        sed -n 's/.* and \(.*\) with 1 differ:.*/\1/p' | sort -u
}

# The answer to a question, in small letters, without the space around it.
answer() # STREAM FACT
{
    sed -n "s/^$1 $2: *\(.*[^ ]\) *$/\1/p" answers.txt | tr '[:upper:]' '[:lower:]'
}

# Fails if an answer is not among the given ones.
right() # STREAM FACT HINT ACCEPTED...
{
    local stream=$1 fact=$2 hint=$3 given
    shift 3
    given=$(answer "$stream" "$fact")
    printf '%s\n' "$@" | grep -qxF -- "${given:-nothing}" ||
        { echo "answers.txt, \"$stream $fact\": found \"$given\", expected another answer. $hint" && return 1; }
}

# True if the words of the answer are the given lines, in any order.
right_engines() # STREAM ENGINES
{
    [[ $(answer "$1" engines | tr -s ' ,' '\n' | sort -u) == "$2" ]] ||
        { echo "answers.txt, \"$1 engines\": expected the engines that verify names, of: ${ENGINES[*]}" && return 1; }
}

# A line of the specification, in small letters, without the space around it.
text_of() # FILE:LINE
{
    sed -n "${1##*:}s/^ *//p" "$ROOT/src/${1%:*}" | tr '[:upper:]' '[:lower:]'
}

# Compares the answers about a stream with what the planted renderer shows.
answers() # STREAM
{
    local stream=$1 engines report=$WORK/$1.json place pass cause
    [[ -f answers.txt ]] || { echo 'expected a file answers.txt' && return 1; }
    engines=$(differing "$PLANTED" "$stream")
    "$PLANTED" bisect "$WORK/$stream.tri" --engines "emulate,$(head -n 1 <<<"$engines")" --json "$report" >/dev/null
    place=$(fact place "$report") pass=$(fact pass "$report")
    cause=('back end' backend none 'no pass' 'registers, selection or encoding')
    [[ $pass != 'pass '* ]] || { pass=${pass#pass } && pass=${pass%% *} && cause=("$pass" "pass $pass"); }
    right_engines "$stream" "$engines" &&
        right "$stream" unit 'bisect names it.' "$(fact unit "$report")" &&
        right "$stream" operation 'bisect names it.' "$(fact operation "$report")" &&
        right "$stream" line 'bisect names a file and a line of it.' "$place" "src/$place" "${place##*/}" \
            "$(text_of "$place")" &&
        right "$stream" function 'It is the innermost whose name begins with execute_, in the backtrace.' \
            "${FUNCTION[$stream]}" &&
        { [[ -z ${OPERAND[$stream]-} ]] || right "$stream" operand 'Print it by gdb where the operation is wrong.' \
            "${OPERAND[$stream]}" "+${OPERAND[$stream]}"; } &&
        right "$stream" cause 'A pass without which the picture is right may only hide the mistake.' "${cause[@]}" &&
        right "$stream" file 'A rule can be right, and what it relies on wrong.' \
            "${FILE[$stream]}" "${FILE[$stream]#src/}" "${FILE[$stream]##*/}" &&
        echo "$(wc -l <<<"$engines") engines differ, predicted $(predicted "$stream, engines")"
}

# The passes without which the stream exchange is right.
passes()
{
    local pass count=0
    for pass in phi copy fold reduce common dead invariant hoist preload; do
        ! "$PLANTED" verify "$WORK/exchange.tri" --threads 1 --engines emulate,specialize-8 --without $pass \
            >/dev/null ||
            count=$((count + 1))
    done
    echo "exchange is right without one of $count passes, predicted $(predicted 'exchange, passes')"
}

agree() # STREAM...
{
    local list
    list=$(IFS=, && echo "${ENGINES[*]}")
    "$OWN_TRIPTYCH" verify "${@/#/$WORK/}" --threads 1 --engines "emulate,$list" | cut -c1-200
    return "${PIPESTATUS[0]}"
}

# Machine instructions of the routine of a pixel.
code() # COMMAND STREAM
{
    "$1" dump "$WORK/$2.tri" --show asm --engine specialize-8 | grep -cE '^ *[0-9a-f]+  [a-z]'
}

# A mended renderer makes code as short as the project's: no rule was removed.
short()
{
    local stream own expected
    for stream in "${STREAMS[@]}" zero; do
        own=$(code "$OWN_TRIPTYCH" $stream) expected=$(code "$TRIPTYCH" $stream)
        ((own <= expected)) || {
            echo "$stream: $own machine instructions, expected at most $expected: mend the rule, do not remove it"
            return 1
        }
    done
}

step 'your renderer compiles' compile
step 'the renderer with the mistakes compiles' plant
step 'predictions' predictions
for stream in "${STREAMS[@]}"; do
    step "the answers about $stream" answers $stream
done
step 'passes' passes
for stream in "${STREAMS[@]}"; do
    step "your renderer: $stream is right" agree $stream.tri
done
step 'your renderer: more streams' agree zero.tri factors.tri
step 'your renderer: no rule is lost' short
