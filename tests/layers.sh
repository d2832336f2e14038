#!/usr/bin/env bash
# The layers of src/README.md: each folder with sources has one row in its tables, includes only what its row
# allows, and every row names only rows above it. A cycle of includes between files is found separately.
# Prints a line "ok NAME" or "FAIL NAME" for each folder and for each of the other rules; the reasons go to
# stderr.
# Runs once.
set -u
cd "$(dirname "$0")/.." || exit 1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0

report() # NAME FILE: the file holds the violations; none may be left
{
    if [[ -s $2 ]]; then
        echo "FAIL $1"
        cat "$2" >&2
        failed=1
    else
        echo "ok $1"
    fi
}

# Rows as "FOLDER ALLOWED...", in the order of the map.
awk -F'|' '/^\| `/ { gsub(/[` ]+/, " ", $2); gsub(/`/, "", $4); print $2, $4 }' src/README.md >"$work/rows"

# Every include as "FILE TARGET". A target is looked up beside the file, in src, and at the top, as the
# compiler does.
find src emu asm bench tests -type f \( -name '*.[ch]' -o -name '*.cc' -o -name '*.def' -o -name '*.asm' -o -name '*.inc' \) |
    sort >"$work/files"
xargs grep -HoE '^ *(# *include|%include|incbin) +"[^"]+"' <"$work/files" |
    sed -E 's/:[^"]*"/ /; s/"$//' >"$work/includes"
while read -r file name; do
    for candidate in "${file%/*}/$name" "src/$name" "$name"; do
        [[ -f $candidate ]] && echo "$file $candidate" && continue 2
    done
    case $file in
        asm/* | src/triptych.h | src/front/glsl/compile/lex.c) ;; # generated at build time
        *) echo "$file: includes \"$name\", which is not a file of the repository" >>"$work/missing" ;;
    esac
done <"$work/includes" >"$work/edges"
touch "$work/missing"

# A row's folder and the folders that it allows may end in "*". `rule FOLDER` is the row of a folder: its own,
# or the first pattern that matches it.
functions='
function folder_of(path) { sub(/\/[^\/]*$/, "", path); return path }
function fits(folder, pattern) {
    return pattern ~ /\*$/ ? index(folder, substr(pattern, 1, length(pattern) - 1)) == 1 : folder == pattern
}
function rule(folder, i) {
    for (i = 1; i <= rows; i++) if (name[i] == folder) return i
    for (i = 1; i <= rows; i++) if (fits(folder, name[i])) return i
    return 0
}
function allows(r, folder, i, n, part) {
    n = split(allowed[r], part, " ")
    for (i = 1; i <= n; i++) if (fits(folder, part[i])) return 1
    return 0
}
FILENAME == ARGV[1] { name[++rows] = $1; allowed[rows] = ""; for (i = 2; i <= NF; i++) allowed[rows] = allowed[rows] " " $i; next }
'
rules() # PROGRAM FILE: with the rows read first
{
    awk "$functions $1" "$work/rows" "$2"
}

sed 's|/[^/]*$||' "$work/files" | sort -u >"$work/folders"
rules '!rule($1) { print $1 ": no row in src/README.md" }' "$work/folders" >"$work/unlisted"
report 'every folder has a row in src/README.md' "$work/unlisted"
rules '{ used[rule($1)] } END { for (i = 1; i <= rows; i++) if (!(i in used)) print name[i] ": no folder with sources" }' \
    "$work/folders" >"$work/stale"
report 'every row of src/README.md is a folder' "$work/stale"
awk '{ for (i = 2; i <= NF; i++) { seen = 0; pattern = $i; sub(/\*$/, "", pattern)
        for (above in rows) if (above == $i || ($i ~ /\*$/ && index(above, pattern) == 1)) seen = 1
        if (!seen) print $1 ": names " $i ", which is not a row above it" } rows[$1] }' "$work/rows" >"$work/order"
report 'every row names only rows above it' "$work/order"
report 'every include names a file of the repository' "$work/missing"

# A row may not allow a folder that it does not use, so that the map shows the actual dependencies.
rules '{ a = folder_of($1); b = folder_of($2); r = rule(a); n = split(allowed[r], part, " ")
        for (i = 1; i <= n; i++) if (fits(b, part[i])) used[r, part[i]] }
    END { for (r = 1; r <= rows; r++) { n = split(allowed[r], part, " ")
        for (i = 1; i <= n; i++) if (!((r, part[i]) in used)) print name[r] ": allows " part[i] ", and does not include it" } }' \
    "$work/edges" >"$work/unused"
report 'every row of src/README.md allows only what is used' "$work/unused"

# The public header is allowed everywhere.
rules '{ a = folder_of($1); b = folder_of($2); r = rule(a) }
    a != b && $2 != "src/triptych.h" && !allows(r, b) { print a "\t" $1 ": includes " $2 }' "$work/edges" >"$work/forbidden"
while read -r folder; do
    awk -F'\t' -v folder="$folder" '$1 == folder { print $2 }' "$work/forbidden" >"$work/one"
    report "$folder includes what its row allows" "$work/one"
done <"$work/folders"

# tsort reports cycles on stderr. A file that includes itself is an edge that it ignores.
awk '$1 != $2' "$work/edges" | tsort 2>"$work/cycles" >/dev/null
report 'no file includes itself through others' "$work/cycles"

# A folder is a page to look through: at most 25 sources.
awk '{ folder = $1; sub(/\/[^\/]*$/, "", folder); count[folder]++ }
    END { for (folder in count) if (count[folder] > 25) print folder ": " count[folder] " sources, at most 25" }' \
    "$work/files" >"$work/crowded"
report 'no folder has more than 25 sources' "$work/crowded"
exit "$failed"
