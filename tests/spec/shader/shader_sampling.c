/* Shaders that sample, in whole draws on every engine. Lookups in pixel and vertex shaders are compared with
 * a second implementation of samplers. Targets are binary32, so that they contain the shader's results. */
#include "base/bits.h"
#include "tests/spec/shader/sampling.h"
#include "tests/support/picture/quad.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

void setUp(void)
{
    drawn_begin();
}

void tearDown(void)
{
    close_canvas();
}

static const char *kind_name(void)
{
    return texture.type == TRIPTYCH_TEXTURE_2D     ? "2d"
           : texture.type == TRIPTYCH_TEXTURE_CUBE ? "cube"
                                                   : "volume";
}

static struct model_sampler random_sampler(void)
{
    unsigned word = random_word() >> 8;
    return (struct model_sampler){.mag = word & 1,
                                  .min = word >> 1 & 1,
                                  .mip = (int)(word >> 2) % 3,
                                  .first = (word >> 2) % 3 && !(word >> 8 & 3),
                                  .bias = word >> 10 & 1 ? dyadic(-1, 1) : 0};
}

/* --- Lookups of pixels --------------------------------------------------------------------------------- */

enum load { LOAD, LOAD_PROJECTED, LOAD_BIASED, LOAD_LEVEL, LOAD_CHANGES, LOADS };

/* c0: the step from pixel to pixel; c1: the start, and in w the bias, level or divisor; c2 and c3: the
 * changes. */
static const char *const lookup[LOADS] = {
    "texld r1, r0, s11", "mul r0.xyz, r0, c1.w\nmov r0.w, c1.w\ntexldp r1, r0, s11",
    "mov r0.w, c1.w\ntexldb r1, r0, s11", "mov r0.w, c1.w\ntexldl r1, r0, s11",
    "mov r2, c2\nmov r3, c3\ntexldd r1, r0, s11, r2, r3"};

struct placing {
    float step[4], start[4], change[2][4];
};

static struct placing place_lookup(enum load load)
{
    struct placing r = {.step = {0}};
    for (int a = 0; a < 2; a++) {
        r.step[a] = (float)dyadic(-0.03, 0.03) * (load == LOAD || load == LOAD_PROJECTED ? 8 : 1);
        r.start[a] = (float)dyadic(-2, 2);
        r.change[a][a] = (float)dyadic(-0.5, 0.5);
        r.change[a][!a] = (float)dyadic(-0.25, 0.25);
    }
    r.start[2] = (float)dyadic(-1, 1);
    r.start[3] = load == LOAD_PROJECTED ? 4.0f : (float)dyadic(-2, 3);
    for (int a = 0; a < 2 && texture.type == TRIPTYCH_TEXTURE_CUBE; a++) { /* all on a face of z */
        r.step[a] = (float)dyadic(-0.03, 0.03);
        r.start[a] = (float)dyadic(-0.25, 0.25);
        r.change[a][2] = 0;
        r.start[2] = random_word() & 1 ? 1 : -1;
    }
    return r;
}

/* Returns the level of a lookup. On a face of a cube, the difference of coordinates from edge to edge is
 * 2. */
static int level_of(enum load load, const struct model_sampler *sampler, const struct placing *p)
{
    double change[2][3] = {{0}}, scale = texture.type == TRIPTYCH_TEXTURE_CUBE ? 0.5 : 1;
    for (int i = 0; i < 2; i++)
        for (int a = 0; a < 2; a++)
            change[i][a] = scale * (load == LOAD_CHANGES ? (double)p->change[i][a]
                                    : a == i             ? (double)p->step[a]
                                                         : 0);
    double more = (double)p->start[3];
    if (load == LOAD_LEVEL)
        return (int)rint(256 * (more + sampler->bias));
    return model_lambda(&texture, sampler, change[0], change[1], load == LOAD_BIASED ? more : 0);
}

static void compare_pixels(const struct model_sampler *sampler, const struct placing *p, int lambda,
                           const char *what)
{
    for (int i = 0; i < 40; i++) {
        int x = (int)(random_word() % PART), y = (int)(random_word() % PART);
        const double v[3] = {(double)p->start[0] + x * (double)p->step[0],
                             (double)p->start[1] + y * (double)p->step[1], (double)p->start[2]};
        float expected[4];
        model_sample(&texture, sampler, v, lambda, expected);
        expect_numbers(x, y, expected, what);
    }
}

