/* Pictures whose pixels are all computed from the definition, on every engine: texel grids, bilinear weights,
 * addressing, stages, blending, masks, depth functions, and lighting in double precision. No expected value
 * comes from an engine. Where the contract uses integers, the test does too. */
#include "tests/support/picture/canvas.h"
#include "tests/support/system/seed.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

/* --- Textures ------------------------------------------------------------------------------------------ */

enum addressing { WRAP, MIRROR, CLAMP, BORDER, MIRROR_ONCE, ADDRESSINGS };

static const char *const addressing_word[ADDRESSINGS] = {"wrap", "mirror", "clamp", "border", "mirroronce"};
static uint32_t border; /* an image's word */

static int modulo(int index, int size)
{
    return (index % size + size) % size;
}

static int clamped(int index, int size)
{
    return index < 0 ? 0 : index >= size ? size - 1 : index;
}

/* The index in the image, or -1 for the border. */
static int addressed(int index, int size, enum addressing mode)
{
    int within_two = modulo(index, 2 * size);
    switch (mode) {
    case WRAP: return modulo(index, size);
    case MIRROR: return within_two < size ? within_two : 2 * size - 1 - within_two;
    case CLAMP: return clamped(index, size);
    case BORDER: return index < 0 || index >= size ? -1 : index;
    default: return clamped(index < 0 ? -1 - index : index, size);
    }
}

/* The size of a drawn texture, and the addressing of each axis. */
struct sampled {
    int width, height;
    enum addressing u, v;
};

static uint32_t texel_at(const struct sampled *s, int column, int row)
{
    int x = addressed(column, s->width, s->u), y = addressed(row, s->height, s->v);
    return x < 0 || y < 0 ? border : texel[y * s->width + x];
}

/* Returns the position of pixel i in 1/256 texel if coordinates go from `low` to `high`. It is exact for the
 * draws of this file. */
static int texel_position(int i, double low, double high, int size)
{
    double coordinate = low + (high - low) * (i + 0.5) / SIZE;
    return (int)nearbyint(coordinate * size * 256);
}

static uint32_t expected_point(const struct sampled *s, int px, int py)
{
    return texel_at(s, px >> 8, py >> 8);
}

static unsigned mix(unsigned a, unsigned b, unsigned weight)
{
    return (a * (256 - weight) + b * weight + 128) >> 8;
}

static uint32_t expected_bilinear(const struct sampled *s, int px, int py)
{
    uint32_t word = 0;
    px -= 128;
    py -= 128;
    int x = px >> 8, y = py >> 8;
    for (int c = 0; c < 4; c++) {
        unsigned row[2];
        for (int j = 0; j < 2; j++)
            row[j] = mix(channel(texel_at(s, x, y + j), c), channel(texel_at(s, x + 1, y + j), c), px & 255);
        word |= mix(row[0], row[1], py & 255) << 8 * c;
    }
    return word;
}

static void set_filter(const char *word)
{
    set_sampler(0, TRIPTYCH_SAMPLER_MAGFILTER, word);
    set_sampler(0, TRIPTYCH_SAMPLER_MINFILTER, word);
}

