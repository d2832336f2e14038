/* Variants of engines: their names, their options, and what is wrong in a name. */
#define _GNU_SOURCE
#include "engines/list.h"
#include "engines/specialize/build.h"
#include "engines/specialize/specialize.h"
#include "engines/variant.h"
#include "tests/support/system/fault.h"
#include "triptych.h"
#include <unity.h>

void setUp(void)
{
}

void tearDown(void)
{
    fault_disarm();
}

static const struct engine *make(const char *name)
{
    struct error error = {""};
    const struct engine *engine = engine_named(name, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(engine, error.text);
    TEST_ASSERT_EQUAL_STRING(name, engine->name);
    return engine;
}

static void a_variant_is_an_engine_of_its_own(void)
{
    const struct engine *base = make("specialize-8"), *variant = make("specialize-8:registers=6");
    TEST_ASSERT_NOT_EQUAL(base, variant);
    TEST_ASSERT_TRUE(specialize_is_engine(variant));
    TEST_ASSERT_EQUAL(8, variant->width);
    TEST_ASSERT_EQUAL_PTR(variant, make("specialize-8:registers=6"));
    TEST_ASSERT_EQUAL_PTR(variant, engine_find("specialize-8:registers=6"));
    TEST_ASSERT_NOT_EQUAL(variant, make("specialize-8:registers=7"));
}

/* A walk over all engines does not meet variants, but they have numbers. */
static void variants_are_not_listed(void)
{
    const struct engine *variant = make("specialize-4:registers=5");
    for (unsigned i = 0; engine_at(i); i++)
        TEST_ASSERT_NOT_EQUAL(variant, engine_at(i));
    TEST_ASSERT_EQUAL_PTR(variant, engine_at(engine_number(variant)));
    TEST_ASSERT_EQUAL_PTR(engine_find("stitch"), engine_at(engine_number(engine_find("stitch"))));
    TEST_ASSERT_EQUAL_STRING(variant->name, triptych_engine_name(engine_number(variant)));
}

static unsigned registers_of(const char *name, enum unit unit)
{
    const struct build_options options = specialize_options(make(name), unit);
    uint64_t all = options.width == 16 ? WIDE_REGISTERS : NARROW_REGISTERS;
    return (unsigned)__builtin_popcountll(all & ~options.file.without);
}

static unsigned masks_of(const char *name)
{
    const struct build_options options = specialize_options(make(name), UNIT_PIXEL);
    return (unsigned)__builtin_popcountll(MASK_REGISTERS & ~options.file.without);
}

static void registers_are_limited(void)
{
    static const struct {
        const char *name;
        unsigned registers, masks;
    } rows[] = {{"specialize-16:registers=0", 0, 0},   {"specialize-16:registers=4", 4, 2},
                {"specialize-16:registers=13", 13, 6}, {"specialize-16:registers=14", 14, 6},
                {"specialize-16:registers=28", 28, 6}, {"specialize-16:registers=29", 29, 6}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        TEST_ASSERT_EQUAL_MESSAGE(rows[i].registers, registers_of(rows[i].name, UNIT_PIXEL), rows[i].name);
        TEST_ASSERT_EQUAL_MESSAGE(rows[i].masks, masks_of(rows[i].name), rows[i].name);
    }
    TEST_ASSERT_EQUAL(0, registers_of("specialize-8:registers=0", UNIT_PIXEL));
    TEST_ASSERT_EQUAL(12, registers_of("specialize-8:registers=12", UNIT_PIXEL));
    TEST_ASSERT_EQUAL(13, registers_of("specialize-8:registers=13", UNIT_VERTEX));
    TEST_ASSERT_EQUAL(13, registers_of("specialize:registers=29", UNIT_SETUP));
}

/* Without the pass that every engine has. */
static uint32_t passes_of(const char *name)
{
    const struct build_options *o = make(name)->options;
    return pass_select(o->profile, o->enabled, o->disabled) & ~(1u << PASS_split);
}

static void passes_are_chosen(void)
{
    uint32_t all = passes_of("specialize"), thesis = passes_of("specialize-thesis");
    TEST_ASSERT_EQUAL_HEX32(1u << PASS_copy | 1u << PASS_reduce | 1u << PASS_dead, thesis);
    TEST_ASSERT_EQUAL_HEX32(((1u << PASS_COUNT) - 1) & ~(1u << PASS_unroll | 1u << PASS_split), all);
    TEST_ASSERT_EQUAL_HEX32(0, passes_of("specialize-none"));
    TEST_ASSERT_EQUAL_HEX32(0, passes_of("specialize:passes=none"));
    TEST_ASSERT_EQUAL_HEX32(thesis, passes_of("specialize-16:passes=thesis"));
    TEST_ASSERT_EQUAL_HEX32(all, passes_of("specialize-thesis:passes=all"));
    TEST_ASSERT_EQUAL_HEX32(all & ~(1u << PASS_fold | 1u << PASS_common),
                            passes_of("specialize:without=fold:without=common"));
    TEST_ASSERT_EQUAL_HEX32(1u << PASS_fold, passes_of("specialize-8:with=fold:passes=none"));
    TEST_ASSERT_EQUAL_HEX32(all | 1u << PASS_unroll, passes_of("specialize:unroll"));
    TEST_ASSERT_EQUAL_HEX32(all | 1u << PASS_unroll, passes_of("specialize:with=unroll"));
    TEST_ASSERT_EQUAL_HEX32(all, passes_of("specialize:unroll:without=unroll"));
}

static enum allocator allocator_of(const char *name)
{
    return specialize_options(make(name), UNIT_PIXEL).allocator;
}

static void allocators_are_chosen(void)
{
    TEST_ASSERT_EQUAL(ALLOCATOR_scan, allocator_of("specialize"));
    TEST_ASSERT_EQUAL(ALLOCATOR_none, allocator_of("specialize-simple"));
    TEST_ASSERT_EQUAL(ALLOCATOR_none, allocator_of("specialize-16:allocate=none"));
    TEST_ASSERT_EQUAL(ALLOCATOR_scan, allocator_of("specialize-simple:allocate=scan"));
}

static void encodings_are_chosen(void)
{
    TEST_ASSERT_EQUAL(ENCODING_BYTES, specialize_options(make("specialize-8"), UNIT_PIXEL).encoding);
    TEST_ASSERT_EQUAL(ENCODING_TEXT,
                      specialize_options(make("specialize-8:encode=text"), UNIT_PIXEL).encoding);
}

static void wrong_names_are_refused(void)
{
    static const char *const rows[][2] = {
        {"specialise", "engine specialise: there is none of that name, expected one of: emulate, "},
        {"specialise:unroll", "engine specialise: there is none"},
        {"stitch:registers=6", "engine stitch:registers=6: stitch takes no options"},
        {"emulate:registers=6", "found the option \"registers\", expected one of: files, decode"},
        {"batch:fuse=product", "fuse is \"product\", expected one of: none, products; did you mean"},
        {"external:c=plane",
         "c is \"plane\", expected one of: vectors, plain, portable, pixels; did you mean \"plain\"?"},
        {"emulate:files=one", "files is \"one\", expected one of: typed, array"},
        {"emulate:decode=ones", "decode is \"ones\", expected one of: each, once; did you mean \"once\"?"},
        {"specialize-8:", "engine specialize-8:: found the option \"\", expected one of: registers, "},
        {"specialize-8:unrol", "did you mean \"unroll\"?"},
        {"specialize-8:registers", "registers has no value, expected 0 to 29"},
        {"specialize-8:registers=", "registers is \"\", expected a whole number from 0 to 13"},
        {"specialize-8:registers=14", "registers is \"14\", expected a whole number from 0 to 13"},
        {"specialize-8:registers=+4", "registers is \"+4\", expected"},
        {"specialize-8:registers=4294967300", "registers is \"4294967300\", expected"},
        {"specialize:registers=30", "registers is \"30\", expected a whole number from 0 to 29"},
        {"specialize:passes=most", "passes is \"most\", expected one of: none, thesis, all"},
        {"specialize:without=commn", "did you mean \"common\"?"},
        {"specialize:without=split", "without is \"split\", expected one of: unroll, phi, "},
        {"specialize:allocate=scann", "did you mean \"scan\"?"},
        {"specialize:without=exchang", "did you mean \"exchange\"?"},
        {"specialize:encode=binary", "encode is \"binary\", expected one of: bytes, text"},
        {"specialize:unroll=2", "unroll takes no value, found \"2\""},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct error error = {""};
        TEST_ASSERT_NULL_MESSAGE(engine_named(rows[i][0], &error), rows[i][0]);
        if (!strstr(error.text, rows[i][1]))
            TEST_ASSERT_EQUAL_STRING(rows[i][1], error.text);
    }
}

static void long_names_are_refused(void)
{
    struct error error = {""};
    char name[2 * ENGINE_NAME_CAPACITY] = "specialize";
    while (strlen(name) < ENGINE_NAME_CAPACITY)
        strcat(name, ":unroll");
    TEST_ASSERT_NULL(engine_named(name, &error));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error.text, "bytes, expected at most 255"), error.text);
}