static void check_lookup(enum load load)
{
    char text[400], what[200];
    struct model_sampler sampler = random_sampler();
    struct placing p = place_lookup(load);
    int lambda = level_of(load, &sampler, &p);
    if (lambda == INT_MIN)
        return;
    model_set(device, 11, &sampler);
    snprintf(
        text, sizeof text,
        "ps_3_0\ndcl vPos.xy\ndcl_%s s11\nmov r0, c1\nmov r1, c0\nmad r0.xy, vPos, r1, r0\n%s\nmov oC0, r1\n",
        kind_name(), lookup[load]);
    snprintf(what, sizeof what, "%s, %s, mag %d min %d mip %d first %d bias %g, lambda %d", lookup[load],
             kind_name(), sampler.mag, sampler.min, sampler.mip, sampler.first, sampler.bias, lambda);
    use_shaders(NULL, text);
    OK(triptych_set_shader_floats(device, TRIPTYCH_SHADER_PIXEL, 0, (const float *)&p, 4));
    draw_declared(TRIPTYCH_USAGE_POSITION, NULL, 0);
    read_numbers(0);
    compare_pixels(&sampler, &p, lambda, what);
}

static void check_lookups(void)
{
    static const enum triptych_texture_type types[] = {TRIPTYCH_TEXTURE_2D, TRIPTYCH_TEXTURE_CUBE,
                                                       TRIPTYCH_TEXTURE_VOLUME};
    begin_part();
    for (int i = 0; i < 6; i++) {
        model_make(&texture, device, 11, types[i / 2], i % 2);
        for (enum load load = 0; load < LOADS; load++)
            for (int sampler = 0; sampler < 4; sampler++)
                check_lookup(load);
    }
}

static void test_lookups_of_pixels(void)
{
    on_every_engine(check_lookups);
}

/* --- Any sampler --------------------------------------------------------------------------------------- */

static void set_number(unsigned number, enum triptych_sampler_state state, uint32_t value)
{
    OK(triptych_set_sampler_state(device, number, state, value));
}

/* Binds a texture of any type and size, with bytes, binary32 or depth, and with all levels or one. */
static enum triptych_texture_type bind_any_texture(unsigned number)
{
    static uint32_t words[4 * 16 * 16 * 16];
    static const unsigned formats[] = {TRIPTYCH_SURFACE_A8R8G8B8, TRIPTYCH_SURFACE_A32B32G32R32F,
                                       TRIPTYCH_SURFACE_D24S8};
    unsigned choice = random_word() % 8,
             type = choice < 4       ? 0
                    : choice - 4 < 2 ? 1
                                     : 2,
             what = random_word() % (type ? 2 : 3);
    static const enum triptych_texture_type types[] = {TRIPTYCH_TEXTURE_2D, TRIPTYCH_TEXTURE_CUBE,
                                                       TRIPTYCH_TEXTURE_VOLUME};
    unsigned width = 1 + random_word() % 16, height = type == 1 ? width : 1 + random_word() % 16,
             depth = type == 2 ? 1 + random_word() % 8 : 1, levels = random_word() % 2;
    const struct triptych_texture_description description = {
        types[type], (enum triptych_surface_format)formats[what], width, height, depth, levels};
    triptych_texture *made;
    for (unsigned i = 0; i < sizeof words / sizeof *words; i++)
        words[i] = what == 1 ? bits_of_float((float)random_between(-2, 2)) : random_word();
    OK(triptych_texture_define(device, &description, &made));
    size_t pixel = what == 1 ? 16 : 4;
    for (unsigned level = 0; level == 0 || (!levels && (width | height | depth) >> level); level++)
        for (unsigned face = 0; face < (type == 1 ? 6 : 1); face++) {
            unsigned w = width >> level ? width >> level : 1, h = height >> level ? height >> level : 1;
            OK(triptych_texture_update(device, made, face, level, NULL, words + 97 * face, pixel * w,
                                       pixel * w * h));
        }
    OK(triptych_set_texture(device, number, made));
    return types[type];
}

