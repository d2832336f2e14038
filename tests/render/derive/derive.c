/* Derivation of pixel keys, and of the fields of setup and vertex keys that depend on them. States that draw
 * the same pixels have the same keys. */
#include "tests/support/picture/derivation.h"
#include "contract/key_query.h"

void setUp(void)
{
    derivation_begin();
}

void tearDown(void)
{
}

static void change_sampler(void)
{
    SET_SAMPLER(0, magfilter, "linear");
    SET_SAMPLER(0, addressu, "clamp");
    SET_SAMPLER(0, addressv, "clamp");
    SET_STAGE(0, colorop, "add");
    bind_attribute(TRIPTYCH_TEXCOORD, TRIPTYCH_FORMAT_FLOAT4);
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
    bind_attribute(TRIPTYCH_NORMAL, TRIPTYCH_FORMAT_NONE);
    bind_attribute(TRIPTYCH_DIFFUSE, TRIPTYCH_FORMAT_FLOAT4);
}

static void without_colour_writes_nothing_colours(void)
{
    state.texture[0] = &texture;
    state.light_enabled[0] = 1;
    set_value(TRIPTYCH_STATE_COLORWRITEENABLE, 0);
    expect_same_keys(change_everything_that_colours);
    TEST_ASSERT_EQUAL_INT(INTERPOLATION_NONE, key[UNIT_SETUP].setup.varying[VARYING_diffuse]);
    TEST_ASSERT_EQUAL_INT(0, key[UNIT_VERTEX].vertex.lighting);
    TEST_ASSERT_EQUAL_INT(1, key[UNIT_PIXEL].pixel.depth_write);
}

static void change_diffuse(void)
{
    SET(lighting, "false");
    SET(shademode, "flat");
    bind_attribute(TRIPTYCH_DIFFUSE, TRIPTYCH_FORMAT_FLOAT4);
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
    set_value(TRIPTYCH_STATE_COLORWRITEENABLE, 0);
    derive();
    TEST_ASSERT_FALSE(derive_effective(&key[UNIT_PIXEL].pixel));
}

static void change_alpha_test(void)
{
    SET(alphafunc, "less");
    set_value(TRIPTYCH_STATE_ALPHAREF, 77);
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
    set_value(TRIPTYCH_STATE_ALPHAREF, 200);
}

static void the_alpha_reference_is_only_in_the_job(void)
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

/* Only depth is written, and the alpha test decides which pixels. The varyings of alpha are needed, blending
 * is not. */
static void depth_after_an_alpha_test_needs_colours(void)
{
    state.texture[0] = &texture;
    SET(alphablendenable, "true");
    set_value(TRIPTYCH_STATE_COLORWRITEENABLE, 0);
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

static void where_only_alpha_is_read_the_colour_stage_is_dead(void)
{
    state.texture[0] = &texture;
    set_value(TRIPTYCH_STATE_COLORWRITEENABLE, 0);
    SET(alphatestenable, "true");
    SET(alphafunc, "greater");
    expect_same_keys(change_colour_stage);
    TEST_ASSERT_EQUAL_INT(SOURCE_TEXTURE, key[UNIT_PIXEL].pixel.color_argument[0]);
    TEST_ASSERT_EQUAL_INT(INTERPOLATION_NONE, key[UNIT_PIXEL].pixel.varying[VARYING_diffuse]);
}

/* --- Targets --- */

/* The texture of a bump map stage is sampled only if the next stage needs its offsets. */
static void bump_maps_are_sampled_for_the_next_stage(void)
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

static void wrapping_a_power_of_two_has_a_key_of_its_own(void)
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
    set_value(TRIPTYCH_STATE_TEXTUREFACTOR, 0x12345678);
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
    bind_attribute(TRIPTYCH_TEXCOORD, TRIPTYCH_FORMAT_NONE);
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
    state_set_value(&state, TRIPTYCH_SAMPLER_STATES, 0, TRIPTYCH_SAMPLER_BORDERCOLOR, 0x11223344, NULL);
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
    bind_attribute(TRIPTYCH_NORMAL, TRIPTYCH_FORMAT_NONE);
}

static void without_lights_normals_are_dead(void)
{
    SET(colorvertex, "false");
    expect_same_keys(change_normals);
    TEST_ASSERT_EQUAL_INT(1, key[UNIT_VERTEX].vertex.lighting);
    TEST_ASSERT_EQUAL_INT(ATTRIBUTE_FORMAT_NONE, key[UNIT_VERTEX].vertex.attribute[ATTRIBUTE_DIFFUSE]);
}

static void formats_have_only_the_components_that_are_read(void)
{
    state.texture[0] = &texture;
    state.light_enabled[0] = 1;
    bind_attribute(TRIPTYCH_TEXCOORD, TRIPTYCH_FORMAT_FLOAT4);
    bind_attribute(TRIPTYCH_NORMAL, TRIPTYCH_FORMAT_FLOAT4);
    bind_attribute(TRIPTYCH_POSITION, TRIPTYCH_FORMAT_FLOAT4);
    derive();
    const uint8_t *format = key[UNIT_VERTEX].vertex.attribute;
    TEST_ASSERT_EQUAL_INT(ATTRIBUTE_FORMAT_FLOAT2, format[ATTRIBUTE_TEXCOORD]);
    TEST_ASSERT_EQUAL_INT(ATTRIBUTE_FORMAT_FLOAT3, format[ATTRIBUTE_NORMAL]);
    TEST_ASSERT_EQUAL_INT(ATTRIBUTE_FORMAT_FLOAT4, format[ATTRIBUTE_POSITION]);
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
    RUN_TEST(the_alpha_reference_is_only_in_the_job);
    RUN_TEST(an_alpha_test_that_never_passes_draws_nothing);
    RUN_TEST(depth_after_an_alpha_test_needs_colours);
    RUN_TEST(where_only_alpha_is_read_the_colour_stage_is_dead);
    RUN_TEST(bump_maps_are_sampled_for_the_next_stage);
    RUN_TEST(wrapping_a_power_of_two_has_a_key_of_its_own);
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
    RUN_TEST(formats_have_only_the_components_that_are_read);
    return UNITY_END();
}
