/* The part of samplers in keys and job. Settings that give equal samples have one key, and the job has the
 * levels that the routine needs. */
#include "render/derive/derive.h"
#include "render/texture/format.h"

#include <string.h>
#include <unity.h>

static struct state state;
static struct triptych_texture texture;
static struct triptych_buffer buffer = {.bytes = 1024};
static union key key[UNIT_COUNT];
static struct job job;

static void describe(enum triptych_texture_type type, enum triptych_surface_format format, unsigned width,
                     unsigned height, unsigned depth, unsigned levels)
{
    static uint32_t texels[1 << 16];
    const struct triptych_texture_description description = {type, format, width, height, depth, levels};
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, texture_describe(&description, &texture, NULL));
    texture.texels = texels;
    state.texture[0] = &texture;
}

static void set_number(unsigned row, uint32_t value)
{
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, state_set_value(&state, TRIPTYCH_SAMPLER_STATES, 0, row, value, NULL));
}

static void set_sampler(unsigned row, const char *word)
{
    uint32_t value;
    TEST_ASSERT_EQUAL_INT_MESSAGE(
        0, triptych_value_number(triptych_state_at(TRIPTYCH_SAMPLER_STATES, row)->kind, word, &value), word);
    set_number(row, value);
}

#define SET_NUMBER(name, value) set_number(SAMPLER_##name, value)
#define SET(name, word)         set_sampler(SAMPLER_##name, word)

static const struct pixel_key *derive(void)
{
    derive_keys(&state, PRIMITIVE_TRIANGLE, key);
    derive_job(&state, &key[UNIT_VERTEX].vertex, &key[UNIT_PIXEL].pixel, &job);
    return &key[UNIT_PIXEL].pixel;
}

void setUp(void)
{
    static uint8_t bytes[1024];
    const struct triptych_element position = {TRIPTYCH_FORMAT_FLOAT3, &buffer, 0, 32};
    const struct triptych_element texcoord = {TRIPTYCH_FORMAT_FLOAT4, &buffer, 16, 32};
    buffer.data = bytes;
    state_initialize(&state);
    state_set_viewport(&state, &(struct triptych_viewport){0, 0, 64, 64, 0, 1}, NULL);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, state_set_element(&state, TRIPTYCH_POSITION, &position, NULL));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, state_set_element(&state, TRIPTYCH_TEXCOORD, &texcoord, NULL));
    describe(TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A8R8G8B8, 64, 48, 1, 0);
}

void tearDown(void)
{
}

static void expect_same(void (*change)(void))
{
    union key before[UNIT_COUNT];
    derive();
    memcpy(before, key, sizeof before);
    change();
    derive();
    TEST_ASSERT_EQUAL_MEMORY(before, key, sizeof before);
}

static void one_level_only(void)
{
    describe(TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A8R8G8B8, 64, 48, 1, 1);
}

static void filter_between_levels(void)
{
    SET(mipfilter, "linear");
}

static void a_texture_of_one_level_has_no_filter_between_levels(void)
{
    one_level_only();
    expect_same(filter_between_levels);
    TEST_ASSERT_EQUAL_INT(MIP_NONE, key[UNIT_PIXEL].pixel.mip[0]);
}

static void leave_only_the_last(void)
{
    SET_NUMBER(maxmiplevel, 6);
}

static void leave_more_than_there_are(void)
{
    SET_NUMBER(maxmiplevel, 4000000000u);
}

static void where_one_level_is_left_it_is_the_only_one(void)
{
    leave_only_the_last();
    SET(mipfilter, "point");
    expect_same(leave_more_than_there_are);
    TEST_ASSERT_EQUAL_INT(MIP_NONE, key[UNIT_PIXEL].pixel.mip[0]);
    TEST_ASSERT_EQUAL_INT(1, job.texture[0].width);
    TEST_ASSERT_EQUAL_PTR(texture.texels + texture.level[6].offset, job.texture[0].texels);
    TEST_ASSERT_EQUAL_INT(ADDRESS_WRAP_POWER, key[UNIT_PIXEL].pixel.address_v[0]); /* 1 texel, not 48 */
}

static void bias_levels(void)
{
    SET_NUMBER(mipmaplodbias, 0x3f000000); /* 0.5 */
}

static void without_a_filter_between_levels_the_first_is_sampled(void)
{
    expect_same(leave_only_the_last);
    TEST_ASSERT_EQUAL_INT(64, job.texture[0].width);
    expect_same(bias_levels);
}

static void bias_and_the_first_level_are_only_in_the_job(void)
{
    SET(mipfilter, "linear");
    expect_same(bias_levels);
    TEST_ASSERT_TRUE(job.texture[0].lod_offset == 128 - 2048);
    SET_NUMBER(maxmiplevel, 2);
    derive();
    TEST_ASSERT_EQUAL_INT(512, job.texture[0].first_level_256);
    TEST_ASSERT_EQUAL_INT(6 * 256, job.texture[0].last_level_256);
    TEST_ASSERT_EQUAL_PTR(texture.level, job.texture[0].levels);
    TEST_ASSERT_EQUAL_PTR(texture.texels, job.texture[0].texels);
    TEST_ASSERT_EQUAL_INT(MIP_LINEAR, key[UNIT_PIXEL].pixel.mip[0]);
}

static void anisotropic(void)
{
    SET(minfilter, "anisotropic");
    SET(magfilter, "anisotropic");
}

static void anisotropy_of_one_is_linear(void)
{
    SET(minfilter, "linear");
    SET(magfilter, "linear");
    expect_same(anisotropic);
    SET_NUMBER(maxanisotropy, 8);
    derive();
    TEST_ASSERT_EQUAL_INT(MINIFY_ANISOTROPIC, key[UNIT_PIXEL].pixel.minify[0]);
    TEST_ASSERT_EQUAL_INT(8, key[UNIT_PIXEL].pixel.anisotropy[0]);
}

