/* Blending by primitive (src/spec/pixel/primitive_blend.h), on every engine: draws of cells that are shadows,
 * subpixel text and blended by the states, in any order. Expected values are computed here from the
 * definition. */
#include "tests/support/picture/canvas.h"
#include "tests/support/picture/drawn.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { CELL = 8, CELLS = SIZE / CELL, SHADOW = 1, SUBPIXEL = 2, CORNERS = 6 };

static const char vertices_of_3_0[] =
    "vs_3_0\ndcl_position v0\ndcl_texcoord v1\ndcl_blendindices1 v2\ndcl_color2 v3\ndcl_position o0\n"
    "dcl_texcoord o1.xy\ndcl_blendindices1 o2.x\ndcl_color2 o3\n"
    "mov o0, v0\nmov o1.xy, v1\nmov o2.x, v2\nmov o3, v3\n";
static const char vertices_without_color[] =
    "vs_3_0\ndcl_position v0\ndcl_texcoord v1\ndcl_blendindices1 v2\ndcl_position o0\n"
    "dcl_texcoord o1.xy\ndcl_blendindices1 o2.x\nmov o0, v0\nmov o1.xy, v1\nmov o2.x, v2\n";
static const char two_targets[] =
    "ps_2_0\ndcl t0.xy\ndcl_2d s0\ntexld r0, t0, s0\nmov r1, r0.wzyx\nmov oC0, r0\nmov oC1, r1\n";

struct vertex {
    float position[3], texcoord[2], number, color[4];
    uint32_t packed; /* 0xAARRGGBB */
};

/* A cell's blending and its colour, as bytes with red in the low one, and as numbers. */
static struct cell {
    float number;
    uint32_t packed;
    float color[4];
} cells[CELLS * CELLS];

static uint32_t stored[SIZE * SIZE];
static triptych_texture *textures[2]; /* the stored colours and the new ones */

void setUp(void)
{
}

void tearDown(void)
{
    close_canvas();
}

/* --- Draws --- */

static triptych_texture *make_texture(uint32_t *words)
{
    triptych_texture *texture;
    for (int p = 0; p < SIZE * SIZE; p++)
        words[p] = random_word();
    OK(triptych_texture_create(device, words, SIZE, SIZE, &texture));
    return texture;
}

static unsigned product(unsigned a, unsigned b)
{
    return (2 * a * b + 255) / 510; /* the nearest: no product of bytes is a half */
}

/* Half of the colours are premultiplied; the sums of others are limited. Numbers are beyond 0 and 1 too. */
static struct cell random_cell(void)
{
    static const float numbers[] = {SHADOW, SUBPIXEL, 0, SHADOW, SUBPIXEL, 3, 1.5f, -1};
    struct cell cell = {.number = numbers[random_word() % 8], .packed = random_word()};
    bool premultiplied = random_word() & 1;
    uint32_t alpha = cell.packed >> 24;
    for (int c = 0; c < 3 && premultiplied; c++)
        cell.packed = (cell.packed & ~(255u << 8 * c)) | product(channel(cell.packed, c), alpha) << 8 * c;
    for (int c = 0; c < 4; c++)
        cell.color[c] = (float)dyadic(-0.25, 1.25);
    return cell;
}

static void begin(enum triptych_surface_format format)
{
    struct triptych_target_description description = {
        .width = SIZE, .height = SIZE, .color_format = {format}};
    OK(triptych_set_target_description(device, &description));
    textures[0] = make_texture(stored);
    textures[1] = make_texture(texel);
    set_stage(0, TRIPTYCH_STAGE_COLOROP, "selectarg1");
    set_stage(0, TRIPTYCH_STAGE_ALPHAOP, "selectarg1");
    for (int i = 0; i < CELLS * CELLS; i++)
        cells[i] = random_cell();
}

