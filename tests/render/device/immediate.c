/* Immediate draws: their vertices and indices are copied when they are queued. */
#include "tests/render/device/cover.h"

void setUp(void)
{
}

void tearDown(void)
{
    close_device();
}

static void immediate_vertices_are_copied(void)
{
    struct vertex vertex[3];
    triptych_buffer *bound;
    size_t offset, stride;
    open_device(1);
    triptych_buffer *buffer = cover(RED_ARGB);
    declare(buffer);
    make_cover(vertex, GREEN_ARGB);
    OK(triptych_draw_user(device, TRIPTYCH_TRIANGLE_LIST, 1, vertex, sizeof *vertex));
    memset(vertex, 0, sizeof vertex);
    OK(triptych_get_stream(device, 0, &bound, &offset, &stride));
    TEST_ASSERT_EQUAL_PTR(buffer, bound);
    TEST_ASSERT_EQUAL_UINT64(sizeof *vertex, stride);
    expect_all(GREEN);
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
    expect_all(RED);
}

/* Vertices of one stride share a job. */
static void immediate_draws_share_a_job(void)
{
    struct vertex vertex[3];
    open_device(1);
    OK(triptych_set_declaration(device, elements, 2));
    make_cover(vertex, GREEN_ARGB);
    for (int i = 0; i < 10; i++)
        OK(triptych_draw_user(device, TRIPTYCH_TRIANGLE_LIST, 1, vertex, sizeof *vertex));
    TEST_ASSERT_EQUAL_UINT32(1, device->queue->commands.jobs);
    expect_all(GREEN);
}

static void immediate_indices_are_copied(void)
{
    struct vertex vertex[4] = {{{0}, 0}};
    uint16_t index[6] = {3, 2, 1, 1, 1, 1};
    open_device(1);
    OK(triptych_set_declaration(device, elements, 2));
    make_cover(vertex + 1, RED_ARGB);
    OK(triptych_draw_indexed_user(device, TRIPTYCH_TRIANGLE_LIST, 2, index, 16, 4, vertex, sizeof *vertex));
    memset(index, 0, sizeof index);
    memset(vertex, 0, sizeof vertex);
    expect_all(RED);
}

/* Positions from immediate vertices, colours from a bound stream, as vertex 0 to 2 of each. */
static void other_streams_are_read_from_their_first_vertex(void)
{
    static const struct triptych_declaration_element two[] = {
        {0, 0, TRIPTYCH_FORMAT_FLOAT4, TRIPTYCH_USAGE_POSITION, 0},
        {1, 0, TRIPTYCH_FORMAT_COLOR, TRIPTYCH_USAGE_COLOR, 0}};
    const uint32_t color[6] = {RED_ARGB, RED_ARGB, RED_ARGB, 0, 0, 0};
    struct vertex vertex[3];
    open_device(1);
    make_cover(vertex, 0);
    OK(triptych_set_declaration(device, two, 2));
    triptych_buffer *colors = buffer_of(color, sizeof color);
    OK(triptych_set_stream(device, 1, colors, 0, 4));
    OK(triptych_draw_user(device, TRIPTYCH_TRIANGLE_LIST, 1, vertex, sizeof *vertex));
    OK(triptych_draw_user(device, TRIPTYCH_TRIANGLE_LIST, 1, vertex, sizeof *vertex));
    OK(triptych_buffer_update(device, colors, 0, color + 3, 12));
    expect_all(RED);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_CALL,
                          triptych_draw_user(device, TRIPTYCH_TRIANGLE_LIST, 3, vertex, sizeof *vertex));
}

/* Each instance is a command, and there are more of them than the queue has room for. */
static void immediate_instances_are_drawn(void)
{
    struct vertex vertex[3];
    open_device(2);
    make_cover(vertex, 0x01010101);
    OK(triptych_clear(device, (float[]){0, 0, 0, 0}, 1));
    OK(triptych_set_declaration(device, elements, 2));
    OK(triptych_set_state(device, TRIPTYCH_STATE_ZENABLE, 0));
    OK(triptych_set_state(device, TRIPTYCH_STATE_ALPHABLENDENABLE, 1));
    OK(triptych_set_state(device, TRIPTYCH_STATE_SRCBLEND, 2));
    OK(triptych_set_state(device, TRIPTYCH_STATE_DESTBLEND, 2));
    OK(triptych_set_viewport(device, &(struct triptych_viewport){0, 0, 2, 2, 0, 1}));
    OK(triptych_set_stream_frequency(device, 0, TRIPTYCH_FREQUENCY_INDEXED, QUEUE_COMMANDS + 100));
    for (int i = 0; i < 3; i++) {
        OK(triptych_set_viewport(device, &(struct triptych_viewport){(float)i * 2, 0, 2, 2, 0, 1}));
        OK(triptych_set_stream_frequency(device, 0, TRIPTYCH_FREQUENCY_INDEXED,
                                         (uint32_t[]){100, QUEUE_COMMANDS + 100, 1}[i]));
        OK(triptych_draw_indexed_user(device, TRIPTYCH_TRIANGLE_LIST, 1, (uint16_t[]){0, 1, 2}, 16, 3, vertex,
                                      sizeof *vertex));
    }
    read_image();
    TEST_ASSERT_EQUAL_HEX32(100 * 0x01010101u, pixel(0, 0));
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, pixel(2, 0));
    TEST_ASSERT_EQUAL_HEX32(0x01010101, pixel(4, 0));
}

