#!/bin/bash
# Prints the coverage of the tests that ran on a build with COVERAGE=1:
#
#   tests/support/scripts/coverage.sh BUILD LEAST
#
# Prints a row for each file of src/ and emu/ and for the total: the number of lines with code, and how many
# of them ran. Ends non-zero if less than LEAST per cent ran. A header that several objects include counts
# once: a line ran if it ran in any of them.
# LINES=1 prints the lines that did not run instead.
set -euo pipefail
cd "$(dirname "$0")/../../.."

build=$1 least=$2
report=$(mktemp)
trap 'rm -f "$report"' EXIT
find "$build"/object/{src,emu} -name '*.gcno' -print0 | xargs -0 gcov -t >"$report" 2>/dev/null

awk -v least="$least" -v list="${LINES:-0}" '
    function percent(part, all) { return all ? 100 * part / all : 100 }
    function row(lines, ran, name) { return sprintf("%-34s %7d %7d %8.2f", name, lines, ran, percent(ran, lines)) }

    # "COUNT:LINE:TEXT", "-" where there is no code, "#####" or "=====" where it did not run; line 0
    # describes the file.
    /^ *-: *0:Source:/ { source = $0; sub(/^ *-: *0:Source:/, "", source); next }
    source !~ /^(src|emu)\// { next }
    {
        split($0, part, ":")
        count = part[1]; line = part[2] + 0; gsub(/ /, "", count)
        if (!line || count == "-") next
        place = source ":" line
        if (!(place in text)) { order[++places] = place; from[place] = source; text[place] = $0; lines[source]++ }
        if (count !~ /^[#=]/ && !(place in executed)) { executed[place] = 1; ran[source]++ }
    }
    END {
        if (!places) { print "FAIL no coverage found" > "/dev/stderr"; exit 1 }
        if (list) {
            for (i = 1; i <= places; i++) if (!(order[i] in executed)) {
                code = text[order[i]]; sub(/^[^:]*:[^:]*:/, "", code); print order[i] ":" code
            }
            exit
        }
        printf "%-34s %7s %7s %8s\n", "file", "lines", "ran", "per cent"
        for (source in lines) {
            print row(lines[source], ran[source], source) | "sort"
            all += lines[source]; done += ran[source]
        }
        close("sort")
        print row(all, done, "all")
        if (percent(done, all) < least) { printf "FAIL less than %d per cent\n", least > "/dev/stderr"; exit 1 }
    }' "$report"
