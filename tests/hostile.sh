#!/bin/bash
# Limits and environments that others choose: limits on file sizes and stacks, paths that look like options,
# and processes with more rights than their users.
# Given BUILD, TRIPTYCH and SANITIZE by tests/support/scripts/run.sh.
set -uo pipefail
cd "$(dirname "$0")/.."

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0
stream=tests/data/streams/frames.tri

verdict() # NAME PROBLEM : ok when there is none
{
    if [[ -z $2 ]]; then
        printf 'ok %s\n' "$1"
    else
        printf 'FAIL %s: %s\n' "$1" "$2"
        sed 's/^/     /' "$work/said" | head -n 5
        failures=1
    fi
}

# The command ends with status 2 and one line that matches the pattern. Nothing is left in the folder "out".
refuses() # NAME PATTERN COMMAND...
{
    local name=$1 pattern=$2 status=0 problem=
    shift 2
    rm -rf "$work/out" && mkdir "$work/out"
    timeout 60 "$@" >/dev/null 2>"$work/said" </dev/null || status=$?
    if ((status != 2)); then
        problem="exit status $status, expected 2"
    elif (($(wc -l <"$work/said") != 1)); then
        problem="$(wc -l <"$work/said") lines, expected 1"
    elif ! grep -qE -- "$pattern" "$work/said"; then
        problem="no \"$pattern\""
    elif [[ $(ls -A "$work/out") ]]; then
        problem="left behind: $(ls -A "$work/out")"
    fi
    verdict "$name" "$problem"
}

succeeds() # NAME COMMAND...
{
    local name=$1 status=0
    shift
    timeout 300 "$@" >"$work/said" 2>&1 </dev/null || status=$?
    verdict "$name" "${status/#0/}"
}

limited() # ULIMIT-OPTION VALUE COMMAND...
{
    ulimit -S "$1" "$2" && ulimit -H "$1" "$2" && shift 2 && "$@"
}
export -f limited

# A small picture of many random triangles: its container is larger than the picture.
{
    printf 'triptych 1\ntarget 16 16\nclear color 0 0 0 1 depth 1\nstate lighting false\nvertices many position:float3 {\n'
    awk 'BEGIN { srand(1); for (i = 0; i < 300; i++) print rand(), rand(), rand() }'
    printf '}\nbind vertices many\ndraw triangles 0 100\nframe\n'
} >"$work/many.tri"

# --- File sizes ------------------------------------------------------------------------------------------

# 1,024 bytes.
within=(bash -c 'limited -f 1 "$@"' limited)

refuses 'a picture beyond a limit on file sizes' 'out/a.png: cannot write: File too large' \
    "${within[@]}" "$TRIPTYCH" render "$stream" --engine emulate --out "$work/out/a.png"
refuses 'an EXR picture beyond it' 'out/a.exr: cannot write: File too large' \
    "${within[@]}" "$TRIPTYCH" render "$stream" --engine emulate --out "$work/out/a.exr"
refuses 'a container beyond it' 'out/a.trib: cannot write: File too large' \
    "${within[@]}" "$TRIPTYCH" convert "$work/many.tri" "$work/out/a.trib"
refuses 'a recording beyond it' 'out/a.trib: cannot write: File too large' \
    env TRIPTYCH_RECORD="$work/out/a.trib" "${within[@]}" "$TRIPTYCH" render "$work/many.tri" --engine emulate --out "$work/small.png"
printf 'before' >"$work/kept.png"
refuses 'a picture that exists, beyond it' 'kept.png: cannot write: File too large' \
    "${within[@]}" "$TRIPTYCH" render "$stream" --engine emulate --out "$work/kept.png"
verdict 'which stays as it was' "$([[ $(<"$work/kept.png") == before ]] || echo changed)"
status=0
bash -c 'limited -f 1 "$@" >"$0"' "$work/list" "$TRIPTYCH" list states 2>"$work/said" || status=$?
verdict 'standard output beyond it' "$(((status == 2)) && grep -q 'cannot write to standard output: File too large' \
    "$work/said" || echo "exit status $status")"

# --- Stacks ----------------------------------------------------------------------------------------------

