/* Random variants of the shaders of tests/data/shaders. Damaged shaders that are still valid are drawn once,
 * with random constants and textures of all kinds; some of them are drawn by all engines. Undamaged pairs are
 * drawn by all engines in random states. All pictures of a case must be the same, nothing crashes, and every
 * draw ends. Builds with sanitizers check the memory accesses. The seed is fixed unless TRIPTYCH_SEED is
 * set. */
#include "render/device/device.h"
#include "engines/list.h"
#include "tests/support/system/seed.h"
#include "tests/support/shader/shaders.h"

#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

enum { SIZE = 6, DAMAGES = 32, ALL_ENGINES_EVERY = 8, ENGINES = 5, PAIRS = 240, CONSTANTS = 256 };

struct drawing {
    const struct engine *engine;
    triptych_device *device;
    triptych_texture *texture[TRIPTYCH_SAMPLERS];
};

/* The first draws everything. */
static const char *const names[ENGINES] = {"emulate", "batch", "stitch", "stitch-operation", "specialize"};
static struct drawing drawings[ENGINES];
static unsigned engines;
static struct error error;
static uint64_t seed;
static float picture[SIZE * SIZE][4], first[SIZE * SIZE][4];

#define OK(call) TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, call, triptych_error(device))

static float random_float(void)
{
    return (float)shader_random(&seed, 4096) / 1024 - 2;
}

static void create_textures(struct drawing *drawing)
{
    static const enum triptych_texture_type types[] = {TRIPTYCH_TEXTURE_2D, TRIPTYCH_TEXTURE_CUBE,
                                                       TRIPTYCH_TEXTURE_VOLUME};
    triptych_device *device = drawing->device;
    for (unsigned i = 0; i < TRIPTYCH_SAMPLERS; i++) {
        struct triptych_texture_description description = {
            types[i % 3], TRIPTYCH_SURFACE_A8R8G8B8, 4, 4, 1, 0};
        uint32_t texels[64];
        for (int t = 0; t < 64; t++)
            texels[t] = 0x9e3779b9u * (uint32_t)(t + 1 + (int)i);
        if (types[i % 3] == TRIPTYCH_TEXTURE_VOLUME)
            description.depth = 4;
        OK(triptych_texture_define(device, &description, &drawing->texture[i]));
        for (unsigned face = 0; face < (types[i % 3] == TRIPTYCH_TEXTURE_CUBE ? 6 : 1); face++)
            OK(triptych_texture_update(device, drawing->texture[i], face, 0, NULL, texels, 16, 64));
        OK(triptych_texture_generate_mips(device, drawing->texture[i]));
    }
}

/* Creates vertices with four floats for every input that a shader may read. */
static void create_vertices(triptych_device *device)
{
    enum { ELEMENTS = 18, VERTICES = 4 };
    static const uint8_t usage[ELEMENTS][2] = {
        {TRIPTYCH_USAGE_POSITION, 0}, {TRIPTYCH_USAGE_NORMAL, 0},      {TRIPTYCH_USAGE_COLOR, 0},
        {TRIPTYCH_USAGE_COLOR, 1},    {TRIPTYCH_USAGE_BLENDWEIGHT, 0}, {TRIPTYCH_USAGE_BLENDINDICES, 0},
        {TRIPTYCH_USAGE_TANGENT, 0},  {TRIPTYCH_USAGE_BINORMAL, 0},    {TRIPTYCH_USAGE_POSITION, 1},
        {TRIPTYCH_USAGE_NORMAL, 1},   {TRIPTYCH_USAGE_TEXCOORD, 0},    {TRIPTYCH_USAGE_TEXCOORD, 1},
        {TRIPTYCH_USAGE_TEXCOORD, 2}, {TRIPTYCH_USAGE_TEXCOORD, 3},    {TRIPTYCH_USAGE_TEXCOORD, 4},
        {TRIPTYCH_USAGE_TEXCOORD, 5}, {TRIPTYCH_USAGE_TEXCOORD, 6},    {TRIPTYCH_USAGE_TEXCOORD, 7}};
    struct triptych_declaration_element elements[ELEMENTS];
    static float vertices[VERTICES][ELEMENTS][4];
    triptych_buffer *buffer;
    uint64_t random = 77;
    for (unsigned e = 0; e < ELEMENTS; e++) {
        elements[e] = (struct triptych_declaration_element){0, 16 * e, TRIPTYCH_FORMAT_FLOAT4, usage[e][0],
                                                            usage[e][1]};
        for (int v = 0; v < VERTICES; v++)
            for (int c = 0; c < 4; c++)
                vertices[v][e][c] = (float)shader_random(&random, 2048) / 1024 - 0.5f;
    }
    for (int v = 0; v < VERTICES; v++)
        memcpy(vertices[v][0], (float[4]){(float)(v % 2) * 2 - 1, (float)(v / 2) * 2 - 1, 0.5f, 1}, 16);
    OK(triptych_buffer_create(device, vertices, sizeof vertices, &buffer));
    OK(triptych_set_declaration(device, elements, ELEMENTS));
    OK(triptych_set_stream(device, 0, buffer, 0, sizeof vertices[0]));
}

