/* Operations on a shaded pixel, on every engine: alpha test, late depth write, scissor and blending. Each
 * expected value is computed here from the definition. */
#include "tests/support/picture/canvas.h"
#include "tests/support/system/seed.h"

#include <stdio.h>

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

/* --- Alpha test ---------------------------------------------------------------------------------------- */

static int passes(uint32_t function, unsigned alpha, unsigned reference)
{
    int order = alpha < reference ? 1 : alpha == reference ? 2 : 4;
    return (function - 1) & order ? 1 : 0; /* never, less, equal, lessequal, greater ... always: 1 to 8 */
}

/* A texture whose alpha takes every value, in the order of the pixels. */
static void bind_every_alpha(void)
{
    triptych_texture *texture;
    for (uint32_t i = 0; i < SIZE * SIZE; i++)
        texel[i] = (i % 256) << 24 | (random_word() & 0xffffff);
    OK(triptych_texture_create(device, texel, SIZE, SIZE, &texture));
    OK(triptych_set_texture(device, 0, texture));
    set_stage(0, TRIPTYCH_STAGE_COLOROP, "selectarg1");
    set_stage(0, TRIPTYCH_STAGE_ALPHAOP, "selectarg1");
}

static void expect_alpha_tested(uint32_t function, unsigned reference, uint32_t background, int writes_color,
                                int writes_depth)
{
    static float depth[SIZE * SIZE];
    char what[64];
    snprintf(what, sizeof what, "alpha function %u against %u", (unsigned)function, reference);
    OK(triptych_read_color(device, image, sizeof image));
    OK(triptych_read_depth(device, depth, sizeof depth));
    for (int p = 0; p < SIZE * SIZE; p += pixel_stride()) {
        int kept = passes(function, texel[p] >> 24, reference);
        expect_pixel(p % SIZE, p / SIZE, kept && writes_color ? texel[p] : background, what);
        TEST_ASSERT_EQUAL_FLOAT_MESSAGE(kept && writes_depth ? 0.25f : 1, depth[p], what);
    }
}

static void check_alpha_test(void)
{
    enum { REFERENCES = 6 };
    static const uint8_t references[REFERENCES] = {0, 1, 127, 128, 254, 255};
    bind_every_alpha();
    set(TRIPTYCH_STATE_ZENABLE, "true");
    set(TRIPTYCH_STATE_ALPHATESTENABLE, "true");
    for (unsigned i = 0; i < 8 * REFERENCES * 4; i += test_stride_of(5)) {
        uint32_t function = 1 + i % 8, reference = references[i / 8 % REFERENCES],
                 writes = i / 8 / REFERENCES;
        uint32_t background = random_word();
        OK(triptych_set_state(device, TRIPTYCH_STATE_ALPHAFUNC, function));
        OK(triptych_set_state(device, TRIPTYCH_STATE_ALPHAREF, reference));
        OK(triptych_set_state(device, TRIPTYCH_STATE_COLORWRITEENABLE, writes & 1 ? 15 : 0));
        set(TRIPTYCH_STATE_ZWRITEENABLE, writes & 2 ? "true" : "false");
        clear_to(background);
        draw_square(0.25f, 0xffffffff, NULL, 0, 0, 1, 1);
        expect_alpha_tested(function, reference, background, writes & 1, writes & 2);
    }
}

static void test_alpha_decides_colour_and_depth(void)
{
    on_every_engine(check_alpha_test);
}

/* A pixel that fails the depth comparison is not written, whatever its alpha is. */
static void check_depth_with_alpha_test(void)
{
    static float depth[SIZE * SIZE];
    bind_every_alpha();
    set(TRIPTYCH_STATE_ZENABLE, "true");
    clear_to(0);
    set_sampler(0, TRIPTYCH_SAMPLER_MAGFILTER, "linear");
    set_sampler(0, TRIPTYCH_SAMPLER_MINFILTER, "linear");
    draw_square(0.5f, 0xffffffff, NULL, 0, 0, 1, 1);
    OK(triptych_read_color(device, texel, sizeof texel));
    set(TRIPTYCH_STATE_ALPHATESTENABLE, "true");
    set(TRIPTYCH_STATE_ALPHAFUNC, "greaterequal");
    OK(triptych_set_state(device, TRIPTYCH_STATE_ALPHAREF, 100));
    draw_square(0.75f, 0xffffffff, NULL, 0, 0, 1, 1);
    OK(triptych_read_depth(device, depth, sizeof depth));
    for (int p = 0; p < SIZE * SIZE; p++)
        TEST_ASSERT_EQUAL_FLOAT(0.5f, depth[p]);
    draw_square(0.25f, 0xffffffff, NULL, 0, 0, 1, 1);
    OK(triptych_read_depth(device, depth, sizeof depth));
    for (int p = 0; p < SIZE * SIZE; p++)
        TEST_ASSERT_EQUAL_FLOAT(texel[p] >> 24 >= 100 ? 0.25f : 0.5f, depth[p]);
}

