/* The public interface of a device, with the emulator: refusals, the arguments of hooks, and reports. */
#include "tests/render/device/screen.h"

#include <math.h>
#include <string.h>

void setUp(void)
{
    open_device(1);
}

void tearDown(void)
{
    close_device();
}

/* --- Refusals --- */

static void expect_refused(enum triptych_result expected, enum triptych_result got, const char *reason)
{
    TEST_ASSERT_EQUAL_STRING(reason, triptych_error(device));
    TEST_ASSERT_EQUAL_INT(expected, got);
}

static void targets_have_a_largest_size(void)
{
    expect_refused(TRIPTYCH_BAD_ARGUMENT, triptych_set_target(device, 65536, 32768),
                   "target of 65536 x 32768 pixels: expected 1 to 8192 a side");
    unsigned width, height;
    triptych_target_size(device, &width, &height);
    TEST_ASSERT_EQUAL_UINT32(SIZE, width);
}

static void draws_need_a_target_a_position_and_indices(void)
{
    struct device_options options = {.threads = 1};
    expect_refused(TRIPTYCH_BAD_CALL, triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1),
                   "no position: expected a vertex declaration or an element with one");
    draw_rectangle(0, 0, 1, 1, 0, 0);
    expect_refused(TRIPTYCH_BAD_CALL, triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_LIST, 0, 0, 1),
                   "no indices: expected set_indices first");
    close_device();
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, device_create(&engine_emulate, &options, &device, NULL));
    expect_refused(TRIPTYCH_BAD_CALL, triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1),
                   "no target: expected set_target first");
    expect_refused(TRIPTYCH_BAD_CALL, triptych_read_color(device, image, sizeof image),
                   "no target: expected set_target first");
    expect_refused(TRIPTYCH_BAD_CALL, triptych_clear(device, NULL, 1),
                   "no target: expected set_target first");
}

static void vertices_must_lie_in_their_buffers(void)
{
    struct vertex v[3] = {{{0}, 0}};
    static const uint16_t index[] = {0, 1, 2, 3, 1, 0};
    bind(buffer_of(v, sizeof v));
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
    expect_refused(TRIPTYCH_BAD_CALL, triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 1, 1),
                   "vertex 3: position lies past its buffer, which ends with vertex 2");
    expect_refused(TRIPTYCH_BAD_CALL, triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, UINT32_MAX, 2),
                   "vertices 4294967295 to 4294967300: expected them below 2^32");
    OK(triptych_set_indices(device, buffer_of(index, sizeof index), 16));
    OK(triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_LIST, 0, 0, 1));
    expect_refused(TRIPTYCH_BAD_CALL, triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_LIST, 0, 0, 2),
                   "vertex 3: position lies past its buffer, which ends with vertex 2");
    expect_refused(TRIPTYCH_BAD_CALL, triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_LIST, -1, 0, 1),
                   "vertices -1 to 1: expected them from 0 to 2^32 - 1");
    expect_refused(TRIPTYCH_BAD_CALL, triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_STRIP, 0, 3, 2),
                   "indices 3 to 6: expected them in the buffer of 6 indices");
    OK(triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_LIST, -1, 3, 0));
}

/* An attribute that this draw does not read may be invalid. */
static void attributes_that_are_not_read_are_not_checked(void)
{
    float normal[3] = {0, 0, 1};
    struct triptych_element element = {TRIPTYCH_FORMAT_FLOAT3, buffer_of(normal, sizeof normal), 0, 12};
    OK(triptych_set_element(device, TRIPTYCH_NORMAL, &element));
    draw_rectangle(0, 0, 10, 10, 0, RED_ARGB);
    OK(triptych_set_state(device, TRIPTYCH_STATE_LIGHTING, 1));
    OK(triptych_enable_light(device, 0, 1));
    expect_refused(TRIPTYCH_BAD_CALL, triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 2),
                   "vertex 5: normal lies past its buffer, which ends with vertex 0");
}

