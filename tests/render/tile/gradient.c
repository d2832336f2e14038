/* A key takes the widest of its span readings whose counted blocks are enough, and draws the same pixels with
 * each. */
#include "render/tile/span.h"

#include "tests/support/differential/paired.h"

enum { FVF_XYZRHW_DIFFUSE = 0x044 };

/* Frames of a rectangle over the whole target after which its blocks are enough. */
enum { FRAMES = SPAN_WARMTH / (PAIRED_PIXELS / BLOCK_PIXELS) + 2 };

void setUp(void)
{
    paired_open("stitch", 1, FVF_XYZRHW_DIFFUSE);
}

void tearDown(void)
{
    paired_close();
}

/* Colours of the corners: upper left, upper right, lower left, lower right. */
static void draw(const uint32_t color[4], float rhw)
{
    struct {
        float x, y, z, rhw;
        uint32_t color;
    } vertex[4];
    for (unsigned i = 0; i < 4; i++) {
        vertex[i].x = i & 1 ? PAIRED_SIDE : 0, vertex[i].y = i & 2 ? PAIRED_SIDE : 0, vertex[i].z = 0.5f;
        vertex[i].rhw = rhw, vertex[i].color = color[i];
    }
    PAIRED(triptych_draw_user(paired_device[which], TRIPTYCH_TRIANGLE_STRIP, 2, vertex, sizeof vertex[0]));
    PAIRED(triptych_finish(paired_device[which]));
}

/* Draws enough frames. The last ones have been drawn by one routine more than before, if `adds`. */
static void draw_frames(const uint32_t color[4], float rhw, bool adds)
{
    const unsigned before = paired_pixel_routines();
    for (unsigned frame = 0; frame < FRAMES; frame++) {
        draw(color, rhw);
        paired_expect_equal();
    }
    TEST_ASSERT_EQUAL(before + adds, paired_pixel_routines());
}

static const uint32_t white[4] = {0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff};
static const uint32_t level[4] = {0xff8040c0, 0xff8040c0, 0xff8040c0, 0xff8040c0};
static const uint32_t gradient[4] = {0xff002040, 0xff402040, 0xff006080, 0xff406080};
static const uint32_t fade[4] = {0x80002040, 0x90402040, 0xa0006080, 0xb0406080};
static const uint32_t twisted[4] = {0xff000000, 0xff00ffff, 0xffff00ff, 0xff0000ff};

static void each_wider_reading_follows_when_its_blocks_are_enough(void)
{
    draw(white, 1);
    TEST_ASSERT_EQUAL(1, paired_pixel_routines());
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