static void more_anisotropy(void)
{
    SET_NUMBER(maxanisotropy, 16);
}

static void anisotropy_that_is_not_used_does_not_change_the_key(void)
{
    expect_same(more_anisotropy);
    TEST_ASSERT_EQUAL_INT(MINIFY_SAME, key[UNIT_PIXEL].pixel.minify[0]);
    SET(minfilter, "linear");
    TEST_ASSERT_EQUAL_INT(MINIFY_OTHER, derive()->minify[0]);
}

static void point_filters_of_levels_begin_late_if_the_convention_is_half(void)
{
    SET(magfilter, "linear");
    SET(minfilter, "point");
    SET(mipfilter, "none");
    TEST_ASSERT_EQUAL_INT(MINIFY_OTHER, derive()->minify[0]);
    state.convention[TRIPTYCH_MAGNIFY_LIMIT] = TRIPTYCH_MAGNIFY_LIMIT_HALF;
    TEST_ASSERT_EQUAL_INT(MINIFY_OTHER, derive()->minify[0]);
    SET(mipfilter, "point");
    TEST_ASSERT_EQUAL_INT(MINIFY_LATER, derive()->minify[0]);
    SET(magfilter, "point");
    SET(minfilter, "linear");
    TEST_ASSERT_EQUAL_INT(MINIFY_OTHER, derive()->minify[0]);
}

static void address_cube(void)
{
    SET(addressu, "border");
    SET(addressv, "mirror");
    SET(addressw, "mirroronce");
}

static void cubes_are_clamped_whatever_is_set(void)
{
    describe(TRIPTYCH_TEXTURE_CUBE, TRIPTYCH_SURFACE_A8R8G8B8, 32, 32, 1, 1);
    expect_same(address_cube);
    TEST_ASSERT_EQUAL_INT(TEXTURE_CUBE, key[UNIT_PIXEL].pixel.texture[0]);
    TEST_ASSERT_EQUAL_INT(ADDRESS_CLAMP, key[UNIT_PIXEL].pixel.address_u[0]);
    TEST_ASSERT_EQUAL_INT(33 * 32, job.texture[0].face_texels);
    TEST_ASSERT_EQUAL_INT(INTERPOLATION_SMOOTH, key[UNIT_PIXEL].pixel.varying[VARYING_third0]);
}

static void address_third(void)
{
    SET(addressw, "clamp");
}

static void only_volumes_address_w(void)
{
    expect_same(address_third);
    TEST_ASSERT_EQUAL_INT(INTERPOLATION_NONE, key[UNIT_PIXEL].pixel.varying[VARYING_third0]);
    describe(TRIPTYCH_TEXTURE_VOLUME, TRIPTYCH_SURFACE_A8R8G8B8, 8, 4, 5, 1);
    TEST_ASSERT_EQUAL_INT(ADDRESS_CLAMP, derive()->address_w[0]);
    SET(addressw, "mirror");
    TEST_ASSERT_EQUAL_INT(ADDRESS_MIRROR, derive()->address_w[0]);
    TEST_ASSERT_EQUAL_INT(4, job.texture[0].last_w);
    TEST_ASSERT_EQUAL_INT(36, job.texture[0].slice_texels);
}

static void decode_srgb(void)
{
    SET(srgbtexture, "true");
}

static void srgb_is_for_bytes(void)
{
    TEST_ASSERT_EQUAL_INT(TEXEL_BYTES, derive()->texel[0]);
    TEST_ASSERT_EQUAL_INT(0, key[UNIT_PIXEL].pixel.float_color);
    decode_srgb();
    TEST_ASSERT_EQUAL_INT(TEXEL_SRGB, derive()->texel[0]);
    TEST_ASSERT_EQUAL_INT(1, key[UNIT_PIXEL].pixel.float_color);
    SET(srgbtexture, "false");
    describe(TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_R16F, 8, 8, 1, 1);
    expect_same(decode_srgb);
    TEST_ASSERT_EQUAL_INT(TEXEL_FLOATS, key[UNIT_PIXEL].pixel.texel[0]);
}

static void depth_is_compared_with_a_third_coordinate(void)
{
    describe(TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_D24S8, 8, 8, 1, 1);
    TEST_ASSERT_EQUAL_INT(TEXEL_COMPARE, derive()->texel[0]);
    TEST_ASSERT_EQUAL_INT(INTERPOLATION_SMOOTH, key[UNIT_PIXEL].pixel.varying[VARYING_third0]);
    describe(TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_INTZ, 8, 8, 1, 1);
    TEST_ASSERT_EQUAL_INT(TEXEL_FLOATS, derive()->texel[0]);
    TEST_ASSERT_EQUAL_INT(INTERPOLATION_NONE, key[UNIT_PIXEL].pixel.varying[VARYING_third0]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_texture_of_one_level_has_no_filter_between_levels);
    RUN_TEST(where_one_level_is_left_it_is_the_only_one);
    RUN_TEST(without_a_filter_between_levels_the_first_is_sampled);
    RUN_TEST(bias_and_the_first_level_are_only_in_the_job);
    RUN_TEST(anisotropy_of_one_is_linear);
    RUN_TEST(anisotropy_that_is_not_used_does_not_change_the_key);
    RUN_TEST(point_filters_of_levels_begin_late_if_the_convention_is_half);
    RUN_TEST(cubes_are_clamped_whatever_is_set);
    RUN_TEST(only_volumes_address_w);
    RUN_TEST(srgb_is_for_bytes);
    RUN_TEST(depth_is_compared_with_a_third_coordinate);
    return UNITY_END();
}
