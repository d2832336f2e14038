/* Advanced blending, on every engine: each formula of KHR_blend_equation_advanced in binary64, with colours
 * divided by their alphas, against the pixels of targets of bytes, of 10 bits and of floating point. Engines
 * must also agree in every bit, for colours that are brighter than their alpha too. */
#include "tests/support/picture/canvas.h"
#include "tests/support/system/seed.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { FIRST = TRIPTYCH_BLENDOP_MULTIPLY, LAST = TRIPTYCH_BLENDOP_LUMINOSITY, KINDS = LAST - FIRST + 1 };

static float numbers[SIZE * SIZE][4], stored[SIZE * SIZE][4];
static uint32_t under[SIZE * SIZE];

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

/* --- The formulas --- */

static double separate(uint32_t kind, double s, double d)
{
    switch (kind) {
    case TRIPTYCH_BLENDOP_MULTIPLY: return s * d;
    case TRIPTYCH_BLENDOP_SCREEN: return s + d - s * d;
    case TRIPTYCH_BLENDOP_OVERLAY: return d <= 0.5 ? 2 * s * d : 1 - 2 * (1 - s) * (1 - d);
    case TRIPTYCH_BLENDOP_DARKEN: return fmin(s, d);
    case TRIPTYCH_BLENDOP_LIGHTEN: return fmax(s, d);
    case TRIPTYCH_BLENDOP_COLORDODGE: return d <= 0 ? 0 : s < 1 ? fmin(1, d / (1 - s)) : 1;
    case TRIPTYCH_BLENDOP_COLORBURN: return d >= 1 ? 1 : s > 0 ? 1 - fmin(1, (1 - d) / s) : 0;
    case TRIPTYCH_BLENDOP_HARDLIGHT: return s <= 0.5 ? 2 * s * d : 1 - 2 * (1 - s) * (1 - d);
    case TRIPTYCH_BLENDOP_SOFTLIGHT:
        if (s <= 0.5)
            return d - (1 - 2 * s) * d * (1 - d);
        return d <= 0.25 ? d + (2 * s - 1) * d * ((16 * d - 12) * d + 3) : d + (2 * s - 1) * (sqrt(d) - d);
    case TRIPTYCH_BLENDOP_DIFFERENCE: return fabs(d - s);
    default: return s + d - 2 * s * d; /* exclusion */
    }
}

static double luminosity(const double c[3])
{
    return 0.30 * c[0] + 0.59 * c[1] + 0.11 * c[2];
}

static double least(const double c[3])
{
    return fmin(c[0], fmin(c[1], c[2]));
}

static double most(const double c[3])
{
    return fmax(c[0], fmax(c[1], c[2]));
}

static void set_luminosity(const double base[3], const double bright[3], double r[3])
{
    double change = luminosity(bright) - luminosity(base);
    for (int i = 0; i < 3; i++)
        r[i] = base[i] + change;
    double gray = luminosity(r), low = least(r), high = most(r);
    for (int i = 0; i < 3 && low < -1e-12; i++)
        r[i] = gray + (r[i] - gray) * gray / (gray - low);
    for (int i = 0; i < 3 && high > 1 + 1e-12; i++)
        r[i] = gray + (r[i] - gray) * (1 - gray) / (high - gray);
}

static void set_both(const double base[3], const double vivid[3], const double bright[3], double r[3])
{
    double color[3], low = least(base), range = most(base) - low, wanted = most(vivid) - least(vivid);
    for (int i = 0; i < 3; i++)
        color[i] = range > 0 ? (base[i] - low) * wanted / range : 0;
    set_luminosity(color, bright, r);
}

/* f of all channels of the base colours. */
static void mixed(uint32_t kind, const double s[3], const double d[3], double r[3])
{
    switch (kind) {
    case TRIPTYCH_BLENDOP_HUE: set_both(s, d, d, r); return;
    case TRIPTYCH_BLENDOP_SATURATION: set_both(d, s, d, r); return;
    case TRIPTYCH_BLENDOP_COLOR: set_luminosity(s, d, r); return;
    case TRIPTYCH_BLENDOP_LUMINOSITY: set_luminosity(d, s, r); return;
    default:
        for (int i = 0; i < 3; i++)
            r[i] = separate(kind, s[i], d[i]);
    }
}

static void blended(uint32_t kind, const double s[4], const double d[4], double r[4])
{
    double new[3], old[3], f[3];
    for (int i = 0; i < 3; i++) {
        new[i] = s[3] > 0 ? s[i] / s[3] : 0;
        old[i] = d[3] > 0 ? d[i] / d[3] : 0;
    }
    mixed(kind, new, old, f);
    double p0 = s[3] * d[3], p1 = s[3] * (1 - d[3]), p2 = d[3] * (1 - s[3]);
    for (int i = 0; i < 3; i++)
        r[i] = f[i] * p0 + new[i] * p1 + old[i] * p2;
    r[3] = p0 + p1 + p2;
}

/* --- Pictures --- */

/* Colours with alpha 0 and 255 as often as between, and channels at the ends of their range too. If they are
 * premultiplied, no channel is above alpha. */
static uint32_t random_color(int premultiplied)
{
    uint32_t ends = random_word(), word = random_word(), r = 0;
    uint32_t alpha = ends & 1 ? (ends & 2 ? 255 : 0) : word >> 24;
    uint32_t limit = premultiplied ? alpha : 255;
    for (int c = 0; c < 3; c++) {
        uint32_t value = channel(word, c) * limit / 255;
        if (ends >> (4 + c) & 1)
            value = ends >> (8 + c) & 1 ? limit : 0;
        r |= value << 8 * c;
    }
    return r | alpha << 24;
}

