#!/bin/bash
# The files of `make install` are usable without this tree: header, libraries, pkg-config file, command.
# Given BUILD, TRIPTYCH and SLOW by tests/support/scripts/run.sh.
set -uo pipefail
cd "$(dirname "$0")/.."

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

test_case() # NAME COMMAND... : the command's output is shown only if it fails
{
    local name=$1
    shift
    if "$@" >"$work/said" 2>&1; then
        echo "ok $name"
    else
        echo "FAIL $name"
        cat "$work/said"
        failures=1
    fi
}

stack_is_not_executable() # FILE...
{
    local file
    for file in "$@"; do
        readelf -lW "$file" | grep -E 'GNU_STACK +([^ ]+ +){5}RW ' || return 1
    done
}

# The build with sanitizers has only the command, and instrumented libraries are not installed.
if [[ ${SLOW-} ]]; then
    test_case 'stack is not executable' stack_is_not_executable "$TRIPTYCH"
    exit $failures
fi

installs()
{
    make BUILD="$BUILD" PREFIX="$work" DESTDIR= install
}

pkgconfig_needs_no_build()
{
    make BUILD="$work/new" "$work/new/triptych.pc" && grep '^Version: [0-9]' "$work/new/triptych.pc"
}

header_stands_alone()
{
    printf '#include <triptych.h>\n' >"$work/header.c"
    gcc -std=c17 -Wall -Wextra -Werror -pedantic -fsyntax-only $(pkg-config --cflags triptych) \
        "$work/header.c" &&
        clang -x c++ -std=c++17 -Wall -Wextra -Werror -fsyntax-only $(pkg-config --cflags triptych) \
            "$work/header.c"
}

exports_are_the_header()
{
    gcc -E -P $(pkg-config --cflags triptych) "$work/include/triptych/triptych.h" | tr '\n' ' ' |
        tr ';' '\n' |
        sed -n 's/.*visibility("default").*[ *]\(triptych_[a-z0-9_]*\)(.*/\1/p' | sort >"$work/declared"
    nm -D --defined-only "$work/lib/libtriptych.so" | awk '{ print $3 }' | sort >"$work/exported"
    [[ -s $work/declared ]] && diff "$work/declared" "$work/exported"
}

# The emulator runs on every x86-64, so a device with it must come up.
cat >"$work/program.c" <<'C'
#include <stdio.h>
#include <string.h>
#include <triptych.h>

int main(void)
{
    struct triptych_options options = {.engine = "emulate", .threads = 1};
    char reason[256] = "";
    triptych_device *device;
    uint32_t pixels[4] = {0};
    const float color[4] = {1, 1, 1, 1};
    if (triptych_device_create(&options, &device, reason, sizeof reason)) {
        puts(reason);
        return 1;
    }
    int failed = triptych_set_target(device, 2, 2) || triptych_clear(device, color, -1) ||
                 triptych_read_color(device, pixels);
    if (failed)
        puts(triptych_error(device));
    triptych_device_destroy(device);
    return failed || pixels[0] != 0xffffffff || pixels[3] != 0xffffffff;
}
C

shared_library_works()
{
    gcc "$work/program.c" -o "$work/shared" $(pkg-config --cflags --libs triptych) &&
        readelf -dW "$work/shared" | grep -q 'NEEDED.*libtriptych.so.[0-9]' &&
        LD_LIBRARY_PATH=$work/lib "$work/shared"
}

static_library_works()
{
    gcc "$work/program.c" -o "$work/static" $(pkg-config --cflags triptych) "$work/lib/libtriptych.a" \
        $(pkg-config --static --libs-only-l triptych | sed 's/-ltriptych//') &&
        "$work/static"
}

code_needs_no_patching()
{
    readelf -dW "$work/lib/libtriptych.so" >"$work/dynamic" && grep -q SONAME "$work/dynamic" &&
        ! grep TEXTREL "$work/dynamic"
}

command_runs()
{
    "$work/bin/triptych" --version
}

# The installed command lists the pages that must be there.
manual_pages_are_installed()
{
    local page
    for page in triptych $("$work/bin/triptych" --help | sed -nE 's/^  ([a-z]+) .*/triptych-\1/p'); do
        grep -qi "^\.TH ${page//-/.*} 1 " "$work/share/man/man1/$page.1" || return 1
    done
}

completions_are_installed()
{
    grep -q '^complete -F _triptych triptych$' "$work/share/bash-completion/completions/triptych" &&
        grep -q '^#compdef triptych$' "$work/share/zsh/site-functions/_triptych" &&
        grep -q '^complete -c triptych ' "$work/share/fish/vendor_completions.d/triptych.fish"
}

export PKG_CONFIG_PATH=$work/lib/pkgconfig
test_case 'make install' installs
test_case 'pkg-config file is the first thing made' pkgconfig_needs_no_build
test_case 'header stands alone in C and C++' header_stands_alone
test_case 'exported symbols are those of the header' exports_are_the_header
test_case 'program with the shared library' shared_library_works
test_case 'program with the static library' static_library_works
test_case 'installed command runs' command_runs
test_case 'manual pages are installed' manual_pages_are_installed
test_case 'completions are installed' completions_are_installed
test_case 'code needs no patching' code_needs_no_patching
test_case 'stack is not executable' stack_is_not_executable "$work/lib/libtriptych.so" "$work/bin/triptych"
exit $failures