static void test_the_depth_comparison_comes_before_the_alpha_test(void)
{
    on_every_engine(check_depth_with_alpha_test);
}

/* --- Scissor ------------------------------------------------------------------------------------------- */

static void expect_scissored(unsigned x, unsigned y, unsigned width, unsigned height, uint32_t inside,
                             uint32_t outside, const char *what)
{
    OK(triptych_read_color(device, image, sizeof image));
    for (unsigned row = 0; row < SIZE; row++)
        for (unsigned column = 0; column < SIZE; column++) {
            int in = column - x < width && row - y < height;
            expect_pixel((int)column, (int)row, in ? inside : outside, what);
        }
}

static void check_scissor(void)
{
    for (int round = 0; round < (int)test_share_of(40, 8); round++) {
        uint32_t background = random_word(), clear = random_word(), color = random_word();
        unsigned x = random_word() % (SIZE + 1), y = random_word() % (SIZE + 1);
        unsigned width = random_word() % (SIZE + 1 - x), height = random_word() % (SIZE + 1 - y);
        OK(triptych_set_scissor(device, x, y, width, height));
        set(TRIPTYCH_STATE_SCISSORTESTENABLE, "false");
        clear_to(background);
        expect_scissored(0, 0, SIZE, SIZE, background, background, "a clear without the test");
        set(TRIPTYCH_STATE_SCISSORTESTENABLE, "true");
        clear_to(clear);
        expect_scissored(x, y, width, height, clear, background, "a clear with the test");
        draw_square(0, color, NULL, 0, 0, 1, 1);
        expect_scissored(x, y, width, height, image_word(color), background, "a draw with the test");
        set(TRIPTYCH_STATE_SCISSORTESTENABLE, "false");
        draw_square(0, color, NULL, 0, 0, 1, 1);
        expect_scissored(0, 0, SIZE, SIZE, image_word(color), color, "a draw without the test");
    }
}

static void check_new_target(void)
{
    OK(triptych_set_scissor(device, 10, 10, 5, 5));
    set(TRIPTYCH_STATE_SCISSORTESTENABLE, "true");
    OK(triptych_set_target(device, SIZE, SIZE));
    clear_to(0x12345678);
    expect_scissored(0, 0, SIZE, SIZE, 0x12345678, 0, "a clear of a new target");
}

static void test_the_scissor_rectangle_limits_draws_and_clears(void)
{
    on_every_engine(check_scissor);
}

static void test_a_new_target_is_the_scissor_rectangle(void)
{
    on_every_engine(check_new_target);
}

/* --- Blending ------------------------------------------------------------------------------------------ */

/* Numbers are Direct3D 9's. */
struct blending {
    uint32_t operation, source, target;
};

enum { ADD = 1, SUBTRACT, REVSUBTRACT, MIN, MAX };
enum { FACTORS = 17, LAST_CONSECUTIVE = 15, BLENDINGS = 5 * FACTORS * FACTORS };

static uint32_t stored[SIZE * SIZE], constant; /* images' words */

static unsigned factor(uint32_t number, uint32_t s, uint32_t d, int c)
{
    unsigned saturated = s >> 24 < 255 - (d >> 24) ? s >> 24 : 255 - (d >> 24);
    switch (number) {
    case 1: return 0;
    case 2: return 255;
    case 3: return channel(s, c);
    case 4: return 255 - channel(s, c);
    case 5: return s >> 24;
    case 6: return 255 - (s >> 24);
    case 7: return d >> 24;
    case 8: return 255 - (d >> 24);
    case 9: return channel(d, c);
    case 10: return 255 - channel(d, c);
    case 11: return c == 3 ? 255 : saturated;
    case 14: return channel(constant, c);
    case 18: return constant >> 24;
    case 19: return 255 - (constant >> 24);
    default: return 255 - channel(constant, c);
    }
}

/* Returns true if the factors are f and 1 - f. */
static int complementary(uint32_t source, uint32_t target)
{
    uint32_t low = source < target ? source : target, high = source ^ target ^ low;
    return high == low + 1 && (low == 14 || low == 18 || (low % 2 && low < 11));
}

static unsigned rounded(unsigned sum)
{
    return (2 * sum + 255) / 510;
}

static unsigned blend_channel(struct blending b, uint32_t s, uint32_t d, int c)
{
    if (b.source == 12 || b.source == 13) {
        b.target = b.source == 12 ? 6 : 5;
        b.source = b.source == 12 ? 5 : 6;
    }
    unsigned x = channel(s, c), y = channel(d, c);
    unsigned px = x * factor(b.source, s, d, c), py = y * factor(b.target, s, d, c);
    unsigned new = rounded(px), old = rounded(py);
    switch (b.operation) {
    case ADD: return complementary(b.source, b.target) ? rounded(px + py) : new + old > 255 ? 255 : new + old;
    case SUBTRACT: return new > old ? new - old : 0;
    case REVSUBTRACT: return old > new ? old - new : 0;
    case MIN: return x < y ? x : y;
    default: return x > y ? x : y;
    }
}

