/* Derivation: states that draw the same have the same keys, and the job's values are right. */
#include "draw/derive.h"

#include <math.h>
#include <string.h>
#include <unity.h>
#include <xmmintrin.h>

static struct state state;
static struct triptych_buffer buffer = {.bytes = 1024};
static struct triptych_texture texture; /* 64 x 48, one level */
static union key key[UNIT_COUNT];
static struct job job;

static void bind(enum triptych_attribute attribute, enum triptych_format format)
{
    struct triptych_element element = {format, &buffer, 16, 32};
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, state_set_element(&state, attribute, &element, NULL));
}

#define SET(name, word)            set(TRIPTYCH_RENDER_STATES, 0, TRIPTYCH_STATE_##name, word)
#define SET_SAMPLER(i, name, word) set(TRIPTYCH_SAMPLER_STATES, i, TRIPTYCH_SAMPLER_##name, word)
#define SET_STAGE(i, name, word)   set(TRIPTYCH_STAGE_STATES, i, TRIPTYCH_STAGE_##name, word)

static void set_number(enum triptych_state which, uint32_t value)
{
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK,
                          state_set_value(&state, TRIPTYCH_RENDER_STATES, 0, which, value, NULL));
}

static void set(enum triptych_state_table table, unsigned i, unsigned row, const char *word)
{
    uint32_t value;
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, triptych_value_number(triptych_state_at(table, row)->kind, word, &value),
                                  word);
    TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, state_set_value(&state, table, i, row, value, NULL), word);
}

static void describe(enum triptych_texture_type type, unsigned width, unsigned height, unsigned depth,
                     unsigned levels)
{
    const struct triptych_texture_description description = {
        type, TRIPTYCH_SURFACE_A8R8G8B8, width, height, depth, levels};
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, texture_describe(&description, &texture, NULL));
}

void setUp(void)
{
    static uint8_t bytes[1024];
    describe(TRIPTYCH_TEXTURE_2D, 64, 48, 1, 1);
    buffer.data = bytes;
    state_initialize(&state);
    state_set_viewport(&state, &(struct triptych_viewport){0, 0, 640, 480, 0, 1}, 640, 480, NULL);
    bind(TRIPTYCH_POSITION, TRIPTYCH_FORMAT_FLOAT3);
    bind(TRIPTYCH_NORMAL, TRIPTYCH_FORMAT_FLOAT3);
    bind(TRIPTYCH_DIFFUSE, TRIPTYCH_FORMAT_COLOR);
    bind(TRIPTYCH_TEXCOORD, TRIPTYCH_FORMAT_FLOAT2);
}

void tearDown(void)
{
}

static void derive(void)
{
    derive_keys(&state, PRIMITIVE_TRIANGLE, key);
    derive_job(&state, &key[UNIT_VERTEX].vertex, &key[UNIT_PIXEL].pixel, &job);
}

/* Derives, changes nothing but a state by `change`, and expects the same keys. */
static void expect_same_keys(void (*change)(void))
{
    union key before[UNIT_COUNT];
    derive_keys(&state, PRIMITIVE_TRIANGLE, before);
    change();
    derive_keys(&state, PRIMITIVE_TRIANGLE, key);
    TEST_ASSERT_EQUAL_MEMORY(before, key, sizeof before);
}

/* --- Keys -------------------------------------------------------------------------------------------------
 */

static void change_sampler(void)
{
    SET_SAMPLER(0, magfilter, "linear");
    SET_SAMPLER(0, addressu, "clamp");
    SET_SAMPLER(0, addressv, "clamp");
    SET_STAGE(0, colorop, "add");
    bind(TRIPTYCH_TEXCOORD, TRIPTYCH_FORMAT_FLOAT4);
}

static void without_a_texture_its_states_are_dead(void)
{
    expect_same_keys(change_sampler);
    TEST_ASSERT_EQUAL_INT(0, key[UNIT_PIXEL].pixel.texture[0]);
    TEST_ASSERT_EQUAL_INT(0, key[UNIT_PIXEL].pixel.filter[0]);
    TEST_ASSERT_EQUAL_INT(STAGE_SELECT, key[UNIT_PIXEL].pixel.color_stage[0]);
    TEST_ASSERT_EQUAL_INT(SOURCE_DIFFUSE, key[UNIT_PIXEL].pixel.color_argument[0]);
    TEST_ASSERT_EQUAL_INT(ATTRIBUTE_FORMAT_NONE, key[UNIT_VERTEX].vertex.attribute[ATTRIBUTE_TEXCOORD]);
}

static void change_everything_that_colours(void)
{
    change_sampler();
    state.texture[0] = NULL;
    SET(lighting, "false");
    SET(shademode, "flat");
    SET(alphablendenable, "true");
    SET(destblend, "invsrcalpha");
    bind(TRIPTYCH_NORMAL, TRIPTYCH_FORMAT_NONE);
    bind(TRIPTYCH_DIFFUSE, TRIPTYCH_FORMAT_FLOAT4);
}

static void without_colour_writes_nothing_colours(void)
{
    state.texture[0] = &texture;
    state.light_enabled[0] = 1;
    set_number(TRIPTYCH_STATE_colorwriteenable, 0);
    expect_same_keys(change_everything_that_colours);
    TEST_ASSERT_EQUAL_INT(INTERPOLATION_NONE, key[UNIT_SETUP].setup.varying[VARYING_diffuse]);
    TEST_ASSERT_EQUAL_INT(0, key[UNIT_VERTEX].vertex.lighting);
    TEST_ASSERT_EQUAL_INT(1, key[UNIT_PIXEL].pixel.depth_write);
}

static void change_diffuse(void)
{
    SET(lighting, "false");
    SET(shademode, "flat");
    bind(TRIPTYCH_DIFFUSE, TRIPTYCH_FORMAT_FLOAT4);
}

