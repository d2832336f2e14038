/* Texts of external:c=portable as programs of their own. Each is compiled with the flags of strict C11, by
 * gcc and by clang, and runs on the same inputs as the emulator, in another process, without flags of the
 * processor. The results are equal.
 *
 * TRIPTYCH_CROSS names a compiler for another machine and TRIPTYCH_CROSS_RUN the command that runs its
 * programs: then only this compiler is tested (make check-cross). Both may have arguments, in words. */
#include "emu/emulate/emulate.h"
#include "engines/external/external.h"
#include "engines/list.h"
#include "tests/support/portable/image.h"
#include "tests/support/differential/differential_part.h"
#include "tests/support/system/seed.h"
#include <unity.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *const strict = "-std=c11 -pedantic -Wall -Wextra -Werror -Wno-unused -Wno-unknown-pragmas "
                                  "-Wno-incompatible-function-pointer-types -O1";
enum { ROUNDS = 4, RANGES = ATTRIBUTE_COUNT + 6, PATH = 256 };

static char folder[] = "/tmp/triptych-portable-test-XXXXXX";
static struct differential *differential;
static const struct engine *portable;

void setUp(void)
{
    differential = differential_create(NULL);
    TEST_ASSERT_NOT_NULL(differential);
    portable = engine_find("external:c=portable");
    TEST_ASSERT_NOT_NULL(portable);
}

void tearDown(void)
{
    differential_destroy(differential);
}

/* --- Images --------------------------------------------------------------------------------------------- */

/* Memory that an image has a copy of, at an offset. */
struct range {
    const void *start;
    size_t bytes, offset;
};

struct image {
    struct range range[RANGES];
    unsigned ranges;
    struct image_head head;
    char *memory;
    struct image_pointer *pointer;
};

static void add_range(struct image *image, const void *start, size_t bytes)
{
    size_t misaligned = (uintptr_t)start % 64;
    struct range *range = &image->range[image->ranges++];
    image->head.bytes = (image->head.bytes + 63) / 64 * 64 + misaligned;
    *range = (struct range){start, bytes, image->head.bytes};
    image->head.bytes += bytes;
}

static bool find_offset(const struct image *image, uint64_t address, uint64_t *offset)
{
    for (unsigned r = 0; r < image->ranges; r++) {
        const struct range *range = &image->range[r];
        if (address - (uintptr_t)range->start <= range->bytes) {
            *offset = address - (uintptr_t)range->start + range->offset;
            return true;
        }
    }
    return false;
}

/* Copies the ranges. Each aligned word that is an address in one of them becomes a pointer of the image. */
static void fill_image(struct image *image)
{
    image->memory = calloc(1, image->head.bytes + 64);
    image->pointer = calloc(image->head.bytes / 8 + 1, sizeof *image->pointer);
    TEST_ASSERT_TRUE(image->memory && image->pointer);
    for (unsigned r = 0; r < image->ranges; r++)
        memcpy(image->memory + image->range[r].offset, image->range[r].start, image->range[r].bytes);
    for (uint64_t at = 0; at + 8 <= image->head.bytes; at += 8) {
        struct image_pointer *pointer = &image->pointer[image->head.pointers];
        uint64_t word;
        memcpy(&word, image->memory + at, sizeof word);
        pointer->at = at;
        image->head.pointers += find_offset(image, word, &pointer->to);
    }
}

static void write_image(const struct image *image, const char *path)
{
    FILE *file = fopen(path, "wb");
    TEST_ASSERT_NOT_NULL(file);
    fwrite(&image->head, sizeof image->head, 1, file);
    fwrite(image->pointer, sizeof *image->pointer, image->head.pointers, file);
    fwrite(image->memory, 1, image->head.bytes, file);
    TEST_ASSERT_EQUAL(0, fclose(file));
}

/* Writes the inputs of the differential test, and a call of the unit whose outputs are its second result. */
static void write_call(enum unit unit, const char *path)
{
    struct differential *d = differential;
    struct differential_arguments call = differential_arguments(d, &d->result[1]);
    const void *calls[UNIT_COUNT] = {&call.vertex, &call.setup, &call.pixel};
    struct image *image = calloc(1, sizeof *image);
    TEST_ASSERT_NOT_NULL(image);
    d->result[1] = d->initial;
    add_range(image, &call, sizeof call);
    add_range(image, d, sizeof *d);
    add_range(image, d->job.srgb, sizeof *d->job.srgb);
    add_range(image, d->texels, TEXTURE_BYTES);
    add_range(image, d->palette, PALETTE_BYTES);
    add_range(image, d->constants, CONSTANT_BYTES);
    for (int a = 0; a < ATTRIBUTE_COUNT; a++)
        add_range(image, d->stream[a], STREAM_BYTES);
    TEST_ASSERT_TRUE(find_offset(image, (uintptr_t)calls[unit], &image->head.call));
    TEST_ASSERT_TRUE(find_offset(image, (uintptr_t)&d->result[1], &image->head.result));
    image->head.result_bytes = sizeof d->result[1];
    fill_image(image);
    write_image(image, path);
    free(image->memory);
    free(image->pointer);
    free(image);
}