static void create_drawing(const struct engine *engine)
{
    struct device_options options = {.threads = 1, .cache_bytes = 1 << 20};
    struct drawing *drawing = &drawings[engines++];
    struct triptych_target_description target = {
        .width = SIZE, .height = SIZE, .color_format = {TRIPTYCH_SURFACE_A32B32G32R32F}};
    drawing->engine = engine;
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, device_create(engine, &options, &drawing->device, NULL));
    triptych_device *device = drawing->device;
    OK(triptych_set_target_description(device, &target));
    OK(triptych_set_state(device, TRIPTYCH_STATE_LIGHTING, 0));
    OK(triptych_set_state(device, TRIPTYCH_STATE_CULLMODE, 1));
    create_textures(drawing);
    create_vertices(device);
}

void setUp(void)
{
    error_clear(&error);
    seed = test_seed();
    engines = 0;
    for (unsigned i = 0; i < ENGINES; i++)
        if (!engine_unavailable(engine_find(names[i])))
            create_drawing(engine_find(names[i]));
}

void tearDown(void)
{
    for (unsigned i = 0; i < engines; i++)
        triptych_device_destroy(drawings[i].device);
    engines = 0;
}

static void set_constants(uint64_t random)
{
    static float floats[CONSTANTS][4];
    int32_t integers[16][4], booleans[16];
    seed = random;
    for (int i = 0; i < 4 * CONSTANTS; i++)
        floats[i / 4][i % 4] =
            random_float() / 8 + (i < 16 && i % 5 == 0); /* near the unit matrix: vertices are in view */
    for (int i = 0; i < 16; i++) {
        booleans[i] = (int32_t)shader_random(&seed, 2);
        for (int c = 0; c < 4; c++)
            integers[i][c] = (int32_t)shader_random(&seed, 4);
    }
    for (unsigned e = 0; e < engines; e++) {
        triptych_device *device = drawings[e].device;
        for (int stage = 0; stage < TRIPTYCH_SHADER_STAGE_COUNT; stage++) {
            OK(triptych_set_shader_floats(device, stage, 0, floats[0], CONSTANTS));
            OK(triptych_set_shader_integers(device, stage, 0, integers[0], 16));
            OK(triptych_set_shader_booleans(device, stage, 0, booleans, 16));
        }
        for (unsigned i = 0; i < TRIPTYCH_SAMPLERS; i++)
            OK(triptych_set_texture(device, i, drawings[e].texture[(i + random) % TRIPTYCH_SAMPLERS]));
    }
}

static void expect_one_line(const char *reason)
{
    TEST_ASSERT_TRUE(reason[0] != 0);
    TEST_ASSERT_NULL_MESSAGE(strchr(reason, '\n'), reason);
}

/* Returns true if the draw succeeded. */
static bool draw(struct drawing *drawing, const struct shader *shader)
{
    static const float black[4] = {0};
    triptych_device *device = drawing->device;
    triptych_shader *made;
    error_clear(&error);
    if (device_shader_create(device, shader, &made, &error)) {
        expect_one_line(error.text);
        return false;
    }
    OK(triptych_clear(device, black, 1));
    OK(device_set_shader(device, shader->model->stage, made, &error));
    bool drawn = triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 0, 2) == TRIPTYCH_OK;
    if (!drawn)
        expect_one_line(triptych_error(device));
    OK(triptych_shader_destroy(device, made));
    OK(triptych_read_target_numbers(device, 0, picture[0], sizeof picture));
    return drawn;
}

static void describe(const struct shader *shader, const char *engine)
{
    char *text;
    size_t bytes;
    if (shader_print(shader, &text, &bytes, NULL))
        return;
    printf("%s draws %s differently:\n%s", engine, shader->path, text);
    free(text);
}

static void draw_by_all(const struct shader *shader)
{
    bool drawn = draw(&drawings[0], shader);
    memcpy(first, picture, sizeof first);
    for (unsigned e = 1; e < engines; e++) {
        bool same = draw(&drawings[e], shader) == drawn && !memcmp(first, picture, sizeof first);
        if (!same)
            describe(shader, drawings[e].engine->name);
        TEST_ASSERT_TRUE_MESSAGE(same, drawings[e].engine->name);
    }
}

