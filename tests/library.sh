#!/usr/bin/env bash
# The library as a user has it: the examples of docs/examples are built with the files of `make install` in a
# folder of their own, and draw the stored picture. The kernel is built by the command of its page. A program
# can load and unload the library without growing, and a recorded program gets its frames.
# Given BUILD, TRIPTYCH and SLOW by tests/support/scripts/run.sh.
set -uo pipefail
cd "$(dirname "$0")/.." || exit 1

if [[ ${SLOW-} ]]; then
    echo 'ok library: not in an instrumented build, which is not installed'
    exit 0
fi

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0
root=$PWD
examples=$root/docs/examples
prefix=$work/prefix
build=${BUILD:-build}
build=${build#"$PWD"/}
export PKG_CONFIG_PATH=$prefix/lib/pkgconfig LD_LIBRARY_PATH=$prefix/lib
unset TRIPTYCH_RECORD TRIPTYCH_DEBUG

test_case() # NAME COMMAND... : the command's output is shown only if it fails
{
    local name=$1
    shift
    if (cd "$work" && "$@") >"$work/said" 2>&1; then
        echo "ok $name"
    else
        echo "FAIL $name"
        cat "$work/said"
        failures=1
    fi
}

if ! make BUILD="$build" PREFIX="$prefix" DESTDIR= install >"$work/said" 2>&1; then
    echo 'FAIL library: make install'
    cat "$work/said"
    exit 1
fi

# --- Examples -----------------------------------------------------------------------------------------------

compile() # SOURCE PROGRAM PACKAGE...
{
    gcc -Wall -Wextra -Werror "$1" -o "$2" $(pkg-config --cflags --libs "${@:3}") -ldl
}

c_cube_draws_the_picture()
{
    compile "$examples/cube.c" cube triptych libpng && compile "$examples/golden/same.c" same libpng || return
    local engine
    for engine in emulate specialize stitch; do
        ./cube "$engine" "$engine.png" && ./same "$examples/golden/cube.png" "$engine.png" || return
    done
}

kernel_is_built_by_the_command_of_its_page()
{
    local command
    command=$(sed -n '/^cc .*kernel\.c/,/[^\\]$/p' "$root/docs/clients.md") && [[ $command ]] || return
    cd "$root" && eval "${command//build\//$build/}" >"$work/products" &&
        diff - "$work/products" <<<'0 3 6 9 12 15 18 21 24 27 30 33 36 39 42 45'
}

c_cube_reports_errors()
{
    ! ./cube nonsense none.png 2>message && grep '^cube: engine nonsense: ' message &&
        [[ ! -e none.png ]] && ! ./cube emulate /nowhere/cube.png 2>message &&
        grep '^cube: /nowhere/cube.png: ' message
}

python_cube_draws_the_picture()
{
    python3 "$examples/cube.py" specialize python.png && ./same "$examples/golden/cube.png" python.png
}

python_cube_reports_errors()
{
    ! python3 "$examples/cube.py" nonsense none.png 2>message &&
        grep '^cube.py: engine nonsense: ' message
}

ctest_compares_with_the_picture()
{
    cmake -S "$examples/golden" -B golden && cmake --build golden &&
        ctest --test-dir golden --output-on-failure
}

# A copy of the example with another picture must fail, and name a pixel.
ctest_finds_another_picture()
{
    mkdir -p copy && cp "$examples/cube.c" copy/ && cp -r "$examples/golden" copy/golden &&
        sed -i 's/0.25, 0.75, 0, 0/0.26, 0.75, 0, 0/' copy/cube.c &&
        cmake -S copy/golden -B other >/dev/null && cmake --build other || return
    ! ctest --test-dir other --output-on-failure >message &&
        grep -E 'emulate.png: pixel [0-9]+, [0-9]+ is 0x' message
}

# --- Unloading ----------------------------------------------------------------------------------------------

cat >"$work/cycle.c" <<'C'
/* Loads the library, draws with an engine, unloads it, many times. Prints the growth of the process after the
 * first cycles, in which the allocator of the C library finds its size. Its arenas may still take some
 * megabytes once, so the limit is for each cycle, and one of three rounds of cycles must be within it: a leak
 * is in every round. */
#include <dlfcn.h>
#include <malloc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <triptych.h>

enum { WARM = 20, CYCLES = 100, ROUNDS = 3, SIDE = 64, LIMIT = 64 };

static void *library;

#define FUNCTION(name) ((__typeof__(name) *)dlsym(library, #name))

static void cycle(const char *engine)
{
    static const float corners[3][3] = {{-1, -1, 0}, {0, 1, 0}, {1, -1, 0}};
    static const char pixel[] = "ps_2_0\ndef c0, 1, 0.5, 0, 1\nmov oC0, c0\n";
    static uint32_t pixels[SIDE * SIDE];
    struct triptych_options options = {.engine = engine, .threads = 2};
    struct triptych_element element = {.format = TRIPTYCH_FORMAT_FLOAT3, .stride = 12};
    triptych_device *device;
    triptych_shader *shader;
    library = dlopen("libtriptych.so", RTLD_NOW | RTLD_LOCAL);
    if (!library || FUNCTION(triptych_device_create)(&options, &device, NULL, 0))
        exit(3);
    int bad = FUNCTION(triptych_set_target)(device, SIDE, SIDE) ||
              FUNCTION(triptych_set_state)(device, TRIPTYCH_STATE_CULLMODE, TRIPTYCH_CULL_NONE) ||
              FUNCTION(triptych_buffer_create)(device, corners, sizeof corners, &element.buffer) ||
              FUNCTION(triptych_set_element)(device, TRIPTYCH_POSITION, &element) ||
              FUNCTION(triptych_draw)(device, TRIPTYCH_TRIANGLE_LIST, 0, 1) ||
              FUNCTION(triptych_shader_assemble)(device, "pixel", pixel, strlen(pixel), &shader) ||
              FUNCTION(triptych_set_pixel_shader)(device, shader) ||
              FUNCTION(triptych_draw)(device, TRIPTYCH_TRIANGLE_LIST, 0, 1) ||
              FUNCTION(triptych_read_color)(device, pixels, sizeof pixels);
    FUNCTION(triptych_device_destroy)(device);
    if (bad || dlclose(library) || dlopen("libtriptych.so", RTLD_NOW | RTLD_NOLOAD))
        exit(4);
}

/* KiB of the field of /proc/self/status, and the bytes that malloc has given. */
static long status(const char *field)
{
    char line[256];
    long value = 0;
    FILE *file = fopen("/proc/self/status", "r");
    while (file && fgets(line, sizeof line, file))
        if (!strncmp(line, field, strlen(field)))
            value = atol(line + strlen(field));
    fclose(file);
    return value;
}

/* Returns true if the process has grown by more than the limit. */
static int grows(const char *engine)
{
    long mapped = status("VmSize:"), given = (long)mallinfo2().uordblks;
    for (int i = 0; i < CYCLES; i++)
        cycle(engine);
    mapped = status("VmSize:") - mapped;
    given = (long)mallinfo2().uordblks - given;
    printf("%s, growth in %d cycles: %ld KiB mapped, %ld bytes of malloc, expected at most %d\n", engine, CYCLES,
           mapped, given, LIMIT * CYCLES);
    return mapped > LIMIT * CYCLES || given > LIMIT * CYCLES;
}

int main(int count, char **arguments)
{
    int grown = count > 1;
    for (int i = 0; i < WARM && count > 1; i++)
        cycle(arguments[1]);
    for (int i = 0; i < ROUNDS && grown; i++)
        grown = grows(arguments[1]);
    return grown;
}
C

unloading_leaves_nothing() # ENGINE
{
    gcc -Wall -Wextra -Werror cycle.c -o cycle $(pkg-config --cflags triptych) -ldl && ./cycle "$1"
}

# --- Recordings of programs ---------------------------------------------------------------------------------

cat >"$work/frames.c" <<'C'
#include <triptych.h>

/* Eight frames, as a program draws them that only reads its pictures, or that marks their ends. */
int main(int count, char **arguments)
{
    (void)arguments;
    const struct triptych_options options = {.engine = "emulate", .threads = 1};
    uint32_t pixels[64];
    triptych_device *device;
    if (triptych_device_create(&options, &device, NULL, 0) || triptych_set_target(device, 8, 8))
        return 1;
    for (int frame = 0; frame < 8; frame++) {
        const float color[4] = {(float)frame / 8, 0, 0, 1};
        if (triptych_clear(device, color, 1) || triptych_read_color(device, pixels, sizeof pixels) ||
            (count > 1 && triptych_end_frame(device)))
            return 1;
    }
    triptych_device_destroy(device);
    return 0;
}
C

recordings_have_the_marked_frames()
{
    compile frames.c frames triptych || return
    TRIPTYCH_RECORD=marked.trib ./frames marked 2>message && [[ ! -s message ]] || return
    "$TRIPTYCH" render marked.trib --frame 7 --out marked.png || return
}

recordings_without_frames_are_a_warning()
{
    TRIPTYCH_RECORD=one.trib ./frames 2>message || return
    grep '^triptych: the recording is one frame, although pixels were read or finished 8 times' message &&
        ! "$TRIPTYCH" render one.trib --frame 1 --out one.png
}

test_case 'the cube in C draws the stored picture' c_cube_draws_the_picture
test_case 'the cube in C reports errors' c_cube_reports_errors
test_case 'the kernel is built by the command of its page' kernel_is_built_by_the_command_of_its_page
test_case 'the cube in Python draws the stored picture' python_cube_draws_the_picture
test_case 'the cube in Python reports errors' python_cube_reports_errors
test_case 'CTest compares with the stored picture' ctest_compares_with_the_picture
test_case 'CTest finds another picture' ctest_finds_another_picture
for engine in emulate batch stitch specialize tiered; do
    test_case "nothing is left after unloading, engine $engine" unloading_leaves_nothing "$engine"
done
test_case 'a recorded program has the frames that it marks' recordings_have_the_marked_frames
test_case 'a recorded program without ends of frames is a warning' recordings_without_frames_are_a_warning
exit $failures
