/* Labels from recordings find keys that lack a field. Each field of the pixel key is left out in turn. */
#include "tests/support/picture/varied.h"
#include "tests/support/system/seed.h"
#include "tests/support/system/tried.h"

#include <stdio.h>
#include <string.h>
#include <unity.h>

enum { DRAWS = 170 };

/* The linker replaces key_pack by this function (see the Makefile). */
static const struct key_field *planted; /* a field of the pixel key that is not packed, or null */
struct packed_key __real_key_pack(enum unit unit, const union key *key);
struct packed_key __wrap_key_pack(enum unit unit, const union key *key);
struct packed_key __wrap_key_pack(enum unit unit, const union key *key)
{
    union key without = *key;
    if (planted && unit == UNIT_PIXEL)
        memset((char *)&without + planted->offset, 0, planted->count);
    return __real_key_pack(unit, &without);
}

static union key drawn[DRAWS];
static unsigned draws;

void setUp(void)
{
    planted = NULL;
    draws = 0;
}

void tearDown(void)
{
}

static void note_draw(void *user, uint64_t number, const union key key[UNIT_COUNT])
{
    (void)user, (void)number;
    if (draws < DRAWS)
        drawn[draws++] = key[UNIT_PIXEL];
}

/* Draws all states, and returns the counts of the pixel unit. */
static struct cache_unit draw(const char *name, struct varied_image *image)
{
    struct error error = {""};
    struct triptych_device *device;
    const struct engine *engine = engine_named(name, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(engine, error.text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(
        TRIPTYCH_OK, device_create(engine, &(struct device_options){.threads = 1}, &device, &error),
        error.text);
    draws = 0;
    device_on_draw(device, note_draw, NULL);
    varied_begin(device);
    for (unsigned n = 0; n < DRAWS; n++)
        varied_draw(device, n);
    varied_read(device, image);
    const struct cache_statistics statistics = cache_statistics(device->cache);
    triptych_device_destroy(device);
    return statistics.unit[UNIT_PIXEL];
}

/* Returns true if two of the drawn keys differ only in the planted field. */
static bool plant_matters(void)
{
    static struct packed_key packed[DRAWS];
    for (unsigned i = 0; i < draws; i++) {
        packed[i] = __wrap_key_pack(UNIT_PIXEL, &drawn[i]);
        for (unsigned j = 0; j < i; j++)
            if (key_equal(&packed[i], &packed[j]) && memcmp(&drawn[i], &drawn[j], sizeof(struct pixel_key)))
                return true;
    }
    return false;
}

static void correct_keys_are_not_reported(void)
{
    struct varied_image by_key, by_label;
    test_needs_engine("specialize");
    const struct cache_unit keys = draw("specialize", &by_key);
    const struct cache_unit labels = draw("specialize:labels=recording", &by_label);
    TEST_ASSERT_EQUAL_MEMORY(&by_key, &by_label, sizeof by_key);
    TEST_ASSERT_EQUAL_UINT64(keys.misses, labels.misses);
    TEST_ASSERT_EQUAL_UINT64(0, labels.wrong_keys);
    TEST_ASSERT_EQUAL_UINT64(0, labels.shared_keys);
    TEST_ASSERT_EQUAL_UINT64(draws, labels.lookups);
}

/* With keys the picture is wrong; with labels it is right, and the key is reported. */
static void a_key_that_lacks_a_field_is_reported(void)
{
    struct varied_image expected, found;
    size_t count;
    unsigned mattered = 0, wrong_pictures = 0;
    const struct key_field *fields = key_fields(UNIT_PIXEL, &count);
    test_needs_engine("specialize");
    draw("specialize", &expected);
    for (size_t i = 0; i < count; i++) {
        planted = fields + i;
        bool matters = plant_matters();
        const bool is_shown = matters ? mattered >= 3 && test_stride() > 1 : mattered > 0;
        if (is_shown && i % (8 * test_stride_of(9)))
            continue;
        const struct cache_unit labels = draw("specialize:labels=recording", &found);
        TEST_ASSERT_EQUAL_MEMORY_MESSAGE(&expected, &found, sizeof found, planted->name);
        TEST_ASSERT_EQUAL_MESSAGE(matters, labels.wrong_keys > 0, planted->name);
        draw("specialize", &found);
        wrong_pictures += memcmp(&expected, &found, sizeof found) != 0;
        mattered += matters;
    }
    TEST_ASSERT_TRUE(mattered >= 3);
    TEST_ASSERT_TRUE(wrong_pictures > 0 && wrong_pictures <= mattered);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(correct_keys_are_not_reported);
    RUN_TEST(a_key_that_lacks_a_field_is_reported);
    return UNITY_END();
}
