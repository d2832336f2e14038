/* The state: defaults, words, and refusals with their reasons. */
#include "base/file.h"
#include "render/state/state.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
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

static enum triptych_result set(enum triptych_state_table table, unsigned i, unsigned row, uint32_t value)
{
    error_clear(&error);
    return state_set_value(&state, table, i, row, value, &error);
}

static enum triptych_result set_state(enum triptych_state which, uint32_t value)
{
    return set(TRIPTYCH_RENDER_STATES, 0, which, value);
}

/* Calls `visit` for each row of each table. */
static void for_each_row(void (*visit)(enum triptych_state_table, unsigned,
                                       const struct triptych_state_row *))
{
    for (unsigned t = 0; t < TRIPTYCH_STATE_TABLE_COUNT; t++)
        for (unsigned row = 0; triptych_state_at(t, row); row++)
            visit(t, row, triptych_state_at(t, row));
}

/* States of extensions have numbers after Direct3D 9's last one. */
static void the_tables_begin_with_all_states_of_direct3d(void)
{
    static const unsigned rows[] = {103, 13, 18}, last[] = {209, 13, 32};
    for (unsigned t = 0; t < TRIPTYCH_STATE_TABLE_COUNT; t++) {
        unsigned number = 0;
        for (unsigned row = 0; triptych_state_at(t, row); row++) {
            TEST_ASSERT_GREATER_THAN_UINT(number, triptych_state_at(t, row)->number);
            number = triptych_state_at(t, row)->number;
        }
        const struct triptych_state_row *end = triptych_state_at(t, rows[t] - 1);
        TEST_ASSERT_NOT_NULL(end);
        TEST_ASSERT_EQUAL_UINT(last[t], end->number);
    }
    TEST_ASSERT_EQUAL_STRING("zenable", triptych_state_at(TRIPTYCH_RENDER_STATES, 0)->name);
    TEST_ASSERT_EQUAL_UINT(165, triptych_state_at(0, TRIPTYCH_STATE_DEBUGMONITORTOKEN)->number);
    TEST_ASSERT_NULL(triptych_state_at(TRIPTYCH_STATE_TABLE_COUNT, 0));
    TEST_ASSERT_NULL(triptych_table_name(TRIPTYCH_STATE_TABLE_COUNT));
}

static void set_default(enum triptych_state_table table, unsigned row, const struct triptych_state_row *r)
{
    for (unsigned i = 0; i < triptych_table_size(table); i++)
        TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, set(table, i, row, triptych_state_default(table, row, i)),
                                      r->name);
}

static void defaults_are_allowed_values(void)
{
    for_each_row(set_default);
    TEST_ASSERT_EQUAL_MEMORY(&before, &state, sizeof state);
    TEST_ASSERT_EQUAL_UINT32(4, state.value[TRIPTYCH_STATE_ZFUNC]);
    TEST_ASSERT_EQUAL_UINT32(3, state.value[TRIPTYCH_STATE_CULLMODE]);
    TEST_ASSERT_EQUAL_HEX32(triptych_float_bits(64), state.value[TRIPTYCH_STATE_POINTSIZE_MAX]);
    TEST_ASSERT_EQUAL_HEX32(triptych_float_bits(1), state.value[TRIPTYCH_STATE_FOGEND]);
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, state.value[TRIPTYCH_STATE_STENCILMASK]);
}

static void stages_after_the_first_are_off_and_have_their_own_coordinates(void)
{
    for (unsigned i = 0; i < TRIPTYCH_STAGES; i++) {
        TEST_ASSERT_EQUAL_UINT32(i ? 1 : 4, state.stage[i][TRIPTYCH_STAGE_COLOROP]);
        TEST_ASSERT_EQUAL_UINT32(i ? 1 : 2, state.stage[i][TRIPTYCH_STAGE_ALPHAOP]);
        TEST_ASSERT_EQUAL_UINT32(i, state.stage[i][TRIPTYCH_STAGE_TEXCOORDINDEX]);
    }
}