static void expect_blended(struct blending color, struct blending alpha)
{
    char what[96];
    snprintf(what, sizeof what, "operation %u of %u and %u, alpha %u of %u and %u", color.operation,
             color.source, color.target, alpha.operation, alpha.source, alpha.target);
    OK(triptych_read_color(device, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p += pixel_stride()) {
        uint32_t word = 0;
        for (int c = 0; c < 4; c++)
            word |= blend_channel(c == 3 ? alpha : color, texel[p], stored[p], c) << 8 * c;
        expect_pixel(p % SIZE, p / SIZE, word, what);
    }
}

static void set_blending(struct blending b)
{
    OK(triptych_set_state(device, TRIPTYCH_STATE_BLENDOP, b.operation));
    OK(triptych_set_state(device, TRIPTYCH_STATE_SRCBLEND, b.source));
    OK(triptych_set_state(device, TRIPTYCH_STATE_DESTBLEND, b.target));
}

static void set_alpha_blending(struct blending b)
{
    OK(triptych_set_state(device, TRIPTYCH_STATE_BLENDOPALPHA, b.operation));
    OK(triptych_set_state(device, TRIPTYCH_STATE_SRCBLENDALPHA, b.source));
    OK(triptych_set_state(device, TRIPTYCH_STATE_DESTBLENDALPHA, b.target));
}

/* The numbers after 15, srccolor2 and its inverse, are in second_color.c. */
static uint32_t factor_number(unsigned i)
{
    return i < LAST_CONSECUTIVE ? 1 + i : 3 + i;
}

/* Makes blending number i. Returns 0 if its target factor is allowed only as a source factor. */
static int make_blending(unsigned i, struct blending *b)
{
    *b = (struct blending){1 + i / (FACTORS * FACTORS), factor_number(i / FACTORS % FACTORS),
                           factor_number(i % FACTORS)};
    return b->target != 12 && b->target != 13;
}

/* Makes words whose channels are as often at the ends of their range as between them. */
static void make_texture(uint32_t *words, triptych_texture **texture)
{
    for (int p = 0; p < SIZE * SIZE; p++) {
        uint32_t ends = random_word();
        words[p] = random_word();
        for (int c = 0; c < 4; c++)
            if (ends >> c & 1)
                words[p] = (words[p] & ~(255u << 8 * c)) | (ends >> (4 + c) & 1 ? 255u << 8 * c : 0);
    }
    OK(triptych_texture_create(device, words, SIZE, SIZE, texture));
}

static void draw_over_stored(triptych_texture *under, triptych_texture *over)
{
    set(TRIPTYCH_STATE_ALPHABLENDENABLE, "false");
    OK(triptych_set_texture(device, 0, under));
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    set(TRIPTYCH_STATE_ALPHABLENDENABLE, "true");
    OK(triptych_set_texture(device, 0, over));
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
}

static void check_blending(int separate)
{
    triptych_texture *under, *over;
    make_texture(stored, &under);
    make_texture(texel, &over);
    set_stage(0, TRIPTYCH_STAGE_COLOROP, "selectarg1");
    set_stage(0, TRIPTYCH_STAGE_ALPHAOP, "selectarg1");
    set(TRIPTYCH_STATE_SEPARATEALPHABLENDENABLE, separate ? "true" : "false");
    for (unsigned i = 0; i < BLENDINGS; i += test_step(2, 19)) {
        struct blending color, alpha;
        if (!make_blending(i, &color))
            continue;
        while (!make_blending(random_word() % BLENDINGS, &alpha))
            ;
        uint32_t packed = random_word();
        constant = image_word(packed);
        OK(triptych_set_state(device, TRIPTYCH_STATE_BLENDFACTOR, packed));
        set_blending(color);
        set_alpha_blending(alpha);
        draw_over_stored(under, over);
        expect_blended(color, separate ? alpha : color);
    }
}

static void check_blending_alike(void)
{
    check_blending(0);
}

static void check_blending_apart(void)
{
    check_blending(1);
}

static void test_blending_is_as_defined(void)
{
    on_every_engine(check_blending_alike);
}

static void test_alpha_is_blended_separately(void)
{
    on_every_engine(check_blending_apart);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_alpha_decides_colour_and_depth);
    RUN_TEST(test_the_depth_comparison_comes_before_the_alpha_test);
    RUN_TEST(test_the_scissor_rectangle_limits_draws_and_clears);
    RUN_TEST(test_a_new_target_is_the_scissor_rectangle);
    RUN_TEST(test_blending_is_as_defined);
    RUN_TEST(test_alpha_is_blended_separately);
    return UNITY_END();
}
