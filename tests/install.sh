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
                 triptych_read_color(device, pixels, sizeof pixels);
    if (failed)
        puts(triptych_error(device));
    triptych_device_destroy(device);
    return failed || pixels[0] != 0xffffffff || pixels[3] != 0xffffffff;
}
C

shared_library_works()
{
    gcc "$work/program.c" -o "$work/shared" $(pkg-config --cflags --libs triptych) &&
        grep -q 'NEEDED.*libtriptych.so.[0-9]' < <(readelf -dW "$work/shared") &&
        LD_LIBRARY_PATH=$work/lib "$work/shared"
}

is_linked_statically() # PROGRAM
{
    ! readelf -dW "$1" | grep 'NEEDED.*libtriptych' && "$1"
}

static_library_works()
{
    gcc "$work/program.c" -o "$work/static" $(pkg-config --cflags --libs triptych-static) &&
        is_linked_statically "$work/static"
}

# Where only the archive is installed, the usual package links it.
only_static_library_works()
{
    mkdir -p "$work/only/lib" && cp "$work/lib/libtriptych.a" "$work/only/lib/" &&
        sed "s|^libdir=.*|libdir=$work/only/lib|" "$work/lib/pkgconfig/triptych.pc" >"$work/only/triptych.pc" &&
        PKG_CONFIG_PATH=$work/only gcc "$work/program.c" -o "$work/archive" \
            $(PKG_CONFIG_PATH=$work/only pkg-config --cflags --static --libs triptych) &&
        is_linked_statically "$work/archive"
}

header_is_one_file()
{
    [[ $(ls -R "$work/include/triptych") == "$work/include/triptych:
triptych.h" ]] && ! grep '#include "' "$work/include/triptych/triptych.h"
}

version_is_everywhere()
{
    local version
    version=$(pkg-config --modversion triptych) &&
        grep -q "^#define TRIPTYCH_VERSION  *\"$version\"" "$work/include/triptych/triptych.h" &&
        readelf -dW "$work/lib/libtriptych.so" | grep "SONAME.*libtriptych.so.${version%%.*}]" &&
        "$work/bin/triptych" --version | grep -F "$version"
}

# The enumerations of the header against the tables of the library: every state and every word, in both
# directions.
cat >"$work/words.c" <<'C'
#include <ctype.h>
#include <stdio.h>
#include <string.h>
#include <triptych.h>

static const struct {
    const char *name;
    uint32_t number;
} words[] = {
#include "words.h"
};

static int failed;

/* The number of PREFIX NAME in the header, with NAME in capitals. */
static void expect(const char *prefix, const char *name, uint32_t number)
{
    char text[128];
    int length = snprintf(text, sizeof text, "TRIPTYCH_%s_%s", prefix, name);
    for (int i = 0; i < length; i++)
        text[i] = (char)toupper(text[i]);
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (!strcmp(words[i].name, text) && words[i].number == number) {
            return;
        }
    printf("the header has no %s = %u\n", text, number);
    failed = 1;
}

int main(void)
{
    static const char *const prefix[] = {"STATE", "SAMPLER", "STAGE"};
    const unsigned count[] = {TRIPTYCH_STATE_COUNT, TRIPTYCH_SAMPLER_STATE_COUNT, TRIPTYCH_STAGE_STATE_COUNT};
    for (unsigned table = 0; table < TRIPTYCH_STATE_TABLE_COUNT; table++) {
        const struct triptych_state_row *row;
        unsigned rows = 0;
        for (; (row = triptych_state_at((enum triptych_state_table)table, rows)); rows++)
            expect(prefix[table], row->name, rows);
        if (rows != count[table])
            failed = printf("the header has %u rows of %s, the library %u\n", count[table], prefix[table], rows);
    }
    unsigned values = 0;
    const struct triptych_kind *kind;
    for (unsigned k = 0; (kind = triptych_kind_at(k)); k++) {
        const struct triptych_value *value;
        for (unsigned i = 0; (value = triptych_value_at(kind, i)); i++, values++)
            expect(kind->prefix, value->word, value->number);
    }
    for (unsigned i = 0; i < TRIPTYCH_DEPTH_COUNT; i++)
        expect("DEPTH", triptych_depth_format_name((enum triptych_depth_format)i), i);
    char version[32];
    snprintf(version, sizeof version, "%d.%d.%d", TRIPTYCH_VERSION_MAJOR, TRIPTYCH_VERSION_MINOR,
             TRIPTYCH_VERSION_PATCH);
    if (strcmp(version, TRIPTYCH_VERSION) || strcmp(version, triptych_version()))
        failed = printf("versions %s, %s and %s\n", version, TRIPTYCH_VERSION, triptych_version());
    return failed || values < 200;
}
C

header_agrees_with_tables()
{
    sed -n 's/^ *\(TRIPTYCH_[A-Z0-9_]*\)\( = [0-9a-fx]*\)\?,.*/{"\1", (uint32_t)\1},/p' \
        "$work/include/triptych/triptych.h" >"$work/words.h"
    gcc -I"$work" "$work/words.c" -o "$work/words" $(pkg-config --cflags --libs triptych) &&
        LD_LIBRARY_PATH=$work/lib "$work/words"
}

# Names of the interface have one letter case after their prefix.
names_have_one_case()
{
    ! grep -oE '\bTRIPTYCH_[A-Z0-9_]*[a-z][A-Za-z0-9_]*' "$work/include/triptych/triptych.h"
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
test_case 'header is one file' header_is_one_file
test_case 'names of the header have one letter case' names_have_one_case
test_case 'header agrees with the tables of the library' header_agrees_with_tables
test_case 'version is the same everywhere' version_is_everywhere
test_case 'exported symbols are those of the header' exports_are_the_header
test_case 'program with the shared library' shared_library_works
test_case 'program with the static library' static_library_works
test_case 'program where only the static library is installed' only_static_library_works
test_case 'installed command runs' command_runs
test_case 'manual pages are installed' manual_pages_are_installed
test_case 'completions are installed' completions_are_installed
test_case 'code needs no patching' code_needs_no_patching
test_case 'stack is not executable' stack_is_not_executable "$work/lib/libtriptych.so" "$work/bin/triptych"
exit $failures
