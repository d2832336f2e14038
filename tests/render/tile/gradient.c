/* A key takes the widest of its span readings whose counted blocks are enough, and draws the same pixels with
 * each. */
#include "triptych.h"

#include "render/tile/span.h"

#include <string.h>
#include <unity.h>

enum { SIDE = 256, PIXELS = SIDE * SIDE, DEVICES = 2, FVF_XYZRHW_DIFFUSE = 0x044 };

/* Frames of a rectangle over the whole target after which its blocks are enough. */
enum { FRAMES = SPAN_WARMTH / (PIXELS / BLOCK_PIXELS) + 2 };

static triptych_device *device[DEVICES];

#define OK(which, call) TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, call, triptych_error(device[which]))
#define EACH(call)                                                                                           \
    for (int which = 0; which < DEVICES; which++)                                                            \
    OK(which, call)

static void open(int which, const char *engine, const char *settings)
{
    const struct triptych_options options = {.engine = engine, .threads = 1, .settings = settings};
    char reason[256];
    TEST_ASSERT_EQUAL_INT_MESSAGE(
        TRIPTYCH_OK, triptych_device_create(&options, &device[which], reason, sizeof reason), reason);
}

void setUp(void)
{
    open(0, "emulate", "spans=off");
    open(1, "stitch", "spans=on");
    EACH(triptych_set_target(device[which], SIDE, SIDE));
    EACH(triptych_set_fvf(device[which], FVF_XYZRHW_DIFFUSE));
    EACH(triptych_set_state(device[which], TRIPTYCH_STATE_LIGHTING, 0));
    EACH(triptych_set_state(device[which], TRIPTYCH_STATE_ZENABLE, 0));
    EACH(triptych_set_state(device[which], TRIPTYCH_STATE_CULLMODE, 1));
}

void tearDown(void)
{
    for (int which = 0; which < DEVICES; which++)
        triptych_device_destroy(device[which]);
}

/* Colours of the corners: upper left, upper right, lower left, lower right. */
static void draw(const uint32_t color[4], float rhw)
{
    struct {
        float x, y, z, rhw;
        uint32_t color;
    } vertex[4];
    for (unsigned i = 0; i < 4; i++) {
        vertex[i].x = i & 1 ? SIDE : 0, vertex[i].y = i & 2 ? SIDE : 0, vertex[i].z = 0.5f;
        vertex[i].rhw = rhw, vertex[i].color = color[i];
    }
    EACH(triptych_draw_user(device[which], TRIPTYCH_TRIANGLE_STRIP, 2, vertex, sizeof vertex[0]));
    EACH(triptych_finish(device[which]));
}

static unsigned pixel_routines(int which)
{
    struct triptych_routine_info info;
    unsigned count = 0;
    for (unsigned i = 0; triptych_get_routine(device[which], i, &info); i++)
        count += !strcmp(info.unit, "pixel");
    return count;
}

static void expect_equal_targets(void)
{
    static uint32_t color[DEVICES][PIXELS];
    EACH(triptych_read_color(device[which], color[which], sizeof color[which]));
    TEST_ASSERT_EQUAL_MEMORY(color[0], color[1], sizeof color[0]);
}

/* Draws enough frames. The last ones have been drawn by one routine more than before, if `adds`. */
static void draw_frames(const uint32_t color[4], float rhw, bool adds)
{
    const unsigned before = pixel_routines(1);
    for (unsigned frame = 0; frame < FRAMES; frame++) {
        draw(color, rhw);
        expect_equal_targets();
    }
    TEST_ASSERT_EQUAL(before + adds, pixel_routines(1));
}

static const uint32_t white[4] = {0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff};
static const uint32_t level[4] = {0xff8040c0, 0xff8040c0, 0xff8040c0, 0xff8040c0};
static const uint32_t gradient[4] = {0xff002040, 0xff402040, 0xff006080, 0xff406080};
static const uint32_t fade[4] = {0x80002040, 0x90402040, 0xa0006080, 0xb0406080};
static const uint32_t twisted[4] = {0xff000000, 0xff00ffff, 0xffff00ff, 0xff0000ff};

static void each_wider_reading_follows_when_its_blocks_are_enough(void)
{
    draw(white, 1);
    TEST_ASSERT_EQUAL(1, pixel_routines(1));
    draw_frames(white, 1, true);
    draw_frames(level, 1, true);
    draw_frames(white, 1, false);
    draw_frames(gradient, 1, true);
    draw_frames(fade, 1, true);
    draw_frames(gradient, 1, false);
    draw_frames(level, 1, false);
    draw_frames(white, 1, false);
}

/* Its wider reading draws white ones, too. */
static void a_key_without_white_triangles_has_no_reading_for_them(void)
{
    draw(level, 1);
    draw_frames(level, 1, true);
    draw_frames(white, 1, false);
}

static void triangles_of_no_class_add_none(void)
{
    draw(level, 1);
    draw_frames(twisted, 1, false);
    draw_frames(gradient, 0.5f, false);
    draw_frames(fade, 1, true);
    draw_frames(gradient, 1, false);
    draw_frames(level, 0.5f, false);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(each_wider_reading_follows_when_its_blocks_are_enough);
    RUN_TEST(a_key_without_white_triangles_has_no_reading_for_them);
    RUN_TEST(triangles_of_no_class_add_none);
    return UNITY_END();
}
