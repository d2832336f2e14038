/* Declarations, streams and vertex formats: the positions of attributes, and calls that are refused and
 * change nothing. */
#include "contract/key.h"
#include "render/state/state.h"

#include <string.h>
#include <unity.h>

static struct state state;
static struct triptych_buffer buffer = {.bytes = 1024};
static struct error error;

void setUp(void)
{
    state_initialize(&state);
    error_clear(&error);
}

void tearDown(void)
{
}

static void expect_element(enum triptych_attribute attribute, enum triptych_format format, unsigned stream,
                           size_t offset)
{
    const struct state_element *element = &state.element[attribute];
    TEST_ASSERT_EQUAL_INT_MESSAGE(format, element->format, state_attribute_name[attribute]);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(stream, element->stream, state_attribute_name[attribute]);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(offset, element->offset, state_attribute_name[attribute]);
}

static void a_declaration_determines_the_position_of_each_attribute(void)
{
    static const struct triptych_declaration_element elements[] = {
        {0, 0, TRIPTYCH_FORMAT_FLOAT3, TRIPTYCH_USAGE_POSITION, 0},
        {0, 12, TRIPTYCH_FORMAT_DEC3N, TRIPTYCH_USAGE_NORMAL, 0},
        {15, 65535, TRIPTYCH_FORMAT_COLOR, TRIPTYCH_USAGE_COLOR, 1},
        {3, 8, TRIPTYCH_FORMAT_FLOAT16_2, TRIPTYCH_USAGE_TEXCOORD, 7},
        {3, 12, TRIPTYCH_FORMAT_FLOAT3, TRIPTYCH_USAGE_TANGENT, 0},
        {4, 0, TRIPTYCH_FORMAT_FLOAT3, TRIPTYCH_USAGE_POSITION, 1},
        {5, 0, TRIPTYCH_FORMAT_FLOAT2, TRIPTYCH_USAGE_TEXCOORD, 9}};
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, state_set_declaration(&state, elements, 7, &error));
    expect_element(TRIPTYCH_POSITION, TRIPTYCH_FORMAT_FLOAT3, 0, 0);
    expect_element(TRIPTYCH_NORMAL, TRIPTYCH_FORMAT_DEC3N, 0, 12);
    expect_element(TRIPTYCH_SPECULAR, TRIPTYCH_FORMAT_COLOR, 15, 65535);
    expect_element(TRIPTYCH_TEXCOORD7, TRIPTYCH_FORMAT_FLOAT16_2, 3, 8);
    expect_element(TRIPTYCH_POSITION1, TRIPTYCH_FORMAT_FLOAT3, 4, 0);
    expect_element(TRIPTYCH_DIFFUSE, TRIPTYCH_FORMAT_NONE, 0, 0);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, state_set_declaration(&state, NULL, 0, &error));
    expect_element(TRIPTYCH_POSITION, TRIPTYCH_FORMAT_NONE, 0, 0);
}

static void a_bad_declaration_changes_nothing(void)
{
    static const struct {
        struct triptych_declaration_element element;
        const char *part;
    } cases[] = {
        {{16, 0, TRIPTYCH_FORMAT_FLOAT1, TRIPTYCH_USAGE_NORMAL, 0}, "element 1: stream 16, expected 0 to 15"},
        {{0, 65536, TRIPTYCH_FORMAT_FLOAT1, TRIPTYCH_USAGE_NORMAL, 0},
         "element 1: offset 65536, expected 0 to 65535"},
        {{0, 0, TRIPTYCH_FORMAT_NONE, TRIPTYCH_USAGE_NORMAL, 0}, "element 1: format 0, expected 1 to 57"},
        {{0, 0, TRIPTYCH_FORMAT_COUNT, TRIPTYCH_USAGE_NORMAL, 0}, "element 1: format 58"},
        {{0, 0, TRIPTYCH_FORMAT_FLOAT1, TRIPTYCH_USAGE_COUNT, 0}, "element 1: usage 14, expected 0 to 13"},
        {{0, 0, TRIPTYCH_FORMAT_FLOAT1, TRIPTYCH_USAGE_NORMAL, 16}, "element 1: usage index 16"},
        {{0, 0, TRIPTYCH_FORMAT_FLOAT1, TRIPTYCH_USAGE_POSITION, 0},
         "element 1: usage 0 with index 0 again"}};
    struct triptych_declaration_element elements[65] = {
        {0, 0, TRIPTYCH_FORMAT_FLOAT3, TRIPTYCH_USAGE_POSITION, 0}};
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, state_set_declaration(&state, elements, 1, &error));
    struct state before = state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        elements[1] = cases[i].element;
        error_clear(&error);
        TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, state_set_declaration(&state, elements, 2, &error));
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error.text, cases[i].part), error.text);
    }
    error_clear(&error);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, state_set_declaration(&state, elements, 65, &error));
    TEST_ASSERT_EQUAL_STRING("declaration of 65 elements: expected at most 64", error.text);
    TEST_ASSERT_EQUAL_MEMORY(before.element, state.element, sizeof state.element);
}

