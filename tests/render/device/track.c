/* Constants of shaders as literals in code: when variants are built, when their guards fail, and that the
 * pictures are those of the emulator in any case. Each draw writes one pixel of a target of binary32. */
#include "render/device/device.h"
#include "base/bits.h"
#include "tests/support/system/tried.h"

#include <string.h>
#include <unity.h>

enum { DRAWS = 96, ROWS = 3, VARIANTS = 4 /* the most of a routine */ };

static struct error error;
static triptych_device *device;

#define OK(call) TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, call, triptych_error(device))

static const char position_text[] = "vs_2_0\ndcl_position v0\nmov oPos, v0\n";
static const char pixel_text[] = "ps_2_0\nmov r0, c0\nmul r0, r0, c1\nadd r0, r0, c2\nmov oC0, r0\n";
static const char address_text[] = "vs_2_0\ndcl_position v0\nmov oPos, v0\nmova a0.x, c0.x\n"
                                   "mov r0, c[a0.x + 1]\nadd r0, r0, c1\nmov oT0, r0\n";
static const char copy_text[] = "ps_2_0\ndcl t0\nmov oC0, t0\n";
static const char edge_text[] =
    "ps_2_0\nmov r0, c0\nadd r1, r0, c1\nmul r2, r0, c2\nmad r3, r0, r1, c2\nmin r0, r0, c1\nmax r1, r1, c2\n"
    "rcp r2.x, r2.x\ncmp r0, r0, r1, r2\nadd r0, r0, r3\nmov oC0, r0\n";

/* Bits of the constants of draw n: c0 to c2. */
typedef void constants_of(unsigned n, uint32_t rows[ROWS][4]);

struct script {
    const char *vertex, *pixel;
    enum triptych_shader_stage stage; /* whose constants are set */
    constants_of *constants;
    unsigned draws, threads;
    unsigned flush; /* draws after which rendering begins; 0: none */
};

struct played {
    struct routine_tracking tracking;
    struct cache_statistics cache;
    float picture[DRAWS][4];
};

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

static triptych_shader *assemble(const char *text)
{
    triptych_shader *shader;
    OK(triptych_shader_assemble(device, NULL, text, strlen(text), &shader));
    return shader;
}

static void begin(const char *name, const struct script *script)
{
    static const float corners[4][4] = {{-1, -1, 0, 1}, {-1, 1, 0, 1}, {1, -1, 0, 1}, {1, 1, 0, 1}};
    const struct triptych_target_description target = {
        .width = DRAWS, .height = 1, .color_format = {TRIPTYCH_SURFACE_A32B32G32R32F}};
    const struct device_options options = {.threads = script->threads};
    struct triptych_element position = {.format = TRIPTYCH_FORMAT_FLOAT4, .stride = 16};
    const struct engine *engine = engine_named(name, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(engine, error.text);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, device_create(engine, &options, &device, NULL));
    OK(triptych_set_target_description(device, &target));
    OK(triptych_set_state(device, TRIPTYCH_STATE_CULLMODE, 1));
    OK(triptych_set_state(device, TRIPTYCH_STATE_SCISSORTESTENABLE, 1));
    OK(triptych_buffer_create(device, corners, sizeof corners, &position.buffer));
    OK(triptych_set_element(device, TRIPTYCH_POSITION, &position));
    OK(triptych_set_vertex_shader(device, assemble(script->vertex)));
    OK(triptych_set_pixel_shader(device, assemble(script->pixel)));
}

/* The counts of the routine of the script's stage. */
static struct routine_tracking tracking_of(const struct script *script)
{
    enum unit unit = script->stage == TRIPTYCH_SHADER_VERTEX ? UNIT_VERTEX : UNIT_PIXEL;
    struct routine routine;
    for (size_t i = 0; cache_get(device->cache, i, &routine); i++)
        if (routine.unit == unit && routine.tracking)
            return *routine.tracking;
    return (struct routine_tracking){0};
}