# A sanitizer's process does not start on such a stack.
if [[ ! ${SANITIZE-} ]]; then
    within=(bash -c 'limited -s 64 "$@"' limited)
    for subcommand in 'verify' 'bench --frames 1 --seconds 0.01' "render --out $work/a.png" 'dump' 'bisect'; do
        succeeds "${subcommand%% *} on a stack of 64 KiB" "${within[@]}" "$TRIPTYCH" $subcommand "$stream"
    done
    XDG_CACHE_HOME=/dev/null succeeds 'a model on a stack of 64 KiB' "${within[@]}" \
        "$TRIPTYCH" render bench/streams/cat.tri --engine emulate --out "$work/cat.png"
fi

# --- Paths that look like options ------------------------------------------------------------------------

if grep -q '^external .* available' < <("$TRIPTYCH" list engines); then
    program=$(realpath "$TRIPTYCH") small=$(realpath "$stream")
    for folder in -x @x; do
        mkdir -p "$work/here/$folder"
        succeeds "external with TMPDIR=$folder" env -C "$work/here" TMPDIR="$folder" \
            "$program" render "$small" --engine external --out "$work/external.png"
        verdict "which leaves nothing there" "$(ls -A "$work/here/$folder")"
    done
fi

refuses 'an empty path of a stream' 'render: "": is not a path, expected that of a file' \
    "$TRIPTYCH" render '' --out "$work/out/a.png"
refuses 'an empty path of a picture' 'compare: "": is not a path' "$TRIPTYCH" compare '' "$work/kept.png"

# --- More rights than the user ---------------------------------------------------------------------------

# A setuid program that another user starts. Only root can make one.
if ((EUID)) || [[ ${SANITIZE-} ]] || ! command -v setpriv >/dev/null; then
    printf 'ok setuid programs are not tested: this needs root, setpriv and no sanitizer\n'
else
    chmod 755 "$work"
    cp "$TRIPTYCH" "$work/setuid"
    cp "$stream" "$work/stream.tri"
    chmod 4755 "$work/setuid"
    mkdir -m 777 "$work/cache" "$work/temporary" "$work/user"
    printf '#!/bin/sh\ntouch "%s"\nexit 1\n' "$work/user/ran" >"$work/cc"
    chmod 755 "$work/cc"
    cp "$work/cc" "$work/compiler"
    as_user() # COMMAND...
    {
        env PATH="$work:$PATH" TRIPTYCH_CC="$work/compiler" TMPDIR="$work/temporary" TRIPTYCH_CPU=-avx2 \
            XDG_CACHE_HOME="$work/cache" TRIPTYCH_RECORD="$work/cache/recording.trib" \
            setpriv --reuid=65534 --clear-groups "$@"
    }
    export -f as_user
    export work
    refuses 'a setuid program starts no compiler' 'more rights than its user' bash -c 'as_user "$@"' as_user \
        "$work/setuid" render "$work/stream.tri" --engine external --out "$work/user/a.png"
    verdict 'not even one that its user names' "$(ls -A "$work/user" "$work/temporary" | grep -v :)"
    as_user "$work/setuid" list cpu >"$work/said" 2>&1
    verdict 'a setuid program hides no features' "$(grep -o 'avx2 *hidden' "$work/said")"
    as_user "$work/setuid" render "$work/stream.tri" --engine emulate --out "$work/user/b.png" >"$work/said" 2>&1
    verdict 'a setuid program draws' "$([[ -s $work/user/b.png ]] || echo no picture)"
    verdict 'and has neither cache nor recording' "$(ls -A "$work/cache")"
    cp "$TRIPTYCH" "$work/plain"
    if grep -q '^external .* available' < <("$TRIPTYCH" list engines); then
        env -u TRIPTYCH_CPU PATH="$work:$PATH" TRIPTYCH_CC="$work/compiler" setpriv --reuid=65534 --clear-groups \
            "$work/plain" render "$work/stream.tri" --engine external --out "$work/user/c.png" >"$work/said" 2>&1
        verdict 'a program without such rights starts the compiler that its user names' \
            "$([[ -e $work/user/ran ]] || echo it did not)"
    fi
fi

exit $failures