static void null_arguments_are_refused(void)
{
    triptych_buffer *buffer;
    expect_refused(TRIPTYCH_BAD_ARGUMENT, triptych_buffer_create(device, NULL, 4, NULL), "buffer is null");
    expect_refused(TRIPTYCH_BAD_ARGUMENT, triptych_read_color(device, NULL, 0), "rgba is null");
    expect_refused(TRIPTYCH_BAD_ARGUMENT, triptych_read_depth(device, NULL, 0), "depth is null");
    triptych_texture *texture;
    expect_refused(TRIPTYCH_BAD_ARGUMENT, triptych_texture_create(device, NULL, 4, 4, &texture),
                   "rgba is null");
    expect_refused(TRIPTYCH_BAD_ARGUMENT, triptych_set_material(device, NULL), "material is null");
    expect_refused(TRIPTYCH_BAD_ARGUMENT, triptych_buffer_create(device, image, 0, &buffer),
                   "buffer of 0 bytes: expected 1 to 2^31 - 1");
    TEST_ASSERT_NULL(buffer);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_finish(NULL));
    triptych_target_size(device, NULL, NULL);
    triptych_get_statistics(device, NULL);
    TEST_ASSERT_EQUAL_INT(0, triptych_get_routine(device, 0, NULL));
    triptych_device_destroy(NULL);
}

static void clear_values_are_checked(void)
{
    expect_refused(TRIPTYCH_BAD_ARGUMENT, triptych_clear(device, NULL, 1.5f),
                   "clear depth 1.5: expected 0 to 1");
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_clear(device, NULL, NAN));
    expect_refused(TRIPTYCH_BAD_ARGUMENT, triptych_clear(device, (float[4]){0, NAN, 0, 0}, 0),
                   "clear colour 1 is nan, expected a finite number");
}

static void engines_are_chosen_by_name(void)
{
    struct triptych_options options = {.engine = "voodoo"};
    triptych_device *other;
    char reason[100];
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT,
                          triptych_device_create(&options, &other, reason, sizeof reason));
    TEST_ASSERT_NULL(other);
    static const char expected[] = "engine voodoo: there is none of that name, expected one of: emulate, ";
    TEST_ASSERT_EQUAL_STRING_LEN(expected, reason, sizeof expected - 1);
    options = (struct triptych_options){.engine = "emulate", .cache_bytes = (size_t)1 << 40};
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT,
                          triptych_device_create(&options, &other, reason, sizeof reason));
    TEST_ASSERT_EQUAL_STRING("cache of 1099511627776 bytes: expected at most 1073741824", reason);
    TEST_ASSERT_EQUAL_STRING("emulate", triptych_engine_name(0));
    TEST_ASSERT_EQUAL_UINT32(4, triptych_engine_width(0));
    TEST_ASSERT_NULL(triptych_engine_unavailable(0));
    TEST_ASSERT_NULL(triptych_engine_name(1000));
}

/* --- Hooks and reports --- */

static uint64_t heard;
static union key heard_key[UNIT_COUNT];

static void hear(void *user, uint64_t number, const union key key[UNIT_COUNT])
{
    TEST_ASSERT_EQUAL_PTR(&heard, user);
    TEST_ASSERT_EQUAL_UINT64(heard, number);
    heard++;
    memcpy(heard_key, key, sizeof heard_key);
}

static void hooks_receive_each_draw_and_its_keys(void)
{
    heard = 0;
    device_on_draw(device, hear, &heard);
    draw_rectangle(0, 0, 10, 10, 0, RED_ARGB);
    OK(triptych_set_state(device, TRIPTYCH_STATE_ZENABLE, 0));
    draw_rectangle(0, 0, 10, 10, 0, RED_ARGB);
    TEST_ASSERT_EQUAL_UINT64(2, heard);
    TEST_ASSERT_EQUAL_INT(COMPARE_ALWAYS, heard_key[UNIT_PIXEL].pixel.depth_function);
    TEST_ASSERT_EQUAL_INT(ATTRIBUTE_FORMAT_COLOR, heard_key[UNIT_VERTEX].vertex.attribute[ATTRIBUTE_DIFFUSE]);
    TEST_ASSERT_EQUAL_PTR(&engine_emulate, device_engine(device));
    TEST_ASSERT_NULL(device->arena);
}

static void routines_report_their_identity(void)
{
    struct triptych_routine_info info;
    TEST_ASSERT_EQUAL_INT(0, triptych_get_routine(device, 0, &info));
    draw_rectangle(0, 0, 10, 10, 0, RED_ARGB);
    draw_rectangle(0, 0, 10, 10, 0, RED_ARGB);
    TEST_ASSERT_EQUAL_INT(1, triptych_get_routine(device, 2, &info));
    TEST_ASSERT_EQUAL_UINT32(3, info.number);
    TEST_ASSERT_EQUAL_STRING("pixel", info.unit);
    TEST_ASSERT_EQUAL_STRING("depth_function=3 depth_write=1 varying=1 write_mask=15", info.key);
    TEST_ASSERT_EQUAL_UINT64(1, info.hits);
    TEST_ASSERT_EQUAL_INT(0, triptych_get_routine(device, 3, &info));
}

