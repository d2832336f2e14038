/* The parts of shaders and their constants that are in the keys: only what the shaders read.
 * tests/engines/specialize/audit.c tests the states. */
#include "tests/support/picture/situation.h"

#include "shader/program/program.h"

#include <stdlib.h>
#include <string.h>
#include <unity.h>

static struct situation situation;
static union key key[UNIT_COUNT], before[UNIT_COUNT];

void setUp(void)
{
    situation_start(&situation);
}

void tearDown(void)
{
}

static void derive(void)
{
    memcpy(before, key, sizeof key);
    derive_keys(&situation.state, derive_primitive(&situation.state, situation.drawn), key);
}

static void begin(const char *description)
{
    TEST_ASSERT_NULL(situation_add(&situation, description));
    derive();
}

static bool changed(enum unit unit)
{
    struct packed_key a = key_pack(unit, &before[unit]), b = key_pack(unit, &key[unit]);
    return !key_equal(&a, &b);
}

static const struct vertex_key *vertex(void)
{
    return &key[UNIT_VERTEX].vertex;
}

static const struct pixel_key *pixel(void)
{
    return &key[UNIT_PIXEL].pixel;
}

static void booleans_that_are_not_read_are_in_no_key(void)
{
    begin("vertex vertex_loops pixel pixel_branches texture 2 2d A8R8G8B8 64 booleans 0 65527 booleans 1 "
          "65503");
    begin("booleans 0 0 booleans 1 0");
    TEST_ASSERT_FALSE(changed(UNIT_VERTEX));
    TEST_ASSERT_FALSE(changed(UNIT_PIXEL));
    begin("booleans 0 8");
    TEST_ASSERT_TRUE(changed(UNIT_VERTEX));
    begin("booleans 1 32");
    TEST_ASSERT_TRUE(changed(UNIT_PIXEL));
    begin("vertex none pixel none");
    begin("booleans 0 65535 booleans 1 65535");
    TEST_ASSERT_FALSE(changed(UNIT_VERTEX));
    TEST_ASSERT_FALSE(changed(UNIT_PIXEL));
}

static void the_convention_of_products_is_in_keys_of_shaders_only(void)
{
    begin("");
    situation.state.convention[TRIPTYCH_MULTIPLY] = TRIPTYCH_MULTIPLY_LEGACY;
    derive();
    TEST_ASSERT_FALSE(changed(UNIT_VERTEX) || changed(UNIT_PIXEL));
    begin("vertex vertex_plain pixel pixel_plain");
    situation.state.convention[TRIPTYCH_MULTIPLY] = TRIPTYCH_MULTIPLY_IEEE;
    derive();
    TEST_ASSERT_TRUE(changed(UNIT_VERTEX) && changed(UNIT_PIXEL));
}

static void a_pixel_shader_without_effect_is_removed(void)
{
    begin("pixel pixel_plain state colorwriteenable 0");
    TEST_ASSERT_EQUAL_UINT32(0, key_program(pixel()->shader));
    begin("pixel pixel_deep");
    TEST_ASSERT_NOT_EQUAL(0, key_program(pixel()->shader));
    TEST_ASSERT_EQUAL_INT(1, pixel()->kills);
    TEST_ASSERT_EQUAL_INT(1, pixel()->depth_output);
    begin("state zenable false");
    TEST_ASSERT_EQUAL_UINT32(0, key_program(pixel()->shader));
    TEST_ASSERT_EQUAL_INT(0, pixel()->kills);
    begin("state colorwriteenable 15");
    TEST_ASSERT_EQUAL_INT(1, pixel()->kills);
    TEST_ASSERT_EQUAL_INT(0, pixel()->depth_output);
}

/* The declaration's other elements and components that no instruction reads do not matter. */
static void inputs_are_what_the_shader_reads_of_the_declaration(void)
{
    begin("vertex vertex_indexed attribute normal float4 attribute indices float4");
    TEST_ASSERT_EQUAL_INT(ATTRIBUTE_FORMAT_FLOAT3, vertex()->input[0]);
    TEST_ASSERT_EQUAL_INT(ATTRIBUTE_FORMAT_FLOAT1, vertex()->input[1]);
    TEST_ASSERT_EQUAL_INT(ATTRIBUTE_FORMAT_FLOAT3, vertex()->input[2]);
    TEST_ASSERT_EQUAL_INT(ATTRIBUTE_FORMAT_NONE, vertex()->input[3]);
    for (int i = 0; i < ATTRIBUTE_COUNT; i++)
        TEST_ASSERT_EQUAL_INT(ATTRIBUTE_FORMAT_NONE, vertex()->attribute[i]);
    begin("attribute specular none attribute diffuse none attribute texcoord float1 attribute weights none");
    TEST_ASSERT_FALSE(changed(UNIT_VERTEX));
    begin("attribute indices none");
    TEST_ASSERT_EQUAL_INT(ATTRIBUTE_FORMAT_NONE, vertex()->input[1]);
}

