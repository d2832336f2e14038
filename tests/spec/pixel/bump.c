/* Bump mapping on every engine: the matrix determines the texels that displaced coordinates sample, and
 * luminance darkens them. Displacements are whole texels, so that the test can compute every texel. */
#include "tests/support/picture/canvas.h"

#include <math.h>
#include <stdio.h>

static float bumps[SIZE * SIZE][4];

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

static void set_stage_float(unsigned stage, enum triptych_stage_state state, float value)
{
    OK(triptych_set_stage_state(device, stage, state, triptych_float_bits(value)));
}

static void set_matrix(unsigned stage, const float m[4])
{
    static const enum triptych_stage_state state[4] = {
        TRIPTYCH_STAGE_BUMPENVMAT00, TRIPTYCH_STAGE_BUMPENVMAT01, TRIPTYCH_STAGE_BUMPENVMAT10,
        TRIPTYCH_STAGE_BUMPENVMAT11};
    for (int i = 0; i < 4; i++)
        set_stage_float(stage, state[i], m[i]);
}

static triptych_texture *make(enum triptych_surface_format format, const void *data, size_t pitch)
{
    struct triptych_texture_description description = {TRIPTYCH_TEXTURE_2D, format, SIZE, SIZE, 1, 1};
    triptych_texture *texture;
    OK(triptych_texture_define(device, &description, &texture));
    OK(triptych_texture_update(device, texture, 0, 0, NULL, data, pitch, 0));
    return texture;
}

static int whole(float value)
{
    return (int)lrintf(value * SIZE);
}

/* Stage 0 displaces stage 1, whose texture is the result. */
static void bind_stages(const char *operation, triptych_texture *bump)
{
    triptych_texture *texture;
    for (int p = 0; p < SIZE * SIZE; p++)
        texel[p] = random_word();
    OK(triptych_texture_create(device, texel, SIZE, SIZE, &texture));
    OK(triptych_set_texture(device, 0, bump));
    OK(triptych_set_texture(device, 1, texture));
    set_stage(0, TRIPTYCH_STAGE_COLOROP, operation);
    set_stage(1, TRIPTYCH_STAGE_COLOROP, "selectarg1");
    set_stage(1, TRIPTYCH_STAGE_ALPHAOP, "selectarg1");
    set_stage(1, TRIPTYCH_STAGE_TEXCOORDINDEX, "0");
}

static void make_bumps(void)
{
    for (int p = 0; p < SIZE * SIZE; p++)
        for (int c = 0; c < 4; c++)
            bumps[p][c] = (float)((int)(random_word() % 33) - 16) / (c < 2 ? SIZE : 16);
}

static uint32_t displaced(int p, const float m[4], float du, float dv)
{
    int x = p % SIZE + whole(m[0] * du + m[2] * dv), y = p / SIZE + whole(m[1] * du + m[3] * dv);
    return texel[(y & (SIZE - 1)) * SIZE + (x & (SIZE - 1))];
}

