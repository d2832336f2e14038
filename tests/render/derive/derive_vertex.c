/* Derivation of vertex keys: a state that affects no vertex is not in the key. */
#include "render/derive/derive_part.h"

#include <unity.h>

static struct state state;
static struct triptych_buffer buffer = {.bytes = 1024};
static union key key[UNIT_COUNT];

static void bind(enum triptych_attribute attribute, enum triptych_format format)
{
    struct triptych_element element = {format, &buffer, 0, 32};
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, state_set_element(&state, attribute, &element, NULL));
}

static void set(enum triptych_state which, uint32_t value)
{
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK,
                          state_set_value(&state, TRIPTYCH_RENDER_STATES, 0, which, value, NULL));
}

#define SET(name, value) set((enum triptych_state)STATE_##name, value)

static const struct vertex_key *derive(void)
{
    derive_keys(&state, PRIMITIVE_TRIANGLE, key);
    return &key[UNIT_VERTEX].vertex;
}

static void expect_same_key(void (*change)(void))
{
    struct vertex_key before = *derive();
    change();
    TEST_ASSERT_EQUAL_MEMORY(&before, derive(), sizeof before);
}

void setUp(void)
{
    static uint8_t bytes[1024];
    buffer.data = bytes;
    state_initialize(&state);
    state_set_viewport(&state, &(struct triptych_viewport){0, 0, 64, 64, 0, 1}, NULL);
    bind(TRIPTYCH_POSITION, TRIPTYCH_FORMAT_FLOAT3);
    bind(TRIPTYCH_NORMAL, TRIPTYCH_FORMAT_FLOAT3);
    bind(TRIPTYCH_DIFFUSE, TRIPTYCH_FORMAT_COLOR);
    bind(TRIPTYCH_SPECULAR, TRIPTYCH_FORMAT_COLOR);
    state.light_enabled[3] = 1;
}

void tearDown(void)
{
}

static void change_highlights(void)
{
    SET(localviewer, 0);
    SET(specularmaterialsource, MATERIALSOURCE_material);
    state.material.power = 7;
}

static void without_specular_light_its_states_are_dead(void)
{
    expect_same_key(change_highlights);
    TEST_ASSERT_EQUAL_INT(HIGHLIGHT_NONE, key[UNIT_VERTEX].vertex.highlight);
}

static void the_materials_power_is_staged_where_it_is_simple(void)
{
    SET(specularenable, 1);
    state.material.power = 0;
    TEST_ASSERT_EQUAL_INT(HIGHLIGHT_FLAT, derive()->highlight);
    state.material.power = 1;
    TEST_ASSERT_EQUAL_INT(HIGHLIGHT_LINEAR, derive()->highlight);
    state.material.power = 1.5f;
    TEST_ASSERT_EQUAL_INT(HIGHLIGHT_POWER, derive()->highlight);
    state.light_enabled[3] = 0;
    TEST_ASSERT_EQUAL_INT(HIGHLIGHT_NONE, derive()->highlight);
}

static void change_sources(void)
{
    SET(diffusematerialsource, MATERIALSOURCE_material);
    SET(ambientmaterialsource, MATERIALSOURCE_color2);
    SET(emissivematerialsource, MATERIALSOURCE_color1);
}

static void without_vertex_colours_sources_are_dead(void)
{
    SET(colorvertex, 0);
    expect_same_key(change_sources);
    TEST_ASSERT_EQUAL_INT(ATTRIBUTE_FORMAT_NONE, key[UNIT_VERTEX].vertex.attribute[ATTRIBUTE_DIFFUSE]);
}

static void reflectances_come_from_the_colours_that_vertices_have(void)
{
    change_sources();
    const struct vertex_key *vertex = derive();
    TEST_ASSERT_EQUAL_INT(REFLECTANCE_MATERIAL, vertex->reflectance[REFLECTANCE_DIFFUSE]);
    TEST_ASSERT_EQUAL_INT(REFLECTANCE_SPECULAR_COLOR, vertex->reflectance[REFLECTANCE_AMBIENT]);
    TEST_ASSERT_EQUAL_INT(REFLECTANCE_DIFFUSE_COLOR, vertex->reflectance[REFLECTANCE_EMISSIVE]);
    bind(TRIPTYCH_SPECULAR, TRIPTYCH_FORMAT_NONE);
    TEST_ASSERT_EQUAL_INT(REFLECTANCE_MATERIAL, derive()->reflectance[REFLECTANCE_AMBIENT]);
}