static void replacing_by_the_texture_kills_diffuse(void)
{
    state.texture[0] = &texture;
    state.light_enabled[2] = 1;
    SET_STAGE(0, colorop, "selectarg1");
    expect_same_keys(change_diffuse);
    TEST_ASSERT_EQUAL_INT(STAGE_SELECT, key[UNIT_PIXEL].pixel.color_stage[0]);
    TEST_ASSERT_EQUAL_INT(SOURCE_TEXTURE, key[UNIT_PIXEL].pixel.color_argument[0]);
    TEST_ASSERT_EQUAL_INT(SOURCE_TEXTURE, key[UNIT_PIXEL].pixel.alpha_argument[0]);
    TEST_ASSERT_EQUAL_INT(INTERPOLATION_NONE, key[UNIT_PIXEL].pixel.varying[VARYING_diffuse]);
    TEST_ASSERT_EQUAL_INT(INTERPOLATION_SMOOTH, key[UNIT_PIXEL].pixel.varying[VARYING_texcoord0]);
    TEST_ASSERT_EQUAL_INT(LIGHT_NONE, key[UNIT_VERTEX].vertex.light[0]);
    TEST_ASSERT_EQUAL_INT(ATTRIBUTE_FORMAT_NONE, key[UNIT_VERTEX].vertex.attribute[ATTRIBUTE_NORMAL]);
}

static void change_depth(void)
{
    SET(zfunc, "greater");
    SET(zwriteenable, "false");
}

static void depth_off_is_always_without_write(void)
{
    SET(zenable, "false");
    expect_same_keys(change_depth);
    TEST_ASSERT_EQUAL_INT(COMPARE_ALWAYS, key[UNIT_PIXEL].pixel.depth_function);
    TEST_ASSERT_EQUAL_INT(0, key[UNIT_PIXEL].pixel.depth_write);
    TEST_ASSERT_EQUAL_INT(0, key[UNIT_SETUP].setup.depth);
}

static void setup_computes_depth_exactly_when_pixels_read_it(void)
{
    derive();
    TEST_ASSERT_EQUAL_INT(1, key[UNIT_SETUP].setup.depth);
    SET(zfunc, "always");
    derive();
    TEST_ASSERT_EQUAL_INT(1, key[UNIT_SETUP].setup.depth);
    SET(zwriteenable, "false");
    derive();
    TEST_ASSERT_EQUAL_INT(0, key[UNIT_SETUP].setup.depth);
}

static void change_depth_write(void)
{
    SET(zwriteenable, "false");
}

static void equal_depth_needs_no_write(void)
{
    SET(zfunc, "equal");
    expect_same_keys(change_depth_write);
}

static void draws_without_effect_are_recognised(void)
{
    derive();
    TEST_ASSERT_TRUE(derive_effective(&key[UNIT_PIXEL].pixel));
    SET(zfunc, "never");
    derive();
    TEST_ASSERT_FALSE(derive_effective(&key[UNIT_PIXEL].pixel));
    SET(zfunc, "less");
    SET(zwriteenable, "false");
    set_number(TRIPTYCH_STATE_colorwriteenable, 0);
    derive();
    TEST_ASSERT_FALSE(derive_effective(&key[UNIT_PIXEL].pixel));
}

static void change_alpha_test(void)
{
    SET(alphafunc, "less");
    set_number(TRIPTYCH_STATE_alpharef, 77);
}

static void an_alpha_test_that_is_off_has_no_function(void)
{
    expect_same_keys(change_alpha_test);
    TEST_ASSERT_EQUAL_INT(COMPARE_NEVER, key[UNIT_PIXEL].pixel.alpha_discard);
}

static void change_alpha_test_to_always(void)
{
    SET(alphatestenable, "true");
    SET(alphafunc, "always");
}

static void an_alpha_test_that_always_passes_is_off(void)
{
    expect_same_keys(change_alpha_test_to_always);
}

static void change_alpha_reference(void)
{
    set_number(TRIPTYCH_STATE_alpharef, 200);
}

static void the_alpha_reference_is_in_the_job_alone(void)
{
    SET(alphatestenable, "true");
    SET(alphafunc, "greaterequal");
    expect_same_keys(change_alpha_reference);
    derive();
    TEST_ASSERT_EQUAL_INT(COMPARE_LESS, key[UNIT_PIXEL].pixel.alpha_discard);
    TEST_ASSERT_EQUAL_INT(200, job.alpha_reference);
    SET(alphafunc, "notequal");
    derive();
    TEST_ASSERT_EQUAL_INT(COMPARE_EQUAL, key[UNIT_PIXEL].pixel.alpha_discard);
}

static void an_alpha_test_that_never_passes_draws_nothing(void)
{
    union key nothing[UNIT_COUNT];
    SET(zfunc, "never");
    derive_keys(&state, PRIMITIVE_TRIANGLE, nothing);
    SET(zfunc, "less");
    SET(alphatestenable, "true");
    SET(alphafunc, "never");
    derive();
    TEST_ASSERT_FALSE(derive_effective(&key[UNIT_PIXEL].pixel));
    TEST_ASSERT_EQUAL_MEMORY(nothing, key, sizeof nothing);
}

/* Depth alone is written, and alpha decides where: its varyings are needed, its blending is not. */
static void depth_behind_an_alpha_test_needs_colours(void)
{
    state.texture[0] = &texture;
    SET(alphablendenable, "true");
    set_number(TRIPTYCH_STATE_colorwriteenable, 0);
    derive();
    TEST_ASSERT_EQUAL_INT(0, key[UNIT_PIXEL].pixel.texture[0]);
    SET(alphatestenable, "true");
    SET(alphafunc, "greater");
    derive();
    TEST_ASSERT_EQUAL_INT(1, key[UNIT_PIXEL].pixel.texture[0]);
    TEST_ASSERT_EQUAL_INT(INTERPOLATION_SMOOTH, key[UNIT_SETUP].setup.varying[VARYING_texcoord0]);
    TEST_ASSERT_EQUAL_INT(BLEND_COPY, key[UNIT_PIXEL].pixel.blend[BLEND_COLOR]);
    SET(zwriteenable, "false");
    derive();
    TEST_ASSERT_EQUAL_INT(0, key[UNIT_PIXEL].pixel.texture[0]);
    TEST_ASSERT_EQUAL_INT(COMPARE_NEVER, key[UNIT_PIXEL].pixel.alpha_discard);
}

static void change_colour_stage(void)
{
    SET_STAGE(0, colorop, "add");
    SET_STAGE(0, colorarg2, "tfactor");
}