static void damaged_shaders_are_drawn_or_refused(void)
{
    glob_t files;
    unsigned valid = 0, number = 0;
    TEST_ASSERT_EQUAL_INT(0, glob("tests/data/shaders/*/*.?sa", 0, NULL, &files));
    for (size_t f = 0; f < files.gl_pathc; f++)
        for (int i = 0; i < DAMAGES; i++) {
            struct shader *shader;
            TEST_ASSERT_EQUAL_INT(0, shader_load(files.gl_pathv[f], &shader, &error));
            for (uint32_t changes = (uint32_t)i % 4; changes; changes--)
                shader_damage(shader, &seed);
            bool good = !shader_validate(shader, NULL, NULL);
            valid += good;
            if (good && number++ % ALL_ENGINES_EVERY == 0) {
                set_constants(seed);
                draw_by_all(shader);
            } else if (good) {
                draw(&drawings[0], shader);
            }
            shader_free(shader);
        }
    globfree(&files);
    TEST_ASSERT_GREATER_THAN_UINT32(1000, valid);
}

/* Bytecode in which a word or a bit is replaced or the last words are missing is given to the public
 * interface. */
static void damaged_bytecode_is_drawn_or_refused(void)
{
    glob_t files;
    unsigned drawn = 0, refused = 0;
    triptych_device *device = drawings[0].device;
    TEST_ASSERT_EQUAL_INT(0, glob("tests/data/shaders/*/*.?sa", 0, NULL, &files));
    for (size_t f = 0; f < files.gl_pathc; f++) {
        struct shader *shader;
        uint32_t *tokens;
        size_t count;
        TEST_ASSERT_EQUAL_INT(0, shader_load(files.gl_pathv[f], &shader, &error));
        TEST_ASSERT_EQUAL_INT(0, shader_encode(shader, &tokens, &count, &error));
        for (int i = 0; i < DAMAGES; i++) {
            triptych_shader *made;
            size_t at = shader_random(&seed, (uint32_t)count), cut = shader_random(&seed, 20) ? 0 : at;
            uint32_t before = tokens[at];
            tokens[at] = shader_random(&seed, 3) ? before ^ 1u << shader_random(&seed, 32)
                                                 : tokens[shader_random(&seed, (uint32_t)count)];
            if (triptych_shader_create(device, "tokens", tokens, 4 * (count - cut), &made)) {
                expect_one_line(triptych_error(device));
                refused++;
            } else {
                OK(triptych_shader_get_stage(made) == TRIPTYCH_SHADER_VERTEX
                       ? triptych_set_vertex_shader(device, made)
                       : triptych_set_pixel_shader(device, made));
                drawn += !triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 0, 2);
                OK(triptych_finish(device));
                OK(triptych_shader_destroy(device, made));
            }
            tokens[at] = before;
        }
        shader_free(shader);
        free(tokens);
    }
    globfree(&files);
    TEST_ASSERT_GREATER_THAN_UINT32(500, drawn);
    TEST_ASSERT_GREATER_THAN_UINT32(500, refused);
}

/* --- States --- */

/* Chooses a supported value of a state: one of its words, or any bits of a colour or mask. Returns false for
 * other kinds. */
static bool choose_value(const struct triptych_kind *kind, uint32_t *number)
{
    const struct triptych_value *value;
    unsigned count = 0;
    if (kind->notation == TRIPTYCH_NOTATION_HEXADECIMAL || kind->notation == TRIPTYCH_NOTATION_NUMBER) {
        *number = shader_random(&seed, UINT32_MAX);
        return *number >= kind->first && *number <= kind->last;
    }
    if (kind->notation != TRIPTYCH_NOTATION_WORDS)
        return false;
    while (triptych_value_at(kind, count))
        count++;
    value = triptych_value_at(kind, shader_random(&seed, count));
    *number = value->number;
    return value->support == TRIPTYCH_SUPPORT_YES;
}

static void set_everywhere(enum triptych_state_table table, unsigned i, unsigned row, uint32_t value)
{
    for (unsigned e = 0; e < engines; e++) {
        triptych_device *device = drawings[e].device;
        OK(table == TRIPTYCH_RENDER_STATES    ? triptych_set_state(device, row, value)
           : table == TRIPTYCH_SAMPLER_STATES ? triptych_set_sampler_state(device, i, row, value)
                                              : triptych_set_stage_state(device, i, row, value));
    }
}

static void set_defaults(void)
{
    for (unsigned table = 0; table < TRIPTYCH_STATE_TABLE_COUNT; table++)
        for (unsigned i = 0; i < triptych_table_size(table); i++)
            for (unsigned row = 0; triptych_state_at(table, row); row++)
                set_everywhere(table, i, row, triptych_state_default(table, row, i));
}