static void a_spots_falloff_is_staged_where_it_is_one(void)
{
    state.light[3].type = TRIPTYCH_LIGHT_SPOT;
    state.light[3].falloff = 1;
    TEST_ASSERT_EQUAL_INT(LIGHT_SPOT, derive()->light[0]);
    state.light[3].falloff = 2;
    TEST_ASSERT_EQUAL_INT(LIGHT_SPOT_POWER, derive()->light[0]);
}

static void change_fog(void)
{
    SET(fogvertexmode, FOGMODE_linear);
    SET(rangefogenable, 1);
}

static void without_fog_and_with_table_fog_vertex_fog_is_dead(void)
{
    expect_same_key(change_fog);
    SET(fogenable, 1);
    TEST_ASSERT_EQUAL_INT(VERTEX_FOG_LINEAR, derive()->fog);
    TEST_ASSERT_EQUAL_INT(1, derive()->fog_range);
    SET(fogtablemode, FOGMODE_exp);
    TEST_ASSERT_EQUAL_INT(0, derive()->fog);
    TEST_ASSERT_EQUAL_INT(0, derive()->varying[VARYING_fog]);
}

static void change_blend_attributes(void)
{
    SET(indexedvertexblendenable, 1);
    bind(TRIPTYCH_WEIGHTS, TRIPTYCH_FORMAT_FLOAT3);
    bind(TRIPTYCH_INDICES, TRIPTYCH_FORMAT_UBYTE4);
    bind(TRIPTYCH_POSITION1, TRIPTYCH_FORMAT_FLOAT3);
}

static void without_blending_its_attributes_are_dead(void)
{
    expect_same_key(change_blend_attributes);
    SET(vertexblend, VERTEXBLEND_0weights);
    TEST_ASSERT_EQUAL_INT(1, derive()->matrices);
    TEST_ASSERT_EQUAL_INT(ATTRIBUTE_FORMAT_NONE, derive()->attribute[ATTRIBUTE_WEIGHTS]);
    SET(indexedvertexblendenable, 0);
    TEST_ASSERT_EQUAL_INT(0, derive()->matrices);
    SET(vertexblend, VERTEXBLEND_1weights);
    TEST_ASSERT_EQUAL_INT(2, derive()->matrices);
    TEST_ASSERT_EQUAL_INT(ATTRIBUTE_FORMAT_FLOAT1, derive()->attribute[ATTRIBUTE_WEIGHTS]);
    TEST_ASSERT_EQUAL_INT(ATTRIBUTE_FORMAT_NONE, derive()->attribute[ATTRIBUTE_INDICES]);
    SET(vertexblend, VERTEXBLEND_tweening);
    TEST_ASSERT_EQUAL_INT(1, derive()->tween);
    TEST_ASSERT_EQUAL_INT(ATTRIBUTE_FORMAT_FLOAT3, derive()->attribute[ATTRIBUTE_POSITION1]);
}

static void change_what_transforms(void)
{
    SET(lighting, 0);
    SET(normalizenormals, 1);
    SET(vertexblend, VERTEXBLEND_3weights);
    SET(fogvertexmode, FOGMODE_exp);
    bind(TRIPTYCH_POSITION, TRIPTYCH_FORMAT_FLOAT4);
}

static void vertices_in_window_coordinates_are_not_transformed_or_lit(void)
{
    bind(TRIPTYCH_POSITIONT, TRIPTYCH_FORMAT_FLOAT4);
    SET(fogenable, 1);
    expect_same_key(change_what_transforms);
    TEST_ASSERT_EQUAL_INT(0, key[UNIT_VERTEX].vertex.lighting);
    TEST_ASSERT_EQUAL_INT(1, key[UNIT_SETUP].setup.window);
    TEST_ASSERT_EQUAL_INT(ATTRIBUTE_FORMAT_NONE, key[UNIT_VERTEX].vertex.attribute[ATTRIBUTE_POSITION]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(without_specular_light_its_states_are_dead);
    RUN_TEST(the_materials_power_is_staged_where_it_is_simple);
    RUN_TEST(without_vertex_colours_sources_are_dead);
    RUN_TEST(reflectances_come_from_the_colours_that_vertices_have);
    RUN_TEST(a_spots_falloff_is_staged_where_it_is_one);
    RUN_TEST(without_fog_and_with_table_fog_vertex_fog_is_dead);
    RUN_TEST(without_blending_its_attributes_are_dead);
    RUN_TEST(vertices_in_window_coordinates_are_not_transformed_or_lit);
    return UNITY_END();
}
