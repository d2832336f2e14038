#!/bin/bash
# Manual pages and completions of shells that the command writes: `triptych help --as FORM`.
# Given TRIPTYCH by tests/support/scripts/run.sh. One build suffices.
# Runs once.
set -uo pipefail
cd "$(dirname "$0")/.."

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

verdict() # NAME EXPECTED GOT
{
    if [[ $2 == "$3" ]]; then
        printf 'ok %s\n' "$1"
    else
        printf 'FAIL %s\n     expected: %s\n     got:      %s\n' "$1" "$2" "$3"
        failures=1
    fi
}

commands=$("$TRIPTYCH" --help | sed -nE 's/^  ([a-z]+) .*/\1/p')
for form in bash zsh fish; do
    "$TRIPTYCH" help --as $form >"$work/$form" || failures=1
done

# --- Manual pages -------------------------------------------------------------------------------------------

# Pages have no date, so that equal sources make equal files.
lint() # FILE
{
    mandoc -Tlint -Wwarning "$1" 2>&1 | grep -v 'missing date, using ""'
    ! command -v groff >/dev/null || groff -man -ww -z "$1" 2>&1
}

for command in '' $commands; do
    "$TRIPTYCH" help $command --as man >"$work/page.1"
    verdict "manual page of triptych ${command:-itself} has no warning" '' "$(lint "$work/page.1")"
done

text_of() # COMMAND
{
    "$TRIPTYCH" help "$1" --as man | mandoc -Tutf8 | sed 's/.\x08//g'
}

# Every option of the help is in the page, with a hyphen that can be copied.
for command in $commands; do
    text_of "$command" >"$work/text"
    missing=
    while read -r option; do
        grep -qF -- "$option" "$work/text" || missing+=" $option"
    done < <("$TRIPTYCH" "$command" --help | sed -nE 's/^  (--[a-z-]+).*/\1/p')
    verdict "manual page of $command has all its options" '' "$missing"
done
verdict 'a default in the help is a value, not a note' '' \
    "$(for command in $commands; do "$TRIPTYCH" "$command" --help; done | grep -E '\(default: ([^)]*may|auto:)')"
verdict 'manual page names the words of an option' 1 "$(text_of dump | grep -cF 'One of: vertex, setup, pixel.')"
verdict 'and of a list, with stages of another engine' 1 "$(text_of dump | tr -s ' \n' ' ' | grep -cE 'parts, .*vector, whole')"
verdict 'manual page has the rows of a table, also of a point' 1 "$(text_of view | grep -cE '^ +\. +one more draw')"
verdict 'manual page of the program names each command' '' \
    "$(for command in $commands; do
        grep -qF "triptych-$command(1)" < <("$TRIPTYCH" help --as man | mandoc -Tutf8 | sed 's/.\x08//g') || echo "$command"
    done)"

# --- bash ---------------------------------------------------------------------------------------------------

mkdir "$work/folder" "$work/folder/inner"
touch "$work/folder/"{horse.tri,house.trib,hound.png,hour.exr}
source "$work/bash"