static unsigned words;

static int can_be_set(const struct triptych_state_row *row, const struct triptych_value *value,
                      uint32_t initial)
{
    int both = row->support == TRIPTYCH_SUPPORT_YES && value->support == TRIPTYCH_SUPPORT_YES;
    return both || value->number == initial;
}

static void set_words(enum triptych_state_table table, unsigned row, const struct triptych_state_row *r)
{
    uint32_t initial = triptych_state_default(table, row, 0), back = 0;
    const struct triptych_value *value;
    for (unsigned i = 0; (value = triptych_value_at(r->kind, i)); i++, words++) {
        TEST_ASSERT_EQUAL_STRING(value->word, triptych_value_word(r->kind, value->number));
        TEST_ASSERT_EQUAL_INT(0, triptych_value_number(r->kind, value->word, &back));
        TEST_ASSERT_EQUAL_HEX32(value->number, back);
        TEST_ASSERT_EQUAL_INT_MESSAGE(can_be_set(r, value, initial) ? TRIPTYCH_OK : TRIPTYCH_UNSUPPORTED,
                                      set(table, 0, row, value->number), error.text);
    }
}

static void every_word_leads_to_its_value_and_back(void)
{
    for_each_row(set_words);
    TEST_ASSERT_GREATER_THAN_UINT(4 * TRIPTYCH_STATE_COUNT, words);
}

static void kinds_are_either_words_or_numbers(void)
{
    const struct triptych_kind *kind;
    for (unsigned i = 0; (kind = triptych_kind_at(i)); i++) {
        int has_words = kind->notation == TRIPTYCH_NOTATION_WORDS;
        TEST_ASSERT_EQUAL_INT_MESSAGE(has_words, triptych_value_at(kind, 0) != NULL, kind->name);
        TEST_ASSERT_EQUAL_INT_MESSAGE(has_words, !(kind->first < kind->last), kind->name);
    }
}

static void words_belong_to_their_kind(void)
{
    uint32_t value = 77;
    const struct triptych_kind *cull = triptych_state_at(0, TRIPTYCH_STATE_CULLMODE)->kind;
    const struct triptych_kind *ambient = triptych_state_at(0, TRIPTYCH_STATE_AMBIENT)->kind;
    TEST_ASSERT_EQUAL_STRING("ccw", triptych_value_word(cull, 3));
    TEST_ASSERT_NULL(triptych_value_word(ambient, 0));
    TEST_ASSERT_NOT_EQUAL(0, triptych_value_number(cull, "less", &value));
    TEST_ASSERT_NOT_EQUAL(0, triptych_value_number(cull, NULL, &value));
    TEST_ASSERT_EQUAL_UINT32(77, value);
}

static void a_value_that_direct3d_has_and_we_do_not_is_unsupported(void)
{
    expect_refused(
        TRIPTYCH_UNSUPPORTED, set_state(TRIPTYCH_STATE_DESTBLEND, 13),
        "state destblend: value bothinvsrcalpha (13) is not supported, expected zero (1), one (2), "
        "srccolor (3), invsrccolor (4), srcalpha (5), invsrcalpha (6), destalpha (7), "
        "invdestalpha (8), destcolor (9), invdestcolor (10), srcalphasat (11), blendfactor (14), "
        "invblendfactor (15), srccolor2 (16), invsrccolor2 (17), blendfactoralpha (18), "
        "invblendfactoralpha (19), srcalpha2 (20), ...");
    expect_refused(TRIPTYCH_UNSUPPORTED, set_state(TRIPTYCH_STATE_PATCHEDGESTYLE, 1),
                   "state patchedgestyle: value continuous (1) is not supported, expected discrete (0)");
    expect_refused(TRIPTYCH_UNSUPPORTED, set_state(TRIPTYCH_STATE_POSITIONDEGREE, 5),
                   "state positiondegree: value quintic (5) is not supported, expected cubic (3)");
    expect_refused(TRIPTYCH_UNSUPPORTED, set(TRIPTYCH_SAMPLER_STATES, 2, TRIPTYCH_SAMPLER_DMAPOFFSET, 256),
                   "sampler 2 dmapoffset: value 256 is not supported, expected 0");
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_UNSUPPORTED, set_state(TRIPTYCH_STATE_DESTBLEND, 12));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_UNSUPPORTED, set(TRIPTYCH_STAGE_STATES, 0, TRIPTYCH_STAGE_ALPHAOP, 24));
}