static void where_alpha_alone_is_looked_at_the_colour_stage_is_dead(void)
{
    state.texture[0] = &texture;
    set_number(TRIPTYCH_STATE_colorwriteenable, 0);
    SET(alphatestenable, "true");
    SET(alphafunc, "greater");
    expect_same_keys(change_colour_stage);
    TEST_ASSERT_EQUAL_INT(SOURCE_TEXTURE, key[UNIT_PIXEL].pixel.color_argument[0]);
    TEST_ASSERT_EQUAL_INT(INTERPOLATION_NONE, key[UNIT_PIXEL].pixel.varying[VARYING_diffuse]);
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

static void blending_is_reduced_to_what_it_does(void)
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

static void alpha_that_is_blended_like_colour_is_not_apart(void)
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

/* The two products of (srccolor, invsrcalpha) are rounded each, those of (srcalpha, invsrcalpha) together. */
static void alpha_that_is_rounded_otherwise_is_apart(void)
{
    set_blending("add", "srccolor", "invsrcalpha");
    set_alpha_blending("add", "srcalpha", "invsrcalpha");
    expect_blending(BLEND_COLOR, BLEND_ADD, FACTOR_SOURCE_COLOR, FACTOR_INVERSE_SOURCE_ALPHA);
    expect_blending(BLEND_ALPHA, BLEND_ADD, FACTOR_SOURCE_ALPHA, FACTOR_INVERSE_SOURCE_ALPHA);
    set_alpha_blending("add", "srccolor", "invsrcalpha");
    expect_blending(BLEND_ALPHA, BLEND_ADD, FACTOR_SOURCE_COLOR, FACTOR_INVERSE_SOURCE_ALPHA);
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
    set_number(TRIPTYCH_STATE_colorwriteenable, 7);
    expect_same_keys(change_alpha_blending);
    set_number(TRIPTYCH_STATE_colorwriteenable, 8);
    expect_same_keys(change_colour_blending);
    set_number(TRIPTYCH_STATE_colorwriteenable, 0);
    expect_same_keys(separate_own_colour);
}

static void channels_that_keep_what_is_stored_are_not_written(void)
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
    set_number(TRIPTYCH_STATE_blendfactor, 0x80402010);
}

