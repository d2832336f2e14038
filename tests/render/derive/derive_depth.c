/* Derivation of depth, stencil and samples. States that draw the same pixels have the same keys, and
 * references and masks are only in the job. */
#include "render/derive/derive.h"

#include "render/target/depth.h"

#include <math.h>
#include <string.h>
#include <unity.h>

static struct state state;
static struct triptych_buffer buffer = {.bytes = 1024};
static union key key[UNIT_COUNT];
static struct job job;
static const struct pixel_key *const pixel = &key[UNIT_PIXEL].pixel;

static void set_number(enum triptych_state which, uint32_t value)
{
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK,
                          state_set_value(&state, TRIPTYCH_RENDER_STATES, 0, which, value, NULL));
}

#define SET(name, word) set((enum triptych_state)STATE_##name, word)

static void set(enum triptych_state which, const char *word)
{
    uint32_t value;
    TEST_ASSERT_EQUAL_INT_MESSAGE(
        0, triptych_value_number(triptych_state_at(TRIPTYCH_RENDER_STATES, which)->kind, word, &value), word);
    set_number(which, value);
}

static void set_target(enum triptych_depth_format format, unsigned samples)
{
    struct triptych_target_description description = {
        .width = 64, .height = 64, .depth_format = format, .samples = samples};
    state_set_target(&state, &description);
}

void setUp(void)
{
    static uint8_t bytes[1024];
    struct triptych_element element = {TRIPTYCH_FORMAT_FLOAT3, &buffer, 0, 32};
    buffer.data = bytes;
    state_initialize(&state);
    set_target(TRIPTYCH_DEPTH_D24S8, 0);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, state_set_element(&state, TRIPTYCH_POSITION, &element, NULL));
    SET(cullmode, "none");
}

void tearDown(void)
{
}

static void derive_as(enum primitive primitive)
{
    derive_keys(&state, primitive, key);
    derive_job(&state, &key[UNIT_VERTEX].vertex, &key[UNIT_PIXEL].pixel, &job);
}

static void derive(void)
{
    derive_as(PRIMITIVE_TRIANGLE);
}

static void set_side(const char *function, const char *fail, const char *depth_fail, const char *pass)
{
    SET(stencilenable, "true");
    SET(stencilfunc, function);
    SET(stencilfail, fail);
    SET(stencilzfail, depth_fail);
    SET(stencilpass, pass);
}

static void set_other_side(const char *function, const char *fail, const char *depth_fail, const char *pass)
{
    SET(twosidedstencilmode, "true");
    SET(ccw_stencilfunc, function);
    SET(ccw_stencilfail, fail);
    SET(ccw_stencilzfail, depth_fail);
    SET(ccw_stencilpass, pass);
}

static void expect_side(int side, int function, int fail, int depth_fail, int pass)
{
    TEST_ASSERT_EQUAL_INT(function, pixel->stencil_function[side]);
    TEST_ASSERT_EQUAL_INT(fail, pixel->stencil_fail[side]);
    TEST_ASSERT_EQUAL_INT(depth_fail, pixel->stencil_depth_fail[side]);
    TEST_ASSERT_EQUAL_INT(pass, pixel->stencil_pass[side]);
}

static void a_test_that_passes_and_keeps_everything_is_disabled_in_the_key(void)
{
    set_side("always", "zero", "keep", "keep");
    derive();
    TEST_ASSERT_EQUAL_INT(STENCIL_OFF, pixel->stencil);
    expect_side(SIDE_CLOCKWISE, 0, 0, 0, 0);
    set_side("always", "keep", "keep", "incr");
    set_number(TRIPTYCH_STATE_STENCILWRITEMASK, 0xffffff00);
    derive();
    TEST_ASSERT_EQUAL_INT(STENCIL_OFF, pixel->stencil);
    set_side("lessequal", "zero", "keep", "keep");
    set_number(TRIPTYCH_STATE_STENCILMASK, 0xffffff00);
    derive();
    TEST_ASSERT_EQUAL_INT(STENCIL_OFF, pixel->stencil);
}

static void a_format_without_stencil_has_no_test(void)
{
    set_side("never", "zero", "zero", "zero");
    for (int format = 0; format < TRIPTYCH_DEPTH_COUNT; format++) {
        set_target((enum triptych_depth_format)format, 0);
        derive();
        TEST_ASSERT_EQUAL_INT(stencil_mask((enum triptych_depth_format)format) ? STENCIL_ONE : STENCIL_OFF,
                              pixel->stencil);
    }
}