static void expect_displaced(const float m[4])
{
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    OK(triptych_read_color(device, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p++)
        expect_pixel(p % SIZE, p / SIZE, displaced(p, m, bumps[p][0], bumps[p][1]), "displaced");
}

static void check_displacement(void)
{
    static const float matrices[][4] = {{1, 0, 0, 1}, {0, 1, 1, 0}, {-1, 2, 3, 1}, {0, 0, 0, 0}};
    make_bumps();
    bind_stages("bumpenvmap", make(TRIPTYCH_SURFACE_A32B32G32R32F, bumps, sizeof *bumps * SIZE));
    for (unsigned i = 0; i < sizeof matrices / sizeof *matrices; i++) {
        set_matrix(0, matrices[i]);
        expect_displaced(matrices[i]);
    }
}

static void test_the_matrix_turns_displacements(void)
{
    on_every_engine(check_displacement);
}

/* Signed bytes, the format that bump maps were made of. */
static void check_signed_bytes(void)
{
    static int8_t vectors[SIZE * SIZE][2];
    const float scale = 127.0f / SIZE, m[4] = {scale, 0, 0, scale};
    for (int p = 0; p < SIZE * SIZE; p++)
        for (int c = 0; c < 2; c++)
            vectors[p][c] = (int8_t)(random_word() % 255 - 127);
    bind_stages("bumpenvmap", make(TRIPTYCH_SURFACE_V8U8, vectors, sizeof *vectors * SIZE));
    set_matrix(0, m);
    for (int p = 0; p < SIZE * SIZE; p++)
        for (int c = 0; c < 2; c++)
            bumps[p][c] = (float)vectors[p][c] / 127;
    expect_displaced(m);
}

static void test_signed_bytes_displace_both_ways(void)
{
    on_every_engine(check_signed_bytes);
}

static void check_luminance(void)
{
    static const float identity[4] = {1, 0, 0, 1};
    make_bumps();
    bind_stages("bumpenvmapluminance", make(TRIPTYCH_SURFACE_A32B32G32R32F, bumps, sizeof *bumps * SIZE));
    set_matrix(0, identity);
    set_stage_float(0, TRIPTYCH_STAGE_BUMPENVLSCALE, 0.75f);
    set_stage_float(0, TRIPTYCH_STAGE_BUMPENVLOFFSET, 0.5f);
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    OK(triptych_read_color(device, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p++) {
        uint32_t sampled = displaced(p, identity, bumps[p][0], bumps[p][1]), expected = 0;
        float luminance = fmaxf(0, fminf(1, bumps[p][2] * 0.75f + 0.5f));
        for (int c = 0; c < 4; c++) {
            float value = (float)channel(sampled, c) / 255.0f * luminance;
            expected |= (uint32_t)rintf(value * 255) << 8 * c;
        }
        expect_pixel(p % SIZE, p / SIZE, expected, "luminance");
    }
}

static void test_luminance_darkens(void)
{
    on_every_engine(check_luminance);
}

/* Displaced coordinates can displace others; other properties of the stages do not change.
 */
static void check_chain(void)
{
    static const float identity[4] = {1, 0, 0, 1};
    triptych_texture *texture;
    make_bumps();
    triptych_texture *bump = make(TRIPTYCH_SURFACE_A32B32G32R32F, bumps, sizeof *bumps * SIZE);
    bind_stages("bumpenvmap", bump);
    OK(triptych_texture_create(device, texel, SIZE, SIZE, &texture));
    OK(triptych_set_texture(device, 1, bump));
    OK(triptych_set_texture(device, 2, texture));
    set_stage(1, TRIPTYCH_STAGE_COLOROP, "bumpenvmap");
    set_stage(2, TRIPTYCH_STAGE_COLOROP, "modulate");
    set_stage(2, TRIPTYCH_STAGE_ALPHAOP, "selectarg2");
    set_stage(2, TRIPTYCH_STAGE_TEXCOORDINDEX, "0");
    set_matrix(0, identity);
    set_matrix(1, identity);
    draw_square(0, 0x80ffffff, NULL, 0, 0, 1, 1);
    OK(triptych_read_color(device, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p++) {
        int x = (p % SIZE + whole(bumps[p][0])) & (SIZE - 1),
            y = (p / SIZE + whole(bumps[p][1])) & (SIZE - 1);
        uint32_t color = displaced(p, identity, bumps[y * SIZE + x][0], bumps[y * SIZE + x][1]);
        expect_pixel(p % SIZE, p / SIZE, (color & 0xffffff) | 0x80000000, "twice");
    }
}

static void test_displacements_chain(void)
{
    on_every_engine(check_chain);
}

/* If one of the two textures is missing, coordinates are not displaced. */
static void check_missing(void)
{
    make_bumps();
    triptych_texture *bump = make(TRIPTYCH_SURFACE_A32B32G32R32F, bumps, sizeof *bumps * SIZE);
    bind_stages("bumpenvmap", bump);
    set_matrix(0, (const float[4]){1, 0, 0, 1});
    OK(triptych_set_texture(device, 0, NULL));
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    OK(triptych_read_color(device, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p++)
        expect_pixel(p % SIZE, p / SIZE, texel[p], "no bump map");
    OK(triptych_set_texture(device, 0, bump));
    OK(triptych_set_texture(device, 1, NULL));
    draw_square(0, 0x80402010, NULL, 0, 0, 1, 1);
    OK(triptych_read_color(device, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p++)
        expect_pixel(p % SIZE, p / SIZE, image_word(0x80402010), "nothing to displace");
}

static void test_nothing_is_displaced_without_textures(void)
{
    on_every_engine(check_missing);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_matrix_turns_displacements);
    RUN_TEST(test_signed_bytes_displace_both_ways);
    RUN_TEST(test_luminance_darkens);
    RUN_TEST(test_displacements_chain);
    RUN_TEST(test_nothing_is_displaced_without_textures);
    return UNITY_END();
}