static void set_any_states(unsigned number)
{
    static const enum triptych_sampler_state address[] = {
        TRIPTYCH_SAMPLER_ADDRESSU, TRIPTYCH_SAMPLER_ADDRESSV, TRIPTYCH_SAMPLER_ADDRESSW};
    static const char *const modes[] = {"wrap", "mirror", "clamp", "border", "mirroronce"},
                             *const filters[] = {"point", "linear", "anisotropic"},
                             *const mips[] = {"none", "point", "linear"};
    for (int a = 0; a < 3; a++)
        set_sampler(number, address[a], modes[random_word() % 5]);
    set_sampler(number, TRIPTYCH_SAMPLER_MAGFILTER, filters[random_word() % 2]);
    set_sampler(number, TRIPTYCH_SAMPLER_MINFILTER, filters[random_word() % 3]);
    set_sampler(number, TRIPTYCH_SAMPLER_MIPFILTER, mips[random_word() % 3]);
    set_sampler(number, TRIPTYCH_SAMPLER_SRGBTEXTURE, random_word() % 4 ? "false" : "true");
    set_number(number, TRIPTYCH_SAMPLER_BORDERCOLOR, random_word());
    set_number(number, TRIPTYCH_SAMPLER_MAXANISOTROPY, 1 + random_word() % 4);
    set_number(number, TRIPTYCH_SAMPLER_MAXMIPLEVEL, random_word() % 8 < 6 ? 0 : random_word() % 6);
    set_number(number, TRIPTYCH_SAMPLER_MIPMAPLODBIAS,
               bits_of_float(random_word() % 2 ? 0 : (float)random_between(-2, 2)));
}

/* Returns an ordinary number, or sometimes a value that is not a number. */
static float any_number(double reach)
{
    static const float odd[] = {NAN, INFINITY, -INFINITY, 3.4e38f, -3.4e38f, 0, -0.0f, 1e-39f};
    return random_word() % 64 ? (float)random_between(-reach, reach) : odd[random_word() % 8];
}

static const char elements[] =
    "vs_3_0\ndcl_position v0\ndcl_texcoord0 v1\ndcl_texcoord1 v2\ndcl_texcoord2 v3\n"
    "dcl_position o0\ndcl_texcoord0 o1\ndcl_texcoord1 o2\ndcl_texcoord2 o3\n"
    "mov o0, v0\nmov o1, v1\nmov o2, v2\nmov o3, v3\n";

/* The three varyings at the pixels, as the shader reads them. */
static float varying[3][SIZE * SIZE][4];

static void draw_varyings(const struct drawn_element element[3])
{
    for (unsigned i = 0; i < 3; i++) {
        char text[120];
        snprintf(text, sizeof text, "ps_3_0\ndcl_texcoord%u v%u\nmov oC0, v%u\n", i, i, i);
        use_shaders(elements, text);
        draw_declared(TRIPTYCH_USAGE_POSITION, element, 3);
        read_numbers(0);
        memcpy(varying[i], drawn, sizeof drawn);
    }
}

static void compare_quad(const char *text, int x, int y)
{
    static struct quad quad;
    struct quad_result result;
    memset(&quad, 0, sizeof quad);
    for (int r = 0; r < 3; r++)
        for (int lane = 0; lane < QUAD_LANES; lane++)
            for (int c = 0; c < 4; c++)
                quad.v[r][c][lane] = varying[r][(y + lane / 2) * SIZE + x + lane % 2][c];
    quad_shade(device, text, &quad, &result);
    for (int lane = 0; lane < QUAD_LANES; lane++)
        for (int c = 0; c < 4; c++) {
            char what[500];
            float expected = result.color[c][lane], got = drawn[(y + lane / 2) * SIZE + x + lane % 2][c];
            if (bits_of_float(expected) == bits_of_float(got) || (isnan(expected) && isnan(got)))
                continue;
            snprintf(what, sizeof what, "pixel (%d, %d), component %c: expected %.9g, got %.9g of\n%s",
                     x + lane % 2, y + lane / 2, "xyzw"[c], (double)expected, (double)got, text);
            TEST_FAIL_MESSAGE(what);
        }
}