static triptych_texture *make_texture(uint32_t *words, int premultiplied)
{
    triptych_texture *texture;
    for (int p = 0; p < SIZE * SIZE; p++)
        words[p] = random_color(premultiplied);
    OK(triptych_texture_create(device, words, SIZE, SIZE, &texture));
    return texture;
}

/* Factors and the states of alpha have no effect. */
static void draw_blended(uint32_t kind, triptych_texture *below, triptych_texture *above)
{
    OK(triptych_set_texture(device, 0, below));
    set(TRIPTYCH_STATE_ALPHABLENDENABLE, "false");
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    OK(triptych_read_target_numbers(device, 0, stored[0], sizeof stored));
    OK(triptych_set_texture(device, 0, above));
    set(TRIPTYCH_STATE_ALPHABLENDENABLE, "true");
    set(TRIPTYCH_STATE_SRCBLEND, kind % 2 ? "zero" : "destcolor");
    set(TRIPTYCH_STATE_SEPARATEALPHABLENDENABLE, kind % 3 ? "true" : "false");
    OK(triptych_set_state(device, TRIPTYCH_STATE_BLENDOP, kind));
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    OK(triptych_read_target_numbers(device, 0, numbers[0], sizeof numbers));
}

static int well_formed_color(const double c[4])
{
    return c[0] <= c[3] && c[1] <= c[3] && c[2] <= c[3];
}

/* The formulas are undefined for colours above an alpha of 0, and those that mix channels above any alpha. */
static int is_defined(uint32_t kind, const double s[4], const double d[4])
{
    return (well_formed_color(s) && well_formed_color(d)) ||
           (kind < TRIPTYCH_BLENDOP_HUE && s[3] > 0 && d[3] > 0);
}

/* `levels` of a channel's codes; 0: floating point. Codes may be off by the error of binary32. */
static double error_of(double got, double expected, int levels)
{
    if (levels)
        expected = fmin(fmax(expected, 0), 1);
    double allowed = levels ? (0.5 + 0.02) / levels : 1e-5 * fmax(1, fabs(expected));
    return fabs(got - expected) - allowed;
}

static void expect_formula(uint32_t kind, const int levels[4])
{
    int compared = 0;
    for (int p = 0; p < SIZE * SIZE; p += pixel_stride()) {
        double s[4], d[4], r[4];
        for (int c = 0; c < 4; c++) {
            s[c] = channel(texel[p], c) / 255.0;
            d[c] = (double)stored[p][c];
        }
        if (!is_defined(kind, s, d))
            continue;
        compared++;
        blended(kind, s, d, r);
        for (int c = 0; c < 4; c++)
            if (!(error_of((double)numbers[p][c], r[c], levels[c]) <= 0)) {
                char message[160];
                snprintf(message, sizeof message,
                         "operation %u, pixel %d, channel %d: expected %.9g, got %.9g", (unsigned)kind, p, c,
                         r[c], (double)numbers[p][c]);
                TEST_FAIL_MESSAGE(message);
            }
    }
    TEST_ASSERT_TRUE_MESSAGE(compared > 10, "few pixels have defined colours");
}

enum { FORMATS = 4 };

static const struct {
    enum triptych_surface_format format;
    int levels[4];
} formats[FORMATS] = {
    {TRIPTYCH_SURFACE_A8R8G8B8, {255, 255, 255, 255}},
    {TRIPTYCH_SURFACE_X8R8G8B8, {255, 255, 255, 255}},
    {TRIPTYCH_SURFACE_A2R10G10B10, {1023, 1023, 1023, 3}},
    {TRIPTYCH_SURFACE_A32B32G32R32F, {0, 0, 0, 0}},
};

static int well_formed;
static float first[FORMATS][KINDS][SIZE * SIZE][4]; /* of the first engine */
static int has_first;

static void expect_same_bits(unsigned format, uint32_t kind)
{
    void *kept = first[format][kind - FIRST];
    if (!has_first)
        memcpy(kept, numbers, sizeof numbers);
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(kept, numbers, sizeof numbers, "engines differ");
}

static void check_format(unsigned i)
{
    struct triptych_target_description description = {
        .width = SIZE, .height = SIZE, .color_format = {formats[i].format}};
    OK(triptych_set_target_description(device, &description));
    triptych_texture *below = make_texture(under, well_formed), *above = make_texture(texel, well_formed);
    for (uint32_t kind = FIRST; kind <= LAST; kind++) {
        draw_blended(kind, below, above);
        expect_formula(kind, formats[i].levels);
        expect_same_bits(i, kind);
    }
}

static void check(void)
{
    set_stage(0, TRIPTYCH_STAGE_COLOROP, "selectarg1");
    set_stage(0, TRIPTYCH_STAGE_ALPHAOP, "selectarg1");
    set(TRIPTYCH_STATE_BLENDOPALPHA, "max");
    for (unsigned i = 0; i < FORMATS; i++)
        check_format(i);
    has_first = 1;
}

static void test_advanced_blending_is_as_defined(void)
{
    well_formed = 1;
    has_first = 0;
    on_every_engine(check);
}

static void test_colours_above_their_alpha_are_blended_by_the_same_formulas(void)
{
    well_formed = 0;
    has_first = 0;
    on_every_engine(check);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_advanced_blending_is_as_defined);
    RUN_TEST(test_colours_above_their_alpha_are_blended_by_the_same_formulas);
    return UNITY_END();
}