static void the_blend_factor_is_in_the_job_alone(void)
{
    set_blending("add", "blendfactor", "one");
    expect_same_keys(change_blend_factor);
    derive();
    TEST_ASSERT_EQUAL_HEX32(0x80102040, job.blend_constant);
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

/* 0 - s * f is not 0 where there is room for it. */
static void differences_below_zero_stay_where_there_is_room(void)
{
    set_blending("subtract", "zero", "one");
    set_targets(TRIPTYCH_SURFACE_A8R8G8B8, 0);
    expect_blending(BLEND_COLOR, BLEND_ADD, FACTOR_ZERO, FACTOR_ZERO);
    set_targets(TRIPTYCH_SURFACE_A8R8G8B8, TRIPTYCH_SURFACE_A16B16G16R16F);
    expect_blending(BLEND_COLOR, BLEND_SUBTRACT, FACTOR_ZERO, FACTOR_ONE);
    set_number(TRIPTYCH_STATE_colorwriteenable1, 0);
    expect_blending(BLEND_COLOR, BLEND_ADD, FACTOR_ZERO, FACTOR_ZERO);
}

/* Of a target that is not written only the place it takes matters, and nothing of those behind the last. */
static void targets_that_are_not_written_are_places(void)
{
    const struct pixel_key *pixel = &key[UNIT_PIXEL].pixel;
    set_targets(TRIPTYCH_SURFACE_R5G6B5, TRIPTYCH_SURFACE_A16B16G16R16F);
    SET(ditherenable, "true");
    derive();
    TEST_ASSERT_EQUAL_INT(TARGET_565, pixel->target[0]);
    TEST_ASSERT_EQUAL_INT(TARGET_HALF, pixel->target[1]);
    TEST_ASSERT_EQUAL_INT(7, pixel->write_mask[0]);
    TEST_ASSERT_TRUE(pixel->float_color && pixel->dither);
    set_number(TRIPTYCH_STATE_colorwriteenable, 8);
    derive();
    TEST_ASSERT_EQUAL_INT(TARGET_8888, pixel->target[0]);
    TEST_ASSERT_EQUAL_INT(0, pixel->write_mask[0]);
    TEST_ASSERT_TRUE(pixel->float_color && !pixel->dither);
    set_number(TRIPTYCH_STATE_colorwriteenable, 1);
    set_number(TRIPTYCH_STATE_colorwriteenable1, 0);
    derive();
    TEST_ASSERT_EQUAL_INT(TARGET_565, pixel->target[0]);
    TEST_ASSERT_EQUAL_INT(0, pixel->target[1]);
    TEST_ASSERT_TRUE(!pixel->float_color && pixel->dither);
}

static void alpha_alone_is_not_encoded(void)
{
    const struct pixel_key *pixel = &key[UNIT_PIXEL].pixel;
    SET(srgbwriteenable, "true");
    derive();
    TEST_ASSERT_EQUAL_INT(TARGET_SRGB, pixel->target[0]);
    TEST_ASSERT_TRUE(pixel->float_color);
    set_number(TRIPTYCH_STATE_colorwriteenable, 8);
    derive();
    TEST_ASSERT_EQUAL_INT(TARGET_8888, pixel->target[0]);
    TEST_ASSERT_FALSE(pixel->float_color);
}

/* A stage that only displaces is sampled for the next one, which must need it. */
static void bump_maps_are_sampled_for_the_stage_behind_them(void)
{
    const struct pixel_key *pixel = &key[UNIT_PIXEL].pixel;
    state.texture[0] = state.texture[1] = &texture;
    SET_STAGE(0, colorop, "bumpenvmap");
    SET_STAGE(1, colorop, "modulate");
    derive();
    TEST_ASSERT_TRUE(pixel->texture[0] && pixel->texture[1] && pixel->bump[1] == BUMP_DISPLACED);
    TEST_ASSERT_TRUE(pixel->float_color);
    SET_STAGE(1, colorop, "selectarg2");
    derive();
    TEST_ASSERT_FALSE(pixel->stages || pixel->texture[0] || pixel->bump[1] || pixel->float_color);
}

/* --- Samplers --- */

static void wrapping_a_power_of_two_is_told_apart(void)
{
    state.texture[0] = &texture;
    derive();
    TEST_ASSERT_EQUAL_INT(ADDRESS_WRAP_POWER, key[UNIT_PIXEL].pixel.address_u[0]);
    TEST_ASSERT_EQUAL_INT(ADDRESS_WRAP, key[UNIT_PIXEL].pixel.address_v[0]);
    SET_SAMPLER(0, addressu, "clamp");
    derive();
    TEST_ASSERT_EQUAL_INT(ADDRESS_CLAMP, key[UNIT_PIXEL].pixel.address_u[0]);
}

static void addressing_follows_the_axis(void)
{
    static const struct {
        const char *word;
        int u, v; /* 64 and 48 texels */
    } modes[] = {{"wrap", ADDRESS_WRAP_POWER, ADDRESS_WRAP},
                 {"mirror", ADDRESS_MIRROR_POWER, ADDRESS_MIRROR},
                 {"clamp", ADDRESS_CLAMP, ADDRESS_CLAMP},
                 {"border", ADDRESS_BORDER, ADDRESS_BORDER},
                 {"mirroronce", ADDRESS_MIRROR_ONCE, ADDRESS_MIRROR_ONCE}};
    state.texture[0] = &texture;
    for (size_t i = 0; i < sizeof modes / sizeof *modes; i++) {
        SET_SAMPLER(0, addressu, modes[i].word);
        SET_SAMPLER(0, addressv, modes[i].word);
        derive();
        TEST_ASSERT_EQUAL_INT(modes[i].u, key[UNIT_PIXEL].pixel.address_u[0]);
        TEST_ASSERT_EQUAL_INT(modes[i].v, key[UNIT_PIXEL].pixel.address_v[0]);
    }
}

static void change_unread_arguments(void)
{
    SET_STAGE(0, colorarg0, "tfactor_complement");
    SET_STAGE(0, colorarg2, "tfactor");
    SET_STAGE(0, alphaarg0, "tfactor");
    SET_STAGE(0, alphaarg1, "texture_alphareplicate");
    set_number(TRIPTYCH_STATE_texturefactor, 0x12345678);
}

static void arguments_that_are_not_read_are_dead(void)
{
    state.texture[0] = &texture;
    SET_STAGE(0, colorop, "selectarg1");
    expect_same_keys(change_unread_arguments);
    derive();
    TEST_ASSERT_EQUAL_HEX32(0, job.texture_factor);
    SET_STAGE(0, colorop, "addsmooth");
    derive();
    TEST_ASSERT_EQUAL_HEX32(0x12785634, job.texture_factor);
}

static void use_the_general_operation(void)
{
    SET_STAGE(0, colorop, "lerp");
    SET_STAGE(0, colorarg0, "texture_alphareplicate");
}

static void blends_are_interpolations(void)
{
    state.texture[0] = &texture;
    SET_STAGE(0, colorop, "blendtexturealpha");
    expect_same_keys(use_the_general_operation);
}

static void unbind_what_is_not_read(void)
{
    state.texture[0] = NULL;
    bind(TRIPTYCH_TEXCOORD, TRIPTYCH_FORMAT_NONE);
}

static void a_stage_without_texture_arguments_needs_no_texture(void)
{
    state.texture[0] = &texture;
    SET_STAGE(0, colorarg1, "tfactor");
    SET_STAGE(0, alphaarg1, "diffuse");
    expect_same_keys(unbind_what_is_not_read);
    TEST_ASSERT_EQUAL_INT(STAGE_MODULATE, key[UNIT_PIXEL].pixel.color_stage[0]);
    TEST_ASSERT_EQUAL_INT(INTERPOLATION_NONE, key[UNIT_PIXEL].pixel.varying[VARYING_texcoord0]);
}

static void change_alpha_stage(void)
{
    SET_STAGE(0, alphaop, "add");
    SET_STAGE(0, alphaarg1, "tfactor");
}

static void a_dot_product_is_alpha_too(void)
{
    state.texture[0] = &texture;
    SET_STAGE(0, colorop, "dotproduct3");
    expect_same_keys(change_alpha_stage);
}

static void a_disabled_stage_passes_diffuse(void)
{
    state.texture[0] = &texture;
    SET_STAGE(0, colorop, "disable");
    expect_same_keys(change_alpha_stage);
    TEST_ASSERT_EQUAL_INT(0, key[UNIT_PIXEL].pixel.texture[0]);
    TEST_ASSERT_EQUAL_INT(INTERPOLATION_SMOOTH, key[UNIT_PIXEL].pixel.varying[VARYING_diffuse]);
}

static void change_border_colour(void)
{
    state_set_value(&state, TRIPTYCH_SAMPLER_STATES, 0, TRIPTYCH_SAMPLER_bordercolor, 0x11223344, NULL);
}

static void the_border_colour_is_the_jobs(void)
{
    state.texture[0] = &texture;
    SET_SAMPLER(0, addressv, "border");
    expect_same_keys(change_border_colour);
    derive();
    TEST_ASSERT_EQUAL_HEX32(0x11443322, job.texture[0].border);
    SET_SAMPLER(0, addressv, "wrap");
    derive();
    TEST_ASSERT_EQUAL_HEX32(0, job.texture[0].border);
}

static void flat_shading_concerns_diffuse_only(void)
{
    state.texture[0] = &texture;
    SET(shademode, "flat");
    derive();
    TEST_ASSERT_EQUAL_INT(INTERPOLATION_FLAT, key[UNIT_PIXEL].pixel.varying[VARYING_diffuse]);
    TEST_ASSERT_EQUAL_INT(INTERPOLATION_SMOOTH, key[UNIT_PIXEL].pixel.varying[VARYING_texcoord0]);
    TEST_ASSERT_EQUAL_MEMORY(key[UNIT_PIXEL].pixel.varying, key[UNIT_SETUP].setup.varying, VARYING_COUNT);
}

static void move_light(void)
{
    state.light[6] = state.light[3];
    state.light_enabled[6] = 1;
    state.light_enabled[3] = 0;
}

static void lights_are_packed_to_the_front(void)
{
    state.light_enabled[1] = state.light_enabled[3] = 1;
    state.light[3].type = TRIPTYCH_LIGHT_POINT;
    state.light[3].range = 5;
    expect_same_keys(move_light);
    TEST_ASSERT_EQUAL_INT(LIGHT_DIRECTIONAL, key[UNIT_VERTEX].vertex.light[0]);
    TEST_ASSERT_EQUAL_INT(LIGHT_POINT, key[UNIT_VERTEX].vertex.light[1]);
    TEST_ASSERT_EQUAL_INT(LIGHT_NONE, key[UNIT_VERTEX].vertex.light[2]);
    derive();
    TEST_ASSERT_EQUAL_FLOAT(5, job.light[1].range);
}

static void change_normals(void)
{
    SET(normalizenormals, "true");
    bind(TRIPTYCH_NORMAL, TRIPTYCH_FORMAT_NONE);
}

static void without_lights_normals_are_dead(void)
{
    SET(colorvertex, "false");
    expect_same_keys(change_normals);
    TEST_ASSERT_EQUAL_INT(1, key[UNIT_VERTEX].vertex.lighting);
    TEST_ASSERT_EQUAL_INT(ATTRIBUTE_FORMAT_NONE, key[UNIT_VERTEX].vertex.attribute[ATTRIBUTE_DIFFUSE]);
}

static void formats_are_cut_to_what_is_read(void)
{
    state.texture[0] = &texture;
    state.light_enabled[0] = 1;
    bind(TRIPTYCH_TEXCOORD, TRIPTYCH_FORMAT_FLOAT4);
    bind(TRIPTYCH_NORMAL, TRIPTYCH_FORMAT_FLOAT4);
    bind(TRIPTYCH_POSITION, TRIPTYCH_FORMAT_FLOAT4);
    derive();
    const uint8_t *format = key[UNIT_VERTEX].vertex.attribute;
    TEST_ASSERT_EQUAL_INT(ATTRIBUTE_FORMAT_FLOAT2, format[ATTRIBUTE_TEXCOORD]);
    TEST_ASSERT_EQUAL_INT(ATTRIBUTE_FORMAT_FLOAT3, format[ATTRIBUTE_NORMAL]);
    TEST_ASSERT_EQUAL_INT(ATTRIBUTE_FORMAT_FLOAT4, format[ATTRIBUTE_POSITION]);
}

/* --- Job --------------------------------------------------------------------------------------------------
 */

static void attributes_point_at_the_first_vertex(void)
{
    derive();
    TEST_ASSERT_EQUAL_PTR(buffer.data + 16, job.attribute[ATTRIBUTE_POSITION].data);
    TEST_ASSERT_EQUAL_INT(32, job.attribute[ATTRIBUTE_POSITION].stride);
    TEST_ASSERT_NULL(job.attribute[ATTRIBUTE_TEXCOORD].data);
}

static void the_viewport_maps_ndc_to_subpixels(void)
{
    state_set_viewport(&state, &(struct triptych_viewport){100, 20, 300, 200, 0.25f, 0.75f}, 640, 480, NULL);
    derive();
    TEST_ASSERT_EQUAL_FLOAT(100 * 256, -job.scale_x + job.offset_x);
    TEST_ASSERT_EQUAL_FLOAT(400 * 256, job.scale_x + job.offset_x);
    TEST_ASSERT_EQUAL_FLOAT(20 * 256, job.scale_y + job.offset_y);
    TEST_ASSERT_EQUAL_FLOAT(220 * 256, -job.scale_y + job.offset_y);
    TEST_ASSERT_EQUAL_FLOAT(0.25f, job.depth_offset);
    TEST_ASSERT_EQUAL_FLOAT(0.5f, job.depth_scale);
}

static void the_guard_band_stays_within_its_limit_and_outside_the_frustum(void)
{
    static const struct triptych_viewport cases[] = {
        {0, 0, 8192, 8192, 0, 1}, {8191, 0, 1, 8192, 0, 1}, {0, 0, 1, 1, 0, 1}, {8191.5f, 3, .5f, 7, 0, 1}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, state_set_viewport(&state, &cases[i], 8192, 8192, NULL));
        derive();
        double x = (double)job.guard_x * (double)job.scale_x + (double)job.offset_x;
        double y = (double)job.guard_y * -(double)job.scale_y + (double)job.offset_y;
        TEST_ASSERT_TRUE(x <= 16383.5 * 256 && y <= 16383.5 * 256);
        TEST_ASSERT_TRUE(job.guard_x >= 2 && job.guard_y >= 2);
    }
}