static void long_lists_of_words_are_cut(void)
{
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT,
                          set(TRIPTYCH_STAGE_STATES, 0, TRIPTYCH_STAGE_COLORARG1, 0x47));
    TEST_ASSERT_EQUAL_STRING_LEN("stage 0 colorarg1: value 71 does not exist, expected diffuse (0), ",
                                 error.text, 62);
    TEST_ASSERT_EQUAL_STRING("), ...", error.text + strlen(error.text) - 6);
    TEST_ASSERT_EQUAL_MEMORY(&before, &state, sizeof state);
}

static void a_value_that_does_not_exist_is_a_bad_argument(void)
{
    expect_refused(TRIPTYCH_BAD_ARGUMENT, set_state(TRIPTYCH_STATE_CULLMODE, 9),
                   "state cullmode: value 9 does not exist, expected none (1), cw (2), ccw (3)");
    expect_refused(TRIPTYCH_BAD_ARGUMENT, set_state(TRIPTYCH_STATE_COLORWRITEENABLE, 16),
                   "state colorwriteenable: value 16, expected 0 to 15");
    expect_refused(TRIPTYCH_BAD_ARGUMENT, set_state(1000, 0), "state 1000: expected 0 to 116");
    expect_refused(TRIPTYCH_BAD_ARGUMENT, set(TRIPTYCH_SAMPLER_STATES, 0, 99, 1),
                   "sampler state 99: expected 0 to 12");
    expect_refused(TRIPTYCH_BAD_ARGUMENT, set(TRIPTYCH_SAMPLER_STATES, 20, TRIPTYCH_SAMPLER_ADDRESSU, 1),
                   "sampler 20: expected 0 to 19");
    expect_refused(TRIPTYCH_BAD_ARGUMENT, set(TRIPTYCH_STAGE_STATES, 8, TRIPTYCH_STAGE_COLOROP, 1),
                   "stage 8: expected 0 to 7");
    expect_refused(TRIPTYCH_BAD_ARGUMENT, set(TRIPTYCH_SAMPLER_STATES, 0, TRIPTYCH_SAMPLER_MAXANISOTROPY, 17),
                   "sampler 0 maxanisotropy: value 17, expected 1 to 16");
}

static void reals_are_finite(void)
{
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT,
                          set_state(TRIPTYCH_STATE_DEPTHBIAS, triptych_float_bits(NAN)));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT,
                          set_state(TRIPTYCH_STATE_FOGSTART, triptych_float_bits(-INFINITY)));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT,
                          set_state(TRIPTYCH_STATE_POINTSIZE, triptych_float_bits(-1)));
    TEST_ASSERT_EQUAL_MEMORY(&before, &state, sizeof state);
}

static bool is_word(int c)
{
    return isalnum(c) || c == '_';
}

/* Returns true if the text contains the word. */
static bool contains(const char *text, const char *word)
{
    for (const char *at = text; (at = strstr(at, word)); at++)
        if (!is_word(at[strlen(word)]) && (at == text || !is_word(at[-1])))
            return true;
    return false;
}

/* Returns true if the text contains the name of the state, or its name in the interface. */
static bool mentions(const char *text, enum triptych_state_table table, const char *name)
{
    static const char *const prefix[] = {"STATE", "SAMPLER", "STAGE"};
    char capitals[128];
    int length = snprintf(capitals, sizeof capitals, "TRIPTYCH_%s_%s", prefix[table], name);
    for (int i = 0; i < length; i++)
        capitals[i] = (char)toupper(capitals[i]);
    return contains(text, name) || contains(text, capitals);
}

