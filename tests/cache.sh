#!/bin/bash
# The cache of meshes, as users of the command have it (docs/cache.md): pictures do not depend on it, whatever
# its folder is like.
# Given BUILD, TRIPTYCH and SANITIZE by tests/support/scripts/run.sh.
set -uo pipefail
cd "$(dirname "$0")/.."

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export XDG_CACHE_HOME=$work/home
folder=$XDG_CACHE_HOME/triptych
failures=0

# The mesh of a large model, in a small picture: drawing takes longer than the rest otherwise.
stream=$work/cat.tri
sed "s|^target .*|target 160 128|; s|\"../../build|\"$PWD/build|" bench/streams/cat.tri >"$stream"

verdict() # NAME PROBLEM : ok when there is none
{
    if [[ -z $2 ]]; then
        printf 'ok %s\n' "$1"
    else
        printf 'FAIL %s: %s\n' "$1" "$2"
        failures=1
    fi
}

# Draws without a word, and the picture is the expected one.
draws() # NAME [OPTION]...
{
    local name=$1 said status=0
    shift
    rm -f "$work/picture.png"
    said=$("$TRIPTYCH" render "$stream" --engine emulate --out "$work/picture.png" "$@" 2>&1) || status=$?
    if ((status)) || [[ $said ]]; then
        verdict "$name" "status $status, \"$said\""
    else
        verdict "$name" "$(cmp "$work/expected.png" "$work/picture.png" 2>&1)"
    fi
}

entries()
{
    find "$work/home" -type f 2>/dev/null | wc -l
}

"$TRIPTYCH" render "$stream" --engine emulate --out "$work/expected.png" --no-cache
verdict 'the option --no-cache writes nothing' "$([[ ! -e $work/home ]] || ls -R "$work/home")"

draws 'without an entry'
verdict 'one entry is kept' "$([[ $(entries) == 1 ]] || entries)"
verdict 'which only its user reads' "$(find "$folder" -maxdepth 0 ! -perm 700)"
entry=$(find "$folder" -type f)
draws 'with the entry'
verdict 'which is still the only one' "$([[ $(entries) == 1 ]] || entries)"

for change in 'truncate -s 100' 'truncate -s 0' 'truncate -s +1' 'sed -i s/TRI/TRX/'; do
    LC_ALL=C $change "$entry"
    draws "with an entry after $change"
    verdict 'which is whole again' "$(cmp "$entry" <(cat "$folder"/*) 2>&1)"
done
printf x | dd of="$entry" bs=1 seek=20000 conv=notrunc status=none
draws 'with an entry that has a wrong byte'
printf 'not an entry' >"$entry"
draws 'with the option --no-cache' --no-cache
verdict 'which leaves a damaged entry' "$([[ $(<"$entry") == 'not an entry' ]] || echo changed)"
for subcommand in bench bisect convert dump render verify; do
    verdict "$subcommand has the option --no-cache" \
        "$(grep -q -e --no-cache < <("$TRIPTYCH" "$subcommand" --help) || echo "not in the help")"
done

rm -rf "$folder"
for i in 1 2 3 4 5 6; do
    "$TRIPTYCH" render "$stream" --engine emulate --out "$work/$i.png" >"$work/said.$i" 2>&1 &
done
wait
problem=
for i in 1 2 3 4 5 6; do
    cmp -s "$work/expected.png" "$work/$i.png" && [[ ! -s $work/said.$i ]] || problem+="process $i: $(<"$work/said.$i") "
done
verdict 'six processes at the same time' "$problem"
verdict 'keep one entry and no other file' "$([[ $(entries) == 1 ]] || ls "$folder")"

rm -rf "$folder"
bash -c 'ulimit -f 16 && "$0" "$@"' "$TRIPTYCH" render "$stream" --engine emulate --out "$work/picture.png" 2>"$work/said"
verdict 'a limit on file sizes keeps no entry' "$([[ $(entries) == 0 ]] || ls "$folder")"
chmod 777 "$folder"
draws 'with a folder that others may write to'
verdict 'where nothing is kept' "$(ls "$folder")"
rm -rf "$work/home"
: >"$work/home"
draws 'with a file instead of the folder'
rm "$work/home"
XDG_CACHE_HOME=/dev/null draws 'with XDG_CACHE_HOME=/dev/null'
XDG_CACHE_HOME=/proc/nothing draws 'with a folder that cannot be made'
HOME= XDG_CACHE_HOME= draws 'without a home'
HOME=$work XDG_CACHE_HOME=relative draws 'with a relative folder, which is not used'
verdict 'so the entry is at home' "$([[ $(find "$work/.cache/triptych" -type f | wc -l) == 1 ]] || ls -R "$work/.cache")"

# A file system without room, where the system allows a new one.
if mkdir -p "$work/full" && unshare --mount --map-root-user true 2>/dev/null; then
    export -f draws verdict
    export work stream failures
    problem=$(unshare --mount --map-root-user bash -c '
        mount -t tmpfs -o size=64k tmpfs "$work/full" || exit 0
        XDG_CACHE_HOME=$work/full draws "with a full disk"
        find "$work/full" -type f | sed "s/^/left: /"' 2>&1)
    [[ $problem ]] || problem='ok with a full disk (not tested: no file system)'
    printf '%s\n' "$problem"
    [[ $problem == ok* && $problem != *left:* ]] || failures=1
fi

# --- Time -------------------------------------------------------------------------------------------------

milliseconds() # COMMAND... : the least processor time of five runs
{
    local TIMEFORMAT='%U %S' least=999999 now
    for _ in 1 2 3 4 5; do
        now=$({ time "$@" >/dev/null 2>&1; } 2>&1 | awk '{ print int(1000 * ($1 + $2)) }')
        ((now >= least)) || least=$now
    done
    echo "$least"
}

# The whole process takes at most as long as some frames and a constant time.
takes() # STREAM FRAMES MILLISECONDS COMMAND...
{
    local stream=$1 frames=$2 more=$3 frame spent most
    shift 3
    frame=$("$TRIPTYCH" bench "$stream" --engines specialize --frames 1 --seconds 0.3 --json - 2>/dev/null |
        awk -F '[:,]' '/"frame_ms"/ { print $2; exit }')
    spent=$(milliseconds "$TRIPTYCH" "$@")
    most=$(awk "BEGIN { print int($frames * $frame + $more) }")
    verdict "$1 of ${stream##*/} takes at most $frames frames and $more ms" \
        "$( ((spent <= most)) || echo "$spent ms, a frame takes $frame ms")"
}

if [[ ! ${SLOW-} ]] && grep -q '^specialize .* available' < <("$TRIPTYCH" list engines); then
    export XDG_CACHE_HOME=$work/again
    for name in bunny teapot-bilinear; do
        takes bench/streams/$name.tri 12 30 render bench/streams/$name.tri --threads 1 --out "$work/$name.png"
    done
    takes bench/streams/bunny.tri 4 20 dump bench/streams/bunny.tri
fi

exit $failures