/* Declares the elements, with colours of bytes or of numbers, or without a colour. */
static void declare(bool has_color, bool numbers)
{
    const struct triptych_declaration_element elements[] = {
        {0, offsetof(struct vertex, position), TRIPTYCH_FORMAT_FLOAT3, TRIPTYCH_USAGE_POSITION, 0},
        {0, offsetof(struct vertex, texcoord), TRIPTYCH_FORMAT_FLOAT2, TRIPTYCH_USAGE_TEXCOORD, 0},
        {0, offsetof(struct vertex, number), TRIPTYCH_FORMAT_FLOAT1, TRIPTYCH_USAGE_BLENDINDICES, 1},
        {0, numbers ? offsetof(struct vertex, color) : offsetof(struct vertex, packed),
         numbers ? TRIPTYCH_FORMAT_FLOAT4 : TRIPTYCH_FORMAT_COLOR, TRIPTYCH_USAGE_COLOR, 2},
    };
    OK(triptych_set_declaration(device, elements, has_color ? 4 : 3));
}

static void draw_stored(void)
{
    OK(triptych_set_declaration(device, NULL, 0));
    OK(triptych_set_texture(device, 0, textures[0]));
    set(TRIPTYCH_STATE_ALPHABLENDENABLE, "false");
    draw_square(0, 0xffffffff, NULL, 0, 0, 1, 1);
    OK(triptych_set_texture(device, 0, textures[1]));
    set(TRIPTYCH_STATE_PRIMITIVEBLENDENABLE, "true");
}

/* A vertex at a pixel's corner; numbers and colours are those of the cell. */
static struct vertex vertex_at(float x, float y, const struct cell *cell)
{
    struct vertex v = {{2 * x / SIZE - 1, 1 - 2 * y / SIZE, 0}, {x / SIZE, y / SIZE}, cell->number, {0}, 0};
    memcpy(v.color, cell->color, sizeof v.color);
    v.packed = image_word(cell->packed);
    return v;
}

/* Two triangles. All but the provoking vertices have a random blending. */
static void make_cell(int i, bool last_provokes, struct vertex vertex[CORNERS])
{
    static const uint8_t corner[CORNERS] = {0, 1, 2, 2, 1, 3};
    for (int v = 0; v < CORNERS; v++) {
        int x = i % CELLS + (corner[v] & 1), y = i / CELLS + (corner[v] >> 1);
        struct cell other = random_cell();
        bool provokes = v % 3 == (last_provokes ? 2 : 0);
        vertex[v] = vertex_at((float)(CELL * x), (float)(CELL * y), provokes ? &cells[i] : &other);
    }
}

static void draw_cells(bool last_provokes)
{
    static struct vertex vertex[CELLS * CELLS][CORNERS];
    for (int i = 0; i < CELLS * CELLS; i++)
        make_cell(i, last_provokes, vertex[i]);
    OK(triptych_draw_user(device, TRIPTYCH_TRIANGLE_LIST, 2 * CELLS * CELLS, vertex, sizeof **vertex));
    use_shaders(NULL, NULL);
    set(TRIPTYCH_STATE_PRIMITIVEBLENDENABLE, "false");
}

/* --- Bytes --- */

enum blending { COPY, OVER, KEEP, LERP, BLENDINGS };

static void set_blending(enum blending blending)
{
    static const char *const factors[BLENDINGS][2] = {
        {"one", "zero"}, {"one", "invsrcalpha"}, {"zero", "one"}, {"srcalpha", "invsrcalpha"}};
    set(TRIPTYCH_STATE_ALPHABLENDENABLE, blending == COPY ? "false" : "true");
    set(TRIPTYCH_STATE_SRCBLEND, factors[blending][0]);
    set(TRIPTYCH_STATE_DESTBLEND, factors[blending][1]);
}

static unsigned limited(unsigned sum)
{
    return sum < 255 ? sum : 255;
}

static unsigned by_states(enum blending blending, uint32_t s, uint32_t d, int c)
{
    unsigned alpha = s >> 24, new = channel(s, c), old = channel(d, c);
    switch (blending) {
    case OVER: return limited(new + product(old, 255 - alpha));
    case KEEP: return old;
    case LERP: return (2 * (new *alpha + old *(255 - alpha)) + 255) / 510;
    default: return new;
    }
}