static void expect_rectangle(int x0, int y0, int x1, int y1)
{
    struct rectangle r = derive_scissor(&state);
    TEST_ASSERT_EQUAL_INT(x0, r.x0);
    TEST_ASSERT_EQUAL_INT(y0, r.y0);
    TEST_ASSERT_EQUAL_INT(x1, r.x1);
    TEST_ASSERT_EQUAL_INT(y1, r.y1);
}

static void set_scissor(uint32_t x, uint32_t y, uint32_t width, uint32_t height)
{
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK,
                          state_set_scissor(&state, (struct scissor){x, y, width, height}, 640, 480, NULL));
}

static void the_scissor_rectangle_cuts_the_viewport_while_its_test_is_on(void)
{
    state.viewport = (struct triptych_viewport){10, 20, 30, 40, 0, 1};
    set_scissor(15, 0, 100, 30);
    expect_rectangle(10, 20, 40, 60);
    SET(scissortestenable, "true");
    expect_rectangle(15, 20, 40, 30);
    set_scissor(12, 25, 3, 200);
    expect_rectangle(12, 25, 15, 60);
}

static void a_rectangle_beside_the_viewport_leaves_nothing(void)
{
    state.viewport = (struct triptych_viewport){10, 20, 30, 40, 0, 1};
    SET(scissortestenable, "true");
    set_scissor(0, 0, 5, 480);
    expect_rectangle(10, 20, 10, 60);
    set_scissor(100, 25, 0, 10);
    expect_rectangle(100, 25, 100, 35);
}

