/* Shaders and their constants in the device: refusals, the constants of a queued draw, the number of parts
 * that a change derives again, and the bounds of memory. tests/spec tests the pictures of shaders. */
#include "render/device/device.h"

#include "emu/emulate/emulate.h"
#include "shader/program/program.h"

#include <stdlib.h>
#include <string.h>
#include <unity.h>

static triptych_device *device;

#define OK(call) TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, call, triptych_error(device))

static const char add_text[] = "vs_1_1\ndcl_position v0\nadd oPos, v0, c3\n";
static const char two_text[] = "vs_1_1\ndcl_position v0\nadd oPos, v0, c1\n";
static const char all_text[] =
    "vs_3_sw\ndcl_position v0\ndcl_position o0\nmova a0.x, v0.x\nmov o0, c[a0.x]\n";
static const char loop_text[] =
    "vs_2_0\ndcl_position v0\nmov r0, v0\nrep i2\nadd r0, r0, c0\nendrep\nif b3\nmov r0, "
    "v0\nendif\nmov oPos, r0\n";
static const char pixel_text[] = "ps_2_0\nmov r0, c1\nmov oC0, r0\n";

void setUp(void)
{
    static const float triangle[3][4] = {{-1, -1, 0, 1}, {0, 1, 0, 1}, {1, -1, 0, 1}};
    struct triptych_element position = {.format = TRIPTYCH_FORMAT_FLOAT4, .stride = 16};
    TEST_ASSERT_EQUAL_INT(
        TRIPTYCH_OK, device_create(&engine_emulate, &(struct device_options){.threads = 1}, &device, NULL));
    OK(triptych_set_target(device, 4, 4));
    OK(triptych_buffer_create(device, triangle, sizeof triangle, &position.buffer));
    OK(triptych_set_element(device, TRIPTYCH_POSITION, &position));
    OK(triptych_set_state(device, TRIPTYCH_STATE_LIGHTING, 0));
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

static void set_vertex(const char *text)
{
    OK(triptych_set_vertex_shader(device, assemble(text)));
}

static void set_float(unsigned index, float x)
{
    OK(triptych_set_shader_floats(device, TRIPTYCH_SHADER_VERTEX, index, (float[4]){x}, 1));
}

static void draw(void)
{
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
}

/* The constants of a recorded draw's vertex shader. */
static const float *recorded(uint32_t number)
{
    TEST_ASSERT_GREATER_THAN_UINT32(number, device->queue->commands.count);
    return device->queue->commands.command[number].draw.job->constants[STAGE_VERTEX];
}

static void expect_refused(enum triptych_result expected, enum triptych_result got, const char *reason)
{
    TEST_ASSERT_EQUAL_INT(expected, got);
    TEST_ASSERT_EQUAL_STRING(reason, triptych_error(device));
}

/* --- Creation --- */

static void text_and_bytecode_make_the_same_program(void)
{
    struct shader *shader;
    uint32_t *tokens;
    size_t count;
    triptych_shader *a = assemble(add_text), *b;
    TEST_ASSERT_EQUAL_INT(0, shader_assemble("t", add_text, strlen(add_text), &shader, NULL));
    TEST_ASSERT_EQUAL_INT(0, shader_encode(shader, &tokens, &count, NULL));
    shader_free(shader);
    OK(triptych_shader_create(device, NULL, tokens, 4 * count, &b));
    free(tokens);
    TEST_ASSERT_EQUAL_PTR(a->program, b->program);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_SHADER_VERTEX, triptych_shader_get_stage(a));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_SHADER_PIXEL, triptych_shader_get_stage(assemble(pixel_text)));
    TEST_ASSERT_EQUAL_STRING("vs_1_1", triptych_shader_get_model(b));
}

