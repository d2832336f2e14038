#!/bin/bash
# Builds Wine's Direct3D 9 tests (visual, device, stateblock, d3d9ex) of Debian's source package of Wine as one
# 64-bit Windows program whose test functions can be selected (bench/d3d9/filter.c).
#
#   bench/d3d9/wine-tests.sh FOLDER    FOLDER/d3d9_test.exe and FOLDER/version
#
# The source package is fetched once, through lists of its own, so that the system's stay as they are. Only the
# tests and three headers are unpacked. Needs x86_64-w64-mingw32-gcc and dpkg-dev.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$1"
out=$(cd "$1" && pwd)

fetch()
{
    local apt=$out/apt file options
    mkdir -p "$apt/lists/partial" "$apt/cache/archives/partial" "$apt/parts"
    : >"$apt/sources.list"
    [[ ! -f /etc/apt/sources.list ]] || sed -n 's/^deb /deb-src /p' /etc/apt/sources.list >"$apt/sources.list"
    for file in /etc/apt/sources.list.d/*.sources; do
        [[ ! -f $file ]] || sed 's/^Types:.*/Types: deb-src/' "$file" >"$apt/parts/$(basename "$file")"
    done
    options=(-qq -o Dir::Etc::SourceList="$apt/sources.list" -o Dir::Etc::SourceParts="$apt/parts"
        -o Dir::State::Lists="$apt/lists" -o Dir::Cache="$apt/cache" -o APT::Sandbox::User=root)
    apt-get "${options[@]}" update
    (cd "$apt" && apt-get "${options[@]}" source --download-only wine >/dev/null)
    basename "$(echo "$apt"/wine_*.dsc)" .dsc >"$out/version"
}

unpack()
{
    mkdir -p "$out/source"
    tar -xf "$(echo "$out"/apt/wine_*.orig.tar.*)" -C "$out/source" --strip-components=1 --wildcards \
        '*/dlls/d3d9/tests/*' '*/include/wine/test.h' '*/include/wine/debug.h' '*/include/wine/heap.h'
}

# Each call of a test function in START_TEST goes through filter_run.
filtered() # FILE
{
    sed -E '/^START_TEST/,/^\}/ s/^    (test_\w+|\w+_test)\(\);/    filter_run("\1", \1);/' "$1"
}

[[ -f $out/version ]] || fetch
[[ -d $out/source/dlls ]] || unpack
mkdir -p "$out/object" "$out/include/wine"
cp "$out"/source/include/wine/*.h "$out/include/wine/"
# The macros are those that Wine's own build defines for its tests.
flags=(-O1 -w -I"$out/include" -I"$out/source/dlls/d3d9/tests" -D__WINESRC__ '-D__WINE_ALLOC_SIZE(...)='
    -D__WINE_MALLOC= -DCURSOR_SUPPRESSED=2)
objects=() compilers=()
for suite in d3d9ex device stateblock visual; do
    {
        echo 'extern void filter_run(const char *, void (*)(void));'
        filtered "$out/source/dlls/d3d9/tests/$suite.c"
    } >"$out/object/$suite.c"
    # Failures are printed by file and line of Wine's own file.
    sed -i "1a #line 1 \"$suite.c\"" "$out/object/$suite.c"
    x86_64-w64-mingw32-gcc "${flags[@]}" -c "$out/object/$suite.c" -o "$out/object/$suite.o" &
    compilers+=($!)
    objects+=("$out/object/$suite.o")
done
x86_64-w64-mingw32-gcc "${flags[@]}" -c "$here/filter.c" -o "$out/object/filter.o"
for compiler in "${compilers[@]}"; do wait "$compiler"; done
x86_64-w64-mingw32-gcc "${objects[@]}" "$out/object/filter.o" -o "$out/d3d9_test.exe" -ld3d9 -luser32 -lgdi32 \
    -lole32 -luuid
echo "$out/d3d9_test.exe: the tests of $(<"$out/version")"