# The words that bash would insert. Like readline, a line is cut at spaces and around =.
words() # LINE
{
    local line=$1
    read -ra COMP_WORDS <<<"${line//=/ = }"
    [[ $line != *[\ =] ]] || COMP_WORDS+=('')
    COMP_CWORD=$((${#COMP_WORDS[@]} - 1)) COMPREPLY=()
    (cd "$work/folder" && { _triptych; true; } && printf '%s\n' "${COMPREPLY[@]}" | sort | paste -sd' ')
}

completes() # LINE WORDS...
{
    verdict "bash completes \"$1\"" "${*:2}" "$(words "$1")"
}

completes 'triptych re' render
completes 'triptych --ver' --version
completes 'triptych render --eng' --engine
completes 'triptych render --engine emul' emulate
completes 'triptych render --engine=emul' emulate
completes 'triptych dump --unit ' pixel setup vertex
completes 'triptych verify --engines stitch,emul' stitch,emulate
completes 'triptych dump --show key,as' key,asm
completes 'triptych list sha' shaders
completes 'triptych shader ' assemble disassemble validate
completes 'triptych help con' convert
completes 'triptych render ho' horse.tri house.trib
completes 'triptych render --threads 3 ho' horse.tri house.trib
completes 'triptych render --threads=3 ho' horse.tri house.trib
completes 'triptych render --threads ' ''
completes 'triptych render horse.tri ' ''
completes 'triptych verify horse.tri ho' horse.tri house.trib
completes 'triptych render --out ho' hound.png hour.exr
completes 'triptych verify --golden ' inner
completes 'triptych compare ho' hound.png
completes 'triptych shader assemble ho' horse.tri hound.png hour.exr house.trib

for command in $commands; do
    verdict "bash completes the options of $command" \
        "$("$TRIPTYCH" "$command" --help | sed -nE 's/^  (--[a-z-]+).*/\1/p; s/^  -h, (--help).*/\1/p' | sort | paste -sd' ')" \
        "$(words "triptych $command --")"
done

# The same by pressing the tabulator in a shell of its own, on a terminal.
cat >"$work/press.py" <<'PY'
import os, pty, select, sys, time
script, folder = sys.argv[1:]
child, terminal = pty.fork()
if child == 0:
    os.chdir(folder)
    os.environ.update(TERM="dumb", PS1="ready> ", INPUTRC="/dev/null")
    os.execvp("bash", ["bash", "--norc", "--noprofile", "-i"])

seen = b""
def wait(text):
    global seen
    end = time.time() + 30
    while text not in seen and time.time() < end:
        if select.select([terminal], [], [], 0.1)[0]:
            seen += os.read(terminal, 4096)
    if text not in seen:
        sys.exit("expected %r, got %r" % (text, seen))
    seen = seen[seen.index(text) + len(text):]

def press(keys, expected):
    os.write(terminal, keys)
    wait(expected)

wait(b"ready> ")
press(b"source '" + script.encode() + b"'\r", b"ready> ")
press(b"triptych ver\t", b"triptych verify ")
press(b"--engi\t", b"--engines ")
press(b"emulate,tiered-\t", b"emulate,tiered-swap")
press(b" horse\t", b" horse.tri ")
PY
verdict 'bash completes on a terminal' '' "$(python3 "$work/press.py" "$work/bash" "$work/folder" 2>&1)"

# --- zsh and fish -------------------------------------------------------------------------------------------

verdict 'completion of zsh has no error' '' "$(zsh -n "$work/zsh" 2>&1)"
verdict 'completion of fish has no error' '' "$(fish --no-execute "$work/fish" 2>&1)"

fish_words() # LINE
{
    (cd "$work/folder" && HOME=$work fish --no-config -c "source $work/fish; complete -C '$1'" 2>&1) | cut -f1 | sort | paste -sd' '
}
verdict 'fish completes a command' render "$(fish_words 'triptych rend')"
verdict 'fish completes an option' --engine "$(fish_words 'triptych render --eng')"
verdict 'fish completes a word' emulate "$(fish_words 'triptych render --engine emul')"
verdict 'fish completes a list' stitch,emulate "$(fish_words 'triptych verify --engines stitch,emul')"

# A terminal of zsh's own shows what the tabulator inserts.
cat >"$work/press.zsh" <<'ZSH'
zmodload zsh/zpty
zpty shell zsh -f -i
seen=
wait_for() { # TEXT
    local more end=$((SECONDS + 30))
    while [[ $seen != *$1* && $SECONDS -lt $end ]]; do
        if zpty -rt shell more; then seen+=${more//[^[:print:]]/}; else sleep 0.05; fi
    done
    [[ $seen == *$1* ]] || { print -r -- "expected $1, got $seen"; exit 1; }
    seen=
}
zpty -w shell "PS1=; fpath=($1 \$fpath); autoload -Uz compinit; compinit -u -D; print rea''dy"
wait_for ready
zpty -n -w shell $'triptych rend\t'
wait_for render
zpty -n -w shell $'--engine=emul\t'
wait_for emulate
ZSH
mkdir "$work/functions" && cp "$work/zsh" "$work/functions/_triptych"
verdict 'zsh completes on a terminal' '' "$(TERM=dumb zsh -f "$work/press.zsh" "$work/functions" 2>&1)"

exit $failures
