#!/usr/bin/env bash
# A stream with the new call `clear-rectangle`: the picture is the same with every engine, after a conversion
# to a container and back, and after a recording of the calls.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
stream() # LINE...: the first frame clears the target, the rest draws on it
{
    printf '%s\n' 'triptych 1' 'target 16 8 depth d32f_lockable' 'clear color 0 0 1 1 depth 1' "$@" 'frame'
}
stream 'clear-rectangle 4 2 20 3 1 0.5 0 1' >"$work/new.tri"
stream 'scissor 4 2 12 3' 'state scissortestenable true' 'clear color 1 0.5 0 1' >"$work/old.tri"

"$TRIPTYCH" convert "$work/new.tri" "$work/text.tri"
"$TRIPTYCH" convert "$work/new.tri" "$work/new.trib"
"$TRIPTYCH" convert "$work/new.trib" "$work/back.tri"
cmp "$work/text.tri" "$work/back.tri"
grep -q '^clear-rectangle 4 2 20 3 1 0.5 0 1$' "$work/text.tri"

"$TRIPTYCH" verify "$work/new.tri" "$work/new.trib" >/dev/null
TRIPTYCH_RECORD=$work/recorded.trib "$TRIPTYCH" render --out "$work/new.png" "$work/new.tri" >/dev/null
"$TRIPTYCH" render --out "$work/old.png" "$work/old.tri" >/dev/null
"$TRIPTYCH" render --out "$work/recorded.png" "$work/recorded.trib" >/dev/null
"$TRIPTYCH" compare "$work/new.png" "$work/old.png" >/dev/null
"$TRIPTYCH" compare "$work/new.png" "$work/recorded.png" >/dev/null

for line in 'clear-rectangle 4 2 20 3 1 0.5 0' 'clear-rectangle 4 2 20 9000 1 0.5 0 1' 'clear-rectangle 4 2 20 3 1 0.5 inf 1'; do
    stream "$line" >"$work/bad.tri"
    if "$TRIPTYCH" convert "$work/bad.tri" "$work/bad.trib" 2>"$work/reason"; then
        echo "accepted: $line" >&2
        exit 1
    fi
    grep -q 'bad.tri:4:' "$work/reason"
done