static void operations_that_cannot_happen_do_not_change_the_key(void)
{
    set_side("less", "zero", "incr", "decr");
    derive();
    expect_side(SIDE_CLOCKWISE, COMPARE_LESS, STENCIL_ZERO, STENCIL_INCREMENT, STENCIL_DECREMENT);
    SET(zfunc, "always");
    derive();
    expect_side(SIDE_CLOCKWISE, COMPARE_LESS, STENCIL_ZERO, STENCIL_DECREMENT, STENCIL_DECREMENT);
    SET(zfunc, "never");
    derive();
    expect_side(SIDE_CLOCKWISE, COMPARE_LESS, STENCIL_ZERO, STENCIL_INCREMENT, STENCIL_INCREMENT);
    TEST_ASSERT_EQUAL_INT(0, pixel->write_mask[0]);
    TEST_ASSERT_EQUAL_INT(0, pixel->depth_write);
    TEST_ASSERT_EQUAL_INT(COMPARE_ALWAYS, pixel->depth_function); /* either way the same happens */
    SET(zfunc, "less");
    SET(stencilfunc, "always");
    derive();
    expect_side(SIDE_CLOCKWISE, COMPARE_ALWAYS, STENCIL_DECREMENT, STENCIL_INCREMENT, STENCIL_DECREMENT);
    SET(stencilfunc, "never");
    derive();
    expect_side(SIDE_CLOCKWISE, COMPARE_NEVER, STENCIL_ZERO, STENCIL_ZERO, STENCIL_ZERO);
    TEST_ASSERT_EQUAL_INT(0, pixel->write_mask[0]);
}

static void two_equal_sides_have_the_key_of_one(void)
{
    set_side("equal", "keep", "keep", "incr");
    set_other_side("equal", "keep", "keep", "incr");
    derive();
    TEST_ASSERT_EQUAL_INT(STENCIL_ONE, pixel->stencil);
    TEST_ASSERT_EQUAL_INT(0, key[UNIT_SETUP].setup.facing);
    SET(ccw_stencilpass, "decr");
    derive();
    TEST_ASSERT_EQUAL_INT(STENCIL_TWO, pixel->stencil);
    TEST_ASSERT_EQUAL_INT(1, key[UNIT_SETUP].setup.facing);
    expect_side(SIDE_CLOCKWISE, COMPARE_EQUAL, STENCIL_KEEP, STENCIL_KEEP, STENCIL_INCREMENT);
    expect_side(SIDE_COUNTERCLOCKWISE, COMPARE_EQUAL, STENCIL_KEEP, STENCIL_KEEP, STENCIL_DECREMENT);
    SET(twosidedstencilmode, "false");
    derive();
    TEST_ASSERT_EQUAL_INT(STENCIL_ONE, pixel->stencil);
    expect_side(SIDE_COUNTERCLOCKWISE, 0, 0, 0, 0);
}

static void culling_leaves_one_side(void)
{
    set_side("equal", "keep", "keep", "incr");
    set_other_side("equal", "keep", "keep", "decr");
    SET(cullmode, "ccw");
    derive();
    TEST_ASSERT_EQUAL_INT(STENCIL_ONE, pixel->stencil);
    TEST_ASSERT_EQUAL_INT(STENCIL_INCREMENT, pixel->stencil_pass[0]);
    SET(cullmode, "cw");
    derive();
    TEST_ASSERT_EQUAL_INT(STENCIL_ONE, pixel->stencil);
    TEST_ASSERT_EQUAL_INT(STENCIL_DECREMENT, pixel->stencil_pass[0]);
    derive_as(PRIMITIVE_LINE); /* which has no winding */
    TEST_ASSERT_EQUAL_INT(STENCIL_ONE, pixel->stencil);
    TEST_ASSERT_EQUAL_INT(STENCIL_INCREMENT, pixel->stencil_pass[0]);
    SET(cullmode, "none");
    derive_as(PRIMITIVE_EDGE);
    TEST_ASSERT_EQUAL_INT(STENCIL_TWO, pixel->stencil);
    TEST_ASSERT_EQUAL_INT(1, key[UNIT_SETUP].setup.facing);
}

