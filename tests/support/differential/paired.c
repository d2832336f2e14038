#include "tests/support/differential/paired.h"

#include <string.h>

triptych_device *paired_device[PAIRED_DEVICES];

static void open_one(int which, const char *engine, unsigned threads, const char *settings)
{
    const struct triptych_options options = {.engine = engine, .threads = threads, .settings = settings};
    char reason[256];
    TEST_ASSERT_EQUAL_INT_MESSAGE(
        TRIPTYCH_OK, triptych_device_create(&options, &paired_device[which], reason, sizeof reason), reason);
}

void paired_open(const char *engine, unsigned threads, uint32_t fvf)
{
    open_one(0, "emulate", threads, "spans=off");
    open_one(1, engine, threads, "spans=on");
    PAIRED(triptych_set_target(paired_device[which], PAIRED_SIDE, PAIRED_SIDE));
    PAIRED(triptych_set_fvf(paired_device[which], fvf));
    PAIRED(triptych_set_state(paired_device[which], TRIPTYCH_STATE_LIGHTING, 0));
    PAIRED(triptych_set_state(paired_device[which], TRIPTYCH_STATE_ZENABLE, 0));
    PAIRED(triptych_set_state(paired_device[which], TRIPTYCH_STATE_CULLMODE, 1));
}

void paired_close(void)
{
    for (int which = 0; which < PAIRED_DEVICES; which++)
        triptych_device_destroy(paired_device[which]);
}

void paired_expect_equal(void)
{
    static uint32_t color[PAIRED_DEVICES][PAIRED_PIXELS];
    PAIRED(triptych_read_color(paired_device[which], color[which], sizeof color[which]));
    TEST_ASSERT_EQUAL_HEX32_ARRAY(color[0], color[1], PAIRED_PIXELS);
}

unsigned paired_pixel_routines(void)
{
    struct triptych_routine_info info;
    unsigned count = 0;
    for (unsigned i = 0; triptych_get_routine(paired_device[1], i, &info); i++)
        count += !strcmp(info.unit, "pixel");
    return count;
}