static struct played play(const char *name, const struct script *script)
{
    struct played played;
    begin(name, script);
    for (unsigned n = 0; n < script->draws; n++) {
        uint32_t rows[ROWS][4];
        float values[ROWS][4];
        script->constants(n, rows);
        memcpy(values, rows, sizeof values);
        OK(triptych_set_shader_floats(device, script->stage, 0, values[0], ROWS));
        OK(triptych_set_scissor(device, n, 0, 1, 1));
        OK(triptych_draw(device, TRIPTYCH_TRIANGLE_STRIP, 0, 2));
        if (script->flush && n % script->flush == 0)
            OK(triptych_flush(device));
    }
    OK(triptych_read_target_numbers(device, 0, played.picture[0], sizeof played.picture));
    played.tracking = tracking_of(script);
    played.cache = cache_statistics(device->cache);
    triptych_device_destroy(device);
    device = NULL;
    return played;
}

/* Plays the script with a tracking engine. Its picture must be the emulator's. */
static struct played compare(const char *name, const struct script *script)
{
    const struct played expected = play("emulate", script), found = play(name, script);
    TEST_ASSERT_EQUAL_HEX32_ARRAY(expected.picture, found.picture, 4 * DRAWS);
    return found;
}

static void fill_row(uint32_t row[4], float value)
{
    for (unsigned c = 0; c < 4; c++)
        row[c] = bits_of_float(value + (float)c / 8);
}

/* --- Guards --------------------------------------------------------------------------------------------- */

static void change_once(unsigned n, uint32_t rows[ROWS][4])
{
    for (unsigned r = 0; r < ROWS; r++)
        fill_row(rows[r], (float)(r + 1));
    if (n >= 6)
        fill_row(rows[1], 7);
}

/* The fourth draw is the first with a variant. The seventh has another c1, and the tenth a second variant. */
static void a_guard_fails_after_a_change(void)
{
    const struct script script = {position_text, pixel_text, TRIPTYCH_SHADER_PIXEL, change_once, 10, 1, 0};
    const struct played played = compare("specialize-8:track=3", &script);
    TEST_ASSERT_EQUAL_UINT32(12, played.tracking.words);
    TEST_ASSERT_EQUAL_UINT64(10, played.tracking.draws);
    TEST_ASSERT_EQUAL_UINT64(4, played.tracking.burnt_draws);
    TEST_ASSERT_EQUAL_UINT64(1, played.tracking.guards);
    TEST_ASSERT_EQUAL_UINT64(1, played.tracking.failures);
    TEST_ASSERT_EQUAL_UINT32(2, played.tracking.variants);
    TEST_ASSERT_EQUAL_UINT32(24, played.tracking.burnt);
    TEST_ASSERT_EQUAL_UINT32(0, played.tracking.refused);
}

static void change_often(unsigned n, uint32_t rows[ROWS][4])
{
    change_once(0, rows);
    fill_row(rows[2], (float)n);
}

/* Only the words that stay are in the code, so no guard fails. */
static void a_value_that_changes_often_is_not_burnt_in(void)
{
    const struct script script = {position_text, pixel_text, TRIPTYCH_SHADER_PIXEL, change_often, 40, 1, 0};
    const struct played played = compare("specialize-8:track=3", &script);
    TEST_ASSERT_EQUAL_UINT32(8, played.tracking.burnt);
    TEST_ASSERT_EQUAL_UINT64(37, played.tracking.burnt_draws);
    TEST_ASSERT_EQUAL_UINT64(36, played.tracking.guards);
    TEST_ASSERT_EQUAL_UINT64(0, played.tracking.failures);
}

/* c0.x is 1, so the shader reads c2 by address, and c1 directly. */
static void change_addressed(unsigned n, uint32_t rows[ROWS][4])
{
    change_often(n, rows);
    fill_row(rows[0], 1);
}

static void a_constant_that_is_read_by_address_is_not_burnt_in(void)
{
    const struct script script = {
        address_text, copy_text, TRIPTYCH_SHADER_VERTEX, change_addressed, 40, 1, 0};
    const struct played played = compare("specialize-8:track=2", &script);
    TEST_ASSERT_EQUAL_UINT32(5, played.tracking.words);
    TEST_ASSERT_EQUAL_UINT32(5, played.tracking.burnt);
    TEST_ASSERT_EQUAL_UINT32(1, played.tracking.variants);
    TEST_ASSERT_EQUAL_UINT64(0, played.tracking.failures);
    TEST_ASSERT_EQUAL_UINT64(38, played.tracking.burnt_draws);
}