static void set_random_states(void)
{
    for (int chosen = 0; chosen < 24;) {
        unsigned table = shader_random(&seed, 3), rows = 0;
        uint32_t value;
        while (triptych_state_at(table, rows))
            rows++;
        unsigned row = shader_random(&seed, rows), i = shader_random(&seed, table ? 4 : 1);
        const struct triptych_state_row *state = triptych_state_at(table, row);
        if (state->support == TRIPTYCH_SUPPORT_YES && choose_value(state->kind, &value)) {
            set_everywhere(table, i, row, value);
            chosen++;
        }
    }
    set_everywhere(TRIPTYCH_RENDER_STATES, 0, TRIPTYCH_STATE_CULLMODE, 1);
    for (unsigned e = 0; e < engines; e++)
        triptych_set_convention(drawings[e].device, TRIPTYCH_MULTIPLY, (unsigned)(seed & 1));
}

static void set_random_target(void)
{
    static const enum triptych_surface_format formats[] = {TRIPTYCH_SURFACE_A8R8G8B8, TRIPTYCH_SURFACE_R5G6B5,
                                                           TRIPTYCH_SURFACE_A16B16G16R16F,
                                                           TRIPTYCH_SURFACE_A32B32G32R32F};
    struct triptych_target_description target = {.width = SIZE, .height = SIZE};
    do
        target.depth_format = shader_random(&seed, TRIPTYCH_DEPTH_COUNT);
    while (target.depth_format == TRIPTYCH_DEPTH_NONE);
    unsigned targets = shader_random(&seed, 3) ? 1 : 2;
    for (unsigned t = 0; t < targets; t++)
        target.color_format[t] = formats[shader_random(&seed, 4)];
    if (targets == 1 && !shader_random(&seed, 3))
        target.samples = 4;
    for (unsigned e = 0; e < engines; e++) {
        triptych_device *device = drawings[e].device;
        OK(triptych_set_target_description(device, &target));
    }
}

/* Draws a pair of shaders with every engine and compares the pictures. Either shader may be null. */
static bool draw_pair(const struct shader *vertex, const struct shader *pixel)
{
    static const float black[4] = {0};
    enum triptych_result results[ENGINES] = {TRIPTYCH_OK};
    for (unsigned e = 0; e < engines; e++) {
        triptych_device *device = drawings[e].device;
        triptych_shader *made[SHADER_STAGES] = {0};
        for (int stage = 0; stage < SHADER_STAGES; stage++) {
            const struct shader *shader = stage == STAGE_PIXEL ? pixel : vertex;
            if (shader)
                OK(device_shader_create(device, shader, &made[stage], &error));
            OK(device_set_shader(device, stage, made[stage], &error));
        }
        OK(triptych_clear(device, black, 1));
        results[e] = triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 0, 2);
        OK(triptych_read_target_numbers(device, 0, picture[0], sizeof picture));
        OK(triptych_shader_destroy(device, made[0]));
        OK(triptych_shader_destroy(device, made[1]));
        if (!e)
            memcpy(first, picture, sizeof first);
        bool same = results[e] == results[0] && !memcmp(first, picture, sizeof first);
        if (!same && vertex)
            describe(vertex, drawings[e].engine->name);
        if (!same && pixel)
            describe(pixel, drawings[e].engine->name);
        TEST_ASSERT_TRUE_MESSAGE(same, drawings[e].engine->name);
    }
    return results[0] == TRIPTYCH_OK;
}

static struct shader *load_random(const char *pattern)
{
    glob_t files;
    struct shader *shader;
    TEST_ASSERT_EQUAL_INT(0, glob(pattern, 0, NULL, &files));
    TEST_ASSERT_EQUAL_INT(
        0, shader_load(files.gl_pathv[shader_random(&seed, (uint32_t)files.gl_pathc)], &shader, &error));
    globfree(&files);
    return shader;
}

static void pairs_in_random_states_are_drawn_alike(void)
{
    unsigned drawn = 0;
    for (int i = 0; i < PAIRS; i++) {
        struct shader *vertex = i % 4 ? load_random("tests/data/shaders/*/*.vsa") : NULL;
        struct shader *pixel = i % 4 != 1 ? load_random("tests/data/shaders/*/*.psa") : NULL;
        if (i % 8 == 0)
            set_random_target();
        set_constants(seed);
        set_defaults();
        set_random_states();
        drawn += draw_pair(vertex, pixel);
        shader_free(vertex);
        shader_free(pixel);
    }
    TEST_ASSERT_GREATER_THAN_UINT32(PAIRS / 2, drawn);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(damaged_shaders_are_drawn_or_refused);
    RUN_TEST(damaged_bytecode_is_drawn_or_refused);
    RUN_TEST(pairs_in_random_states_are_drawn_alike);
    return UNITY_END();
}