static void bad_shaders_are_refused_with_the_position(void)
{
    static const char bad[] = "ps_2_0\nmov oC0, q0\n", invalid[] = "ps_2_0\nmov oC0, r0\n";
    static const uint32_t cut[] = {0xffff0200}, unknown[] = {0xffff0200, 0x0000fff0, 0x0000ffff};
    triptych_shader *shader = (triptych_shader *)device;
    expect_refused(TRIPTYCH_BAD_ARGUMENT,
                   triptych_shader_assemble(device, "wood.psa", bad, strlen(bad), &shader),
                   "wood.psa:2:10: found 'q0', expected a register of ps_2_0");
    TEST_ASSERT_NULL(shader);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT,
                          triptych_shader_assemble(device, NULL, invalid, strlen(invalid), &shader));
    TEST_ASSERT_EQUAL_STRING_LEN("shader:2:10: ", triptych_error(device), 13);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_shader_create(device, "cut", cut, 4, &shader));
    TEST_ASSERT_EQUAL_STRING_LEN("cut: token 1: ", triptych_error(device), 14);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_shader_create(device, NULL, unknown, 12, &shader));
    TEST_ASSERT_EQUAL_STRING_LEN("shader: token 1: ", triptych_error(device), 17);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_shader_create(device, NULL, cut, 3, &shader));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_shader_create(device, NULL, cut, 0, &shader));
    TEST_ASSERT_NULL(device->resources.shaders);
}

static void null_arguments_are_refused(void)
{
    triptych_shader *shader;
    enum triptych_shader_stage pixel = TRIPTYCH_SHADER_PIXEL;
    expect_refused(TRIPTYCH_BAD_ARGUMENT, triptych_shader_create(device, NULL, NULL, 8, &shader),
                   "code is null");
    expect_refused(TRIPTYCH_BAD_ARGUMENT, triptych_shader_assemble(device, NULL, add_text, 8, NULL),
                   "shader is null");
    expect_refused(TRIPTYCH_BAD_ARGUMENT, triptych_set_shader_floats(device, pixel, 0, NULL, 1),
                   "values is null");
    OK(triptych_set_shader_floats(device, pixel, 0, NULL, 0));
    OK(triptych_set_shader_integers(device, pixel, TRIPTYCH_SHADER_INTEGERS, NULL, 0));
    OK(triptych_set_shader_booleans(device, pixel, 0, NULL, 0));
    OK(triptych_shader_destroy(device, NULL));
    OK(triptych_set_pixel_shader(device, NULL));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_set_vertex_shader(NULL, NULL));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_shader_assemble(NULL, NULL, add_text, 8, &shader));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, triptych_set_shader_booleans(NULL, pixel, 0, NULL, 0));
    TEST_ASSERT_NULL(triptych_shader_get_model(NULL));
}

static void a_shader_is_of_its_stage_and_its_device(void)
{
    triptych_device *other;
    triptych_shader *foreign, *pixel = assemble(pixel_text);
    TEST_ASSERT_EQUAL_INT(
        TRIPTYCH_OK, device_create(&engine_emulate, &(struct device_options){.threads = 1}, &other, NULL));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK,
                          triptych_shader_assemble(other, NULL, add_text, strlen(add_text), &foreign));
    expect_refused(TRIPTYCH_BAD_ARGUMENT, triptych_set_vertex_shader(device, pixel),
                   "vertex shader of model ps_2_0: expected a model of vertex shaders");
    expect_refused(TRIPTYCH_BAD_ARGUMENT, triptych_set_vertex_shader(device, foreign),
                   "vertex shader of another device: expected one of this");
    expect_refused(TRIPTYCH_BAD_ARGUMENT, triptych_shader_destroy(device, foreign),
                   "shader to destroy: expected one of this device");
    TEST_ASSERT_NULL(device->state.program[STAGE_VERTEX]);
    triptych_device_destroy(other);
}