/* Both shaders have t0. The other outputs of vertex_loops have no link. */
static void outputs_that_are_not_requested_have_no_link(void)
{
    begin("vertex vertex_loops pixel pixel_deep");
    for (int i = 0; i < 4 * PORTS; i++) {
        int missing = i % 4 == 3 ? LINK_ONE : LINK_ZERO;
        TEST_ASSERT_EQUAL_INT(i / 4 == PORT_CHANNEL ? missing : LINK_FIXED, vertex()->link[i]);
    }
    begin("vertex vertex_plain");
    for (int c = 0; c < 4; c++)
        TEST_ASSERT_EQUAL_INT(LINK_OUTPUT + 4 * OUTPUT_COORDINATE + c, vertex()->link[4 * PORT_CHANNEL + c]);
    TEST_ASSERT_EQUAL_INT(0, vertex()->varying[VARYING_diffuse]);
    TEST_ASSERT_EQUAL_INT(LINK_FIXED, vertex()->fog_link);
    TEST_ASSERT_EQUAL_INT(LINK_FIXED, vertex()->size_link);
}

static void samplers_are_those_that_the_shader_samples(void)
{
    begin("pixel pixel_four texture 0 2d A8R8G8B8 64 texture 1 cube A8R8G8B8 64 texture 2 2d A8R8G8B8 64 "
          "texture 15 2d "
          "A8R8G8B8 64");
    TEST_ASSERT_EQUAL_INT(TEXTURE_2D, pixel()->texture[0]);
    TEST_ASSERT_EQUAL_INT(TEXTURE_CUBE, pixel()->texture[1]);
    TEST_ASSERT_EQUAL_INT(TEXTURE_NONE, pixel()->texture[2]);
    TEST_ASSERT_EQUAL_INT(TEXTURE_NONE, pixel()->texture[15]);
}

static void addresses_of_cubes_are_clamped_unless_the_convention_is_the_samplers(void)
{
    begin("pixel pixel_four texture 0 2d A8R8G8B8 64 texture 1 cube A8R8G8B8 64");
    TEST_ASSERT_EQUAL_INT(ADDRESS_WRAP_POWER, pixel()->address_u[0]);
    TEST_ASSERT_EQUAL_INT(ADDRESS_CLAMP, pixel()->address_u[1]);
    situation.state.convention[TRIPTYCH_CUBE_ADDRESS] = TRIPTYCH_CUBE_ADDRESS_SAMPLER;
    derive();
    TEST_ASSERT_EQUAL_INT(ADDRESS_WRAP_POWER, pixel()->address_u[1]);
    TEST_ASSERT_EQUAL_INT(ADDRESS_WRAP_POWER, pixel()->address_v[1]);
    TEST_ASSERT_EQUAL_INT(0, pixel()->address_w[1]);
}

/* Only lookups with the two samplers read t0. The second lookup divides by its fourth component. */
static void third_coordinates_are_linked_where_a_texture_reads_them(void)
{
    begin("pixel pixel_four texture 0 2d A8R8G8B8 64 texture 1 2d A8R8G8B8 64");
    TEST_ASSERT_EQUAL_INT(INTERPOLATION_SMOOTH, pixel()->varying[VARYING_texcoord0]);
    TEST_ASSERT_EQUAL_INT(INTERPOLATION_NONE, pixel()->varying[VARYING_third0]);
    TEST_ASSERT_EQUAL_INT(INTERPOLATION_SMOOTH, pixel()->varying[VARYING_divisor0]);
    begin("texture 1 cube A8R8G8B8 64");
    TEST_ASSERT_EQUAL_INT(INTERPOLATION_SMOOTH, pixel()->varying[VARYING_third0]);
    begin("texture 1 2d D24X8 64");
    TEST_ASSERT_EQUAL_INT(INTERPOLATION_SMOOTH, pixel()->varying[VARYING_third0]);
    begin("pixel pixel_deep");
    TEST_ASSERT_EQUAL_INT(INTERPOLATION_SMOOTH, pixel()->varying[VARYING_third0]);
}

static void targets_without_a_colour_are_not_written(void)
{
    begin("target 0 8888 15 target 1 8888 15 target 2 8888 15 target 3 8888 15 pixel pixel_branches");
    TEST_ASSERT_EQUAL_INT(15, pixel()->write_mask[0]);
    TEST_ASSERT_EQUAL_INT(0, pixel()->write_mask[1] | pixel()->write_mask[2] | pixel()->write_mask[3]);
    begin("pixel pixel_four");
    for (int t = 0; t < TARGETS; t++)
        TEST_ASSERT_EQUAL_INT(15, pixel()->write_mask[t]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(booleans_that_are_not_read_are_in_no_key);
    RUN_TEST(the_convention_of_products_is_in_keys_of_shaders_only);
    RUN_TEST(a_pixel_shader_without_effect_is_removed);
    RUN_TEST(inputs_are_what_the_shader_reads_of_the_declaration);
    RUN_TEST(outputs_that_are_not_requested_have_no_link);
    RUN_TEST(samplers_are_those_that_the_shader_samples);
    RUN_TEST(addresses_of_cubes_are_clamped_unless_the_convention_is_the_samplers);
    RUN_TEST(third_coordinates_are_linked_where_a_texture_reads_them);
    RUN_TEST(targets_without_a_colour_are_not_written);
    return UNITY_END();
}