/* --- Bounds --------------------------------------------------------------------------------------------- */

/* Eight values that stay for four draws each, again and again. */
static void change_in_turn(unsigned n, uint32_t rows[ROWS][4])
{
    change_once(0, rows);
    fill_row(rows[0], (float)(n / 4 % 8));
}

static void more_variants_than_the_limit_end_the_tracking(void)
{
    const struct script script = {
        position_text, pixel_text, TRIPTYCH_SHADER_PIXEL, change_in_turn, DRAWS, 1, 0};
    const struct played played = compare("specialize-8:track=3", &script);
    TEST_ASSERT_EQUAL_UINT32(VARIANTS, played.tracking.variants);
    TEST_ASSERT_EQUAL_UINT32(1, played.tracking.refused);
    TEST_ASSERT_GREATER_THAN_UINT64(VARIANTS, played.tracking.failures);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT64(2 * 4 * VARIANTS, played.tracking.burnt_draws);
    TEST_ASSERT_LESS_THAN_UINT64(VARIANTS * 8192, played.tracking.bytes);
    TEST_ASSERT_GREATER_THAN_UINT64(played.tracking.bytes, played.cache.unit[UNIT_PIXEL].bytes);
}

static void without_the_option_nothing_is_tracked(void)
{
    const struct script script = {position_text, pixel_text, TRIPTYCH_SHADER_PIXEL, change_once, 10, 1, 0};
    const struct played played = compare("specialize-8", &script);
    TEST_ASSERT_EQUAL_UINT64(0, played.tracking.draws);
}

/* --- Values and threads --------------------------------------------------------------------------------- */

static const uint32_t edges[] = {0,          0x80000000, 1,          0x807fffff, 0x00800000,
                                 0x7f800000, 0xff800000, 0x7fc12345, 0xffc54321, 0x7f812345,
                                 0xff800001, 0x3f800000, 0xbf800000, 0x7f7fffff, 0x34000000};
enum { EDGES = sizeof edges / sizeof *edges };

/* Each pair of values for two draws, so that the second has them in its code. */
static void change_edges(unsigned n, uint32_t rows[ROWS][4])
{
    for (unsigned r = 0; r < ROWS; r++)
        for (unsigned c = 0; c < 4; c++)
            rows[r][c] = edges[(n / 2 * (1 + 3 * r) + c * (r + 5)) % EDGES];
}

/* The limit is of a routine, so each pair has a device of its own. */
static unsigned edge;

static void change_one_edge(unsigned n, uint32_t rows[ROWS][4])
{
    (void)n;
    change_edges(2 * edge, rows);
}

static void literals_have_the_bits_of_constants(void)
{
    const struct script script = {position_text, edge_text, TRIPTYCH_SHADER_PIXEL, change_one_edge, 3, 1, 0};
    for (edge = 0; edge < EDGES * 3; edge++) {
        compare("specialize-8:track=1", &script);
        compare("specialize-8:track=1:passes=none", &script);
    }
}

static void draws_in_flight_keep_their_routine(void)
{
    const struct script script = {
        position_text, pixel_text, TRIPTYCH_SHADER_PIXEL, change_in_turn, DRAWS, 2, 3};
    const struct script often = {
        address_text, copy_text, TRIPTYCH_SHADER_VERTEX, change_addressed, DRAWS, 2, 1};
    const struct played played = compare("specialize-8:track=2", &script);
    TEST_ASSERT_EQUAL_UINT32(VARIANTS, played.tracking.variants);
    compare("specialize-8:track=2:addresses=patched", &often);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_guard_fails_after_a_change);
    RUN_TEST(a_value_that_changes_often_is_not_burnt_in);
    RUN_TEST(a_constant_that_is_read_by_address_is_not_burnt_in);
    RUN_TEST(more_variants_than_the_limit_end_the_tracking);
    RUN_TEST(without_the_option_nothing_is_tracked);
    RUN_TEST(literals_have_the_bits_of_constants);
    RUN_TEST(draws_in_flight_keep_their_routine);
    return UNITY_END();
}