static void a_device_has_the_engine_that_is_named(void)
{
    triptych_device *device;
    char reason[200];
    struct triptych_options options = {.engine = "specialize-4:registers=7:unroll", .threads = 1};
    if (engine_unavailable(make("specialize-4")))
        TEST_IGNORE_MESSAGE("needs AVX2 and FMA");
    TEST_ASSERT_EQUAL_MESSAGE(TRIPTYCH_OK, triptych_device_create(&options, &device, reason, sizeof reason),
                              reason);
    TEST_ASSERT_EQUAL_STRING(options.engine, triptych_get_engine(device));
    triptych_device_destroy(device);
    options.engine = "specialize-4:registers=14";
    TEST_ASSERT_EQUAL(TRIPTYCH_BAD_ARGUMENT,
                      triptych_device_create(&options, &device, reason, sizeof reason));
    TEST_ASSERT_EQUAL_STRING(
        "engine specialize-4:registers=14: registers is \"14\", expected a whole number from 0 to 13",
        reason);
}

/* After a refusal of memory the same name can be made. */
static void memory_may_be_refused(void)
{
    static const char name[] = "specialize-8:registers=9:without=fold";
    unsigned refused = 0;
    for (unsigned long at = 1; at < 10; at++) {
        triptych_device *device = NULL;
        char reason[200];
        const struct triptych_options options = {.engine = name, .threads = 1};
        fault_arm(at, true);
        enum triptych_result result = triptych_device_create(&options, &device, reason, sizeof reason);
        fault_disarm();
        triptych_device_destroy(device);
        if (result == TRIPTYCH_OK)
            break;
        refused += strstr(reason, "out of memory for an engine") != NULL;
        TEST_ASSERT_EQUAL_MESSAGE(TRIPTYCH_NO_MEMORY, result, reason);
    }
    TEST_ASSERT_EQUAL(2, refused);
    make(name);
}