static void a_draw_that_only_changes_stencil_has_an_effect(void)
{
    set_number(TRIPTYCH_STATE_COLORWRITEENABLE, 0);
    SET(zwriteenable, "false");
    derive();
    TEST_ASSERT_FALSE(derive_effective(pixel));
    set_side("always", "keep", "keep", "invert");
    derive();
    TEST_ASSERT_TRUE(derive_effective(pixel));
    SET(alphatestenable, "true");
    SET(alphafunc, "never");
    derive();
    TEST_ASSERT_FALSE(derive_effective(pixel));
    SET(alphafunc, "greater");
    derive();
    TEST_ASSERT_TRUE(derive_effective(pixel));
    TEST_ASSERT_EQUAL_INT(INTERPOLATION_SMOOTH, pixel->varying[VARYING_diffuse]);
    state.counting = 1;
    SET(stencilenable, "false");
    derive();
    TEST_ASSERT_TRUE(derive_effective(pixel));
    TEST_ASSERT_EQUAL_INT(1, pixel->count);
}

static void the_format_is_in_the_key_where_it_is_read(void)
{
    derive();
    TEST_ASSERT_EQUAL_INT(DEPTH_UNORM, pixel->depth_format);
    TEST_ASSERT_EQUAL_FLOAT(16777215, job.depth_maximum);
    SET(zenable, "usew");
    derive();
    TEST_ASSERT_EQUAL_INT(1, pixel->depth_w);
    TEST_ASSERT_EQUAL_INT(0, key[UNIT_SETUP].setup.depth);
    SET(zenable, "false");
    derive();
    TEST_ASSERT_EQUAL_INT(DEPTH_FLOAT, pixel->depth_format);
    TEST_ASSERT_EQUAL_INT(0, pixel->depth_w);
    set_target(TRIPTYCH_DEPTH_NONE, 0);
    SET(zenable, "true");
    derive();
    TEST_ASSERT_EQUAL_INT(COMPARE_ALWAYS, pixel->depth_function);
    TEST_ASSERT_EQUAL_INT(0, pixel->depth_write);
    set_target(TRIPTYCH_DEPTH_D16, 0);
    derive();
    TEST_ASSERT_EQUAL_INT(DEPTH_UNORM, pixel->depth_format); /* the number of bits is the job's */
    TEST_ASSERT_EQUAL_FLOAT(65535, job.depth_maximum);
}

static void reference_and_masks_are_in_the_job_with_the_bits_of_the_stencil(void)
{
    union key before[UNIT_COUNT];
    set_side("less", "zero", "incr", "decr");
    set_target(TRIPTYCH_DEPTH_D24X4S4, 0);
    derive_keys(&state, PRIMITIVE_TRIANGLE, before);
    set_number(TRIPTYCH_STATE_STENCILREF, 0x57);
    set_number(TRIPTYCH_STATE_STENCILMASK, 0x1236);
    set_number(TRIPTYCH_STATE_STENCILWRITEMASK, 0xfffffff9);
    derive();
    TEST_ASSERT_EQUAL_MEMORY(before, key, sizeof before);
    TEST_ASSERT_EQUAL_INT(15, job.stencil_maximum);
    TEST_ASSERT_EQUAL_INT(7, job.stencil_reference);
    TEST_ASSERT_EQUAL_INT(6, job.stencil_mask);
    TEST_ASSERT_EQUAL_INT(9, job.stencil_write_mask);
}