static void the_scissor_is_the_viewports_pixel_centres(void)
{
    state.viewport = (struct triptych_viewport){1.5f, 0.25f, 2, 1.5f, 0, 1};
    struct rectangle r = derive_scissor(&state);
    TEST_ASSERT_EQUAL_INT(1, r.x0);
    TEST_ASSERT_EQUAL_INT(3, r.x1);
    TEST_ASSERT_EQUAL_INT(0, r.y0);
    TEST_ASSERT_EQUAL_INT(2, r.y1);
}

static void matrices_multiply_in_row_order(void)
{
    float(*world)[4] = state.transform[TRIPTYCH_TRANSFORM_WORLD];
    float(*view)[4] = state.transform[TRIPTYCH_TRANSFORM_VIEW];
    world[0][0] = 2; /* scale x, then move x */
    view[3][0] = 10;
    state.transform[TRIPTYCH_TRANSFORM_PROJECTION][0][0] = 3;
    derive();
    TEST_ASSERT_EQUAL_FLOAT(2, job.world_view[0][0]);
    TEST_ASSERT_EQUAL_FLOAT(10, job.world_view[3][0]);
    TEST_ASSERT_EQUAL_FLOAT(6, job.world_view_projection[0][0]);
    TEST_ASSERT_EQUAL_FLOAT(30, job.world_view_projection[3][0]);
}

/* Normals times the normal matrix stay perpendicular to surfaces times world * view. */
static void the_normal_matrix_keeps_normals_perpendicular(void)
{
    static const float matrix[3][3] = {{1, 2, -1}, {0.5f, -3, 2}, {4, 0, 1.5f}};
    for (int i = 0; i < 3; i++)
        memcpy(state.transform[TRIPTYCH_TRANSFORM_WORLD][i], matrix[i], sizeof matrix[i]);
    state.light_enabled[0] = 1;
    derive();
    const float normal[3] = {1, 1, -2}, tangent[3] = {4, 2, 3};
    float n[3] = {0}, t[3] = {0};
    for (int c = 0; c < 3; c++)
        for (int r = 0; r < 3; r++) {
            n[c] += normal[r] * job.normal[r][c];
            t[c] += tangent[r] * job.world_view[r][c];
        }
    TEST_ASSERT_FLOAT_WITHIN(1e-5f, 0, n[0] * t[0] + n[1] * t[1] + n[2] * t[2]);
    TEST_ASSERT_TRUE(fabsf(n[0]) + fabsf(n[1]) + fabsf(n[2]) > 0.1f);
}

static void directional_lights_point_to_the_light_in_camera_space(void)
{
    state.light_enabled[0] = 1;
    state.light[0].direction[0] = 0;
    state.light[0].direction[2] = 5; /* travels along +z */
    float(*view)[4] = state.transform[TRIPTYCH_TRANSFORM_VIEW];
    view[2][2] = 0;
    view[2][0] = 1; /* z becomes x */
    view[0][0] = 0;
    view[0][2] = -1;
    derive();
    TEST_ASSERT_EQUAL_FLOAT(-1, job.light[0].position[0]);
    TEST_ASSERT_EQUAL_FLOAT(0, job.light[0].position[1]);
    TEST_ASSERT_EQUAL_FLOAT(0, job.light[0].position[2]);
}

static void base_colour_collects_what_no_vertex_changes(void)
{
    state.value[TRIPTYCH_STATE_ambient] = 0x00ff8000;
    SET(colorvertex, "false");
    state.material = (struct triptych_material){
        .diffuse = {.5f, 1, 1, .25f}, .ambient = {.5f, .5f, .5f, 1}, .emissive = {.125f, 0, 0, 1}};
    state.light_enabled[0] = state.light_enabled[1] = 1;
    state.light[0].ambient[2] = 1;
    state.light[1].type = TRIPTYCH_LIGHT_POINT;
    state.light[1].ambient[0] = 1;
    derive();
    TEST_ASSERT_EQUAL_FLOAT(.625f, job.base_color[0]);
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, .5f * 128 / 255, job.base_color[1]);
    TEST_ASSERT_EQUAL_FLOAT(.5f, job.base_color[2]);
    TEST_ASSERT_EQUAL_FLOAT(.25f, job.base_color[3]);
    TEST_ASSERT_EQUAL_FLOAT(.5f, job.light[0].diffuse[0]);
    TEST_ASSERT_EQUAL_FLOAT(.5f, job.light[1].ambient[0]);
}

static void the_job_does_not_depend_on_the_callers_rounding(void)
{
    struct job nearest;
    state.light_enabled[0] = 1;
    state.light[0].direction[0] = 0.3f;
    state.transform[TRIPTYCH_TRANSFORM_WORLD][0][1] = 0.1f;
    state.transform[TRIPTYCH_TRANSFORM_VIEW][1][2] = 0.7f;
    derive();
    nearest = job;
    unsigned saved = _mm_getcsr();
    _mm_setcsr(saved | _MM_ROUND_UP);
    derive();
    TEST_ASSERT_EQUAL_HEX32((saved | _MM_ROUND_UP) & ~0x3fu, _mm_getcsr() & ~0x3fu);
    _mm_setcsr(saved);
    TEST_ASSERT_EQUAL_MEMORY(&nearest, &job, sizeof job);
}

/* --- Primitives --------------------------------------------------------------------------------------------
 */

static void derive_as(enum primitive primitive)
{
    derive_keys(&state, primitive, key);
    derive_job(&state, &key[UNIT_VERTEX].vertex, &key[UNIT_PIXEL].pixel, &job);
}

