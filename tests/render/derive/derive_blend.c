/* Derivation of pixel keys: the fields of blending, write masks and targets. */
#include "tests/support/picture/derivation.h"
#include "contract/key_query.h"

void setUp(void)
{
    derivation_begin();
}

void tearDown(void)
{
}

static void set_blending(const char *operation, const char *source, const char *target)
{
    SET(alphablendenable, "true");
    SET(blendop, operation);
    SET(srcblend, source);
    SET(destblend, target);
}

static void set_alpha_blending(const char *operation, const char *source, const char *target)
{
    SET(separatealphablendenable, "true");
    SET(blendopalpha, operation);
    SET(srcblendalpha, source);
    SET(destblendalpha, target);
}

static void expect_blending(int channel, int blend, int source, int target)
{
    const struct pixel_key *pixel = &key[UNIT_PIXEL].pixel;
    derive();
    TEST_ASSERT_EQUAL_INT(blend, pixel->blend[channel]);
    TEST_ASSERT_EQUAL_INT(source, pixel->source_factor[channel]);
    TEST_ASSERT_EQUAL_INT(target, pixel->target_factor[channel]);
}

static void blendings_with_equal_results_have_equal_keys(void)
{
    static const struct {
        const char *operation, *source, *target;
        int blend, source_factor, target_factor;
    } cases[] = {
        {"add", "one", "zero", BLEND_COPY, 0, 0},
        {"subtract", "one", "zero", BLEND_COPY, 0, 0},
        {"add", "one", "invsrcalpha", BLEND_ADD, FACTOR_ONE, FACTOR_INVERSE_SOURCE_ALPHA},
        {"add", "srcalpha", "invsrcalpha", BLEND_ADD, FACTOR_SOURCE_ALPHA, FACTOR_INVERSE_SOURCE_ALPHA},
        {"add", "bothsrcalpha", "one", BLEND_ADD, FACTOR_SOURCE_ALPHA, FACTOR_INVERSE_SOURCE_ALPHA},
        {"add", "bothinvsrcalpha", "one", BLEND_ADD, FACTOR_INVERSE_SOURCE_ALPHA, FACTOR_SOURCE_ALPHA},
        {"add", "srcalphasat", "invblendfactor", BLEND_ADD, FACTOR_SATURATED_ALPHA, FACTOR_INVERSE_CONSTANT},
        {"add", "blendfactor", "invdestcolor", BLEND_ADD, FACTOR_CONSTANT, FACTOR_INVERSE_TARGET_COLOR},
        {"subtract", "destcolor", "zero", BLEND_ADD, FACTOR_TARGET_COLOR, FACTOR_ZERO},
        {"subtract", "zero", "destcolor", BLEND_ADD, FACTOR_ZERO, FACTOR_ZERO},
        {"revsubtract", "zero", "srccolor", BLEND_ADD, FACTOR_ZERO, FACTOR_SOURCE_COLOR},
        {"revsubtract", "srccolor", "zero", BLEND_ADD, FACTOR_ZERO, FACTOR_ZERO},
        {"subtract", "one", "one", BLEND_SUBTRACT, FACTOR_ONE, FACTOR_ONE},
        {"min", "srcalpha", "invdestalpha", BLEND_MINIMUM, 0, 0},
        {"max", "zero", "zero", BLEND_MAXIMUM, 0, 0},
        {"add", "srccolor2", "invsrccolor2", BLEND_ADD, FACTOR_SOURCE_COLOR, FACTOR_INVERSE_SOURCE_COLOR},
        {"add", "one", "invsrcalpha2", BLEND_ADD, FACTOR_ONE, FACTOR_INVERSE_SOURCE_ALPHA},
        {"multiply", "zero", "one", BLEND_ADVANCED + (int)ADVANCED_MULTIPLY, 0, 0},
        {"luminosity", "srcalpha", "zero", BLEND_ADVANCED + (int)ADVANCED_LUMINOSITY, 0, 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        set_blending(cases[i].operation, cases[i].source, cases[i].target);
        for (int c = 0; c < BLEND_CHANNELS; c++)
            expect_blending(c, cases[i].blend, cases[i].source_factor, cases[i].target_factor);
        SET(alphablendenable, "false");
        expect_blending(BLEND_COLOR, BLEND_COPY, 0, 0);
        expect_blending(BLEND_ALPHA, BLEND_COPY, 0, 0);
    }
}

static void separate_same_alpha(void)
{
    set_alpha_blending("add", "srcalpha", "invsrcalpha");
}

static void separate_own_colour(void)
{
    set_alpha_blending("add", "srccolor", "invsrccolor");
}

static void alpha_that_is_blended_like_colour_has_no_key_field_of_its_own(void)
{
    set_blending("add", "srcalpha", "invsrcalpha");
    expect_same_keys(separate_same_alpha);
    expect_same_keys(separate_own_colour);
    set_alpha_blending("add", "one", "invsrcalpha");
    expect_blending(BLEND_COLOR, BLEND_ADD, FACTOR_SOURCE_ALPHA, FACTOR_INVERSE_SOURCE_ALPHA);
    expect_blending(BLEND_ALPHA, BLEND_ADD, FACTOR_ONE, FACTOR_INVERSE_SOURCE_ALPHA);
    SET(separatealphablendenable, "false");
    expect_blending(BLEND_ALPHA, BLEND_ADD, FACTOR_SOURCE_ALPHA, FACTOR_INVERSE_SOURCE_ALPHA);
}

/* The two products of (srccolor, invsrcalpha) are rounded separately, those of (srcalpha, invsrcalpha)
 * together. */
static void alpha_that_is_rounded_differently_has_key_fields_of_its_own(void)
{
    set_blending("add", "srccolor", "invsrcalpha");
    set_alpha_blending("add", "srcalpha", "invsrcalpha");
    expect_blending(BLEND_COLOR, BLEND_ADD, FACTOR_SOURCE_COLOR, FACTOR_INVERSE_SOURCE_ALPHA);
    expect_blending(BLEND_ALPHA, BLEND_ADD, FACTOR_SOURCE_ALPHA, FACTOR_INVERSE_SOURCE_ALPHA);
    set_alpha_blending("add", "srccolor", "invsrcalpha");
    expect_blending(BLEND_ALPHA, BLEND_ADD, FACTOR_SOURCE_COLOR, FACTOR_INVERSE_SOURCE_ALPHA);
}

static void change_kind(void)
{
    set_blending("hue", "one", "zero");
}

static void advanced_blending_has_neither_factors_nor_an_operation_of_alpha(void)
{
    set_blending("screen", "srcalpha", "one");
    set_alpha_blending("max", "zero", "destalpha");
    for (int c = 0; c < BLEND_CHANNELS; c++)
        expect_blending(c, BLEND_ADVANCED + (int)ADVANCED_SCREEN, 0, 0);
    set_value(TRIPTYCH_STATE_COLORWRITEENABLE, 8);
    expect_same_keys(change_kind);
}

static void change_alpha_blending(void)
{
    set_alpha_blending("max", "one", "one");
}

static void change_colour_blending(void)
{
    set_blending("revsubtract", "destcolor", "one");
}

static void channels_that_are_not_written_are_blended_like_the_others(void)
{
    set_blending("add", "srcalpha", "one");
    set_value(TRIPTYCH_STATE_COLORWRITEENABLE, 7);
    expect_same_keys(change_alpha_blending);
    set_value(TRIPTYCH_STATE_COLORWRITEENABLE, 8);
    expect_same_keys(change_colour_blending);
    set_value(TRIPTYCH_STATE_COLORWRITEENABLE, 0);
    expect_same_keys(separate_own_colour);
}

static void channels_that_keep_the_stored_value_are_not_written(void)
{
    set_blending("add", "zero", "one");
    derive();
    TEST_ASSERT_EQUAL_INT(0, key[UNIT_PIXEL].pixel.write_mask[0]);
    set_alpha_blending("add", "one", "one");
    derive();
    TEST_ASSERT_EQUAL_INT(8, key[UNIT_PIXEL].pixel.write_mask[0]);
    set_blending("add", "one", "one");
    set_alpha_blending("revsubtract", "zero", "one");
    derive();
    TEST_ASSERT_EQUAL_INT(7, key[UNIT_PIXEL].pixel.write_mask[0]);
}

static void change_blend_factor(void)
{
    set_value(TRIPTYCH_STATE_BLENDFACTOR, 0x80402010);
}

static void the_blend_factor_is_only_in_the_job(void)
{
    set_blending("add", "blendfactor", "one");
    expect_same_keys(change_blend_factor);
    derive();
    TEST_ASSERT_EQUAL_HEX32(0x80102040, job.blend_constant);
}

/* --- By primitive --- */

static void enable_primitive_blending(void)
{
    SET(primitiveblendenable, "true");
}

static void declare_number(void)
{
    state.other[state.others++] =
        (struct state_other){TRIPTYCH_USAGE_BLENDINDICES, 1, {.format = TRIPTYCH_FORMAT_UBYTE4}};
}

static void primitives_have_a_blending_of_their_own_if_vertices_have_its_number(void)
{
    const struct pixel_key *pixel = &key[UNIT_PIXEL].pixel;
    expect_same_keys(enable_primitive_blending);
    declare_number();
    set_blending("add", "zero", "one");
    derive();
    TEST_ASSERT_EQUAL_INT(INTERPOLATION_FLAT, pixel->varying[VARYING_blending]);
    TEST_ASSERT_EQUAL_INT(15, pixel->write_mask[0]); /* other primitives keep the stored colour */
    TEST_ASSERT_EQUAL_INT(ATTRIBUTE_FORMAT_UBYTE4, key[UNIT_VERTEX].vertex.input[0]);
    TEST_ASSERT_EQUAL_INT(ATTRIBUTE_FORMAT_NONE, key[UNIT_VERTEX].vertex.input[1]);
    set_value(TRIPTYCH_STATE_COLORWRITEENABLE, 0);
    derive();
    TEST_ASSERT_FALSE(pixel_blends_by_primitive(pixel));
}

static void disable_primitive_blending(void)
{
    SET(primitiveblendenable, "false");
}

static void logic_operations_replace_blending_by_primitive(void)
{
    declare_number();
    enable_primitive_blending();
    SET(logicop, "xor");
    expect_same_keys(disable_primitive_blending);
}

/* --- Targets --- */

static void set_targets(enum triptych_surface_format first, enum triptych_surface_format second)
{
    const struct triptych_target_description description = {
        .width = 640, .height = 480, .color_format = {first, second}};
    state_set_target(&state, &description);
}

static void alpha_of_targets_without_one_is_known(void)
{
    set_targets(TRIPTYCH_SURFACE_X8R8G8B8, TRIPTYCH_SURFACE_R5G6B5);
    set_blending("add", "destalpha", "invdestalpha");
    expect_blending(BLEND_COLOR, BLEND_COPY, 0, 0);
    TEST_ASSERT_EQUAL_INT(7, key[UNIT_PIXEL].pixel.write_mask[0]);
    set_blending("add", "srcalphasat", "one");
    derive();
    TEST_ASSERT_EQUAL_INT(0, pixel_write_mask(&key[UNIT_PIXEL].pixel));
    set_targets(TRIPTYCH_SURFACE_X8R8G8B8, TRIPTYCH_SURFACE_A1R5G5B5);
    set_blending("add", "destalpha", "invdestalpha");
    expect_blending(BLEND_COLOR, BLEND_ADD, FACTOR_TARGET_ALPHA, FACTOR_INVERSE_TARGET_ALPHA);
}

/* In formats with negative values, 0 - s * f is not 0. */
static void differences_below_zero_stay_in_formats_with_negative_values(void)
{
    set_blending("subtract", "zero", "one");
    set_targets(TRIPTYCH_SURFACE_A8R8G8B8, 0);
    expect_blending(BLEND_COLOR, BLEND_ADD, FACTOR_ZERO, FACTOR_ZERO);
    set_targets(TRIPTYCH_SURFACE_A8R8G8B8, TRIPTYCH_SURFACE_A16B16G16R16F);
    expect_blending(BLEND_COLOR, BLEND_SUBTRACT, FACTOR_ZERO, FACTOR_ONE);
    set_value(TRIPTYCH_STATE_COLORWRITEENABLE1, 0);
    expect_blending(BLEND_COLOR, BLEND_ADD, FACTOR_ZERO, FACTOR_ZERO);
}

/* The key of a target that is not written contains only its number of planes. Targets after the last written
 * one are not in the key. */
static void targets_that_are_not_written_have_only_their_planes_in_the_key(void)
{
    const struct pixel_key *pixel = &key[UNIT_PIXEL].pixel;
    set_targets(TRIPTYCH_SURFACE_R5G6B5, TRIPTYCH_SURFACE_A16B16G16R16F);
    SET(ditherenable, "true");
    derive();
    TEST_ASSERT_EQUAL_INT(TARGET_565, pixel->target[0]);
    TEST_ASSERT_EQUAL_INT(TARGET_HALF, pixel->target[1]);
    TEST_ASSERT_EQUAL_INT(7, pixel->write_mask[0]);
    TEST_ASSERT_TRUE(pixel->float_color && pixel->dither);
    set_value(TRIPTYCH_STATE_COLORWRITEENABLE, 8);
    derive();
    TEST_ASSERT_EQUAL_INT(TARGET_8888, pixel->target[0]);
    TEST_ASSERT_EQUAL_INT(0, pixel->write_mask[0]);
    TEST_ASSERT_TRUE(pixel->float_color && !pixel->dither);
    set_value(TRIPTYCH_STATE_COLORWRITEENABLE, 1);
    set_value(TRIPTYCH_STATE_COLORWRITEENABLE1, 0);
    derive();
    TEST_ASSERT_EQUAL_INT(TARGET_565, pixel->target[0]);
    TEST_ASSERT_EQUAL_INT(0, pixel->target[1]);
    TEST_ASSERT_TRUE(!pixel->float_color && pixel->dither);
}

static void only_colour_is_encoded(void)
{
    const struct pixel_key *pixel = &key[UNIT_PIXEL].pixel;
    SET(srgbwriteenable, "true");
    derive();
    TEST_ASSERT_EQUAL_INT(TARGET_SRGB, pixel->target[0]);
    TEST_ASSERT_TRUE(pixel->float_color);
    set_value(TRIPTYCH_STATE_COLORWRITEENABLE, 8);
    derive();
    TEST_ASSERT_EQUAL_INT(TARGET_8888, pixel->target[0]);
    TEST_ASSERT_FALSE(pixel->float_color);
}

/* --- Logic operations --- */

/* Floating point and sRGB have no operation; a target that keeps its bits is not written. */
static void expect_logic(int logic, int first_mask, int second_mask)
{
    const struct pixel_key *pixel = &key[UNIT_PIXEL].pixel;
    derive();
    TEST_ASSERT_EQUAL_INT(logic, pixel->logic);
    TEST_ASSERT_EQUAL_INT(first_mask, pixel->write_mask[0]);
    TEST_ASSERT_EQUAL_INT(second_mask, pixel->write_mask[1]);
    TEST_ASSERT_EQUAL_INT(BLEND_COPY, pixel->blend[BLEND_COLOR]);
    TEST_ASSERT_EQUAL_INT(BLEND_COPY, pixel->blend[BLEND_ALPHA]);
}

static void logic_operations_replace_blending_where_targets_have_codes(void)
{
    set_blending("add", "srcalpha", "one");
    set_targets(TRIPTYCH_SURFACE_R5G6B5, TRIPTYCH_SURFACE_A32B32G32R32F);
    SET(logicop, "xor");
    expect_logic(LOGIC_XOR, 7, 15);
    SET(logicop, "copy");
    expect_logic(LOGIC_COPY, 7, 15);
    SET(logicop, "noop");
    expect_logic(LOGIC_COPY, 0, 15);
    set_targets(TRIPTYCH_SURFACE_A32B32G32R32F, TRIPTYCH_SURFACE_A16B16G16R16F);
    SET(logicop, "xor");
    expect_logic(LOGIC_COPY, 15, 15);
    SET(logicop, "noop");
    expect_logic(LOGIC_COPY, 15, 15);
}

static void encoded_targets_have_no_logic_operation(void)
{
    const struct pixel_key *pixel = &key[UNIT_PIXEL].pixel;
    set_targets(TRIPTYCH_SURFACE_A8R8G8B8, TRIPTYCH_SURFACE_R5G6B5);
    SET(srgbwriteenable, "true");
    SET(logicop, "nand");
    set_value(TRIPTYCH_STATE_COLORWRITEENABLE, 8);
    expect_logic(LOGIC_NAND, 8, 7);
    TEST_ASSERT_EQUAL_INT(TARGET_SRGB, pixel->target[0]); /* alpha has none either */
    set_value(TRIPTYCH_STATE_COLORWRITEENABLE1, 0);
    expect_logic(LOGIC_COPY, 8, 0);
    TEST_ASSERT_EQUAL_INT(TARGET_8888, pixel->target[0]);
}

static void without_a_written_target_there_is_no_logic_operation(void)
{
    SET(logicop, "set");
    set_value(TRIPTYCH_STATE_COLORWRITEENABLE, 0);
    expect_logic(LOGIC_COPY, 0, 0);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(blendings_with_equal_results_have_equal_keys);
    RUN_TEST(alpha_that_is_blended_like_colour_has_no_key_field_of_its_own);
    RUN_TEST(alpha_that_is_rounded_differently_has_key_fields_of_its_own);
    RUN_TEST(advanced_blending_has_neither_factors_nor_an_operation_of_alpha);
    RUN_TEST(channels_that_are_not_written_are_blended_like_the_others);
    RUN_TEST(channels_that_keep_the_stored_value_are_not_written);
    RUN_TEST(the_blend_factor_is_only_in_the_job);
    RUN_TEST(primitives_have_a_blending_of_their_own_if_vertices_have_its_number);
    RUN_TEST(logic_operations_replace_blending_by_primitive);
    RUN_TEST(alpha_of_targets_without_one_is_known);
    RUN_TEST(differences_below_zero_stay_in_formats_with_negative_values);
    RUN_TEST(targets_that_are_not_written_have_only_their_planes_in_the_key);
    RUN_TEST(only_colour_is_encoded);
    RUN_TEST(logic_operations_replace_blending_where_targets_have_codes);
    RUN_TEST(encoded_targets_have_no_logic_operation);
    RUN_TEST(without_a_written_target_there_is_no_logic_operation);
    return UNITY_END();
}