static void expect_values(int stencil, int values, const char *what)
{
    derive();
    TEST_ASSERT_EQUAL_INT_MESSAGE(stencil, pixel->stencil, what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(values, pixel->stencil_values, what);
}

static void values_of_each_side_are_in_the_key_where_they_are_read(void)
{
    set_side("less", "keep", "keep", "incr");
    set_other_side("less", "keep", "keep", "incr");
    expect_values(STENCIL_ONE, STENCIL_VALUES_FIRST, "shared");
    SET(stencilseparate, "true");
    set_number(TRIPTYCH_STATE_CCW_STENCILREF, 0x109);
    set_number(TRIPTYCH_STATE_CCW_STENCILMASK, 0xff0f);
    set_number(TRIPTYCH_STATE_CCW_STENCILWRITEMASK, 0xfff0);
    expect_values(STENCIL_TWO, STENCIL_VALUES_EACH, "equal operations with other values");
    TEST_ASSERT_EQUAL_INT(9, job.ccw_stencil_reference);
    TEST_ASSERT_EQUAL_INT(0x0f, job.ccw_stencil_mask);
    TEST_ASSERT_EQUAL_INT(0xf0, job.ccw_stencil_write_mask);
    SET(cullmode, "cw");
    expect_values(STENCIL_ONE, STENCIL_VALUES_SECOND, "only counter-clockwise triangles");
    SET(cullmode, "ccw");
    expect_values(STENCIL_ONE, STENCIL_VALUES_FIRST, "only clockwise triangles");
    TEST_ASSERT_EQUAL_INT(0, job.ccw_stencil_mask);
    SET(cullmode, "none");
    derive_as(PRIMITIVE_LINE);
    TEST_ASSERT_EQUAL_INT(STENCIL_VALUES_FIRST, pixel->stencil_values);
    set_other_side("always", "keep", "keep", "keep");
    expect_values(STENCIL_TWO, STENCIL_VALUES_FIRST, "a side that reads none");
    set_other_side("less", "keep", "keep", "keep");
    expect_values(STENCIL_TWO, STENCIL_VALUES_EACH, "a side that compares");
    set_number(TRIPTYCH_STATE_CCW_STENCILMASK, 0xff00);
    expect_values(STENCIL_TWO, STENCIL_VALUES_FIRST, "nothing is compared");
    set_other_side("always", "keep", "keep", "invert");
    expect_values(STENCIL_TWO, STENCIL_VALUES_EACH, "a side that writes");
    set_number(TRIPTYCH_STATE_CCW_STENCILWRITEMASK, 0xff00);
    expect_values(STENCIL_TWO, STENCIL_VALUES_FIRST, "nothing is written");
    SET(stencilenable, "false");
    expect_values(STENCIL_OFF, STENCIL_VALUES_FIRST, "no stencil");
}

static void samples_come_from_the_target(void)
{
    for (unsigned n = 0; n < SAMPLES_RADIX; n++) {
        set_target(TRIPTYCH_DEPTH_D24S8, 1u << n);
        SET(multisampleantialias, "true");
        set_number(TRIPTYCH_STATE_MULTISAMPLEMASK, 0xffffff5a);
        derive();
        struct sampling sampling = derive_sampling(&state);
        TEST_ASSERT_EQUAL_INT(n, pixel->samples);
        TEST_ASSERT_EQUAL_INT(0, pixel->sample_centers);
        TEST_ASSERT_EQUAL_HEX8(n ? 0x5a & ((1u << (1u << n)) - 1) : 1, sampling.mask);
        SET(multisampleantialias, "false");
        derive();
        TEST_ASSERT_EQUAL_INT(n ? 1 : 0, pixel->sample_centers);
    }
}

static void alpha_covers_samples_with_the_alpha_test(void)
{
    for (unsigned n = 0; n < SAMPLES_RADIX; n++) {
        set_target(TRIPTYCH_DEPTH_D24S8, 1u << n);
        SET(adaptivetess_y, "atoc");
        SET(alphatestenable, "false");
        derive();
        TEST_ASSERT_EQUAL_INT(0, pixel->alpha_coverage);
        SET(alphatestenable, "true");
        derive();
        TEST_ASSERT_EQUAL_INT(n > 0, pixel->alpha_coverage);
        SET(adaptivetess_y, "none");
        derive();
        TEST_ASSERT_EQUAL_INT(0, pixel->alpha_coverage);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_test_that_passes_and_keeps_everything_is_disabled_in_the_key);
    RUN_TEST(a_format_without_stencil_has_no_test);
    RUN_TEST(operations_that_cannot_happen_do_not_change_the_key);
    RUN_TEST(two_equal_sides_have_the_key_of_one);
    RUN_TEST(culling_leaves_one_side);
    RUN_TEST(a_draw_that_only_changes_stencil_has_an_effect);
    RUN_TEST(the_format_is_in_the_key_where_it_is_read);
    RUN_TEST(reference_and_masks_are_in_the_job_with_the_bits_of_the_stencil);
    RUN_TEST(values_of_each_side_are_in_the_key_where_they_are_read);
    RUN_TEST(samples_come_from_the_target);
    RUN_TEST(alpha_covers_samples_with_the_alpha_test);
    return UNITY_END();
}