/* Codes as in Direct3D 9's documentation; the parts are consecutive. */
static void vertex_formats_are_declarations_of_stream_0(void)
{
    TEST_ASSERT_EQUAL_INT(
        TRIPTYCH_OK,
        state_set_fvf(&state, 0x002 | 0x010 | 0x020 | 0x040 | 0x080 | 0x300 | 1u << 18 | 3u << 20, &error));
    expect_element(TRIPTYCH_POSITION, TRIPTYCH_FORMAT_FLOAT3, 0, 0);
    expect_element(TRIPTYCH_NORMAL, TRIPTYCH_FORMAT_FLOAT3, 0, 12);
    expect_element(TRIPTYCH_POINT_SIZE, TRIPTYCH_FORMAT_FLOAT1, 0, 24);
    expect_element(TRIPTYCH_DIFFUSE, TRIPTYCH_FORMAT_COLOR, 0, 28);
    expect_element(TRIPTYCH_SPECULAR, TRIPTYCH_FORMAT_COLOR, 0, 32);
    expect_element(TRIPTYCH_TEXCOORD, TRIPTYCH_FORMAT_FLOAT2, 0, 36);
    expect_element(TRIPTYCH_TEXCOORD1, TRIPTYCH_FORMAT_FLOAT3, 0, 44);
    expect_element(TRIPTYCH_TEXCOORD2, TRIPTYCH_FORMAT_FLOAT1, 0, 56);
    expect_element(TRIPTYCH_TEXCOORD3, TRIPTYCH_FORMAT_NONE, 0, 0);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, state_set_fvf(&state, 0x004, &error));
    expect_element(TRIPTYCH_POSITIONT, TRIPTYCH_FORMAT_FLOAT4, 0, 0);
    expect_element(TRIPTYCH_POSITION, TRIPTYCH_FORMAT_NONE, 0, 0);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, state_set_fvf(&state, 0x4002 | 0x800, &error));
    expect_element(TRIPTYCH_POSITION, TRIPTYCH_FORMAT_FLOAT4, 0, 0);
    expect_element(TRIPTYCH_TEXCOORD7, TRIPTYCH_FORMAT_FLOAT2, 0, 72);
}

static void weights_and_indices_share_the_betas(void)
{
    static const struct {
        uint32_t fvf;
        enum triptych_format weights, indices;
    } cases[] = {{0x006, TRIPTYCH_FORMAT_FLOAT1, TRIPTYCH_FORMAT_NONE},
                 {0x00c, TRIPTYCH_FORMAT_FLOAT4, TRIPTYCH_FORMAT_NONE},
                 {0x00a | 0x1000, TRIPTYCH_FORMAT_FLOAT2, TRIPTYCH_FORMAT_UBYTE4},
                 {0x006 | 0x1000, TRIPTYCH_FORMAT_NONE, TRIPTYCH_FORMAT_UBYTE4},
                 {0x00e | 0x8000, TRIPTYCH_FORMAT_FLOAT4, TRIPTYCH_FORMAT_COLOR},
                 {0x00e, TRIPTYCH_FORMAT_FLOAT4, TRIPTYCH_FORMAT_FLOAT1}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        size_t bytes = key_vertex_types[cases[i].weights].bytes;
        TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, state_set_fvf(&state, cases[i].fvf, &error));
        expect_element(TRIPTYCH_WEIGHTS, cases[i].weights, 0, cases[i].weights ? 12 : 0);
        expect_element(TRIPTYCH_INDICES, cases[i].indices, 0, cases[i].indices ? 12 + bytes : 0);
    }
}

