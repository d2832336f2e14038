/* The second code of pixel routines, for the 16 pixels of a block: which draws make an engine build it, which
 * use it, and that pictures are those of the emulator in any case. */
#include "render/device/device.h"
#include "tests/support/system/tried.h"

#include <stdio.h>
#include <string.h>
#include <unity.h>

enum { SIZE = 64, BLOCKS = SIZE * SIZE / 16, DRAWS = 4, TEXT = 4096 };

static struct error error;
static triptych_device *device;

#define OK(call) TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, call, triptych_error(device))

static const char vertex_text[] =
    "vs_3_0\ndcl_position v0\ndcl_position o0\ndcl_texcoord o1\nmov o0, v0\nmov o1, v0\n";

void setUp(void)
{
    error_clear(&error);
    test_needs_engine("specialize-8");
}

void tearDown(void)
{
    triptych_device_destroy(device);
    device = NULL;
}

/* A pixel shader with a line many times. */
static const char *repeat(const char *line, unsigned times)
{
    static char text[TEXT];
    int length = snprintf(text, sizeof text, "ps_3_0\ndcl_texcoord v0\nmov r1, c1\nmov r0, v0\n");
    for (unsigned i = 0; i < times; i++)
        length += snprintf(text + length, sizeof text - (size_t)length, "%s\n", line);
    snprintf(text + length, sizeof text - (size_t)length, "mov oC0, r0\n");
    return text;
}

/* Each result waits for the one before it, so that halves of a block can hide each other's latency. */
static const char *chain(void)
{
    return repeat("exp r0.x, r0.x\nlog r0.x, r0.x", 12);
}

/* Each multiply-add has two constants, for which two registers a value leave no register. */
static const char *constants(void)
{
    return repeat("mad r0, r0, c0, r1", 40);
}

static triptych_shader *assemble(const char *text)
{
    triptych_shader *shader;
    OK(triptych_shader_assemble(device, NULL, text, strlen(text), &shader));
    return shader;
}

/* A quad; and triangles of a pixel each, so that no block is covered in both halves. Neighbours have other
 * values. */
static const float quad[4][4] = {{-1, -1, .5f, 1}, {-1, 1, .5f, 1}, {1, -1, .5f, 1}, {1, 1, .5f, 1}};
static float dots[BLOCKS][3][4];

static void make_dots(void)
{
    for (unsigned n = 0; n < BLOCKS; n++)
        for (unsigned corner = 0; corner < 3; corner++) {
            float x = (float)(n % 16 * 4) + (corner == 1 ? 1 : 0), y = (float)(n / 16 * 4) + (corner == 2);
            const float at[4] = {x / 32 - 1, 1 - y / 32, .25f + (float)(n % 8) / 16, 1};
            memcpy(dots[n][corner], at, sizeof at);
        }
}

static void begin(const char *name, unsigned threads, const char *pixel)
{
    const struct triptych_target_description target = {
        .width = SIZE, .height = SIZE, .color_format = {TRIPTYCH_SURFACE_A32B32G32R32F}};
    const struct device_options options = {.threads = threads};
    const float rows[2][4] = {{.5f, .25f, .75f, .5f}, {.1f, .2f, .3f, .4f}};
    const struct engine *engine = engine_named(name, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(engine, error.text);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, device_create(engine, &options, &device, NULL));
    OK(triptych_set_target_description(device, &target));
    OK(triptych_set_state(device, TRIPTYCH_STATE_CULLMODE, 1));
    OK(triptych_set_vertex_shader(device, assemble(vertex_text)));
    OK(triptych_set_pixel_shader(device, assemble(pixel)));
    OK(triptych_set_shader_floats(device, TRIPTYCH_SHADER_PIXEL, 0, rows[0], 2));
}

static void draw(const void *corners, size_t bytes, enum triptych_primitive primitive, unsigned count)
{
    struct triptych_element position = {.format = TRIPTYCH_FORMAT_FLOAT4, .stride = 16};
    OK(triptych_buffer_create(device, corners, bytes, &position.buffer));
    OK(triptych_set_element(device, TRIPTYCH_POSITION, &position));
    OK(triptych_draw(device, primitive, 0, count));
    OK(triptych_finish(device));
}

static void draw_quad(void)
{
    draw(quad, sizeof quad, TRIPTYCH_TRIANGLE_STRIP, 2);
}

static void draw_dots(void)
{
    make_dots();
    draw(dots, sizeof dots, TRIPTYCH_TRIANGLE_LIST, BLOCKS);
}

/* The counts of the pixel routine, when all draws are rendered; `least` is 0 if it may have no second
 * code. */
static struct routine_second second_of(float picture[SIZE * SIZE][4])
{
    struct routine routine;
    OK(triptych_read_target_numbers(device, 0, picture[0], sizeof(float[SIZE * SIZE][4])));
    for (size_t i = 0; cache_get(device->cache, i, &routine); i++)
        if (routine.unit == UNIT_PIXEL && routine.second)
            return *routine.second;
    return (struct routine_second){0};
}

typedef void drawing(void);

