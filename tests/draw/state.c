/* The state: defaults, words, and what is refused with which reason. */
#include "draw/state.h"

#include <math.h>
#include <string.h>
#include <unity.h>

static struct state state, before;
static struct error error;

void setUp(void)
{
    state_initialize(&state);
    before = state;
    error_clear(&error);
}

void tearDown(void)
{
}

static void expect_refused(enum triptych_result expected, enum triptych_result got, const char *reason)
{
    TEST_ASSERT_EQUAL_INT(expected, got);
    TEST_ASSERT_EQUAL_STRING(reason, error.text);
    TEST_ASSERT_EQUAL_MEMORY(&before, &state, sizeof state);
}

static void defaults_are_allowed_values(void)
{
    for (int i = 0; i < TRIPTYCH_STATE_COUNT; i++)
        TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, state_set_value(&state, i, before.value[i], &error));
    TEST_ASSERT_EQUAL_UINT32(4, state.value[TRIPTYCH_STATE_zfunc]);
    TEST_ASSERT_EQUAL_UINT32(3, state.value[TRIPTYCH_STATE_cullmode]);
}

static void every_word_leads_to_its_value_and_back(void)
{
    int words = 0;
    for (int i = 0; i < TRIPTYCH_STATE_COUNT; i++)
        for (uint32_t value = 0; value < 32; value++) {
            const char *word = triptych_state_word(i, value);
            uint32_t back = 99;
            if (!word)
                continue;
            words++;
            TEST_ASSERT_EQUAL_INT(0, triptych_state_value(i, word, &back));
            TEST_ASSERT_EQUAL_UINT32(value, back);
            TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, state_set_value(&state, i, value, &error));
        }
    TEST_ASSERT_TRUE(words > TRIPTYCH_STATE_COUNT);
}

static void names_are_direct3ds(void)
{
    uint32_t value = 77;
    TEST_ASSERT_EQUAL_STRING("zenable", triptych_state_name(TRIPTYCH_STATE_zenable));
    TEST_ASSERT_EQUAL_STRING("ccw", triptych_state_word(TRIPTYCH_STATE_cullmode, 3));
    TEST_ASSERT_NULL(triptych_state_word(TRIPTYCH_STATE_ambient, 0));
    TEST_ASSERT_NULL(triptych_state_name(TRIPTYCH_STATE_COUNT));
    TEST_ASSERT_NOT_EQUAL(0, triptych_state_value(TRIPTYCH_STATE_zfunc, "ccw", &value));
    TEST_ASSERT_EQUAL_UINT32(77, value);
}

static void a_value_that_direct3d_has_and_we_do_not_is_unsupported(void)
{
    expect_refused(TRIPTYCH_UNSUPPORTED, state_set_value(&state, TRIPTYCH_STATE_srcblend, 16, &error),
                   "state srcblend: value 16 is not supported yet, expected zero (1), one (2), srccolor (3), "
                   "invsrccolor (4), srcalpha (5), invsrcalpha (6), destalpha (7), invdestalpha (8), "
                   "destcolor (9), invdestcolor (10), srcalphasat (11), bothsrcalpha (12), "
                   "bothinvsrcalpha (13), blendfactor (14), invblendfactor (15)");
    error_clear(&error);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_UNSUPPORTED,
                          state_set_value(&state, TRIPTYCH_STATE_destblend, 12, &error));
}

static void arguments_and_operations_not_here_are_unsupported(void)
{
    static const struct {
        enum triptych_state state;
        uint32_t value;
    } unsupported[] = {{TRIPTYCH_STATE_colorarg1, 4},
                       {TRIPTYCH_STATE_colorarg2, 5},
                       {TRIPTYCH_STATE_alphaarg0, 6},
                       {TRIPTYCH_STATE_colorop, 22},
                       {TRIPTYCH_STATE_alphaop, 24}};
    uint32_t value;
    for (size_t i = 0; i < sizeof unsupported / sizeof *unsupported; i++)
        TEST_ASSERT_EQUAL_INT(TRIPTYCH_UNSUPPORTED,
                              state_set_value(&state, unsupported[i].state, unsupported[i].value, NULL));
    TEST_ASSERT_EQUAL_MEMORY(&before, &state, sizeof state);
    TEST_ASSERT_EQUAL_INT(
        0, triptych_state_value(TRIPTYCH_STATE_alphaarg2, "tfactor_complement_alphareplicate", &value));
    TEST_ASSERT_EQUAL_HEX32(0x33, value);
}

static void a_value_that_nobody_has_is_a_bad_argument(void)
{
    expect_refused(TRIPTYCH_BAD_ARGUMENT, state_set_value(&state, TRIPTYCH_STATE_shademode, 9, &error),
                   "state shademode: value 9 does not exist, expected flat (1), gouraud (2)");
    error_clear(&error);
    expect_refused(TRIPTYCH_BAD_ARGUMENT,
                   state_set_value(&state, TRIPTYCH_STATE_colorwriteenable, 16, &error),
                   "state colorwriteenable: value 16, expected 0 to 15");
    error_clear(&error);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, state_set_value(&state, 1000, 0, &error));
}