/* Checks the quads of the upper left triangle. Quads on the diagonal are left out because they have pixels of
 * two triangles. */
static void check_any(void)
{
    static const char *const loads[LOADS] = {"texld r0, v0, s7", "texldp r0, v0, s7", "texldb r0, v0, s7",
                                             "texldl r0, v0, s7",
                                             "mov r1, v1\nmov r2, v2\ntexldd r0, v0, s7, r1, r2"};
    static const char *const dcl[] = {"2d", "cube", "volume"};
    char text[300];
    struct drawn_element element[3];
    enum triptych_texture_type type = bind_any_texture(7);
    double reach = random_word() % 2 ? 1 : 8;
    set_any_states(7);
    for (unsigned i = 0; i < 3; i++) {
        element[i] = drawn_constant(TRIPTYCH_USAGE_TEXCOORD, i, 0, 0, 0, 0);
        for (int corner = 0; corner < 16; corner++)
            element[i].value[corner / 4][corner % 4] = any_number(i ? 0.25 : reach);
    }
    draw_varyings(element);
    snprintf(text, sizeof text,
             "ps_3_0\ndcl_%s s7\ndcl_texcoord0 v0\ndcl_texcoord1 v1\ndcl_texcoord2 v2\n%s\nmov oC0, r0\n",
             dcl[type == TRIPTYCH_TEXTURE_2D     ? 0
                 : type == TRIPTYCH_TEXTURE_CUBE ? 1
                                                 : 2],
             loads[random_word() % LOADS]);
    use_shaders(elements, text);
    draw_declared(TRIPTYCH_USAGE_POSITION, element, 3);
    read_numbers(0);
    for (int i = 0; i < 12; i++) {
        int x = 2 * (int)(random_word() % (PART / 2 - 1));
        compare_quad(text, x, 2 * (int)(random_word() % (unsigned)(PART / 2 - 1 - x / 2)));
    }
}

static void check_all(void)
{
    begin_part();
    for (int i = 0; i < 40; i++)
        check_any();
}

static void test_any_sampler_on_any_numbers(void)
{
    on_every_engine(check_all);
}

/* --- Lookups of vertices ------------------------------------------------------------------------------- */

static void check_vertex(unsigned sampler)
{
    char text[300], what[100];
    const struct model_sampler states = random_sampler();
    double v[3] = {dyadic(-0.75, 0.75), dyadic(-0.75, 0.75), random_word() & 1 ? 1 : -1},
           level = dyadic(-1, 4);
    float expected[4];
    model_set(device, TRIPTYCH_VERTEX_SAMPLER + sampler, &states);
    snprintf(
        text, sizeof text,
        "vs_3_0\ndcl_%s s%u\ndcl_position v0\ndcl_texcoord v1\ndcl_position o0\ndcl_texcoord o1\nmov o0, v0\n"
        "texldl o1, v1, s%u\n",
        kind_name(), sampler, sampler);
    use_shaders(text, "ps_3_0\ndcl_texcoord v0\nmov oC0, v0\n");
    const struct drawn_element element =
        drawn_constant(TRIPTYCH_USAGE_TEXCOORD, 0, (float)v[0], (float)v[1], (float)v[2], (float)level);
    draw_declared(TRIPTYCH_USAGE_POSITION, &element, 1);
    read_numbers(0);
    model_sample(&texture, &states, v, (int)rint(256 * (level + states.bias)), expected);
    snprintf(what, sizeof what, "s%u of vertices, %s, level %g", sampler, kind_name(), level);
    expect_numbers(PART / 2, PART / 2, expected, what);
}

static void check_vertices(void)
{
    begin_part();
    for (unsigned i = 0; i < 12; i++) {
        static const enum triptych_texture_type types[] = {TRIPTYCH_TEXTURE_2D, TRIPTYCH_TEXTURE_CUBE,
                                                           TRIPTYCH_TEXTURE_VOLUME};
        model_make(&texture, device, TRIPTYCH_VERTEX_SAMPLER + i % 4, types[i % 3], i / 6);
        check_vertex(i % 4);
    }
}

static void test_lookups_of_vertices(void)
{
    on_every_engine(check_vertices);
}

