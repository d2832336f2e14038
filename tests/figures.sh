#!/bin/bash
# The measured figures of README.md and docs/ are those of results/, and a change of either is found.
# Prints a line "ok NAME" or "FAIL NAME" for each test; the reasons go to stderr.
# Runs once.
set -uo pipefail
cd "$(dirname "$0")/.." || exit 1

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0

check() # NAME COMMAND...
{
    local name=$1
    shift
    if "$@" >"$work/output" 2>&1; then
        echo "ok $name"
    else
        echo "FAIL $name"
        head -n 40 "$work/output" >&2
        failed=1
    fi
}

figures() # the generator on the copy
{
    python3 bench/figures --results "$work/results" --pages "$work/pages" "$@"
}

fresh() # copies pages and results
{
    rm -rf "$work/pages" "$work/results"
    mkdir -p "$work/pages"
    cp -r README.md docs results "$work/pages/"
    cp -r results "$work/results"
}

refused() # TEXT: the generator finds the copy wrong and prints the text
{
    ! figures check >"$work/check" 2>&1 && grep -qF -- "$1" "$work/check"
}

check 'pages and results agree' python3 bench/figures check
check 'there are marks' test "$(python3 bench/figures list | wc -l)" -gt 20

# Each file that a page reads, with every number in it changed: a 7 before its first digit.
fresh
for file in $(python3 bench/figures files); do
    sed -E 's/(^|[^0-9.a-zA-Z_-])([1-9])/\17\2/g' "results/$file" >"$work/results/$file"
    check "a changed number in $file is found" refused 'disagree'
    cp "results/$file" "$work/results/$file"
done
check 'and not when it is as it was' figures check

fresh
echo 'It takes <!-- figure no-such-figure -->3<!-- /figure --> hours.' >>"$work/pages/docs/peers.md"
check 'an unknown figure is found' refused 'no figure has the name no-such-figure'

fresh
echo 'It takes <!-- figure peer flat nothing -->3<!-- /figure --> hours.' >>"$work/pages/docs/peers.md"
check 'a figure that results do not have is found' refused 'expected one'

fresh
echo 'It takes 3.7 ms.' >>"$work/pages/docs/peers.md"
check 'a measured number outside of all marks is found' refused "'3.7 ms' is outside of all marks"

fresh
sed -i 's/\(<!-- figure shader-count -->\)[0-9]*/\11/' "$work/pages/docs/shader-engines.md"
check 'a changed figure is found' refused 'figure shader-count: the page and results/ disagree'
check 'and written' figures write
check 'what is written agrees' figures check
check 'and is the page as it was' diff -r docs "$work/pages/docs"

# The kernels: speed by lanes and by threads, of a file as bench/clients.sh writes it. Missing engines are
# empty cells.
fresh
cp tests/data/measurements/clients.json "$work/results/"
check 'the tables of kernels are written' figures write
check 'instructions by lanes' grep -qF '| cipher | 51.3 | 24.7 | 6.18 | 3.10 | 3.07 |' "$work/pages/docs/clients.md"
check 'speed by lanes' grep -qE '^\| cipher \| 250 \| 250 \| 1,000 \|  \|  \|  \| 16,000 \|' "$work/pages/docs/clients.md"
check 'speed by threads' grep -qF '| cipher | 1.95 | 1.95 | 1.95 | 1.95 | 1.95 | 1.95 |  | 1.95 |  |' "$work/pages/docs/clients.md"
check 'where they come from' grep -qE '`emulate` [0-9]+ lanes.*; a processor, gcc 12.2.0, commit 1234567; `make bench-clients`' "$work/pages/docs/clients.md"
rm "$work/results/clients.json"
check 'without the file the page names its command' figures write
check 'in each of the tables' test "$(grep -c '^.make bench-clients. writes .results/clients.json., and' "$work/pages/docs/clients.md")" = 3
exit $failed
