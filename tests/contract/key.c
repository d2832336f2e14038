/* Keys: packed and textual forms keep every field, and refuse input that is not a key. */
#include "contract/key.h"
#include "tests/support/shader/random_key.h"

#include <stdio.h>
#include <string.h>
#include <unity.h>

enum { RANDOM_KEYS = 2000 };

void setUp(void)
{
}

void tearDown(void)
{
}

static void packing_gives_the_same_fields_back(void)
{
    uint64_t seed = 1;
    for (int unit = 0; unit < UNIT_COUNT; unit++)
        for (int i = 0; i < RANDOM_KEYS; i++) {
            union key key, back;
            key_random(unit, &seed, &key);
            struct packed_key packed = key_pack(unit, &key);
            key_unpack(unit, &packed, &back);
            TEST_ASSERT_EQUAL_MEMORY(&key, &back, sizeof key);
        }
}

static void text_gives_the_same_fields_back(void)
{
    uint64_t seed = 2;
    for (int unit = 0; unit < UNIT_COUNT; unit++)
        for (int i = 0; i < RANDOM_KEYS; i++) {
            union key key, back;
            char text[KEY_TEXT_CAPACITY];
            const char *where;
            key_random(unit, &seed, &key);
            TEST_ASSERT_EQUAL_INT(0, key_parse(unit, key_print(unit, &key, text), &back, &where));
            TEST_ASSERT_EQUAL_MEMORY(&key, &back, sizeof key);
        }
}

/* A change of any single digit changes the packed form, so digits do not overlap and are inside of the
 * words. */
static void every_digit_matters(void)
{
    for (int unit = 0; unit < UNIT_COUNT; unit++) {
        size_t count;
        const struct key_field *field = key_fields(unit, &count);
        for (size_t f = 0; f < count; f++)
            for (unsigned j = 0; j < field[f].count; j++) {
                union key key;
                memset(&key, 0, sizeof key);
                struct packed_key zero = key_pack(unit, &key);
                ((uint8_t *)&key)[field[f].offset + j] = (uint8_t)(field[f].radix - 1);
                struct packed_key one = key_pack(unit, &key);
                TEST_ASSERT_FALSE_MESSAGE(key_equal(&zero, &one), field[f].name);
                TEST_ASSERT_TRUE_MESSAGE(key_hash(unit, &zero) != key_hash(unit, &one), field[f].name);
            }
    }
}

/* The largest digits fit: the words hold the whole radix product of every unit. */
static void the_largest_key_survives_packing(void)
{
    for (int unit = 0; unit < UNIT_COUNT; unit++) {
        union key key, back;
        size_t count;
        memset(&key, 0, sizeof key);
        const struct key_field *field = key_fields(unit, &count);
        for (size_t f = 0; f < count; f++)
            for (unsigned j = 0; j < field[f].count; j++)
                ((uint8_t *)&key)[field[f].offset + j] = (uint8_t)(field[f].radix - 1);
        struct packed_key packed = key_pack(unit, &key);
        key_unpack(unit, &packed, &back);
        TEST_ASSERT_EQUAL_MEMORY(&key, &back, sizeof key);
    }
}

static void hash_differs_between_units(void)
{
    union key key;
    memset(&key, 0, sizeof key);
    struct packed_key packed = key_pack(UNIT_VERTEX, &key);
    TEST_ASSERT_TRUE(key_hash(UNIT_VERTEX, &packed) != key_hash(UNIT_SETUP, &packed));
    TEST_ASSERT_TRUE(key_hash(UNIT_SETUP, &packed) != key_hash(UNIT_PIXEL, &packed));
}

static void the_zero_key_prints_as_default(void)
{
    union key key;
    char text[KEY_TEXT_CAPACITY];
    memset(&key, 0, sizeof key);
    TEST_ASSERT_EQUAL_STRING("default", key_print(UNIT_PIXEL, &key, text));
}

static void fields_print_by_name(void)
{
    union key key;
    char text[KEY_TEXT_CAPACITY];
    memset(&key, 0, sizeof key);
    key.pixel.depth_function = COMPARE_LESS_EQUAL;
    key.pixel.varying[VARYING_texcoord0] = INTERPOLATION_SMOOTH;
    TEST_ASSERT_EQUAL_STRING("depth_function=3 varying=0,1", key_print(UNIT_PIXEL, &key, text));
}

static void bad_text_is_refused_with_the_position(void)
{
    static const struct {
        const char *text;
        int offset;
    } bad[] = {
        {"nonsense=1", 0},      {"cull", 0},        {"cull=", 5},
        {"cull=3", 5},          {"cull=x", 5},      {"cull=1,2", 6},
        {"varying=1,9", 10},    {"varying=1,", 10}, {"cull=1,", 6},
        {"cull=1 depth=2", 13}, {"cull=-1", 5},     {"cull=99999999999", 5},
        {"default=1", 0},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        union key key;
        const char *where;
        TEST_ASSERT_EQUAL_INT_MESSAGE(-1, key_parse(UNIT_SETUP, bad[i].text, &key, &where), bad[i].text);
        TEST_ASSERT_EQUAL_INT_MESSAGE(bad[i].offset, (int)(where - bad[i].text), bad[i].text);
    }
}

static void the_fields_of_a_unit_stay_inside_its_key(void)
{
    static const size_t size[UNIT_COUNT] = {sizeof(struct vertex_key), sizeof(struct setup_key),
                                            sizeof(struct pixel_key)};
    for (int unit = 0; unit < UNIT_COUNT; unit++) {
        size_t count, bytes = 0;
        const struct key_field *field = key_fields(unit, &count);
        for (size_t f = 0; f < count; f++) {
            TEST_ASSERT_EQUAL_UINT64(bytes, field[f].offset);
            bytes += field[f].count;
        }
        TEST_ASSERT_EQUAL_UINT64(size[unit], bytes);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(packing_gives_the_same_fields_back);
    RUN_TEST(text_gives_the_same_fields_back);
    RUN_TEST(every_digit_matters);
    RUN_TEST(the_largest_key_survives_packing);
    RUN_TEST(hash_differs_between_units);
    RUN_TEST(the_zero_key_prints_as_default);
    RUN_TEST(fields_print_by_name);
    RUN_TEST(bad_text_is_refused_with_the_position);
    RUN_TEST(the_fields_of_a_unit_stay_inside_its_key);
    return UNITY_END();
}