/* --- Programs ------------------------------------------------------------------------------------------- */

static const char *path(const char *name)
{
    static char text[8][PATH];
    static unsigned next;
    char *at = text[next++ % 8];
    snprintf(at, PATH, "%s/%s", folder, name);
    return at;
}

static void write_text(enum unit unit, const union key *key)
{
    struct error error = {{0}};
    FILE *out = fopen(path("routine.c"), "w");
    struct ir *ir = ir_take(unit, key, &error);
    TEST_ASSERT_TRUE_MESSAGE(out && ir, error.text);
    external_print_beginning(EXTERNAL_PORTABLE, out);
    TEST_ASSERT_EQUAL(0, external_print(EXTERNAL_PORTABLE, ir, unit, key, out));
    ir_give(ir);
    TEST_ASSERT_EQUAL(0, fclose(out));
}

static void run_command(const char *command)
{
    if (system(command)) /* NOLINT: the command is the test's */
        TEST_FAIL_MESSAGE(command);
}

static void read_result(void)
{
    FILE *file = fopen(path("result"), "rb");
    TEST_ASSERT_NOT_NULL(file);
    TEST_ASSERT_EQUAL(1, fread(&differential->result[1], sizeof differential->result[1], 1, file));
    fclose(file);
}

/* Compares the program with the emulator, whose result is the first. */
static void compare(enum unit unit, const union key *key, const char *compiler, const char *runner)
{
    char command[8 * PATH];
    snprintf(command, sizeof command, "%s %s tests/support/portable/harness.c %s -o %s -lm", compiler, strict,
             path("routine.c"), path("program"));
    run_command(command);
    write_call(unit, path("image"));
    snprintf(command, sizeof command, "%s %s %s %s", runner, path("program"), path("image"), path("result"));
    run_command(command);
    read_result();
    const char *difference = differential_results(differential, &engine_emulate, portable, unit, key);
    if (difference)
        TEST_FAIL_MESSAGE(difference);
}

static void emulate(enum unit unit, const union key *key)
{
    struct error error = {{0}};
    struct differential_arguments call = differential_arguments(differential, &differential->result[0]);
    const void *calls[UNIT_COUNT] = {&call.vertex, &call.setup, &call.pixel};
    struct routine *routine = engine_build(&engine_emulate, NULL, unit, key, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(routine, error.text);
    differential->result[0] = differential->initial;
    routine->run(calls[unit], routine);
    engine_emulate.free(NULL, routine);
}

/* Without a compiler, only writes the texts. */
static void check(const char *compiler, const char *runner)
{
    uint64_t seed = 5;
    for (int round = 0; round < (int)test_share_of(ROUNDS, 5); round++)
        for (int unit = 0; unit < UNIT_COUNT; unit++) {
            union key key;
            differential_key(unit, &seed, &key);
            differential_fill(differential, unit, &key, seed);
            emulate(unit, &key);
            write_text(unit, &key);
            if (compiler)
                compare(unit, &key, compiler, runner);
        }
}

/* --- Tests ---------------------------------------------------------------------------------------------- */

static bool is_here(const char *compiler)
{
    char command[PATH];
    snprintf(command, sizeof command, "command -v %s >/dev/null", compiler);
    return !system(command); /* NOLINT */
}

static void check_native(const char *compiler)
{
    if (getenv("TRIPTYCH_CROSS"))
        TEST_IGNORE_MESSAGE("a compiler for another machine is tested");
    if (!is_here(compiler))
        TEST_IGNORE_MESSAGE("there is no such compiler");
    if (test_stride() > 1)
        TEST_IGNORE_MESSAGE("sanitizers do not check the program of the text");
    check(compiler, "");
}

static void test_the_text_of_every_unit_is_written(void)
{
    check(NULL, "");
}

static void test_strict_c11_of_gcc_equals_the_emulator(void)
{
    check_native("gcc");
}

static void test_strict_c11_of_clang_equals_the_emulator(void)
{
    check_native("clang");
}

static void test_another_machine_equals_the_emulator(void)
{
    const char *compiler = getenv("TRIPTYCH_CROSS"), *runner = getenv("TRIPTYCH_CROSS_RUN");
    if (!compiler)
        TEST_IGNORE_MESSAGE("make check-cross tests it");
    check(compiler, runner ? runner : "");
}

int main(void)
{
    if (!mkdtemp(folder))
        return 1;
    UNITY_BEGIN();
    RUN_TEST(test_the_text_of_every_unit_is_written);
    RUN_TEST(test_strict_c11_of_gcc_equals_the_emulator);
    RUN_TEST(test_strict_c11_of_clang_equals_the_emulator);
    RUN_TEST(test_another_machine_equals_the_emulator);
    static const char *const files[] = {"routine.c", "program", "image", "result"};
    for (unsigned i = 0; i < sizeof files / sizeof *files; i++)
        unlink(path(files[i]));
    rmdir(folder);
    return UNITY_END();
}
