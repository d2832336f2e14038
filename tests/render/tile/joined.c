/* A draw whose triangles are all joined to rectangles with colours from 0 to 1 takes the reading for them,
 * once its key has drawn enough of their blocks, and draws the same pixels with it. */
#include "render/tile/span.h"

#include "base/random.h"
#include "tests/support/differential/paired.h"
#include "tests/support/system/seed.h"

enum { TEXELS = 64, LETTER = 10, CELL = 12, FVF_LETTER = 0x144, SHADE_FLAT = 1 };
enum {
    ROW = PAIRED_SIDE / CELL,
    LETTERS = 1300, /* over each other. Their chunks would have 325 triangles, if that were even */
    LETTER_VERTICES = 6,
    CAPACITY = LETTER_VERTICES * (LETTERS + 1)
};

/* Frames of letters after which their blocks are enough: each has at least four. */
enum { FRAMES = SPAN_WARMTH / (4 * LETTERS) + 2 };

struct vertex {
    float x, y, z, rhw;
    uint32_t color;
    float u, v;
};

static struct random source;
static struct vertex vertex[CAPACITY];
static unsigned vertices;

static void bind_texture(int which)
{
    static uint32_t texel[TEXELS * TEXELS];
    triptych_texture *texture;
    struct random texels = random_start(test_seed(), 1);
    for (unsigned i = 0; i < TEXELS * TEXELS; i++)
        texel[i] = (uint32_t)random_u64(&texels);
    PAIRED_OK(which, triptych_texture_create(paired_device[which], texel, TEXELS, TEXELS, &texture));
    PAIRED_OK(which, triptych_set_texture(paired_device[which], 0, texture));
}

void setUp(void)
{
    source = random_start(test_seed(), 0);
    vertices = 0;
    paired_open("specialize", 2, FVF_LETTER);
    PAIRED(triptych_set_state(paired_device[which], TRIPTYCH_STATE_SHADEMODE, SHADE_FLAT));
    for (int which = 0; which < PAIRED_DEVICES; which++)
        bind_texture(which);
}

void tearDown(void)
{
    paired_close();
}

static unsigned below(unsigned count)
{
    return (unsigned)(random_u64(&source) % count);
}

static void add_vertex(float x, float y, float rhw, uint32_t color, float u, float v)
{
    vertex[vertices++] = (struct vertex){x, y, 0.5f, rhw, color, u / TEXELS, v / TEXELS};
}

/* Two triangles of one colour, with a texel for each pixel, and a gap to the next letter. */
static void add_letter(unsigned number, float rhw)
{
    static const uint8_t corner[LETTER_VERTICES] = {0, 1, 2, 1, 2, 3};
    const uint32_t color = (uint32_t)random_u64(&source);
    const float left = (float)(number % ROW * CELL), top = (float)(number / ROW % ROW * CELL);
    const float u = (float)below(TEXELS - LETTER), v = (float)below(TEXELS - LETTER);
    for (unsigned i = 0; i < LETTER_VERTICES; i++) {
        const float across = corner[i] & 1 ? LETTER : 0, down = corner[i] & 2 ? LETTER : 0;
        add_vertex(left + across, top + down, rhw, color, u + across, v + down);
    }
}

static void add_letters(unsigned from, unsigned to, float rhw)
{
    for (unsigned number = from; number < to; number++)
        add_letter(number, rhw);
}

/* Two in perspective, over several letters. Pairs after them still begin with an even triangle. */
static void add_triangles(void)
{
    add_vertex(20, 30, 1, 0xff80ff40, 0, 0);
    add_vertex(200, 70, 0.5f, 0xff80ff40, 60, 10);
    add_vertex(90, 220, 0.25f, 0xff80ff40, 5, 50);
    add_vertex(40, 60, 0.5f, 0xff4080ff, 10, 0);
    add_vertex(250, 110, 1, 0xff4080ff, 0, 60);
    add_vertex(30, 200, 0.75f, 0xff4080ff, 40, 5);
}

static void draw(void)
{
    PAIRED(triptych_draw_user(paired_device[which], TRIPTYCH_TRIANGLE_LIST, vertices / 3, vertex,
                              sizeof vertex[0]));
    paired_expect_equal();
}

/* Draws enough frames, and returns how many pixel routines there are then. */
static unsigned draw_frames(void)
{
    for (unsigned frame = 0; frame < FRAMES; frame++)
        draw();
    return paired_pixel_routines();
}

static void letters_get_a_reading_of_their_own(void)
{
    add_letters(0, LETTERS, 1);
    draw();
    TEST_ASSERT_EQUAL(1, paired_pixel_routines());
    TEST_ASSERT_EQUAL(2, draw_frames());
    TEST_ASSERT_EQUAL(2, draw_frames());
}

static void letters_of_another_depth_in_perspective_do_not(void)
{
    add_letters(0, LETTERS, 0.5f);
    TEST_ASSERT_EQUAL(1, draw_frames());
}

/* Two triangles are enough to draw all of their draw by the ordinary reading. */
static void triangles_among_letters_have_their_perspective(void)
{
    add_letters(0, LETTERS, 1);
    TEST_ASSERT_EQUAL(2, draw_frames());
    for (unsigned before = 0; before <= LETTERS; before += LETTERS / 32 * test_stride()) {
        vertices = 0;
        add_letters(0, before, 1);
        add_triangles();
        add_letters(before, LETTERS, 1);
        draw();
    }
    TEST_ASSERT_EQUAL(2, paired_pixel_routines());
}

static void letters_with_triangles_among_them_are_not_counted(void)
{
    add_letters(0, LETTERS, 1);
    add_triangles();
    TEST_ASSERT_EQUAL(1, draw_frames());
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(letters_get_a_reading_of_their_own);
    RUN_TEST(letters_of_another_depth_in_perspective_do_not);
    RUN_TEST(triangles_among_letters_have_their_perspective);
    RUN_TEST(letters_with_triangles_among_them_are_not_counted);
    return UNITY_END();
}
