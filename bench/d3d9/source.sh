#!/bin/bash
# Fetches a source package of Debian once, through lists of its own, so that the system's stay as they are.
#
#   bench/d3d9/source.sh PACKAGE FOLDER    FOLDER/PACKAGE/: the files of the package, and `version`
#
# Prints the path of the archive of the original sources.
set -euo pipefail
package=$1
mkdir -p "$2/lists/partial" "$2/cache/archives/partial" "$2/parts" "$2/$package"
folder=$(cd "$2" && pwd)

archive() { ls "$folder/$package/$package"_*.orig.tar.* 2>/dev/null | head -n 1; }

if [[ -z $(archive) ]]; then
    : >"$folder/sources.list"
    [[ ! -f /etc/apt/sources.list ]] || sed -n 's/^deb /deb-src /p' /etc/apt/sources.list >"$folder/sources.list"
    for file in /etc/apt/sources.list.d/*.sources; do
        [[ ! -f $file ]] || sed 's/^Types:.*/Types: deb-src/' "$file" >"$folder/parts/$(basename "$file")"
    done
    options=(-qq -o Dir::Etc::SourceList="$folder/sources.list" -o Dir::Etc::SourceParts="$folder/parts"
        -o Dir::State::Lists="$folder/lists" -o Dir::Cache="$folder/cache" -o APT::Sandbox::User=root)
    [[ -n $(find "$folder/lists" -name '*Sources*' -mtime -1) ]] || apt-get "${options[@]}" update
    (cd "$folder/$package" && apt-get "${options[@]}" source --download-only "$package" >&2)
    basename "$(ls "$folder/$package"/*.dsc)" .dsc >"$folder/$package/version"
fi
archive
