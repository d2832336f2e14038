/* The parts of a build: they are those of the build that others make, and what passes remove adds up. */
#include "engines/list.h"
#include "engines/specialize/build.h"
#include "engines/specialize/parts.h"
#include <unity.h>

#include <string.h>

static const struct engine *engine;
static struct error error;

void setUp(void)
{
    engine = engine_find("specialize-8");
    error_clear(&error);
}

void tearDown(void)
{
}

static struct build_parts measure(enum unit unit, const union key *key)
{
    struct build_parts parts;
    TEST_ASSERT_EQUAL_MESSAGE(0, specialize_measure(engine, unit, key, &parts, &error), error.text);
    return parts;
}

static const union key *plain_key(void)
{
    static union key key;
    memset(&key, 0, sizeof key);
    return &key;
}

static void every_part_has_a_name(void)
{
    TEST_ASSERT_EQUAL_STRING("record", specialize_part_name(BUILD_RECORD));
    TEST_ASSERT_EQUAL_STRING("dead", specialize_part_name(BUILD_PASSES + PASS_dead));
    TEST_ASSERT_EQUAL_STRING("compact", specialize_part_name(BUILD_COMPACT));
    TEST_ASSERT_EQUAL_STRING("encode", specialize_part_name(BUILD_ENCODE));
    TEST_ASSERT_EQUAL_STRING("assemble", specialize_part_name(BUILD_ASSEMBLE));
    TEST_ASSERT_NULL(specialize_part_name(BUILD_PARTS));
}

/* Also after the code was written once without an encoder. */
static void the_build_is_the_one_that_others_make(void)
{
    struct builder *b = specialize_take(&error);
    TEST_ASSERT_NOT_NULL_MESSAGE(b, error.text);
    for (unsigned unit = 0; unit < UNIT_COUNT; unit++) {
        const struct build_options options = specialize_options(engine, unit);
        size_t bytes = specialize_code(b, &options, unit, plain_key(), NULL, NULL, &error);
        TEST_ASSERT_NOT_EQUAL_MESSAGE(0, bytes, error.text);
        struct build_parts parts = measure(unit, plain_key());
        TEST_ASSERT_EQUAL(bytes, parts.bytes);
        TEST_ASSERT_EQUAL(b->ir.count - 1, parts.left);
        TEST_ASSERT_EQUAL(b->allocation.spills, parts.spills);
    }
    specialize_give(b);
}

static void check_sums(const struct build_parts *parts)
{
    int32_t removed = 0;
    uint32_t last = parts->recorded;
    for (unsigned p = 0; p < PASS_COUNT; p++) {
        const struct build_part *part = &parts->part[BUILD_PASSES + p];
        removed += part->removed;
        if (!part->runs)
            TEST_ASSERT_EQUAL(last, part->first_left);
        last = part->first_left;
    }
    TEST_ASSERT_EQUAL(parts->recorded - parts->left, removed);
    TEST_ASSERT_EQUAL(parts->recorded, parts->part[BUILD_RECORD].first_left);
    TEST_ASSERT_EQUAL(parts->left, parts->part[BUILD_ENCODE].first_left);
}

static void what_passes_remove_adds_up(void)
{
    static const char *const names[] = {"specialize-8", "specialize-8:unroll", "specialize-thesis",
                                        "specialize-8:registers=4:without=dead", "specialize-8:encode=text"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        for (unsigned unit = 0; unit < UNIT_COUNT; unit++) {
            engine = engine_find(names[i]);
            const struct build_parts parts = measure(unit, plain_key());
            TEST_ASSERT_GREATER_THAN(10, parts.recorded);
            check_sums(&parts);
        }
}

static void every_part_takes_time(void)
{
    const struct build_parts parts = measure(UNIT_VERTEX, plain_key());
    TEST_ASSERT_GREATER_THAN(0, parts.part[BUILD_RECORD].ns);
    TEST_ASSERT_GREATER_THAN(0, parts.part[BUILD_PASSES + PASS_dead].ns);
    TEST_ASSERT_GREATER_THAN(0, parts.part[BUILD_PASSES + PASS_dead].runs);
    TEST_ASSERT_GREATER_THAN(0, parts.part[BUILD_PASSES + PASS_dead].removed);
    TEST_ASSERT_GREATER_THAN(0, parts.part[BUILD_ALLOCATE].ns);
    TEST_ASSERT_GREATER_THAN(0, parts.part[BUILD_SELECT].ns);
}

static void only_text_is_assembled(void)
{
    const struct build_parts direct = measure(UNIT_VERTEX, plain_key());
    engine = engine_find("specialize-8:encode=text");
    const struct build_parts text = measure(UNIT_VERTEX, plain_key());
    TEST_ASSERT_EQUAL(0, direct.part[BUILD_ASSEMBLE].ns);
    TEST_ASSERT_GREATER_THAN(0, text.part[BUILD_ASSEMBLE].ns);
    TEST_ASSERT_EQUAL(direct.bytes, text.bytes);
}

static void hints_are_found_before_allocation(void)
{
    const struct build_parts scan = measure(UNIT_VERTEX, plain_key());
    engine = engine_find("specialize-8:allocate=hints");
    const struct build_parts hints = measure(UNIT_VERTEX, plain_key());
    TEST_ASSERT_GREATER_THAN(scan.part[BUILD_HINTS].ns, hints.part[BUILD_HINTS].ns);
    TEST_ASSERT_GREATER_THAN(0, hints.part[BUILD_ALLOCATE].ns);
}

static void no_pass_removes_nothing(void)
{
    engine = engine_find("specialize-none");
    const struct build_parts parts = measure(UNIT_VERTEX, plain_key());
    TEST_ASSERT_EQUAL(parts.recorded, parts.left);
    for (unsigned p = 0; p < PASS_COUNT; p++)
        TEST_ASSERT_EQUAL(pass_is_required(p), parts.part[BUILD_PASSES + p].runs);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(every_part_has_a_name);
    RUN_TEST(the_build_is_the_one_that_others_make);
    RUN_TEST(what_passes_remove_adds_up);
    RUN_TEST(every_part_takes_time);
    RUN_TEST(only_text_is_assembled);
    RUN_TEST(hints_are_found_before_allocation);
    RUN_TEST(no_pass_removes_nothing);
    return UNITY_END();
}