/* Vertices of an odd number of bytes, whose elements begin at odd ones, with indices after them: a few, and
 * more bytes than transient memory has. */
static void immediate_vertices_have_any_alignment(void)
{
    enum { STRIDE = sizeof(struct vertex) + 3, MOST = 200003 };
    static const struct triptych_declaration_element odd[] = {
        {0, 3, TRIPTYCH_FORMAT_FLOAT4, TRIPTYCH_USAGE_POSITION, 0},
        {0, 0, TRIPTYCH_FORMAT_UBYTE3N, TRIPTYCH_USAGE_COLOR, 0}};
    static uint8_t data[MOST * STRIDE];
    static const uint32_t counts[] = {3, 5, 7, MOST};
    _Static_assert(sizeof data > TRANSIENT_BYTES, "more than transient memory");
    struct vertex vertex[3];
    make_cover(vertex, 0);
    open_device(1);
    OK(triptych_set_declaration(device, odd, 2));
    for (int i = 0; i < 4; i++) {
        uint32_t count = counts[i], index[3];
        for (uint32_t v = 0; v < 3; v++) {
            uint8_t *at = data + (count - 3 + v) * STRIDE;
            memcpy(at, (uint8_t[]){i % 2 ? 255 : 0, i % 2 ? 0 : 255, 0}, 3);
            memcpy(at + 3, vertex + v, sizeof *vertex);
            index[v] = count - 3 + v;
        }
        OK(triptych_draw_indexed_user(device, TRIPTYCH_TRIANGLE_LIST, 1, index, 32, count, data, STRIDE));
        expect_all(i % 2 ? RED : GREEN);
    }
}

/* More bytes than transient memory has. */
static void large_immediate_draws_are_copied_too(void)
{
    static struct vertex vertex[300000];
    static uint32_t index[300000];
    enum { COUNT = 300000 };
    _Static_assert(sizeof vertex > TRANSIENT_BYTES, "more than transient memory");
    for (unsigned threads = 1; threads <= 2; threads++) {
        open_device(threads);
        OK(triptych_set_declaration(device, elements, 2));
        for (int times = 0; times < 3; times++) {
            memset(vertex, 0, sizeof vertex);
            make_cover(vertex + COUNT - 3, times % 2 ? RED_ARGB : GREEN_ARGB);
            OK(triptych_draw_user(device, TRIPTYCH_TRIANGLE_LIST, COUNT / 3, vertex, sizeof *vertex));
        }
        expect_all(GREEN);
        for (uint32_t i = 0; i < COUNT; i++)
            index[i] = COUNT - 1 - i;
        make_cover(vertex + COUNT - 3, RED_ARGB);
        OK(triptych_draw_indexed_user(device, TRIPTYCH_TRIANGLE_LIST, COUNT / 3, index, 32, COUNT, vertex,
                                      sizeof *vertex));
        memset(index, 0, sizeof index);
        expect_all(RED);
        close_device();
    }
}

static void wrong_immediate_draws_are_refused(void)
{
    struct vertex vertex[3];
    const uint16_t index[3] = {0, 1, 3};
    open_device(1);
    make_cover(vertex, RED_ARGB);
    OK(triptych_clear(device, (float[]){0, 1, 0, 1}, 1));
    OK(triptych_set_declaration(device, elements, 2));
    REFUSED("vertices of 0 bytes: expected 1 to 65536",
            triptych_draw_user(device, TRIPTYCH_TRIANGLE_LIST, 1, vertex, 0));
    REFUSED("vertices of 16 bytes: expected at least 20, the end of their elements",
            triptych_draw_user(device, TRIPTYCH_TRIANGLE_LIST, 1, vertex, 16));
    REFUSED("indices of 24 bits: expected 8, 16 or 32",
            triptych_draw_indexed_user(device, TRIPTYCH_TRIANGLE_LIST, 1, index, 24, 4, vertex, 20));
    REFUSED("index 3: expected less than 3, the number of vertices",
            triptych_draw_indexed_user(device, TRIPTYCH_TRIANGLE_LIST, 1, index, 16, 3, vertex, 20));
    REFUSED("4294967295 vertices of 20 bytes, 3 indices: expected at most 2^31 - 1 bytes",
            triptych_draw_indexed_user(device, TRIPTYCH_TRIANGLE_LIST, 1, index, 16, UINT32_MAX, vertex, 20));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_ARGUMENT,
                          triptych_draw_user(device, TRIPTYCH_TRIANGLE_LIST, 1, NULL, 20));
    OK(triptych_draw_user(device, TRIPTYCH_TRIANGLE_LIST, 0, NULL, 20));
    expect_all(GREEN);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(immediate_vertices_are_copied);
    RUN_TEST(immediate_draws_share_a_job);
    RUN_TEST(immediate_indices_are_copied);
    RUN_TEST(other_streams_are_read_from_their_first_vertex);
    RUN_TEST(immediate_instances_are_drawn);
    RUN_TEST(immediate_vertices_have_any_alignment);
    RUN_TEST(large_immediate_draws_are_copied_too);
    RUN_TEST(wrong_immediate_draws_are_refused);
    return UNITY_END();
}
