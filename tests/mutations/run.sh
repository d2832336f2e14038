#!/bin/bash
# Plants bugs, and checks that the tests find them.
#
#   tests/mutations/run.sh [ONLY]     every row of tests/mutations/table.txt whose name contains ONLY, or one
#                                     of its words
#   tests/mutations/run.sh --fit      only lists the rows that no longer fit their files
#
# A row is a bug. It has whole lines of a file, which must occur there exactly once; their replacement; and
# the finder, the test that must find the bug. A finder is a text as in `make check ONLY=text`, or `fuzz`,
# five minutes of `triptych fuzz`. A row with `needs FEATURE` is a bug in code for processors with a feature
# of `triptych list cpu`; elsewhere it is not planted. Each bug is planted in a copy of the tree,
# BUILD/mutations/tree, which keeps its objects. The finder must pass without the bug.
#
# Prints "found", "GOT AWAY" or "not here" for each row, with the finder and its time, and stores this in
# BUILD/mutations/NAME.result. A row without this file keeps its result in results/mutations.md. When every
# row has a result, this page is written, with the processor and the commits at which rows were last planted.
# Exits with 1 if a bug was not found, does not fit its file or does not build, or if a finder fails without a
# bug.
set -uo pipefail
cd "$(dirname "$0")/../.." || exit 1
export LC_ALL=C

only=${1-}
build=${BUILD:-build}
home=$build/mutations tree=$build/mutations/tree
table=tests/mutations/table.txt
commit=$(git rev-parse --short HEAD 2>/dev/null || echo unknown)
limit=300  # seconds of fuzzing
longest=600 # seconds of a test; a longer one hangs, and the bug counts as found
trouble=0

mkdir -p "$tree/build"
home=$(realpath "$home") tree=$(realpath "$tree")

# --- The table

names=()
declare -A file plants finder needs old new

read_table()
{
    local line name= number=0
    while IFS= read -r line; do
        number=$((number + 1))
        case $line in
        '' | '#'*) ;;
        'bug '*) name=${line#bug } && names+=("$name") &&
            file[$name]= old[$name]= new[$name]= finder[$name]= needs[$name]= ;;
        'file '*) file[$name]=${line#file } ;;
        'plants '*) plants[$name]=${line#plants } ;;
        'needs '*) needs[$name]=${line#needs } ;;
        'found by '*) finder[$name]=${line#found by } ;;
        '-'*) old[$name]+=${line#-}$'\n' ;;
        '+'*) new[$name]+=${line#+}$'\n' ;;
        *) echo "$table:$number: found '$line', expected bug, file, plants, needs, found by, - or +" >&2 && exit 2 ;;
        esac
    done <"$table"
}

# --- The copy

# Copies files that differ, with a new time, so that make rebuilds them.
copy_tree()
{
    local path
    while IFS= read -r -d '' path; do
        [[ -f $path ]] || continue
        cmp -s "$path" "$tree/$path" && continue
        mkdir -p "$tree/$(dirname "$path")" && rm -f "$tree/$path" && cp -P "$path" "$tree/$path" || exit 1
    done < <(git ls-files -z --cached --others --exclude-standard)
    (cd "$tree" && find src emu asm tests -type f -print0) | while IFS= read -r -d '' path; do
        [[ -f $path ]] || rm -f "$tree/$path"
    done
    [[ -e $tree/build/unity || ! -d build/unity ]] || ln -s "$(realpath build/unity)" "$tree/build/unity"
    make -C "$tree" -s build/glmark2 build/assimp
}

# planted NAME: prints the file with the bug; fails if the lines do not occur exactly once.
planted()
{
    perl -0777 -e '
        my ($file, $old, $new) = @ARGV;
        open(my $handle, "<", $file) or exit 1;
        my $text = "\n" . <$handle>;
        my $at = index($text, "\n$old");
        exit 1 if $old eq "" || $at < 0 || index($text, "\n$old", $at + 1) >= 0;
        substr($text, $at + 1, length $old) = $new;
        print substr($text, 1);' "${file[$1]}" "${old[$1]}" "${new[$1]}"
}

# plant NAME: replaces the lines in the copy.
plant()
{
    planted "$1" >"$home/planted" || return 1
    rm -f "$tree/${file[$1]}"
    cp "$home/planted" "$tree/${file[$1]}"
}

restore()
{
    rm -f "$tree/${file[$1]}"
    cp -P "${file[$1]}" "$tree/${file[$1]}"
}

# --- Building and looking

