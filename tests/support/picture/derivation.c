#include "tests/support/picture/derivation.h"

struct state state;
struct triptych_buffer buffer = {.bytes = 1024};
struct triptych_texture texture;
union key key[UNIT_COUNT];
struct job job;

void bind_attribute(enum triptych_attribute attribute, enum triptych_format format)
{
    struct triptych_element element = {format, &buffer, 16, 32};
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, state_set_element(&state, attribute, &element, NULL));
}

void set_value(enum triptych_state which, uint32_t value)
{
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK,
                          state_set_value(&state, TRIPTYCH_RENDER_STATES, 0, which, value, NULL));
}

void set_word(enum triptych_state_table table, unsigned i, unsigned row, const char *word)
{
    uint32_t value;
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, triptych_value_number(triptych_state_at(table, row)->kind, word, &value),
                                  word);
    TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, state_set_value(&state, table, i, row, value, NULL), word);
}

void describe_texture(enum triptych_texture_type type, unsigned width, unsigned height, unsigned depth,
                      unsigned levels)
{
    const struct triptych_texture_description description = {
        type, TRIPTYCH_SURFACE_A8R8G8B8, width, height, depth, levels};
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, texture_describe(&description, &texture, NULL));
}

void derivation_begin(void)
{
    static uint8_t bytes[1024];
    describe_texture(TRIPTYCH_TEXTURE_2D, 64, 48, 1, 1);
    buffer.data = bytes;
    state_initialize(&state);
    state.width = 640;
    state.height = 480;
    state_set_viewport(&state, &(struct triptych_viewport){0, 0, 640, 480, 0, 1}, NULL);
    bind_attribute(TRIPTYCH_POSITION, TRIPTYCH_FORMAT_FLOAT3);
    bind_attribute(TRIPTYCH_NORMAL, TRIPTYCH_FORMAT_FLOAT3);
    bind_attribute(TRIPTYCH_DIFFUSE, TRIPTYCH_FORMAT_COLOR);
    bind_attribute(TRIPTYCH_TEXCOORD, TRIPTYCH_FORMAT_FLOAT2);
}

void derive(void)
{
    derive_keys(&state, PRIMITIVE_TRIANGLE, key);
    derive_job(&state, &key[UNIT_VERTEX].vertex, &key[UNIT_PIXEL].pixel, &job);
}

void expect_same_keys(void (*change)(void))
{
    union key before[UNIT_COUNT];
    derive_keys(&state, PRIMITIVE_TRIANGLE, before);
    change();
    derive_keys(&state, PRIMITIVE_TRIANGLE, key);
    TEST_ASSERT_EQUAL_MEMORY(before, key, sizeof before);
}