static void fill_modes_are_for_triangles(void)
{
    static const struct {
        const char *mode;
        enum primitive primitive;
    } modes[] = {{"solid", PRIMITIVE_TRIANGLE}, {"wireframe", PRIMITIVE_EDGE}, {"point", PRIMITIVE_CORNER}};
    for (int i = 0; i < 3; i++) {
        SET(fillmode, modes[i].mode);
        TEST_ASSERT_EQUAL_INT(modes[i].primitive, derive_primitive(&state, TRIPTYCH_TRIANGLE_LIST));
        TEST_ASSERT_EQUAL_INT(modes[i].primitive, derive_primitive(&state, TRIPTYCH_TRIANGLE_STRIP));
        TEST_ASSERT_EQUAL_INT(modes[i].primitive, derive_primitive(&state, TRIPTYCH_TRIANGLE_FAN));
        TEST_ASSERT_EQUAL_INT(PRIMITIVE_POINT, derive_primitive(&state, TRIPTYCH_POINT_LIST));
        TEST_ASSERT_EQUAL_INT(PRIMITIVE_LINE, derive_primitive(&state, TRIPTYCH_LINE_LIST));
        TEST_ASSERT_EQUAL_INT(PRIMITIVE_LINE, derive_primitive(&state, TRIPTYCH_LINE_STRIP));
    }
}

static void culling_and_depth_bias_are_for_triangles_and_their_parts(void)
{
    SET(cullmode, "cw");
    set_number(TRIPTYCH_STATE_depthbias, 0x3a000000);
    for (int p = 0; p < PRIMITIVE_COUNT; p++) {
        derive_as((enum primitive)p);
        int has_area = p != PRIMITIVE_LINE && p != PRIMITIVE_POINT;
        TEST_ASSERT_EQUAL_INT(p, key[UNIT_SETUP].setup.primitive);
        TEST_ASSERT_EQUAL_INT(has_area ? CULL_CLOCKWISE : CULL_NONE, key[UNIT_SETUP].setup.cull);
        TEST_ASSERT_EQUAL_INT(has_area ? DEPTH_BIAS_CONSTANT : DEPTH_BIAS_NONE,
                              key[UNIT_SETUP].setup.depth_bias);
    }
}

static void depth_bias_is_as_much_as_is_needed(void)
{
    derive_as(PRIMITIVE_TRIANGLE);
    TEST_ASSERT_EQUAL_INT(DEPTH_BIAS_NONE, key[UNIT_SETUP].setup.depth_bias);
    set_number(TRIPTYCH_STATE_depthbias, 0x80000000); /* -0 */
    set_number(TRIPTYCH_STATE_slopescaledepthbias, 0x80000000);
    derive_as(PRIMITIVE_TRIANGLE);
    TEST_ASSERT_EQUAL_INT(DEPTH_BIAS_NONE, key[UNIT_SETUP].setup.depth_bias);
    set_number(TRIPTYCH_STATE_slopescaledepthbias, 0x3f800000);
    derive_as(PRIMITIVE_TRIANGLE);
    TEST_ASSERT_EQUAL_INT(DEPTH_BIAS_SLOPE, key[UNIT_SETUP].setup.depth_bias);
    TEST_ASSERT_EQUAL_FLOAT(1, job.depth_bias_slope);
    SET(zenable, "false");
    derive_as(PRIMITIVE_TRIANGLE);
    TEST_ASSERT_EQUAL_INT(DEPTH_BIAS_NONE, key[UNIT_SETUP].setup.depth_bias);
}

static void points_are_flat_but_for_a_sprites_coordinates(void)
{
    state.texture[0] = &texture;
    state.light_enabled[0] = 1;
    for (int sprite = 0; sprite < 2; sprite++) {
        SET(pointspriteenable, sprite ? "true" : "false");
        derive_as(PRIMITIVE_POINT);
        TEST_ASSERT_EQUAL_INT(INTERPOLATION_FLAT, key[UNIT_PIXEL].pixel.varying[VARYING_diffuse]);
        TEST_ASSERT_EQUAL_INT(sprite ? INTERPOLATION_SMOOTH : INTERPOLATION_FLAT,
                              key[UNIT_PIXEL].pixel.varying[VARYING_texcoord0]);
        TEST_ASSERT_EQUAL_INT(!sprite, key[UNIT_VERTEX].vertex.varying[VARYING_texcoord0]);
        TEST_ASSERT_EQUAL_INT(sprite ? ATTRIBUTE_FORMAT_NONE : ATTRIBUTE_FORMAT_FLOAT2,
                              key[UNIT_VERTEX].vertex.attribute[ATTRIBUTE_TEXCOORD]);
        derive_as(PRIMITIVE_LINE);
        TEST_ASSERT_EQUAL_INT(INTERPOLATION_SMOOTH, key[UNIT_PIXEL].pixel.varying[VARYING_texcoord0]);
    }
}

/* World planes against a camera that moves the world by (0, 0, 4) and a projection that makes w of z. */
static void clip_planes_are_packed_and_in_clip_space(void)
{
    static const float move[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 4, 1}};
    static const float project[4][4] = {{2, 0, 0, 0}, {0, 2, 0, 0}, {0, 0, 1, 1}, {0, 0, -1, 0}};
    static const float planes[2][4] = {{1, -2, 0.5f, 0.25f}, {0, 0, -1, 3}};
    static const float points[][3] = {{1, 2, 2}, {-1, 0.5f, -2}, {4, -3, 9}};
    state_set_transform(&state, TRIPTYCH_TRANSFORM_VIEW, move, NULL);
    state_set_transform(&state, TRIPTYCH_TRANSFORM_PROJECTION, project, NULL);
    state_set_clip_plane(&state, 1, planes[0], NULL);
    state_set_clip_plane(&state, 4, planes[1], NULL);
    set_number(TRIPTYCH_STATE_clipplaneenable, 1 << 1 | 1 << 4);
    derive_as(PRIMITIVE_TRIANGLE);
    TEST_ASSERT_EQUAL_INT(2, key[UNIT_VERTEX].vertex.clip_planes);
    double ratio[2] = {0};
    for (int i = 0; i < 2; i++)
        for (int p = 0; p < 3; p++) {
            double world = (double)planes[i][3], clip = 0, z = (double)points[p][2] + 4;
            double at[4] = {2 * (double)points[p][0], 2 * (double)points[p][1], z - 1, z};
            for (int c = 0; c < 3; c++)
                world += (double)points[p][c] * (double)planes[i][c];
            for (int c = 0; c < 4; c++)
                clip += at[c] * (double)job.clip_plane[i][c];
            TEST_ASSERT_TRUE(clip / world > 0);
            if (p)
                TEST_ASSERT_DOUBLE_WITHIN(1e-5, ratio[i], clip / world);
            ratio[i] = clip / world;
        }
    SET(clipping, "false");
    derive_as(PRIMITIVE_TRIANGLE);
    TEST_ASSERT_EQUAL_INT(0, key[UNIT_VERTEX].vertex.clip_planes);
    TEST_ASSERT_EQUAL_HEX32(CLIP_DEPTH | CLIP_USER_ALL, derive_clip_ignored(&state));
}