static void constants_past_the_last_are_refused(void)
{
    static const float floats[8] = {0};
    static const int32_t integers[8] = {0};
    const enum triptych_shader_stage vertex = TRIPTYCH_SHADER_VERTEX;
    OK(triptych_set_shader_floats(device, vertex, TRIPTYCH_SHADER_FLOATS - 2, floats, 2));
    OK(triptych_set_shader_integers(device, vertex, TRIPTYCH_SHADER_INTEGERS - 1, integers, 1));
    OK(triptych_set_shader_booleans(device, vertex, TRIPTYCH_SHADER_BOOLEANS - 1, integers, 1));
    expect_refused(TRIPTYCH_BAD_ARGUMENT, triptych_set_shader_floats(device, vertex, 8191, floats, 2),
                   "float constants 8191 to 8192: expected them below 8192");
    expect_refused(TRIPTYCH_BAD_ARGUMENT, triptych_set_shader_integers(device, vertex, 2048, integers, 1),
                   "integer constants 2048 to 2048: expected them below 2048");
    expect_refused(TRIPTYCH_BAD_ARGUMENT,
                   triptych_set_shader_booleans(device, vertex, 4294967295, integers, 2),
                   "Boolean constants 4294967295 to 4294967296: expected them below 16");
    expect_refused(TRIPTYCH_BAD_ARGUMENT, triptych_set_shader_floats(device, vertex, 2, floats, 4294967295),
                   "float constants 2 to 4294967296: expected them below 8192");
    expect_refused(TRIPTYCH_BAD_ARGUMENT, triptych_set_shader_floats(device, 2, 0, floats, 1),
                   "shader stage 2: expected vertex (0) or pixel (1)");
}

/* --- Draws --- */

static void a_recorded_draw_keeps_its_constants(void)
{
    set_vertex(add_text);
    set_float(3, 0.25f);
    draw();
    set_float(3, 0.5f);
    draw();
    TEST_ASSERT_EQUAL_FLOAT(0.25f, recorded(0)[4 * 3]);
    TEST_ASSERT_EQUAL_FLOAT(0.5f, recorded(1)[4 * 3]);
    OK(triptych_finish(device));
    draw();
    TEST_ASSERT_EQUAL_FLOAT(0.5f, recorded(0)[4 * 3]);
}

static void draws_share_a_block_until_a_constant_of_it_changes(void)
{
    set_vertex(add_text);
    draw();
    set_float(4, 1); /* not read */
    set_float(3, 0); /* as it was */
    OK(triptych_set_shader_floats(device, TRIPTYCH_SHADER_PIXEL, 3, (float[4]){1}, 1));
    draw();
    TEST_ASSERT_EQUAL_PTR(recorded(0), recorded(1));
    set_float(2, 1);
    draw();
    TEST_ASSERT_TRUE(recorded(1) != recorded(2));
}

static void a_constant_that_is_set_for_another_shader_is_read_by_it(void)
{
    triptych_shader *many = assemble(add_text), *few = assemble(two_text);
    OK(triptych_set_vertex_shader(device, many));
    draw();
    OK(triptych_set_vertex_shader(device, few));
    set_float(3, 5); /* `few` does not read it; the newest block is that of `many` */
    OK(triptych_set_vertex_shader(device, many));
    draw();
    OK(triptych_set_vertex_shader(device, NULL));
    set_float(3, 6);
    OK(triptych_set_vertex_shader(device, many));
    draw();
    TEST_ASSERT_EQUAL_FLOAT(0, recorded(0)[4 * 3]);
    TEST_ASSERT_EQUAL_FLOAT(5, recorded(1)[4 * 3]);
    TEST_ASSERT_EQUAL_FLOAT(6, recorded(2)[4 * 3]);
}