static void check_texture(const struct sampled *s, double low, double high, int linear)
{
    char what[96];
    snprintf(what, sizeof what, "%dx%d texels from %g to %g, %s %s, %s", s->width, s->height, low, high,
             addressing_word[s->u], addressing_word[s->v], linear ? "linear" : "point");
    bind_random_texture((unsigned)s->width, (unsigned)s->height);
    set_sampler(0, TRIPTYCH_SAMPLER_ADDRESSU, addressing_word[s->u]);
    set_sampler(0, TRIPTYCH_SAMPLER_ADDRESSV, addressing_word[s->v]);
    set_filter(linear ? "linear" : "point");
    uint32_t color = random_word();
    border = image_word(color);
    OK(triptych_set_sampler_state(device, 0, TRIPTYCH_SAMPLER_BORDERCOLOR, color));
    draw_square(0, 0xffffffff, NULL, (float)low, (float)low, (float)high, (float)high);
    OK(triptych_read_color(device, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p += pixel_stride()) {
        int x = p % SIZE, y = p / SIZE;
        int px = texel_position(x, low, high, s->width), py = texel_position(y, low, high, s->height);
        expect_pixel(x, y, (linear ? expected_bilinear : expected_point)(s, px, py), what);
    }
}

static int extremes_seen;

static void check_texel_grid(void)
{
    bind_random_texture(SIZE, SIZE);
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    OK(triptych_read_color(device, image, sizeof image));
    TEST_ASSERT_EQUAL_HEX32_ARRAY(texel, image, SIZE * SIZE);
}

static void check_textures(void)
{
    enum { SIZES = 5, WAYS = 2 * ADDRESSINGS * ADDRESSINGS };
    static const int sizes[SIZES][2] = {{8, 8}, {64, 2}, {1, 1}, {6, 12}, {3, 64}};
    for (unsigned i = 0; i < SIZES * WAYS; i += test_stride_of(7)) {
        const int *size = sizes[i / WAYS], linear = i % 2;
        struct sampled s = {size[0], size[1], i / 2 % ADDRESSINGS, i / 2 / ADDRESSINGS % ADDRESSINGS};
        check_texture(&s, -1, 2, linear);
        if (s.u != s.v)
            continue;
        check_texture(&s, 0, 1, linear);
        check_texture(&s, -5, 3, linear);
        check_texture(&s, 0.25, 0.5, linear);
    }
}

/* Coordinates that are too large for the fixed-point format select any texel of the image, the same on every
 * engine. With border addressing they give the border colour. */
static void check_extreme_coordinates(void)
{
    static const float extremes[] = {3e9f, -3e9f, 1e38f, -1e38f};
    static uint32_t first[ADDRESSINGS][2][4][2];
    OK(triptych_set_sampler_state(device, 0, TRIPTYCH_SAMPLER_BORDERCOLOR, 0x80604020));
    for (int mode = 0; mode < ADDRESSINGS; mode++)
        for (int linear = 0; linear < 2; linear++)
            for (int i = 0; i < 4; i++)
                for (int odd = 0; odd < 2; odd++) {
                    uint32_t *expected = &first[mode][linear][i][odd];
                    float at = extremes[i];
                    bind_random_texture(odd ? 6 : 8, 1);
                    set_sampler(0, TRIPTYCH_SAMPLER_ADDRESSU, addressing_word[mode]);
                    set_filter(linear ? "linear" : "point");
                    draw_square(0, 0xffffffff, NULL, at, 0.5f, at, 0.5f);
                    OK(triptych_read_color(device, image, sizeof image));
                    if (!extremes_seen)
                        *expected = mode == BORDER ? image_word(0x80604020) : image[0];
                    for (int p = 0; p < SIZE * SIZE; p++)
                        expect_pixel(p % SIZE, p / SIZE, *expected, addressing_word[mode]);
                }
    extremes_seen = 1;
}

static void test_a_texture_of_the_targets_size_is_copied(void)
{
    on_every_engine(check_texel_grid);
}

static void test_filters_and_addressing_are_as_defined(void)
{
    on_every_engine(check_textures);
}

static void test_extreme_coordinates_are_alike_on_every_engine(void)
{
    extremes_seen = 0;
    on_every_engine(check_extreme_coordinates);
}

/* --- Blending ------------------------------------------------------------------------------------------ */

static unsigned product(unsigned a, unsigned b)
{
    return (unsigned)floor(a * b / 255.0 + 0.5);
}

static unsigned at_most_255(unsigned value)
{
    return value > 255 ? 255 : value;
}

static unsigned blended(unsigned s, unsigned d, unsigned alpha, int source_alpha, int inverse)
{
    if (source_alpha && inverse)
        return (unsigned)floor((s * alpha + d * (255 - alpha)) / 255.0 + 0.5);
    if (inverse)
        return at_most_255(s + product(d, 255 - alpha));
    return source_alpha ? product(s, alpha) : s;
}

static void check_blending(void)
{
    set(TRIPTYCH_STATE_ALPHABLENDENABLE, "true");
    for (int factors = 0; factors < 4; factors++) {
        int source_alpha = factors & 1, inverse = factors >> 1;
        set(TRIPTYCH_STATE_SRCBLEND, source_alpha ? "srcalpha" : "one");
        set(TRIPTYCH_STATE_DESTBLEND, inverse ? "invsrcalpha" : "zero");
        for (unsigned round = 0; round < test_share_of(24, 6); round++) {
            uint32_t d = random_word();
            bind_random_texture(SIZE, SIZE);
            clear_to(d);
            draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
            OK(triptych_read_color(device, image, sizeof image));
            for (int p = 0; p < SIZE * SIZE; p += pixel_stride()) {
                uint32_t word = 0, s = texel[p];
                for (int c = 0; c < 4; c++)
                    word |= blended(channel(s, c), channel(d, c), s >> 24, source_alpha, inverse) << 8 * c;
                expect_pixel(p % SIZE, p / SIZE, word, inverse ? "inverse alpha" : "zero");
            }
        }
    }
}

static void check_write_masks(void)
{
    for (uint32_t mask = 0; mask < 16; mask++) {
        uint32_t new = random_word(), old = random_word(), kept = 0;
        for (int c = 0; c < 4; c++)
            kept |= mask >> c & 1 ? 0 : 255u << 8 * c;
        OK(triptych_set_state(device, TRIPTYCH_STATE_COLORWRITEENABLE, mask));
        clear_to(old);
        draw_square(0, new, NULL, 0, 0, 1, 1);
        OK(triptych_read_color(device, image, sizeof image));
        for (int p = 0; p < SIZE * SIZE; p++)
            expect_pixel(p % SIZE, p / SIZE, (old & kept) | (image_word(new) & ~kept), "write mask");
    }
}

static void test_blending_is_rounded_as_defined(void)
{
    on_every_engine(check_blending);
}

static void test_write_masks_keep_channels(void)
{
    on_every_engine(check_write_masks);
}

/* --- Depth --------------------------------------------------------------------------------------------- */

static void check_depth(void)
{
    static const struct {
        const char *word;
        int passes[3]; /* new less than, equal to, greater than stored */
    } functions[] = {{"never", {0, 0, 0}},        {"less", {1, 0, 0}},    {"equal", {0, 1, 0}},
                     {"lessequal", {1, 1, 0}},    {"greater", {0, 0, 1}}, {"notequal", {1, 0, 1}},
                     {"greaterequal", {0, 1, 1}}, {"always", {1, 1, 1}}};
    static const float stored = 0.5f, new[3] = {0.25f, 0.5f, 0.75f};
    static const float black[4] = {0, 0, 0, 1};
    static float depth[SIZE * SIZE];
    set(TRIPTYCH_STATE_ZENABLE, "true");
    for (unsigned f = 0; f < 8; f++)
        for (int i = 0; i < 6; i++) {
            int writes = i / 3, passes = functions[f].passes[i % 3];
            set(TRIPTYCH_STATE_ZFUNC, functions[f].word);
            set(TRIPTYCH_STATE_ZWRITEENABLE, writes ? "true" : "false");
            OK(triptych_clear(device, black, stored));
            draw_square(new[i % 3], 0xffffffff, NULL, 0, 0, 1, 1);
            OK(triptych_read_color(device, image, sizeof image));
            OK(triptych_read_depth(device, depth, sizeof depth));
            for (int p = 0; p < SIZE * SIZE; p++) {
                expect_pixel(p % SIZE, p / SIZE, passes ? 0xffffffff : 0xff000000, functions[f].word);
                TEST_ASSERT_EQUAL_FLOAT(passes && writes ? new[i % 3] : stored, depth[p]);
            }
        }
}

static void test_depth_functions_decide_colour_and_depth(void)
{
    on_every_engine(check_depth);
}

/* --- Lighting ------------------------------------------------------------------------------------------ */

static void random_vector(double v[3])
{
    double length = 0;
    while (length < 0.1) {
        length = 0;
        for (int c = 0; c < 3; c++) {
            v[c] = random_between(-1, 1);
            length += v[c] * v[c];
        }
    }
    for (int c = 0; c < 3; c++)
        v[c] /= sqrt(length);
}

static void random_color(float color[4], double most)
{
    for (int c = 0; c < 4; c++)
        color[c] = (float)random_between(0, most);
}

static void make_light(struct triptych_light *light, enum triptych_light_type type)
{
    double direction[3];
    memset(light, 0, sizeof *light);
    light->type = type;
    random_vector(direction);
    random_color(light->diffuse, 1);
    random_color(light->ambient, 0.2);
    light->range = (float)random_between(1, 6);
    for (int c = 0; c < 3; c++) {
        light->direction[c] = (float)direction[c];
        light->position[c] = (float)random_between(-2, 2);
        light->attenuation[c] = (float)random_between(0.1, 1);
    }
}

/* The light that a source adds to one channel at a point, by the formulas of the Direct3D 9 documentation. */
static double light_adds(const struct triptych_light *light, const struct triptych_material *material,
                         const double point[3], const double normal[3], int c)
{
    double to[3], squared = 0, cosine = 0, attenuation = 1;
    for (int i = 0; i < 3; i++) {
        to[i] = light->type == TRIPTYCH_LIGHT_POINT ? light->position[i] - point[i] : -light->direction[i];
        squared += to[i] * to[i];
    }
    double distance = sqrt(squared);
    for (int i = 0; i < 3; i++)
        cosine += normal[i] * to[i] / distance;
    if (light->type == TRIPTYCH_LIGHT_POINT) {
        const float *a = light->attenuation;
        attenuation = distance > light->range ? 0 : 1 / (a[0] + a[1] * distance + a[2] * squared);
    }
    return attenuation * (material->ambient[c] * light->ambient[c] +
                          material->diffuse[c] * light->diffuse[c] * fmax(0, cosine));
}

static void check_one_lighting(unsigned lights, int normalize)
{
    struct triptych_light light[TRIPTYCH_LIGHTS] = {{0}};
    struct triptych_material material = {.power = 1};
    double normal[3];
    float given[3];
    random_color(material.diffuse, 1);
    random_color(material.ambient, 1);
    random_color(material.emissive, 0.2);
    random_vector(normal);
    for (int c = 0; c < 3; c++)
        given[c] = (float)(normal[c] * (normalize ? 7 : 1));
    OK(triptych_set_material(device, &material));
    for (unsigned i = 0; i < TRIPTYCH_LIGHTS; i++) {
        make_light(&light[i], i % 2 ? TRIPTYCH_LIGHT_POINT : TRIPTYCH_LIGHT_DIRECTIONAL);
        OK(triptych_set_light(device, i, &light[i]));
        OK(triptych_enable_light(device, i, i < lights));
    }
    set(TRIPTYCH_STATE_NORMALIZENORMALS, normalize ? "true" : "false");
    set(TRIPTYCH_STATE_COLORVERTEX, "false");
    OK(triptych_set_state(device, TRIPTYCH_STATE_AMBIENT, 0xff204060));
    draw_square(0, 0, given, 0, 0, 1, 1);
    OK(triptych_read_color(device, image, sizeof image));
    for (int c = 0; c < 4; c++) {
        static const double origin[3], scene[3] = {0x20 / 255.0, 0x40 / 255.0, 0x60 / 255.0};
        double expected = material.diffuse[3];
        if (c < 3)
            expected = material.emissive[c] + material.ambient[c] * scene[c];
        for (unsigned i = 0; i < lights && c < 3; i++)
            expected += light_adds(&light[i], &material, origin, normal, c);
        expected = 255 * fmin(fmax(expected, 0), 1);
        for (int p = 0; p < SIZE * SIZE; p += SIZE * SIZE - 1)
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(0.51, expected, channel(image[p], c), "lit channel");
    }
}

/* The square is so small in the world that all of its points have the lighting of the origin. */
static void check_lighting(void)
{
    const float large[4][4] = {{0x1p20f}, {0, 0x1p20f}, {0, 0, 1}, {0, 0, 0.5f, 1}};
    extent = 0x1p-20f;
    OK(triptych_set_transform(device, TRIPTYCH_TRANSFORM_PROJECTION, large));
    set(TRIPTYCH_STATE_LIGHTING, "true");
    for (unsigned round = 0; round < test_share_of(40, 8); round++)
        for (unsigned lights = 0; lights <= TRIPTYCH_LIGHTS; lights++)
            check_one_lighting(lights, round & 1);
    extent = 1;
}

static void test_lights_follow_the_documented_formulas(void)
{
    on_every_engine(check_lighting);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_texture_of_the_targets_size_is_copied);
    RUN_TEST(test_filters_and_addressing_are_as_defined);
    RUN_TEST(test_extreme_coordinates_are_alike_on_every_engine);
    RUN_TEST(test_blending_is_rounded_as_defined);
    RUN_TEST(test_write_masks_keep_channels);
    RUN_TEST(test_depth_functions_decide_colour_and_depth);
    RUN_TEST(test_lights_follow_the_documented_formulas);
    return UNITY_END();
}