# build FINDER: builds its programs, and the command if it is a script or the fuzzer.
build()
{
    local goals="ONLY=$1 programs" script
    [[ $1 != fuzz ]] || goals=all
    for script in tests/*.sh; do
        [[ $script != *"$1"* ]] || goals+=" all"
    done
    # shellcheck disable=SC2086
    nice make -C "$tree" -j"$(nproc)" BUILD=build $goals >"$home/build.log" 2>&1
}

# look FINDER: runs it; succeeds if it finds nothing.
look()
{
    if [[ $1 == fuzz ]]; then
        (cd "$tree" && rm -rf build/findings && timeout -k 10 $((limit + longest)) nice build/triptych fuzz \
            --seed 1 --count 1000000 --seconds "$limit" --findings 1 --output build/findings) \
                >"$home/look.log" 2>&1
    else
        timeout -k 10 "$longest" nice "$tree/tests/support/scripts/run.sh" "$1" build >"$home/look.log" 2>&1
    fi
}

# The message of a failing test, or else the first line that reports a fault.
reason()
{
    local said
    said=$(grep -aE -m 1 ':FAIL: |ERROR: |runtime error' "$home/look.log") ||
        said=$(grep -aE -m 1 '^ *FAIL |differ|killed by|stopped after|ran no test|ended with|error:' \
            "$home/look.log")
    sed -E 's/^ +//' <<<"$said" | cut -c 1-160
}

declare -A sound
# Returns true if the finder passes without any bug; tried once.
is_sound()
{
    [[ -n ${sound[$1]-} ]] && return "${sound[$1]}"
    sound[$1]=0
    if [[ $1 != fuzz ]]; then
        build "$1" && look "$1" || sound[$1]=1
    fi
    return "${sound[$1]}"
}

# --- One bug

# is_here NAME: whether this processor has what the bug needs.
is_here()
{
    [[ -z ${needs[$1]} ]] && return
    [[ -x $tree/build/triptych ]] || build fuzz
    "$tree/build/triptych" list cpu | grep -q "^${needs[$1]} *yes"
}

# try NAME: leaves the verdict, the seconds and the message in the result.
try()
{
    local name=$1 test verdict='GOT AWAY' said= by= started
    is_here "$name" || verdict='not here' by=${needs[$name]}
    for test in ${finder[$name]}; do
        [[ $verdict == 'GOT AWAY' ]] || break
        is_sound "$test" || { verdict='TEST FAILS WITHOUT IT' by=$test said=$(reason) && break; }
    done
    started=$SECONDS
    if [[ $verdict == 'GOT AWAY' ]] && ! plant "$name"; then
        verdict='DOES NOT FIT'
    elif [[ $verdict == 'GOT AWAY' ]]; then
        for test in ${finder[$name]}; do
            by=$test
            build "$test" || { verdict='DOES NOT BUILD' said=$(grep -am 1 error "$home/build.log") && break; }
            look "$test" && continue
            [[ $test == fuzz ]] || grep -qE '^[0-9]+ passed, [0-9]+ failed' "$home/look.log" ||
                { verdict='NO ANSWER' && break; }
            verdict=found said=$(reason)
            break
        done
        restore "$name"
    fi
    printf '%s\t%d\t%s\t%s\t%s\n' "$verdict" $((SECONDS - started)) "$commit" "$by" "$said" >"$home/$name.result"
    printf '%-22s %-9s %4d s  %-24s %s\n' "$name" "$verdict" $((SECONDS - started)) "$by" "$said"
    [[ $verdict == found || $verdict == 'not here' ]]
}

# --- The report

processor()
{
    sed -nE '0,/^model name[[:space:]]*: /s/^model name[[:space:]]*: //p' /proc/cpuinfo
}

page=results/mutations.md

# Writes the result that the page has for a bug, without its commit, as NAME.result has it.
recover() # NAME
{
    awk -F ' [|] ' -v name="| $1" '$1 == name {
        verdict = "found"
        if (sub(/^needs /, "", $4))
            verdict = "not here"
        else if (gsub(/[*][*]/, "", $4))
            verdict = $4
        message = $6
        sub(/ [|]$/, "", message)
        gsub(/[\\][|]/, "|", message)
        printf "%s\t%s\t\t%s\t%s\n", verdict, $5, $4, message
    }' "$page"
}

# The result of a bug, from its file or from the page.
result_of() # NAME
{
    if [[ -f $home/$1.result ]]; then cat "$home/$1.result"; else recover "$1"; fi
}

write_report()
{
    local name verdict seconds at by said commits= missing=0 found=0 elsewhere=0
    for name in "${names[@]}"; do
        [[ -f $home/$name.result || -n $(recover "$name") ]] || missing=$((missing + 1))
    done
    ((missing)) && echo "$page waits for $missing more" && return
    commits=$(sed -n 's/.*Commits: \(.*\)\.$/\1/p' "$page" | tr -d ,)
    {
        echo '# Planted bugs'
        echo
        echo 'Each row of `tests/mutations/table.txt` is planted in a copy of the tree, which is built and'
        echo 'tested with the test that must find it. `make mutations` writes this page. Seconds are those of building and'
        echo 'testing, on a machine that also does other work.'
        echo
        echo '| Bug | Where | What | Found by | Seconds | Message |'
        echo '| --- | --- | --- | --- | --- | --- |'
        for name in "${names[@]}"; do
            IFS=$'\x1f' read -r verdict seconds at by said < <(result_of "$name" | tr '\t' '\037')
            [[ -z $at || " $commits " == *" $at "* ]] || commits+="${commits:+ }$at"
            case $verdict in
            found) found=$((found + 1)) ;;
            'not here') elsewhere=$((elsewhere + 1)) by="needs $by" ;;
            *) by="**$verdict**" ;;
            esac
            said=${said//|/\\|}
            echo "| $name | \`${file[$name]}\` | ${plants[$name]} | $by | $seconds | ${said//\`/\'} |"
        done
        echo
        echo "$found of $((${#names[@]} - elsewhere)) found; $elsewhere not planted, because this processor does not execute their code."
        echo
        echo "Processor: $(processor). Commits: ${commits// /, }."
    } >"$page.new" && mv "$page.new" "$page"
}

# is_wanted NAME
is_wanted()
{
    local word
    for word in $only; do
        [[ $1 != *"$word"* ]] || return 0
    done
    [[ -z $only ]]
}

read_table
if [[ $only == --fit ]]; then
    for name in "${names[@]}"; do
        planted "$name" >/dev/null || { echo "$name does not fit ${file[$name]}" && trouble=1; }
    done
    exit $trouble
fi
copy_tree
for name in "${names[@]}"; do
    is_wanted "$name" || continue
    try "$name" || trouble=1
done
write_report
exit $trouble