static const char displaced[] =
    "vs_3_0\ndcl_2d s0\ndcl_position v0\ndcl_position o0\ndcl_texcoord o1\nmov o0, v0\n"
    "texldl o1, v0, s0\n";
static const char given[] = "ps_3_0\ndcl_texcoord v0\nmov oC0, v0\n";

/* A draw reads the texture of its vertices as it was before a later change. */
static void check_changed(void)
{
    static const float first[4] = {1, 2, 3, 4}, second[4] = {5, 6, 7, 8};
    const struct triptych_texture_description description = {
        TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A32B32G32R32F, 1, 1, 1, 1};
    triptych_texture *changing;
    begin_part();
    OK(triptych_texture_define(device, &description, &changing));
    OK(triptych_texture_update(device, changing, 0, 0, NULL, first, sizeof first, 0));
    OK(triptych_set_texture(device, TRIPTYCH_VERTEX_SAMPLER, changing));
    use_shaders(displaced, given);
    draw_declared(TRIPTYCH_USAGE_POSITION, NULL, 0);
    OK(triptych_texture_update(device, changing, 0, 0, NULL, second, sizeof second, 0));
    drawn_position[0][0] = drawn_position[2][0] = -1 + 1.0f * PART / SIZE;
    draw_declared(TRIPTYCH_USAGE_POSITION, NULL, 0);
    read_numbers(0);
    expect_numbers(1, 1, first, "before the change");
    expect_numbers(PART - 2, 1, second, "after the change");
}

static void test_textures_of_vertices_can_change_between_draws(void)
{
    on_every_engine(check_changed);
}

/* A draw samples its target as it was before the draw: each doubles it. */
static void check_feedback(void)
{
    static float numbers[SIZE * SIZE][4];
    const struct triptych_texture_description description = {
        TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A32B32G32R32F, SIZE, SIZE, 1, 1};
    struct triptych_target_surfaces target = {.depth_format = TRIPTYCH_DEPTH_D24S8};
    drawn_begin();
    for (int i = 0; i < SIZE * SIZE; i++)
        memcpy(numbers[i], (float[4]){1, 2, 3, 4}, sizeof numbers[i]);
    OK(triptych_texture_define(device, &description, &target.color[0].texture));
    OK(triptych_texture_update(device, target.color[0].texture, 0, 0, NULL, numbers, sizeof *numbers * SIZE,
                               0));
    OK(triptych_set_texture(device, TRIPTYCH_VERTEX_SAMPLER, target.color[0].texture));
    OK(triptych_set_target_surfaces(device, &target));
    use_shaders("vs_3_0\ndcl_2d s0\ndcl_position v0\ndcl_position o0\ndcl_texcoord o1\nmov o0, v0\n"
                "texldl r0, v0, s0\nadd o1, r0, r0\n",
                given);
    draw_declared(TRIPTYCH_USAGE_POSITION, NULL, 0);
    draw_declared(TRIPTYCH_USAGE_POSITION, NULL, 0);
    read_numbers(0);
    EXPECT_CENTRE("doubled twice", 4, 8, 12, 16);
}

static void test_targets_can_be_sampled_by_vertices(void)
{
    on_every_engine(check_feedback);
}

static void check_unbound(void)
{
    begin_part();
    use_shaders("vs_3_0\ndcl_2d s2\ndcl_position v0\ndcl_position o0\ndcl_texcoord o1\nmov o0, v0\ntexldl "
                "o1, v0, s2\n",
                "ps_3_0\ndcl_2d s9\ndcl_texcoord v0\ntexld r0, v0, s9\nadd r0, r0, v0\nmov oC0, r0\n");
    draw_declared(TRIPTYCH_USAGE_POSITION, NULL, 0);
    read_numbers(0);
    expect_numbers(3, 3, (const float[]){0, 0, 0, 2}, "nothing is bound");
}

static void test_unbound_samplers(void)
{
    on_every_engine(check_unbound);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_lookups_of_pixels);
    RUN_TEST(test_any_sampler_on_any_numbers);
    RUN_TEST(test_lookups_of_vertices);
    RUN_TEST(test_textures_of_vertices_can_change_between_draws);
    RUN_TEST(test_targets_can_be_sampled_by_vertices);
    RUN_TEST(test_unbound_samplers);
    return UNITY_END();
}