static void constants_change_no_key(void)
{
    static const int32_t yes[4] = {1, 1, 1, 1};
    set_vertex(loop_text);
    draw();
    set_float(0, 3);
    OK(triptych_set_shader_integers(device, TRIPTYCH_SHADER_VERTEX, 2, (int32_t[4]){3}, 1));
    OK(triptych_set_shader_booleans(device, TRIPTYCH_SHADER_VERTEX, 4, yes, 4));
    OK(triptych_set_shader_booleans(device, TRIPTYCH_SHADER_PIXEL, 3, yes, 1));
    TEST_ASSERT_EQUAL_HEX32(0, device->derived.changed);
    draw();
    OK(triptych_set_shader_booleans(device, TRIPTYCH_SHADER_VERTEX, 3, yes, 1)); /* this one is read */
    TEST_ASSERT_NOT_EQUAL(0, device->derived.changed);
    draw();
    TEST_ASSERT_EQUAL_HEX16(0x00f8, device->state.booleans[STAGE_VERTEX]);
}

/* Each draw has another constant. The memory is that of the draws in one queue, and the device's memory does
 * not grow. */
static void a_hundred_thousand_draws_stay_within_the_memory_of_constants(void)
{
    size_t most = 0;
    set_vertex(add_text);
    OK(triptych_set_state(device, TRIPTYCH_STATE_CULLMODE, 2)); /* the draws cover no pixels, to be quick */
    for (int i = 0; i < 100000; i++) {
        set_float(3, (float)i);
        draw();
        most = device->constants.used > most ? device->constants.used : most;
        TEST_ASSERT_EQUAL_FLOAT((float)i, recorded(device->queue->commands.count - 1)[4 * 3]);
    }
    TEST_ASSERT_EQUAL_UINT64(QUEUE_COMMANDS * program_constant_bytes(device->state.program[STAGE_VERTEX]),
                             most);
}

static void full_memory_of_constants_renders_what_is_recorded(void)
{
    set_vertex(all_text); /* 128 KiB each */
    uint32_t most = 0;
    for (int i = 0; i < 200; i++) {
        set_float(7, (float)i);
        draw();
        most = device->queue->commands.count > most ? device->queue->commands.count : most;
        TEST_ASSERT_EQUAL_FLOAT((float)i, recorded(device->queue->commands.count - 1)[4 * 7]);
    }
    TEST_ASSERT_EQUAL_UINT32(CONSTANT_BYTES / program_constant_bytes(device->state.program[STAGE_VERTEX]),
                             most);
}

static void loops_that_are_not_allowed_refuse_the_draw(void)
{
    set_vertex(loop_text);
    draw();
    OK(triptych_set_shader_integers(device, TRIPTYCH_SHADER_VERTEX, 2, (int32_t[4]){256}, 1));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_CALL, triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
    TEST_ASSERT_NOT_NULL(strstr(triptych_error(device), "i2"));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_CALL, triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
    OK(triptych_set_vertex_shader(device, assemble(add_text)));
    draw();
    set_vertex(loop_text);
    OK(triptych_set_shader_integers(device, TRIPTYCH_SHADER_VERTEX, 2, (int32_t[4]){255}, 1));
    draw();
}

