#!/bin/bash
# Fetches the Unity test framework into DIRECTORY/src, out of Debian's source package of cJSON.
#
#   tests/support/scripts/unity.sh DIRECTORY
#
# No Debian binary package contains Unity, but cJSON's source package does, in tests/unity. The script uses
# the machine's own apt sources (mirror, keys, proxy), reads them as deb-src and puts them into a private apt
# directory. So /etc/apt does not change, and no privilege is needed. apt checks the signature and the hashes.
set -euo pipefail

target=$1
if [[ -f $target/src/unity.c ]]; then exit 0; fi

stop()
{
    printf '%s\n' "unity: $1; or set UNITY_DIR to a checkout of https://github.com/ThrowTheSwitch/Unity" >&2
    exit 1
}

command -v apt-get >/dev/null || stop 'no apt-get to fetch Unity with'
mkdir -p "$(dirname "$target")"
work=$(mktemp -d "$(dirname "$(realpath -m "$target")")/unity.XXXXXX")
trap 'rm -rf "$work"' EXIT
mkdir -p "$work"/{state/lists/partial,cache/archives/partial,sources,download,unpacked}

# --- The machine's Debian sources, as deb-src ---------------------------------------------------------------
# Only entries with a component "main" of this release, its updates or its security updates are used. Sources
# of third parties may be unreachable and do not have cJSON.

release=$(. /etc/os-release && printf '%s' "${VERSION_CODENAME:-}")
suites="^(${release:-none}|stable|oldstable|testing|unstable|sid)((-|/)(security|updates))?/?$"

shopt -s nullglob
for file in /etc/apt/sources.list /etc/apt/sources.list.d/*.list; do
    [[ -r $file ]] || continue
    # deb [option=value ...] URI suite component...
    awk -v suites="$suites" '
        /^[ \t]*deb(-src)?[ \t]/ {
            sub(/[ \t]*#.*/, "")
            options = ""
            if (match($0, /^[ \t]*deb(-src)?[ \t]+\[[^]]*\]/)) {
                options = substr($0, index($0, "["), RSTART + RLENGTH - index($0, "["))
                $0 = "deb" substr($0, RSTART + RLENGTH)
            }
            main = 0
            for (i = 4; i <= NF; i++)
                if ($i == "main") main = 1
            if (main && $3 ~ suites && $2 !~ /^cdrom:/)
                print "deb-src", options, $2, $3, "main"
        }' "$file"
done | sort -u >"$work/sources/machine.list"

for file in /etc/apt/sources.list.d/*.sources; do
    [[ -r $file ]] || continue
    # Stanzas of "Field: value" are separated by empty lines. Indented lines continue a field. Lines with #
    # are comments.
    awk -v suites="$suites" '
        function flush(    count, part, i, suite, kept, main) {
            count = split(value["suites"], part, /[ \t\n]+/)
            for (i = 1; i <= count; i++)
                if (part[i] ~ suites) kept = kept " " part[i]
            main = (" " value["components"] " ") ~ /[ \t\n]main[ \t\n]/
            if (kept != "" && main && tolower(value["enabled"]) !~ /^ *(no|false|0|off)/) {
                print "Types: deb-src\nURIs:" value["uris"] "\nSuites:" kept "\nComponents: main"
                if ("signed-by" in value) print "Signed-By:" value["signed-by"]
                if ("trusted" in value) print "Trusted:" value["trusted"]
                print ""
            }
            delete value
            field = ""
        }
        /^#/ { next }
        /^[ \t]*$/ { flush(); next }
        /^[ \t]/ { value[field] = value[field] "\n" $0; next }
        { field = tolower(substr($0, 1, index($0, ":") - 1)); value[field] = substr($0, index($0, ":") + 1) }
        END { flush() }' "$file"
done >"$work/sources/machine.sources"

[[ -s $work/sources/machine.list || -s $work/sources/machine.sources ]] ||
    stop "no Debian ${release:-} main archive in /etc/apt/sources.list or /etc/apt/sources.list.d"

# --- Download and unpack ------------------------------------------------------------------------------------

options=(-qq
    -o Dir::Etc::SourceList=/dev/null -o Dir::Etc::SourceParts="$work/sources"
    -o Dir::State::Lists="$work/state/lists" -o Dir::Cache="$work/cache"
    -o Dir::Cache::Archives="$work/cache/archives" -o Acquire::Languages=none -o Acquire::Retries=3)
# As root apt would drop to the user _apt, which may not be able to reach this directory.
((EUID)) || options+=(-o APT::Sandbox::User=root)

printf 'Fetching Unity from the source package of cJSON\n'
# The update fails if one of several archives fails. That is not an error if the download succeeds.
apt-get "${options[@]}" update >"$work/log" 2>&1 || true
if ! (cd "$work/download" && apt-get "${options[@]}" source --download-only cjson) >>"$work/log" 2>&1; then
    cat "$work/log" >&2
    stop 'apt-get source cjson failed'
fi

archives=("$work"/download/cjson_*.orig.tar.*[!c])
((${#archives[@]})) || stop 'the source package of cJSON has no upstream archive'
tar -xf "${archives[0]}" -C "$work/unpacked" --wildcards --strip-components=3 '*/tests/unity/*'
[[ -f $work/unpacked/src/unity.c ]] || stop "no tests/unity/src/unity.c in ${archives[0]##*/}"

# The rename is the last step, so that an interrupted fetch leaves no folder that looks complete.
mv -T "$work/unpacked" "$target" 2>/dev/null || [[ -f $target/src/unity.c ]] || stop "cannot write $target"