static void bad_vertex_formats_are_refused(void)
{
    static const uint32_t codes[] = {
        0,    0x010, 0x4004, 0x002 | 0x900, 0x002 | 0x100 | 1u << 18, 0x002 | 0x1000 | 0x8000, 0x002 | 0x2000,
        0x003};
    for (size_t i = 0; i < sizeof codes / sizeof *codes; i++)
        TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, state_set_fvf(&state, codes[i], &error));
}

static void streams_are_checked(void)
{
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, state_set_stream(&state, 15, &buffer, 1020, 65536, &error));
    TEST_ASSERT_EQUAL_PTR(&buffer, state.stream[15].buffer);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, state_set_stream(&state, 16, &buffer, 0, 4, &error));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, state_set_stream(&state, 0, &buffer, 1024, 4, &error));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT, state_set_stream(&state, 0, &buffer, 0, 65537, &error));
    TEST_ASSERT_NULL(state.stream[0].buffer);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, state_set_stream(&state, 15, NULL, 0, 0, &error));
    TEST_ASSERT_NULL(state.stream[15].buffer);
}

static void streams_begin_at_any_byte(void)
{
    static const struct triptych_declaration_element element = {3, 5, TRIPTYCH_FORMAT_UBYTE3,
                                                                TRIPTYCH_USAGE_COLOR, 0};
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, state_set_declaration(&state, &element, 1, &error));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, state_set_stream(&state, 3, &buffer, 1023, 7, &error));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, state_set_stream(&state, 3, &buffer, 1, 7, &error));
    TEST_ASSERT_EQUAL_UINT64(1, state.stream[3].offset);
    TEST_ASSERT_EQUAL_UINT64(7, state.stream[3].stride);
    TEST_ASSERT_EQUAL_UINT64((1024 - 1 - 5 - 3) / 7,
                             state_last_vertex(&state, &state.element[TRIPTYCH_DIFFUSE]));
}

static void frequencies_are_checked(void)
{
    TEST_ASSERT_EQUAL_UINT32(1, state_instances(&state));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, state_set_frequency(&state, 0, TRIPTYCH_FREQUENCY_INDEXED, 9, &error));
    TEST_ASSERT_EQUAL_UINT32(9, state_instances(&state));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK,
                          state_set_frequency(&state, 2, TRIPTYCH_FREQUENCY_INSTANCE, 4, &error));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT,
                          state_set_frequency(&state, 0, TRIPTYCH_FREQUENCY_INSTANCE, 1, &error));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT,
                          state_set_frequency(&state, 1, TRIPTYCH_FREQUENCY_VERTEX, 2, &error));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT,
                          state_set_frequency(&state, 1, TRIPTYCH_FREQUENCY_INDEXED, 0, &error));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT,
                          state_set_frequency(&state, 1, TRIPTYCH_FREQUENCY_COUNT, 1, &error));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT,
                          state_set_frequency(&state, 16, TRIPTYCH_FREQUENCY_VERTEX, 1, &error));
}

static void the_last_vertex_is_the_last_whole_one(void)
{
    static const struct triptych_declaration_element element = {1, 4, TRIPTYCH_FORMAT_FLOAT3,
                                                                TRIPTYCH_USAGE_POSITION, 0};
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, state_set_declaration(&state, &element, 1, &error));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, state_set_stream(&state, 1, &buffer, 8, 20, &error));
    TEST_ASSERT_EQUAL_UINT64((1024 - 8 - 4 - 12) / 20,
                             state_last_vertex(&state, &state.element[TRIPTYCH_POSITION]));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_OK, state_set_stream(&state, 1, &buffer, 8, 0, &error));
    TEST_ASSERT_EQUAL_UINT64(UINT64_MAX, state_last_vertex(&state, &state.element[TRIPTYCH_POSITION]));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_declaration_determines_the_position_of_each_attribute);
    RUN_TEST(a_bad_declaration_changes_nothing);
    RUN_TEST(vertex_formats_are_declarations_of_stream_0);
    RUN_TEST(weights_and_indices_share_the_betas);
    RUN_TEST(bad_vertex_formats_are_refused);
    RUN_TEST(streams_are_checked);
    RUN_TEST(streams_begin_at_any_byte);
    RUN_TEST(frequencies_are_checked);
    RUN_TEST(the_last_vertex_is_the_last_whole_one);
    return UNITY_END();
}