static void a_matrix_that_is_not_finite_is_refused(void)
{
    float matrix[4][4] = {{1, 0, 0, 0}, {0, 1, NAN, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    expect_refused(TRIPTYCH_BAD_ARGUMENT,
                   state_set_transform(&state, TRIPTYCH_TRANSFORM_VIEW, (const float(*)[4])matrix, &error),
                   "view matrix: value 6 is nan, expected a finite number");
    error_clear(&error);
    matrix[1][2] = INFINITY;
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, state_set_transform(&state, TRIPTYCH_TRANSFORM_VIEW,
                                                                     (const float(*)[4])matrix, &error));
}

static void a_viewport_must_lie_in_the_target(void)
{
    static const struct triptych_viewport bad[] = {
        {0, 0, 101, 50, 0, 1}, {-1, 0, 10, 10, 0, 1}, {0, 41, 10, 10, 0, 1},  {0, 0, 0, 10, 0, 1},
        {0, 0, 10, 10, 0, 2},  {0, 0, 10, 10, -1, 1}, {NAN, 0, 10, 10, 0, 1}, {0, 0, 10, NAN, 0, 1},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, state_set_viewport(&state, &bad[i], 100, 50, &error));
        TEST_ASSERT_EQUAL_MEMORY(&before, &state, sizeof state);
    }
    TEST_ASSERT_EQUAL_INT(
        TRIPTYCH_OK,
        state_set_viewport(&state, &(struct triptych_viewport){90, 40, 10, 10, 1, 0}, 100, 50, NULL));
}

static void a_scissor_rectangle_must_lie_in_the_target(void)
{
    static const struct scissor bad[] = {
        {0, 0, 101, 50}, {1, 0, 100, 50}, {0, 1, 1, 50}, {UINT32_MAX, 0, 2, 1}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, state_set_scissor(&state, bad[i], 100, 50, &error));
        TEST_ASSERT_EQUAL_MEMORY(&before, &state, sizeof state);
    }
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK,
                          state_set_scissor(&state, (struct scissor){100, 50, 0, 0}, 100, 50, NULL));
    TEST_ASSERT_EQUAL_UINT32(100, state.scissor.x);
}

static void lights_are_checked_by_their_type(void)
{
    struct triptych_light light = {.type = TRIPTYCH_LIGHT_DIRECTIONAL};
    expect_refused(TRIPTYCH_BAD_ARGUMENT, state_set_light(&state, 0, &light, &error),
                   "light direction 0, 0, 0: expected a direction other than zero");
    error_clear(&error);
    light.type = TRIPTYCH_LIGHT_POINT;
    light.range = -1;
    expect_refused(TRIPTYCH_BAD_ARGUMENT, state_set_light(&state, 0, &light, &error),
                   "light range -1: expected 0 or more");
    error_clear(&error);
    light.range = 10;
    light.attenuation[1] = NAN;
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, state_set_light(&state, 0, &light, &error));
    light.attenuation[1] = 1;
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, state_set_light(&state, 7, &light, &error));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, state_set_light(&state, 8, &light, &error));
}

static void an_element_must_start_inside_its_buffer(void)
{
    static uint8_t bytes[64];
    struct triptych_buffer buffer = {.data = bytes, .bytes = sizeof bytes};
    struct triptych_element element = {TRIPTYCH_FORMAT_FLOAT3, &buffer, 53, 12};
    expect_refused(TRIPTYCH_BAD_ARGUMENT, state_set_element(&state, TRIPTYCH_NORMAL, &element, &error),
                   "element normal: 12 bytes at offset 53, expected them inside the buffer of 64 bytes");
    element.offset = 52;
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, state_set_element(&state, TRIPTYCH_NORMAL, &element, NULL));
    element.offset = SIZE_MAX;
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, state_set_element(&state, TRIPTYCH_NORMAL, &element, NULL));
    element.offset = 0;
    element.stride = 65537;
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, state_set_element(&state, TRIPTYCH_NORMAL, &element, NULL));
    element.stride = 0;
    element.format = TRIPTYCH_FORMAT_COLOR;
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, state_set_element(&state, TRIPTYCH_NORMAL, &element, NULL));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, state_set_element(&state, TRIPTYCH_DIFFUSE, &element, NULL));
    element.format = TRIPTYCH_FORMAT_NONE;
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, state_set_element(&state, TRIPTYCH_DIFFUSE, &element, NULL));
    TEST_ASSERT_NULL(state.element[TRIPTYCH_DIFFUSE].buffer);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(defaults_are_allowed_values);
    RUN_TEST(every_word_leads_to_its_value_and_back);
    RUN_TEST(names_are_direct3ds);
    RUN_TEST(a_value_that_direct3d_has_and_we_do_not_is_unsupported);
    RUN_TEST(arguments_and_operations_not_here_are_unsupported);
    RUN_TEST(a_value_that_nobody_has_is_a_bad_argument);
    RUN_TEST(a_matrix_that_is_not_finite_is_refused);
    RUN_TEST(a_viewport_must_lie_in_the_target);
    RUN_TEST(a_scissor_rectangle_must_lie_in_the_target);
    RUN_TEST(lights_are_checked_by_their_type);
    RUN_TEST(an_element_must_start_inside_its_buffer);
    return UNITY_END();
}