/* Near at 1 and far at 11, with clip depth from 0 and from -w. */
static void w_buffers_know_the_depth_range(void)
{
    static const float direct3d[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1.1f, 1}, {0, 0, -1.1f, 0}};
    static const float opengl[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1.2f, 1}, {0, 0, -2.2f, 0}};
    for (unsigned minus = 0; minus < 2; minus++) {
        state_set_convention(&state, TRIPTYCH_DEPTH_RANGE, minus, NULL);
        state_set_transform(&state, TRIPTYCH_TRANSFORM_PROJECTION, minus ? opengl : direct3d, NULL);
        SET(zenable, "usew");
        derive_as(PRIMITIVE_TRIANGLE);
        TEST_ASSERT_FLOAT_WITHIN(1e-5f, 0.1f, job.w_scale);
        TEST_ASSERT_FLOAT_WITHIN(1e-5f, -0.1f, job.w_offset);
    }
}

static void conventions_move_the_window_and_the_depth(void)
{
    derive_as(PRIMITIVE_TRIANGLE);
    struct job before = job;
    state_set_convention(&state, TRIPTYCH_PIXEL_CENTER, TRIPTYCH_PIXEL_CENTER_INTEGER, NULL);
    state_set_convention(&state, TRIPTYCH_DEPTH_RANGE, TRIPTYCH_DEPTH_RANGE_MINUS, NULL);
    derive_as(PRIMITIVE_TRIANGLE);
    TEST_ASSERT_EQUAL_FLOAT(before.offset_x + 128, job.offset_x);
    TEST_ASSERT_EQUAL_FLOAT(before.offset_y + 128, job.offset_y);
    for (int i = 0; i < 4; i++) {
        const float *a = before.world_view_projection[i], *b = job.world_view_projection[i];
        TEST_ASSERT_EQUAL_FLOAT((a[2] + a[3]) / 2, b[2]);
        TEST_ASSERT_EQUAL_FLOAT(a[3], b[3]);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(without_a_texture_its_states_are_dead);
    RUN_TEST(without_colour_writes_nothing_colours);
    RUN_TEST(replacing_by_the_texture_kills_diffuse);
    RUN_TEST(depth_off_is_always_without_write);
    RUN_TEST(setup_computes_depth_exactly_when_pixels_read_it);
    RUN_TEST(equal_depth_needs_no_write);
    RUN_TEST(draws_without_effect_are_recognised);
    RUN_TEST(an_alpha_test_that_is_off_has_no_function);
    RUN_TEST(an_alpha_test_that_always_passes_is_off);
    RUN_TEST(the_alpha_reference_is_in_the_job_alone);
    RUN_TEST(an_alpha_test_that_never_passes_draws_nothing);
    RUN_TEST(depth_behind_an_alpha_test_needs_colours);
    RUN_TEST(where_alpha_alone_is_looked_at_the_colour_stage_is_dead);
    RUN_TEST(blending_is_reduced_to_what_it_does);
    RUN_TEST(alpha_that_is_blended_like_colour_is_not_apart);
    RUN_TEST(alpha_that_is_rounded_otherwise_is_apart);
    RUN_TEST(channels_that_are_not_written_are_blended_like_the_others);
    RUN_TEST(channels_that_keep_what_is_stored_are_not_written);
    RUN_TEST(the_blend_factor_is_in_the_job_alone);
    RUN_TEST(alpha_of_targets_without_one_is_known);
    RUN_TEST(differences_below_zero_stay_where_there_is_room);
    RUN_TEST(targets_that_are_not_written_are_places);
    RUN_TEST(alpha_alone_is_not_encoded);
    RUN_TEST(bump_maps_are_sampled_for_the_stage_behind_them);
    RUN_TEST(wrapping_a_power_of_two_is_told_apart);
    RUN_TEST(addressing_follows_the_axis);
    RUN_TEST(the_border_colour_is_the_jobs);
    RUN_TEST(arguments_that_are_not_read_are_dead);
    RUN_TEST(blends_are_interpolations);
    RUN_TEST(a_stage_without_texture_arguments_needs_no_texture);
    RUN_TEST(a_dot_product_is_alpha_too);
    RUN_TEST(a_disabled_stage_passes_diffuse);
    RUN_TEST(flat_shading_concerns_diffuse_only);
    RUN_TEST(lights_are_packed_to_the_front);
    RUN_TEST(without_lights_normals_are_dead);
    RUN_TEST(formats_are_cut_to_what_is_read);
    RUN_TEST(attributes_point_at_the_first_vertex);
    RUN_TEST(the_viewport_maps_ndc_to_subpixels);
    RUN_TEST(the_guard_band_stays_within_its_limit_and_outside_the_frustum);
    RUN_TEST(the_scissor_rectangle_cuts_the_viewport_while_its_test_is_on);
    RUN_TEST(a_rectangle_beside_the_viewport_leaves_nothing);
    RUN_TEST(the_scissor_is_the_viewports_pixel_centres);
    RUN_TEST(matrices_multiply_in_row_order);
    RUN_TEST(the_normal_matrix_keeps_normals_perpendicular);
    RUN_TEST(directional_lights_point_to_the_light_in_camera_space);
    RUN_TEST(base_colour_collects_what_no_vertex_changes);
    RUN_TEST(the_job_does_not_depend_on_the_callers_rounding);
    RUN_TEST(fill_modes_are_for_triangles);
    RUN_TEST(culling_and_depth_bias_are_for_triangles_and_their_parts);
    RUN_TEST(depth_bias_is_as_much_as_is_needed);
    RUN_TEST(points_are_flat_but_for_a_sprites_coordinates);
    RUN_TEST(clip_planes_are_packed_and_in_clip_space);
    RUN_TEST(conventions_move_the_window_and_the_depth);
    RUN_TEST(w_buffers_know_the_depth_range);
    return UNITY_END();
}
