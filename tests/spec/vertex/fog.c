/* Table fog: the factor of each formula at known depths and distances, and how it blends. */
#include "tests/support/picture/canvas.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

static const char *const mode_words[] = {"linear", "exp", "exp2"};

struct fog {
    int mode; /* of mode_words */
    float start, end, density;
};

static void set_float(enum triptych_state state, float value)
{
    OK(triptych_set_state(device, state, triptych_float_bits(value)));
}

/* Direct3D 9's formulas, not yet clamped. */
static double fog_factor(const struct fog *fog, double d)
{
    double start = (double)fog->start, end = (double)fog->end, density = (double)fog->density;
    switch (fog->mode) {
    case 0: return (end - d) / (end - start);
    case 1: return exp(-d * density);
    default: return exp(-(d * density) * (d * density));
    }
}

static uint32_t fogged(uint32_t color, uint32_t fog, int factor)
{
    uint32_t word = color & 0xff000000;
    for (int c = 0; c < 3; c++)
        word |=
            (uint32_t)floor(
                (channel(color, c) * (unsigned)factor + channel(fog, c) * (unsigned)(255 - factor)) / 255.0 +
                0.5)
            << 8 * c;
    return word;
}

/* Draws a square at one distance, unless its fog factor is so near to a boundary that rounding decides. */
static void check_square(const struct fog *fog, double distance, float z)
{
    double scaled = 255 * fmax(0, fmin(1, fog_factor(fog, distance)));
    if (fabs(scaled - floor(scaled) - 0.5) < 0.01)
        return;
    uint32_t color = random_word(), fog_color = random_word();
    char what[96];
    snprintf(what, sizeof what, "%s fog at %g", mode_words[fog->mode], distance);
    set(TRIPTYCH_STATE_FOGTABLEMODE, mode_words[fog->mode]);
    set_float(TRIPTYCH_STATE_FOGSTART, fog->start);
    set_float(TRIPTYCH_STATE_FOGEND, fog->end);
    set_float(TRIPTYCH_STATE_FOGDENSITY, fog->density);
    OK(triptych_set_state(device, TRIPTYCH_STATE_FOGCOLOR, fog_color));
    draw_square(z, color, NULL, 0, 0, 1, 1);
    OK(triptych_read_color(device, image, sizeof image));
    uint32_t expected = fogged(image_word(color), image_word(fog_color), (int)floor(scaled + 0.5));
    for (int p = 0; p < SIZE * SIZE; p += 37)
        expect_pixel(p % SIZE, p / SIZE, expected, what);
}

static struct fog random_fog(int mode, double range)
{
    float start = (float)random_between(-0.2 * range, 0.5 * range);
    return (struct fog){mode, start, start + (float)random_between(0.05 * range, range),
                        (float)(random_between(0, 4) / range)};
}

/* Without perspective the distance is depth. */
static void check_depth_fog(void)
{
    set(TRIPTYCH_STATE_FOGENABLE, "true");
    for (int i = 0; i < 120; i++) {
        struct fog fog = random_fog(i % 3, 1);
        float z = (float)random_between(0, 1);
        check_square(&fog, (double)z, z);
    }
}

/* A square at distance w fills the target, whatever w is. */
static void check_distance_fog(void)
{
    set(TRIPTYCH_STATE_FOGENABLE, "true");
    for (int i = 0; i < 120; i++) {
        struct fog fog = random_fog(i % 3, 60);
        float w = (float)random_between(1, 100);
        float projection[4][4] = {{w, 0, 0, 0}, {0, w, 0, 0}, {0, 0, 0.5f, 1}, {0, 0, 0, 0}};
        OK(triptych_set_transform(device, TRIPTYCH_TRANSFORM_PROJECTION, (const float(*)[4])projection));
        check_square(&fog, (double)w, w);
    }
}

