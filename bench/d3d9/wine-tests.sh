#!/bin/bash
# Builds Wine's Direct3D 9 tests (visual, device, stateblock, d3d9ex) of Debian's source package of Wine as
# one 64-bit Windows program whose test functions can be selected (bench/d3d9/filter.c).
#
#   bench/d3d9/wine-tests.sh FOLDER    FOLDER/d3d9_test.exe and FOLDER/version
#
# Only the tests and three headers of the source package are unpacked. Needs x86_64-w64-mingw32-gcc and
# dpkg-dev.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$1"
out=$(cd "$1" && pwd)

unpack()
{
    mkdir -p "$out/source"
    tar -xf "$("$here/source.sh" wine "$out/packages")" -C "$out/source" --strip-components=1 --wildcards \
        '*/dlls/d3d9/tests/*' '*/include/wine/test.h' '*/include/wine/debug.h' '*/include/wine/heap.h'
    cp "$out/packages/wine/version" "$out/version"
}

# Each call of a test function in START_TEST goes through filter_run.
filtered() # FILE
{
    sed -E '/^START_TEST/,/^\}/ s/^    (test_\w+|\w+_test)\(\);/    filter_run("\1", \1);/' "$1"
}

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