static unsigned by_primitive(const struct cell *cell, uint32_t s, uint32_t d, int c)
{
    unsigned mask = channel(s, cell->number == SHADOW ? 3 : c);
    unsigned covered = product(mask, cell->packed >> 24);
    return limited(product(mask, channel(cell->packed, c)) + product(channel(d, c), 255 - covered));
}

static bool has_own(const struct cell *cell)
{
    return cell->number == SHADOW || cell->number == SUBPIXEL;
}

static const struct cell *cell_of(int pixel)
{
    return &cells[pixel / SIZE / CELL * CELLS + pixel % SIZE / CELL];
}

static uint32_t expected_word(const struct cell *cell, enum blending blending, int p)
{
    uint32_t word = 0;
    for (int c = 0; c < 4; c++)
        word |= (has_own(cell) ? by_primitive(cell, texel[p], stored[p], c)
                               : by_states(blending, texel[p], stored[p], c))
                << 8 * c;
    return word;
}

static void expect_bytes(enum blending blending, const char *what)
{
    OK(triptych_read_color(device, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p += pixel_stride())
        expect_pixel(p % SIZE, p / SIZE, expected_word(cell_of(p), blending, p), what);
}

static void check_bytes(void)
{
    begin(TRIPTYCH_SURFACE_A8R8G8B8);
    for (enum blending blending = COPY; blending < BLENDINGS; blending++) {
        draw_stored();
        set_blending(blending);
        declare(true, false);
        use_shaders(blending & 1 ? vertices_of_3_0 : NULL, NULL);
        draw_cells(false);
        expect_bytes(blending, "a cell");
    }
}

static void test_primitives_of_a_draw_are_blended_by_the_states_or_as_shadows_or_text(void)
{
    on_every_engine(check_bytes);
}

static void check_last(void)
{
    begin(TRIPTYCH_SURFACE_A8R8G8B8);
    draw_stored();
    set_blending(OVER);
    declare(true, false);
    OK(triptych_set_convention(device, TRIPTYCH_PROVOKING_VERTEX, TRIPTYCH_PROVOKING_VERTEX_LAST));
    draw_cells(true);
    OK(triptych_set_convention(device, TRIPTYCH_PROVOKING_VERTEX, TRIPTYCH_PROVOKING_VERTEX_FIRST));
    expect_bytes(OVER, "the last vertex");
}

static void test_the_provoking_vertex_can_be_the_last(void)
{
    on_every_engine(check_last);
}

static void check_without_color(void)
{
    begin(TRIPTYCH_SURFACE_A8R8G8B8);
    for (int i = 0; i < CELLS * CELLS; i++)
        cells[i].packed = 0xff000000;
    for (int by_shader = 0; by_shader < 2; by_shader++) {
        draw_stored();
        set_blending(OVER);
        declare(by_shader, false);
        use_shaders(by_shader ? vertices_without_color : NULL, NULL);
        draw_cells(false);
        expect_bytes(OVER, "opaque black");
    }
}

static void test_a_colour_that_vertices_do_not_have_is_opaque_black(void)
{
    on_every_engine(check_without_color);
}

static void check_disabled(void)
{
    begin(TRIPTYCH_SURFACE_A8R8G8B8);
    draw_stored();
    set_blending(OVER);
    set(TRIPTYCH_STATE_PRIMITIVEBLENDENABLE, "false");
    declare(true, false);
    draw_cells(false);
    for (int i = 0; i < CELLS * CELLS; i++)
        cells[i].number = 0;
    expect_bytes(OVER, "without the state");
}

static void test_numbers_have_no_effect_without_the_state(void)
{
    on_every_engine(check_disabled);
}

/* --- Lines, points and clipped triangles --- */

/* A line for each row of pixels. Its other vertex has another blending. */
static void check_lines(void)
{
    static struct vertex vertex[SIZE][2];
    begin(TRIPTYCH_SURFACE_A8R8G8B8);
    for (int last = 0; last < 2; last++) {
        draw_stored();
        set_blending(OVER);
        declare(true, false);
        for (int y = 0; y < SIZE; y++)
            for (int v = 0; v < 2; v++)
                vertex[y][v] =
                    vertex_at(v ? SIZE + 4 : -4, (float)y + 0.5f, &cells[v == last ? y : SIZE - 1 - y]);
        OK(triptych_set_convention(device, TRIPTYCH_PROVOKING_VERTEX,
                                   last ? TRIPTYCH_PROVOKING_VERTEX_LAST : TRIPTYCH_PROVOKING_VERTEX_FIRST));
        OK(triptych_draw_user(device, TRIPTYCH_LINE_LIST, SIZE, vertex, sizeof **vertex));
        set(TRIPTYCH_STATE_PRIMITIVEBLENDENABLE, "false");
        OK(triptych_read_color(device, image, sizeof image));
        for (int p = 0; p < SIZE * SIZE; p += pixel_stride())
            expect_pixel(p % SIZE, p / SIZE, expected_word(&cells[p / SIZE], OVER, p), "a line");
    }
}

static void test_lines_have_the_blending_of_their_provoking_vertex(void)
{
    on_every_engine(check_lines);
}

static void check_points(void)
{
    static struct vertex vertex[SIZE * SIZE];
    begin(TRIPTYCH_SURFACE_A8R8G8B8);
    draw_stored();
    set_blending(OVER);
    declare(true, false);
    for (int p = 0; p < SIZE * SIZE; p++)
        vertex[p] = vertex_at((float)(p % SIZE) + 0.5f, (float)(p / SIZE) + 0.5f, cell_of(p));
    OK(triptych_draw_user(device, TRIPTYCH_POINT_LIST, SIZE * SIZE, vertex, sizeof *vertex));
    set(TRIPTYCH_STATE_PRIMITIVEBLENDENABLE, "false");
    expect_bytes(OVER, "a point");
}

static void test_points_have_a_blending_each(void)
{
    on_every_engine(check_points);
}

/* The depth of a triangle whose first corner is nearer than the near plane. */
static double depth_at(int pixel)
{
    return (pixel % SIZE + 0.5 + pixel / SIZE + 0.5) / SIZE - 1;
}

static void check_clipped(void)
{
    struct cell black = {SHADOW, 0x80000000, {0}}, none = {0};
    struct vertex vertex[3] = {vertex_at(0, 0, &black), vertex_at(2 * SIZE, 0, &none),
                               vertex_at(0, 2 * SIZE, &none)};
    begin(TRIPTYCH_SURFACE_A8R8G8B8);
    draw_stored();
    set_blending(OVER);
    declare(true, false);
    for (int i = 0; i < 3; i++)
        vertex[i].position[2] = i ? 1 : -1;
    OK(triptych_draw_user(device, TRIPTYCH_TRIANGLE_LIST, 1, vertex, sizeof *vertex));
    OK(triptych_read_color(device, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p += pixel_stride()) {
        double depth = depth_at(p);
        uint32_t word = depth < 0 ? stored[p] : 0;
        for (int c = 0; c < 4 && depth >= 0; c++)
            word |= by_primitive(&black, texel[p], stored[p], c) << 8 * c;
        if (depth < -0.02 || depth > 0.02) /* not at the edge that clipping makes */
            expect_pixel(p % SIZE, p / SIZE, word, "a clipped triangle");
    }
    set(TRIPTYCH_STATE_PRIMITIVEBLENDENABLE, "false");
}

static void test_a_clipped_triangle_has_the_blending_of_a_vertex_that_is_cut_off(void)
{
    on_every_engine(check_clipped);
}

/* A triangle over two tiles, which would hide what is under it if the states blended it. */
static void check_covering(void)
{
    static uint32_t pixels[2 * SIZE * SIZE];
    struct triptych_target_description description = {
        .width = 2 * SIZE, .height = SIZE, .color_format = {TRIPTYCH_SURFACE_A8R8G8B8}};
    struct cell red = {SHADOW, 0x40000040, {0}};
    struct vertex vertex[3] = {vertex_at(0, 0, &red), vertex_at(4 * SIZE, 0, &red),
                               vertex_at(0, 4 * SIZE, &red)};
    uint32_t under = image_word(0xff804020), word = 0;
    OK(triptych_set_target_description(device, &description));
    clear_to(0);
    draw_square(0, 0xff804020, NULL, 0, 0, 1, 1);
    set(TRIPTYCH_STATE_PRIMITIVEBLENDENABLE, "true");
    declare(true, false);
    OK(triptych_draw_user(device, TRIPTYCH_TRIANGLE_LIST, 1, vertex, sizeof *vertex));
    OK(triptych_read_color(device, pixels, sizeof pixels));
    for (int c = 0; c < 4; c++)
        word |= by_primitive(&red, 0xffffffff, under, c) << 8 * c;
    for (int p = 0; p < 2 * SIZE * SIZE; p += pixel_stride())
        TEST_ASSERT_EQUAL_HEX32(word, pixels[p]);
}

static void test_a_shadow_over_a_whole_tile_hides_nothing(void)
{
    on_every_engine(check_covering);
}

/* --- Targets --- */

static uint32_t reversed(uint32_t word)
{
    return __builtin_bswap32(word);
}

static void check_targets(void)
{
    struct triptych_target_description description = {
        .width = SIZE,
        .height = SIZE,
        .color_format = {TRIPTYCH_SURFACE_A8R8G8B8, TRIPTYCH_SURFACE_A8R8G8B8}};
    begin(TRIPTYCH_SURFACE_A8R8G8B8);
    OK(triptych_set_target_description(device, &description));
    draw_stored(); /* in both */
    set_blending(KEEP);
    declare(true, false);
    use_shaders(NULL, two_targets);
    draw_cells(false);
    expect_bytes(KEEP, "the first target");
    OK(triptych_read_target(device, 1, image, sizeof image));
    for (int p = 0; p < SIZE * SIZE; p += pixel_stride()) {
        uint32_t s = reversed(texel[p]), word = has_own(cell_of(p)) ? 0 : stored[p];
        for (int c = 0; c < 4 && has_own(cell_of(p)); c++)
            word |= by_primitive(cell_of(p), s, stored[p], c) << 8 * c;
        expect_pixel(p % SIZE, p / SIZE, word, "the second target");
    }
}

static void test_each_target_has_its_own_mask(void)
{
    on_every_engine(check_targets);
}

/* --- Binary32 --- */

static float fraction(uint32_t word, int c)
{
    return (float)channel(word, c) / 255.0f;
}

static float clamped(float number)
{
    return number < 0 ? 0 : number > 1 ? 1 : number;
}

static float expected_number(const struct cell *cell, int p, int c)
{
    float old = fraction(stored[p], c);
    if (!has_own(cell))
        return fraction(texel[p], c) + old * (1 - fraction(texel[p], 3));
    float mask = fraction(texel[p], cell->number == SHADOW ? 3 : c);
    float new = mask *clamped(cell->color[c]), covered = mask *clamped(cell->color[3]);
    return new + old *(1 - covered);
}

static void check_numbers(void)
{
    begin(TRIPTYCH_SURFACE_A32B32G32R32F);
    draw_stored();
    set_blending(OVER);
    declare(true, true);
    draw_cells(false);
    read_numbers(0);
    for (int p = 0; p < SIZE * SIZE; p += pixel_stride())
        for (int c = 0; c < 4; c++)
            TEST_ASSERT_TRUE_MESSAGE(expected_number(cell_of(p), p, c) == drawn[p][c], "binary32");
}

static void test_numbers_are_blended_in_binary32(void)
{
    on_every_engine(check_numbers);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_primitives_of_a_draw_are_blended_by_the_states_or_as_shadows_or_text);
    RUN_TEST(test_the_provoking_vertex_can_be_the_last);
    RUN_TEST(test_a_colour_that_vertices_do_not_have_is_opaque_black);
    RUN_TEST(test_numbers_have_no_effect_without_the_state);
    RUN_TEST(test_lines_have_the_blending_of_their_provoking_vertex);
    RUN_TEST(test_points_have_a_blending_each);
    RUN_TEST(test_a_clipped_triangle_has_the_blending_of_a_vertex_that_is_cut_off);
    RUN_TEST(test_a_shadow_over_a_whole_tile_hides_nothing);
    RUN_TEST(test_each_target_has_its_own_mask);
    RUN_TEST(test_numbers_are_blended_in_binary32);
    return UNITY_END();
}