/* Formula and colour have no effect while fog is off. */
static void check_no_fog(void)
{
    struct fog fog = {0, 0, 0.0001f, 1};
    OK(triptych_set_state(device, TRIPTYCH_STATE_FOGCOLOR, 0xff00ff00));
    set_float(TRIPTYCH_STATE_FOGEND, fog.end);
    set(TRIPTYCH_STATE_FOGTABLEMODE, "linear");
    draw_square(0.5f, 0x80402010, NULL, 0, 0, 1, 1);
    OK(triptych_read_color(device, image, sizeof image));
    expect_pixel(0, 0, image_word(0x80402010), "fog that is off");
}

/* Linear fog that starts where it is complete: of a table it covers what is not nearer, of vertices
 * everything. */
static void check_fog_without_range(void)
{
    const float distances[] = {0, 0.25f, 0.5f, 0.75f};
    OK(triptych_set_state(device, TRIPTYCH_STATE_FOGCOLOR, 0xff00ff00));
    OK(triptych_set_state(device, TRIPTYCH_STATE_FOGENABLE, 1));
    set_float(TRIPTYCH_STATE_FOGSTART, 0.5f);
    set_float(TRIPTYCH_STATE_FOGEND, 0.5f);
    for (unsigned i = 0; i < 8; i++) {
        bool vertices = i >= 4, nearer = distances[i % 4] < 0.5f;
        set(TRIPTYCH_STATE_FOGTABLEMODE, vertices ? "none" : "linear");
        set(TRIPTYCH_STATE_FOGVERTEXMODE, vertices ? "linear" : "none");
        draw_square(distances[i % 4], 0x80402010, NULL, 0, 0, 1, 1);
        OK(triptych_read_color(device, image, sizeof image));
        expect_pixel(0, 0, image_word(nearer && !vertices ? 0x80402010 : 0x8000ff00), "fog without range");
    }
}

/* Vertices in the window are not clipped to the depth range, and their fog follows the formula outside of
 * it. */
static void check_fog_outside_of_the_depth_range(void)
{
    const float depths[] = {-0.5f, -0.25f, 1.25f, 1.5f};
    struct fog fog = {0, -1, 2.2f, 1};
    OK(triptych_set_state(device, TRIPTYCH_STATE_FOGENABLE, 1));
    OK(triptych_set_state(device, TRIPTYCH_STATE_FOGCOLOR, 0xff00ff00));
    set(TRIPTYCH_STATE_FOGTABLEMODE, "linear");
    set_float(TRIPTYCH_STATE_FOGSTART, fog.start);
    set_float(TRIPTYCH_STATE_FOGEND, fog.end);
    for (int i = 0; i < 4; i++) {
        float corner[4][4];
        triptych_buffer *buffer;
        for (int c = 0; c < 4; c++)
            memcpy(corner[c], (float[4]){c & 1 ? SIZE : 0, c & 2 ? SIZE : 0, depths[i], 1}, sizeof corner[c]);
        OK(triptych_buffer_create(device, corner, sizeof corner, &buffer));
        OK(triptych_set_element(device, TRIPTYCH_POSITIONT,
                                &(struct triptych_element){TRIPTYCH_FORMAT_FLOAT4, buffer, 0, 16}));
        OK(triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 0, 2));
        OK(triptych_read_color(device, image, sizeof image));
        int factor = (int)floor(255 * fog_factor(&fog, (double)depths[i]) + 0.5);
        expect_pixel(SIZE / 2, SIZE / 2, fogged(0xffffffff, 0xff00ff00, factor), "fog in the window");
    }
}

static void test_fog_by_depth(void)
{
    on_every_engine(check_depth_fog);
}

static void test_fog_by_distance(void)
{
    on_every_engine(check_distance_fog);
}

static void test_fog_that_is_off(void)
{
    on_every_engine(check_no_fog);
}

static void test_fog_without_range(void)
{
    on_every_engine(check_fog_without_range);
}

static void test_fog_outside_of_the_depth_range(void)
{
    on_every_engine(check_fog_outside_of_the_depth_range);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_fog_by_depth);
    RUN_TEST(test_fog_by_distance);
    RUN_TEST(test_fog_that_is_off);
    RUN_TEST(test_fog_without_range);
    RUN_TEST(test_fog_outside_of_the_depth_range);
    return UNITY_END();
}