static void check_test(enum triptych_state_table table, unsigned row, const struct triptych_state_row *r)
{
    char path[256], what[320], *text;
    size_t bytes;
    (void)row;
    TEST_ASSERT_EQUAL_INT_MESSAGE(r->support == TRIPTYCH_SUPPORT_YES, r->test[0] != 0, r->name);
    if (!r->test[0])
        return;
    snprintf(path, sizeof path, "tests/%s", r->test);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, file_read(path, 1 << 24, &text, &bytes, &error), error.text);
    snprintf(what, sizeof what, "%s does not mention %s", path, r->name);
    int found = mentions(text, table, r->name);
    free(text);
    TEST_ASSERT_TRUE_MESSAGE(found, what);
}

static void what_is_supported_has_a_test_that_mentions_it(void)
{
    for_each_row(check_test);
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

static void a_viewport_is_finite_and_has_no_negative_side(void)
{
    static const struct triptych_viewport bad[] = {
        {0, 0, 10, 10, 0, 2},      {0, 0, 10, 10, -1, 1}, {0, 0, 10, 10, 0, NAN},
        {NAN, 0, 10, 10, 0, 1},    {0, 0, 10, NAN, 0, 1}, {0, -INFINITY, 9, 9, 0, 1},
        {0, 0, INFINITY, 9, 0, 1}, {0, 0, -1, 10, 0, 1},  {0, 0, 10, -0.5f, 0, 1},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, state_set_viewport(&state, &bad[i], &error));
        TEST_ASSERT_EQUAL_MEMORY(&before, &state, sizeof state);
    }
    const struct triptych_viewport anywhere = {-1e30f, 4e9f, 0, 1e30f, 1, 0};
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, state_set_viewport(&state, &anywhere, NULL));
    TEST_ASSERT_EQUAL_MEMORY(&anywhere, &state.viewport, sizeof anywhere);
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
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, state_set_element(&state, TRIPTYCH_DIFFUSE, &element, NULL));
    TEST_ASSERT_EQUAL_PTR(&buffer, state_stream_of(&state, TRIPTYCH_DIFFUSE)->buffer);
    element.format = TRIPTYCH_FORMAT_COUNT;
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, state_set_element(&state, TRIPTYCH_DIFFUSE, &element, NULL));
    element.format = TRIPTYCH_FORMAT_NONE;
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, state_set_element(&state, TRIPTYCH_DIFFUSE, &element, NULL));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_FORMAT_NONE, state.element[TRIPTYCH_DIFFUSE].format);
    TEST_ASSERT_NULL(state_stream_of(&state, TRIPTYCH_DIFFUSE)->buffer);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(the_tables_begin_with_all_states_of_direct3d);
    RUN_TEST(defaults_are_allowed_values);
    RUN_TEST(stages_after_the_first_are_off_and_have_their_own_coordinates);
    RUN_TEST(every_word_leads_to_its_value_and_back);
    RUN_TEST(kinds_are_either_words_or_numbers);
    RUN_TEST(words_belong_to_their_kind);
    RUN_TEST(a_value_that_direct3d_has_and_we_do_not_is_unsupported);
    RUN_TEST(long_lists_of_words_are_cut);
    RUN_TEST(a_value_that_does_not_exist_is_a_bad_argument);
    RUN_TEST(reals_are_finite);
    RUN_TEST(what_is_supported_has_a_test_that_mentions_it);
    RUN_TEST(a_matrix_that_is_not_finite_is_refused);
    RUN_TEST(a_viewport_is_finite_and_has_no_negative_side);
    RUN_TEST(lights_are_checked_by_their_type);
    RUN_TEST(an_element_must_start_inside_its_buffer);
    return UNITY_END();
}