enum { THREADS = 8, NAMES = 13 };

static void *name_all(void *found)
{
    const struct engine **engine = found;
    for (unsigned n = 0; n < NAMES; n++) {
        char name[64];
        snprintf(name, sizeof name, "specialize-thesis:registers=%u:with=common", n);
        engine[n] = engine_find(name);
    }
    return NULL;
}

static void threads_find_the_same_variants(void)
{
    static const struct engine *found[THREADS][NAMES];
    pthread_t thread[THREADS];
    for (unsigned t = 0; t < THREADS; t++)
        TEST_ASSERT_EQUAL(0, pthread_create(&thread[t], NULL, name_all, found[t]));
    for (unsigned t = 0; t < THREADS; t++)
        pthread_join(thread[t], NULL);
    for (unsigned n = 0; n < NAMES; n++)
        TEST_ASSERT_NOT_NULL(found[0][n]);
    for (unsigned t = 1; t < THREADS; t++)
        TEST_ASSERT_EQUAL_MEMORY(found[0], found[t], sizeof found[0]);
}

static void the_number_of_variants_is_limited(void)
{
    struct error error = {""};
    char name[64];
    unsigned made = 0;
    for (; made <= ENGINE_VARIANTS; made++) {
        snprintf(name, sizeof name, "specialize-8:registers=%u:registers=%u:registers=%u", made / 169,
                 made / 13 % 13, made % 13);
        if (!engine_named(name, &error))
            break;
    }
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error.text, "there are 1024 variants of engines already"),
                                 error.text);
    TEST_ASSERT_NOT_NULL(engine_find("specialize-8:registers=0:registers=0:registers=1"));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_variant_is_an_engine_of_its_own);
    RUN_TEST(variants_are_not_listed);
    RUN_TEST(registers_are_limited);
    RUN_TEST(passes_are_chosen);
    RUN_TEST(allocators_are_chosen);
    RUN_TEST(encodings_are_chosen);
    RUN_TEST(wrong_names_are_refused);
    RUN_TEST(long_names_are_refused);
    RUN_TEST(a_device_has_the_engine_that_is_named);
    RUN_TEST(memory_may_be_refused);
    RUN_TEST(threads_find_the_same_variants);
    RUN_TEST(the_number_of_variants_is_limited);
    return UNITY_END();
}