/* Twice 10 x 10 pixels, two triangles and four vertices. */
static void calls_are_measured_where_enabled(void)
{
    struct triptych_routine_info info;
    draw_rectangle(0, 0, 10, 10, 0, RED_ARGB);
    read_image();
    TEST_ASSERT_EQUAL_INT(1, triptych_get_routine(device, 2, &info));
    TEST_ASSERT_EQUAL_UINT64(0, info.run_ns + info.elements);
    close_device();
    open_device_with(&(struct device_options){.threads = 1, .measure = true});
    draw_rectangle(0, 0, 10, 10, 0, RED_ARGB);
    draw_rectangle(0, 0, 10, 10, 0, RED_ARGB);
    read_image();
    TEST_ASSERT_EQUAL_INT(1, triptych_get_routine(device, 2, &info));
    TEST_ASSERT_EQUAL_UINT64(200, info.elements);
    TEST_ASSERT_GREATER_THAN_UINT64(0, info.run_ns);
    TEST_ASSERT_EQUAL_INT(1, triptych_get_routine(device, 1, &info));
    TEST_ASSERT_EQUAL_UINT64(4, info.elements);
}

static void draws_without_effect_build_nothing(void)
{
    OK(triptych_set_state(device, TRIPTYCH_STATE_ZFUNC, 1));
    draw_rectangle(0, 0, 100, 100, 0.5f, RED_ARGB);
    struct triptych_routine_info info;
    TEST_ASSERT_EQUAL_INT(0, triptych_get_routine(device, 0, &info));
    read_image();
    TEST_ASSERT_EQUAL_UINT32(0, count_color(RED));
}

static void states_are_set_by_table(void)
{
    OK(triptych_set_sampler_state(device, 0, TRIPTYCH_SAMPLER_ADDRESSV, 3));
    OK(triptych_set_stage_state(device, 0, TRIPTYCH_STAGE_COLOROP, 7));
    OK(triptych_set_state(device, TRIPTYCH_STATE_FOGEND, triptych_float_bits(1)));
    TEST_ASSERT_EQUAL_UINT32(3, device->state.sampler[0][TRIPTYCH_SAMPLER_ADDRESSV]);
    TEST_ASSERT_EQUAL_UINT32(7, device->state.stage[0][TRIPTYCH_STAGE_COLOROP]);
    expect_refused(TRIPTYCH_BAD_ARGUMENT, triptych_set_sampler_state(device, 0, TRIPTYCH_SAMPLER_ADDRESSV, 6),
                   "sampler 0 addressv: value 6 does not exist, expected wrap (1), mirror (2), clamp (3), "
                   "border (4), mirroronce (5)");
    expect_refused(TRIPTYCH_BAD_ARGUMENT, triptych_set_stage_state(device, 8, TRIPTYCH_STAGE_COLOROP, 1),
                   "stage 8: expected 0 to 7");
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT,
                          triptych_set_sampler_state(NULL, 0, TRIPTYCH_SAMPLER_ADDRESSV, 3));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT,
                          triptych_set_stage_state(NULL, 0, TRIPTYCH_STAGE_COLOROP, 1));
    TEST_ASSERT_EQUAL_UINT32(3, device->state.sampler[0][TRIPTYCH_SAMPLER_ADDRESSV]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(targets_have_a_largest_size);
    RUN_TEST(draws_need_a_target_a_position_and_indices);
    RUN_TEST(vertices_must_lie_in_their_buffers);
    RUN_TEST(attributes_that_are_not_read_are_not_checked);
    RUN_TEST(null_arguments_are_refused);
    RUN_TEST(clear_values_are_checked);
    RUN_TEST(engines_are_chosen_by_name);
    RUN_TEST(hooks_receive_each_draw_and_its_keys);
    RUN_TEST(routines_report_their_identity);
    RUN_TEST(calls_are_measured_where_enabled);
    RUN_TEST(draws_without_effect_build_nothing);
    RUN_TEST(states_are_set_by_table);
    return UNITY_END();
}