/* Draws quads, then what `draw` draws, with an engine. */
static struct routine_second play(const char *name, unsigned threads, const char *pixel, unsigned quads,
                                  drawing *after, float picture[SIZE * SIZE][4])
{
    begin(name, threads, pixel);
    for (unsigned i = 0; i < quads; i++)
        draw_quad();
    if (after)
        after();
    struct routine_second second = second_of(picture);
    triptych_device_destroy(device);
    device = NULL;
    return second;
}

/* The same with the emulator too, whose picture must be the same. */
static struct routine_second compare(const char *name, unsigned threads, const char *pixel, unsigned quads,
                                     drawing *after)
{
    static float expected[SIZE * SIZE][4], found[SIZE * SIZE][4];
    play("emulate", 1, pixel, quads, after, expected);
    struct routine_second second = play(name, threads, pixel, quads, after, found);
    TEST_ASSERT_EQUAL_MEMORY(expected, found, sizeof found);
    return second;
}

/* A list of one block, which has no partner. */
static void draw_dot(void)
{
    make_dots();
    draw(dots, sizeof dots[0], TRIPTYCH_TRIANGLE_LIST, 1);
}

/* --- Tests ---------------------------------------------------------------------------------------------- */

static void whole_blocks_bring_the_second_code(void)
{
    const struct routine_second second = compare("specialize-8:sixteen=300", 1, chain(), DRAWS, NULL);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT32(2 * BLOCKS, second.blocks); /* after one quad there are too few */
    TEST_ASSERT_TRUE(second.is_decided);
    TEST_ASSERT_GREATER_THAN(0, second.bytes);
    TEST_ASSERT_EQUAL_UINT32(DRAWS - 2, second.runs);
}

static void blocks_with_an_empty_half_do_not_bring_it(void)
{
    const struct routine_second second = compare("specialize-8:sixteen=1", 1, chain(), 0, draw_dots);
    TEST_ASSERT_EQUAL_UINT32(1, second.least);
    TEST_ASSERT_EQUAL_UINT32(0, second.blocks);
    TEST_ASSERT_FALSE(second.is_decided);
}

static void a_call_of_blocks_with_an_empty_half_does_not_use_it(void)
{
    const struct routine_second second = compare("specialize-8:sixteen=1", 1, chain(), 2, draw_dots);
    TEST_ASSERT_GREATER_THAN(0, second.bytes);
    TEST_ASSERT_EQUAL_UINT32(1, second.runs);
}

static void it_is_not_built_where_it_would_be_slower(void)
{
    const struct routine_second second = compare("specialize-8:sixteen=1", 1, constants(), 3, NULL);
    TEST_ASSERT_TRUE(second.is_decided);
    TEST_ASSERT_EQUAL(0, second.bytes);
    TEST_ASSERT_EQUAL_UINT32(0, second.runs);
}

static void threads_use_it_as_soon_as_it_is_built(void)
{
    const struct routine_second second = compare("specialize-8:sixteen=1", 2, chain(), DRAWS, draw_dots);
    TEST_ASSERT_GREATER_THAN(0, second.bytes);
    TEST_ASSERT_GREATER_THAN(0, second.runs);
}

/* A quad has blocks next to each other; lists of dots have records of their own. Chains have four registers
 * for each value, and a pass of two blocks that are one computes it twice. */
static void chains_compute_two_blocks_together(void)
{
    compare("specialize-8x4", 1, chain(), 1, draw_dots);
    compare("specialize-8x4", 1, chain(), 1, draw_dot);
    begin("specialize-8:sixteen=1", 1, chain());
    draw_quad();
    draw_quad();
    static float picture[SIZE * SIZE][4];
    const struct routine_second second = second_of(picture);
    TEST_ASSERT_NOT_NULL(second.routine);
    TEST_ASSERT_EQUAL_UINT32(32, second.routine->lanes);
}

static void other_options_of_code_exclude_it(void)
{
    static const char *const names[] = {"specialize-8", "specialize-8x2:sixteen=1",
                                        "specialize-8:sixteen=1:addresses=patched",
                                        "specialize-8:sixteen=1:calls=sampling", "specialize-4:sixteen=1"};
    for (unsigned i = 0; i < sizeof names / sizeof *names; i++) {
        const struct routine_second second = compare(names[i], 1, chain(), 2, NULL);
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(0, second.least, names[i]);
    }
    const struct routine_second second = compare("specialize-8:sixteen=1:without=shape", 1, chain(), 2, NULL);
    TEST_ASSERT_EQUAL(0, second.bytes);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(whole_blocks_bring_the_second_code);
    RUN_TEST(blocks_with_an_empty_half_do_not_bring_it);
    RUN_TEST(a_call_of_blocks_with_an_empty_half_does_not_use_it);
    RUN_TEST(it_is_not_built_where_it_would_be_slower);
    RUN_TEST(threads_use_it_as_soon_as_it_is_built);
    RUN_TEST(chains_compute_two_blocks_together);
    RUN_TEST(other_options_of_code_exclude_it);
    return UNITY_END();
}
