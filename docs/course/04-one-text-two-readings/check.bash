# The check of lab 4.
. "$COURSE/course.bash"
. "$COURSE/own.bash"

OWN_TRIPTYCH=$WORK/triptych

# Makes the streams, and the picture that is expected.
streams()
{
    local name
    for name in add modulate subtract; do
        "$GIVEN/streams.sh" quad $name >"$WORK/$name.tri" || return 1
    done
    "$GIVEN/streams.sh" picture subtract >"$WORK/bytes.tri" &&
        "$GIVEN/streams.sh" picture subtract A32B32G32R32F >"$WORK/floats.tri" &&
        "$GIVEN/streams.sh" expected 'a + b - 2 * int(a * b / 255 + 0.5)' >"$WORK/expected.tri" &&
        "$TRIPTYCH" render "$WORK/expected.tri" --out "$WORK/expected.png"
}

compile()
{
    own_triptych && streams
}

# Compares the picture of a stream with the formula's.
picture() # NAME TOLERANCE
{
    "$OWN_TRIPTYCH" render "$WORK/$1.tri" --engine emulate --out "$WORK/$1.png" &&
        "$OWN_TRIPTYCH" compare "$WORK/$1.png" "$WORK/expected.png" --tolerance "$2" ||
        { echo "expected a + b - 2 * round(a * b / 255) in pixel (a, b)" && return 1; }
}

agree() # NAME...
{
    "$OWN_TRIPTYCH" verify "${@/%/.tri}" --threads 1 \
        --engines emulate,batch,stitch-operation,specialize-1,specialize-4,specialize-8,specialize-thesis | tail -n 1
}

# The fragments that were written by hand know nothing of the change.
hand_written()
{
    local output status=0
    output=$("$OWN_TRIPTYCH" verify "$WORK/bytes.tri" --threads 1 --engines emulate,stitch) || status=$?
    ((status == 1)) && grep 'differ' <<<"$output" | head -n 1 ||
        { echo "verify with the engines emulate and stitch: status $status, expected 1: a difference" && return 1; }
}

# Operations of the recording.
recorded() # OPERATION
{
    "$OWN_TRIPTYCH" dump "$WORK/$1.tri" --show record | grep -cE '^ *[0-9]+  [a-z]'
}

# Fields of the keys that two operations do not share.
fields() # OPERATION OPERATION
{
    diff <("$OWN_TRIPTYCH" dump "$WORK/$1.tri" --show key | tr ' ' '\n') \
        <("$OWN_TRIPTYCH" dump "$WORK/$2.tri" --show key | tr ' ' '\n') | grep -c '^>'
}

# Fails if the prediction whose line begins with WORDS is another number.
right() # WORDS NUMBER HINT
{
    [[ $(predicted "$1") == "$2" ]] || { echo "predictions.txt, \"$1\": expected another number. $3" && return 1; }
}

count()
{
    local add modulate own
    add=$(recorded add) modulate=$(recorded modulate) own=$(recorded subtract)
    right 'fields of the key' "$(fields modulate subtract)" 'The stream sets two states differently.' &&
        right 'operations recorded for modulate' $((modulate - add)) \
            'Count the calls of both forms, with their literals. Each runs for two pairs of channels.' &&
        right 'operations recorded for your' $((own - modulate)) 'Count the calls of your text.' &&
        echo "recorded: $add operations with add, $modulate with modulate, $own with yours"
}

# Machine instructions of the routine.
code() # OPERATION
{
    "$OWN_TRIPTYCH" dump "$WORK/$1.tri" --show asm --engine specialize-8 | grep -cE '^ *[0-9a-f]+  [a-z]'
}

step 'your renderer compiles' compile
step 'step 1: the operation in bytes, all 65,536 pairs' picture bytes 0
step 'step 2: the engines that read the text agree' agree "$WORK/bytes"
step 'step 3: the operation in binary32' picture floats 1
step 'step 3: the engines agree about it too' agree "$WORK/bytes" "$WORK/floats"
step 'step 4: the engine with fragments written by hand draws the old operation' hand_written
step 'predictions' predictions
step 'step 5: the key and the recording, for three operations' count
echo "         machine instructions for eight pixels: $(code add) with add, $(code modulate) with modulate, $(code subtract) with yours"