/* Counts and starts from 0 to 255, steps from -128 to 127; rep reads only its count. */
static void each_number_of_a_loop_has_its_range(void)
{
    static const struct {
        int32_t loop[4];
        int good, good_for_rep;
    } cases[] = {{{0, 0, 0}, 1, 1},   {{255, 255, 127}, 1, 1}, {{1, 0, -128}, 1, 1},
                 {{-1, 0, 0}, 0, 0},  {{256, 0, 0}, 0, 0},     {{1, -1, 0}, 0, 1},
                 {{1, 256, 0}, 0, 1}, {{1, 0, 128}, 0, 1},     {{1, 0, -129}, 0, 1},
                 {{INT32_MIN}, 0, 0}, {{INT32_MAX}, 0, 0},     {{1, INT32_MIN, 0}, 0, 1}};
    for (int rep = 0; rep < 2; rep++) {
        set_vertex(rep ? loop_text
                       : "vs_2_0\ndcl_position v0\nmov r0, v0\nloop aL, i2\nadd r0, r0, c0[aL]\nendloop\n"
                         "mov oPos, r0\n");
        for (unsigned i = 0; i < sizeof cases / sizeof *cases; i++) {
            int good = rep ? cases[i].good_for_rep : cases[i].good;
            OK(triptych_set_shader_integers(device, TRIPTYCH_SHADER_VERTEX, 2, cases[i].loop, 1));
            TEST_ASSERT_EQUAL_INT(good ? TRIPTYCH_OK : TRIPTYCH_BAD_CALL,
                                  triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
        }
    }
}

static void loops_that_would_run_too_long_refuse_the_draw(void)
{
    static const int32_t long_loop[4] = {255}, short_loop[4] = {1};
    set_vertex("vs_3_0\ndcl_position v0\ndcl_position o0\nmov r0, v0\nrep i0\nrep i1\nrep i0\nrep i1\n"
               "add r0, r0, v0\nendrep\nendrep\nendrep\nendrep\nmov o0, r0\n");
    OK(triptych_set_shader_integers(device, TRIPTYCH_SHADER_VERTEX, 0, short_loop, 1));
    OK(triptych_set_shader_integers(device, TRIPTYCH_SHADER_VERTEX, 1, long_loop, 1));
    draw();
    OK(triptych_set_shader_integers(device, TRIPTYCH_SHADER_VERTEX, 0, long_loop, 1));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_CALL, triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(triptych_error(device), "1048576"), triptych_error(device));
    OK(triptych_set_vertex_shader(device, NULL));
    draw();
}

/* --- Destroying --- */

static void a_shader_is_destroyed_when_its_draws_are_rendered(void)
{
    triptych_shader *shader = assemble(add_text);
    uint32_t number = shader->program->number;
    OK(triptych_set_vertex_shader(device, shader));
    draw();
    OK(triptych_shader_destroy(device, shader));
    TEST_ASSERT_EQUAL_UINT32(0, device->queue->commands.count);
    TEST_ASSERT_NULL(device->state.program[STAGE_VERTEX]);
    TEST_ASSERT_NULL(program_find(number));
    draw();
    TEST_ASSERT_NULL(recorded(0));
}

static void another_shader_of_the_same_program_keeps_it(void)
{
    triptych_shader *one = assemble(add_text), *two = assemble(add_text);
    OK(triptych_set_vertex_shader(device, two));
    OK(triptych_shader_destroy(device, one));
    TEST_ASSERT_EQUAL_PTR(two->program, device->state.program[STAGE_VERTEX]);
    draw();
}

static void a_destroyed_device_destroys_its_shaders(void)
{
    uint32_t number = assemble(add_text)->program->number;
    set_vertex(add_text);
    draw();
    tearDown();
    TEST_ASSERT_NULL(program_find(number));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(text_and_bytecode_make_the_same_program);
    RUN_TEST(bad_shaders_are_refused_with_the_position);
    RUN_TEST(null_arguments_are_refused);
    RUN_TEST(a_shader_is_of_its_stage_and_its_device);
    RUN_TEST(constants_past_the_last_are_refused);
    RUN_TEST(a_recorded_draw_keeps_its_constants);
    RUN_TEST(draws_share_a_block_until_a_constant_of_it_changes);
    RUN_TEST(a_constant_that_is_set_for_another_shader_is_read_by_it);
    RUN_TEST(constants_change_no_key);
    RUN_TEST(a_hundred_thousand_draws_stay_within_the_memory_of_constants);
    RUN_TEST(full_memory_of_constants_renders_what_is_recorded);
    RUN_TEST(loops_that_are_not_allowed_refuse_the_draw);
    RUN_TEST(each_number_of_a_loop_has_its_range);
    RUN_TEST(loops_that_would_run_too_long_refuse_the_draw);
    RUN_TEST(a_shader_is_destroyed_when_its_draws_are_rendered);
    RUN_TEST(another_shader_of_the_same_program_keeps_it);
    RUN_TEST(a_destroyed_device_destroys_its_shaders);
    return UNITY_END();
}
