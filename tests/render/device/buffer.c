/* Buffers that change while draws that use them are queued or rendered, and immediate draws. Each draw reads
 * the bytes of the time when it was queued. */
#include "tests/render/device/screen.h"
#include "engines/list.h"

#include <string.h>

enum { VERTICES = 192, INDICES = 96, BUFFERS = 3, STEPS = 4 * QUEUE_COMMANDS };

void setUp(void)
{
}

void tearDown(void)
{
    close_device();
}

static const struct triptych_declaration_element elements[] = {
    {0, 0, TRIPTYCH_FORMAT_FLOAT4, TRIPTYCH_USAGE_POSITION, 0},
    {0, 16, TRIPTYCH_FORMAT_COLOR, TRIPTYCH_USAGE_COLOR, 0}};

/* Binds vertices as stream 0 of a declaration. */
static void declare(triptych_buffer *buffer)
{
    OK(triptych_set_declaration(device, elements, 2));
    OK(triptych_set_stream(device, 0, buffer, 0, sizeof(struct vertex)));
}

/* A triangle that covers all pixels. */
static void make_cover(struct vertex vertex[3], uint32_t color)
{
    vertex[0] = at(0, 0, 0, color);
    vertex[1] = at(2 * SIZE, 0, 0, color);
    vertex[2] = at(0, 2 * SIZE, 0, color);
}

static triptych_buffer *cover(uint32_t color)
{
    struct vertex vertex[3];
    make_cover(vertex, color);
    return buffer_of(vertex, sizeof vertex);
}

static void expect_all(uint32_t color)
{
    read_image();
    TEST_ASSERT_EQUAL_UINT32(SIZE * SIZE, count_color(color));
}

/* --- Storage --- */

static void set_colors(triptych_buffer *buffer, uint32_t color)
{
    for (size_t i = 0; i < 3; i++)
        OK(triptych_buffer_update(device, buffer, i * sizeof(struct vertex) + 16, &color, 4));
}

static void an_update_does_not_change_earlier_draws(void)
{
    open_device(1);
    triptych_buffer *buffer = cover(RED_ARGB);
    declare(buffer);
    const uint8_t *before = buffer->data;
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
    set_colors(buffer, GREEN_ARGB);
    TEST_ASSERT_TRUE(buffer->data != before);
    TEST_ASSERT_EQUAL_UINT32(1, device_commands(device));
    expect_all(RED);
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
    expect_all(GREEN);
}

static void an_update_without_draws_is_in_place(void)
{
    open_device(1);
    triptych_buffer *buffer = cover(RED_ARGB);
    const uint8_t *before = buffer->data;
    declare(buffer);
    set_colors(buffer, GREEN_ARGB);
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
    OK(triptych_finish(device));
    set_colors(buffer, RED_ARGB);
    TEST_ASSERT_EQUAL_PTR(before, buffer->data);
    expect_all(GREEN);
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
    expect_all(RED);
}

/* The vertices of the draw are 3 to 5, its indices 1 to 3. */
static void an_update_of_bytes_that_no_draw_reads_is_in_place(void)
{
    struct vertex vertex[9];
    const uint16_t index[5] = {8, 3, 4, 5, 8};
    open_device(1);
    for (int i = 0; i < 9; i += 3)
        make_cover(vertex + i, RED_ARGB);
    triptych_buffer *buffer = buffer_of(vertex, sizeof vertex), *indices = buffer_of(index, sizeof index);
    const uint8_t *before = buffer->data, *indices_before = indices->data;
    declare(buffer);
    OK(triptych_set_indices(device, indices, 16));
    OK(triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_LIST, 0, 1, 1));
    OK(triptych_buffer_update(device, buffer, 0, vertex, 3 * sizeof *vertex));
    OK(triptych_buffer_update(device, buffer, 6 * sizeof *vertex, vertex, 3 * sizeof *vertex));
    OK(triptych_buffer_update(device, indices, 0, index, 2));
    OK(triptych_buffer_update(device, indices, 8, index, 2));
    TEST_ASSERT_EQUAL_PTR(before, buffer->data);
    TEST_ASSERT_EQUAL_PTR(indices_before, indices->data);
    OK(triptych_buffer_update(device, buffer, 3 * sizeof *vertex - 1, vertex, 2));
    OK(triptych_buffer_update(device, indices, 6, index, 2));
    TEST_ASSERT_TRUE(before != buffer->data && indices_before != indices->data);
    expect_all(RED);
}

static void a_buffer_without_data_is_zero(void)
{
    static const uint8_t zeros[1000];
    triptych_buffer *buffer;
    void *data;
    open_device(1);
    OK(triptych_buffer_create(device, NULL, sizeof zeros, &buffer));
    OK(triptych_buffer_map(device, buffer, 0, sizeof zeros, TRIPTYCH_MAP_READ, &data));
    TEST_ASSERT_EQUAL_MEMORY(zeros, data, sizeof zeros);
    OK(triptych_buffer_unmap(device, buffer));
}

/* A discarded span has any values; all other bytes are 0, wherever bytes were written before. */
static void a_discard_clears_the_rest(void)
{
    uint8_t bytes[300], expected[300];
    void *data;
    open_device(1);
    memset(bytes, 7, sizeof bytes);
    triptych_buffer *buffer = buffer_of(bytes, sizeof bytes);
    for (size_t i = 0; i < 4; i++) {
        size_t begin = (size_t[]){100, 0, 250, 90}[i];
        memset(expected, 0, sizeof expected);
        memset(expected + begin, (int)i + 1, 50);
        OK(triptych_buffer_map(device, buffer, begin, 50, TRIPTYCH_MAP_DISCARD, &data));
        memset(data, (int)i + 1, 50);
        OK(triptych_buffer_unmap(device, buffer));
        TEST_ASSERT_EQUAL_MEMORY(expected, buffer->data, sizeof expected);
        OK(triptych_buffer_update(device, buffer, 20, bytes, i));
        memset(expected + 20, 7, i);
        TEST_ASSERT_EQUAL_MEMORY(expected, buffer->data, sizeof expected);
    }
}

/* Storage that the draws have released is used again. */
static void a_discard_of_a_used_buffer_gives_other_storage(void)
{
    const uint8_t *storage[9];
    void *data;
    open_device(1);
    triptych_buffer *buffer = cover(RED_ARGB);
    declare(buffer);
    storage[0] = buffer->data;
    for (int i = 1; i < 9; i++) {
        OK(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
        OK(triptych_buffer_map(device, buffer, 0, buffer->bytes, TRIPTYCH_MAP_DISCARD, &data));
        make_cover(data, i % 2 ? RED_ARGB : GREEN_ARGB);
        OK(triptych_buffer_unmap(device, buffer));
        storage[i] = buffer->data;
        for (int before = 0; before < i; before++)
            TEST_ASSERT_TRUE(storage[before] != storage[i]);
    }
    expect_all(RED);
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
    OK(triptych_buffer_map(device, buffer, 0, buffer->bytes, TRIPTYCH_MAP_DISCARD, &data));
    bool again = false;
    for (int i = 0; i < 8; i++)
        again |= storage[i] == buffer->data;
    TEST_ASSERT_TRUE(again);
    expect_all(GREEN);
}

/* A draw reads mapped bytes as they are when it is queued. */
static void a_mapped_buffer_may_be_drawn(void)
{
    void *data;
    open_device(1);
    triptych_buffer *buffer = cover(RED_ARGB);
    declare(buffer);
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
    OK(triptych_buffer_map(device, buffer, 0, buffer->bytes, TRIPTYCH_MAP_WRITE, &data));
    TEST_ASSERT_EQUAL_HEX32(RED_ARGB, ((const struct vertex *)data)->color);
    make_cover(data, GREEN_ARGB);
    expect_all(RED);
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
    OK(triptych_buffer_unmap(device, buffer));
    expect_all(GREEN);
}

static void changed_indices_are_checked_again(void)
{
    struct vertex vertex[3];
    const uint32_t index[3] = {0, 1, 2}, wrong = 3, right = 2;
    void *data;
    open_device(1);
    make_cover(vertex, RED_ARGB);
    declare(buffer_of(vertex, sizeof vertex));
    triptych_buffer *indices = buffer_of(index, sizeof index);
    OK(triptych_set_indices(device, indices, 32));
    OK(triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_LIST, 0, 0, 1));
    OK(triptych_buffer_update(device, indices, 8, &wrong, 4));
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_CALL, triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_LIST, 0, 0, 1));
    OK(triptych_buffer_map(device, indices, 8, 4, TRIPTYCH_MAP_NO_OVERWRITE, &data));
    memcpy(data, &right, sizeof right);
    OK(triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_LIST, 0, 0, 1));
    memcpy(data, &wrong, sizeof wrong);
    TEST_ASSERT_EQUAL_INT(TRIPTYCH_BAD_CALL, triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_LIST, 0, 0, 1));
    memcpy(data, &right, sizeof right);
    OK(triptych_buffer_unmap(device, indices));
    OK(triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_LIST, 0, 0, 1));
    expect_all(RED);
}

/* --- Immediate draws --- */

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

/* --- Bounds --- */

/* Megabytes of the storage that is not a buffer's. */
static size_t kept_megabytes(void)
{
    const struct extents *list[] = {&device->resources.retired, &device->rendered.retired,
                                    &device->resources.spare};
    size_t bytes = 0;
    for (int i = 0; i < 3; i++)
        bytes += list[i]->bytes;
    return bytes >> 20;
}

/* Many times the memory that may be kept, in megabytes. Instrumented threads clear memory slowly. */
#ifdef __SANITIZE_THREAD__
enum { DISCARDS = 1000, DESTROYED = 300 };
#else
enum { DISCARDS = 10000, DESTROYED = 3000 };
#endif

static void discards_take_bounded_memory(void)
{
    enum { BYTES = 1 << 20 };
    for (unsigned threads = 1; threads <= 2; threads++) {
        open_device(threads);
        triptych_buffer *buffer;
        OK(triptych_buffer_create(device, NULL, BYTES, &buffer));
        declare(buffer);
        OK(triptych_set_viewport(device, &(struct triptych_viewport){0, 0, 2, 2, 0, 1}));
        for (int i = 0; i < DISCARDS; i++) {
            void *data;
            OK(triptych_buffer_map(device, buffer, 0, 3 * sizeof(struct vertex), TRIPTYCH_MAP_DISCARD,
                                   &data));
            make_cover(data, i % 2 ? RED_ARGB : GREEN_ARGB);
            OK(triptych_buffer_unmap(device, buffer));
            OK(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
            TEST_ASSERT_LESS_OR_EQUAL_UINT64(100, kept_megabytes());
        }
        read_image();
        TEST_ASSERT_EQUAL_UINT32(4, count_color(RED));
        TEST_ASSERT_LESS_OR_EQUAL_UINT64(16, kept_megabytes());
        close_device();
    }
}

static void destroyed_buffers_take_bounded_memory(void)
{
    struct vertex vertex[3];
    open_device(2);
    for (int i = 0; i < DESTROYED; i++) {
        make_cover(vertex, i % 2 ? RED_ARGB : GREEN_ARGB);
        triptych_buffer *buffer;
        OK(triptych_buffer_create(device, NULL, 1 << 20, &buffer));
        OK(triptych_buffer_update(device, buffer, 0, vertex, sizeof vertex));
        declare(buffer);
        OK(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, 0, 1));
        OK(triptych_buffer_destroy(device, buffer));
        TEST_ASSERT_LESS_OR_EQUAL_UINT64(100, kept_megabytes());
    }
    expect_all(RED);
}

/* --- Refusals --- */

#define REFUSED(expected, call)                                                                              \
    do {                                                                                                     \
        TEST_ASSERT_TRUE(TRIPTYCH_OK != (call));                                                             \
        TEST_ASSERT_EQUAL_STRING(expected, triptych_error(device));                                          \
    } while (0)

static void wrong_changes_are_refused(void)
{
    void *data;
    open_device(1);
    triptych_buffer *buffer = buffer_of("12345678", 8);
    REFUSED("2 bytes at offset 7: expected them inside the buffer of 8 bytes",
            triptych_buffer_update(device, buffer, 7, "ab", 2));
    REFUSED("1 bytes at offset 18446744073709551615: expected them inside the buffer of 8 bytes",
            triptych_buffer_update(device, buffer, SIZE_MAX, "a", 1));
    REFUSED("mapping of 0 bytes: expected at least 1",
            triptych_buffer_map(device, buffer, 0, 0, TRIPTYCH_MAP_WRITE, &data));
    REFUSED("mode 4 of a mapping: expected 0 to 3",
            triptych_buffer_map(device, buffer, 0, 1, TRIPTYCH_MAP_COUNT, &data));
    REFUSED("9 bytes at offset 0: expected them inside the buffer of 8 bytes",
            triptych_buffer_map(device, buffer, 0, 9, TRIPTYCH_MAP_WRITE, &data));
    REFUSED("buffer is not mapped: expected triptych_buffer_map first",
            triptych_buffer_unmap(device, buffer));
    OK(triptych_buffer_map(device, buffer, 0, 8, TRIPTYCH_MAP_WRITE, &data));
    REFUSED("buffer is mapped: expected triptych_buffer_unmap first",
            triptych_buffer_map(device, buffer, 0, 1, TRIPTYCH_MAP_READ, &data));
    REFUSED("buffer is mapped: expected triptych_buffer_unmap first",
            triptych_buffer_update(device, buffer, 0, "a", 1));
    OK(triptych_buffer_destroy(device, buffer));
    TEST_ASSERT_EQUAL_UINT32(0, device->resources.mapped);
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

/* --- Any order --- */

struct scene {
    triptych_buffer *buffer[BUFFERS], *indices, *ring;
    size_t appended; /* vertices of the ring */
    uint32_t seed;
    bool finish; /* after each draw */
};

static uint32_t next_random(struct scene *scene, uint32_t below)
{
    scene->seed = scene->seed * 1664525 + 1013904223;
    return (scene->seed >> 8) % below;
}

static void make_triangles(struct scene *scene, struct vertex *vertex, uint32_t count)
{
    float x = 0, y = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (i % 3 == 0) {
            x = (float)next_random(scene, SIZE);
            y = (float)next_random(scene, SIZE);
        }
        vertex[i] = at(x + (float)next_random(scene, 12), y + (float)next_random(scene, 12), 0,
                       0xff000000 | next_random(scene, 1 << 24));
    }
}

static void change_vertices(struct scene *scene, triptych_buffer *buffer)
{
    struct vertex vertex[VERTICES];
    uint32_t first = next_random(scene, VERTICES), count = 1 + next_random(scene, VERTICES - first);
    size_t offset = first * sizeof *vertex, bytes = count * sizeof *vertex;
    enum triptych_map mode = next_random(scene, 2) ? TRIPTYCH_MAP_WRITE : TRIPTYCH_MAP_DISCARD;
    void *data;
    make_triangles(scene, vertex, count);
    if (next_random(scene, 2)) {
        OK(triptych_buffer_update(device, buffer, offset, vertex, bytes));
        return;
    }
    OK(triptych_buffer_map(device, buffer, offset, bytes, mode, &data));
    if (mode == TRIPTYCH_MAP_WRITE && next_random(scene, 2))
        bytes /= 2;
    memcpy(data, vertex, bytes);
    OK(triptych_buffer_unmap(device, buffer));
}

static void change_indices(struct scene *scene)
{
    uint16_t index[INDICES];
    uint32_t first = next_random(scene, INDICES), count = 1 + next_random(scene, INDICES - first);
    for (uint32_t i = 0; i < count; i++)
        index[i] = (uint16_t)next_random(scene, VERTICES);
    OK(triptych_buffer_update(device, scene->indices, first * sizeof *index, index, count * sizeof *index));
}

static void replace_buffer(struct scene *scene, triptych_buffer **buffer)
{
    struct vertex vertex[VERTICES];
    OK(triptych_buffer_destroy(device, *buffer));
    make_triangles(scene, vertex, VERTICES);
    *buffer = buffer_of(vertex, sizeof vertex);
}

/* Appends to the ring what has not been drawn since it was discarded, and draws it. */
static void draw_from_ring(struct scene *scene)
{
    struct vertex vertex[6];
    void *data;
    bool whole = scene->appended + 6 > VERTICES;
    make_triangles(scene, vertex, 6);
    scene->appended = whole ? 0 : scene->appended;
    OK(triptych_buffer_map(device, scene->ring, scene->appended * sizeof *vertex, sizeof vertex,
                           whole ? TRIPTYCH_MAP_DISCARD : TRIPTYCH_MAP_NO_OVERWRITE, &data));
    memcpy(data, vertex, sizeof vertex);
    OK(triptych_buffer_unmap(device, scene->ring));
    OK(triptych_set_stream(device, 0, scene->ring, 0, sizeof *vertex));
    OK(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, (uint32_t)scene->appended, 2));
    scene->appended += 6;
}

static void draw_immediate(struct scene *scene)
{
    struct vertex vertex[12];
    const uint16_t index[9] = {5, 6, 7, 8, 9, 10, 11, 0, 1};
    make_triangles(scene, vertex, 12);
    if (next_random(scene, 2))
        OK(triptych_draw_user(device, TRIPTYCH_TRIANGLE_STRIP, 1 + next_random(scene, 8), vertex,
                              sizeof *vertex));
    else
        OK(triptych_draw_indexed_user(device, TRIPTYCH_TRIANGLE_LIST, 1 + next_random(scene, 3), index, 16,
                                      12, vertex, sizeof *vertex));
}

static void draw_from_buffers(struct scene *scene)
{
    triptych_buffer *buffer = scene->buffer[next_random(scene, BUFFERS)];
    OK(triptych_set_stream(device, 0, buffer, 0, sizeof(struct vertex)));
    if (next_random(scene, 2))
        OK(triptych_draw(device, TRIPTYCH_TRIANGLE_LIST, next_random(scene, VERTICES - 3), 1));
    else
        OK(triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_LIST, 0, next_random(scene, INDICES - 6), 2));
}

static void step(struct scene *scene)
{
    switch (next_random(scene, 16)) {
    case 0: change_vertices(scene, scene->buffer[next_random(scene, BUFFERS)]); break;
    case 1: change_indices(scene); break;
    case 2:
        if (!next_random(scene, 8))
            replace_buffer(scene, &scene->buffer[next_random(scene, BUFFERS)]);
        break;
    case 3:
    case 4:
    case 5:
    case 6: draw_from_ring(scene); break;
    case 7:
    case 8:
    case 9:
    case 10: draw_immediate(scene); break;
    default: draw_from_buffers(scene); break;
    }
    if (scene->finish)
        OK(triptych_finish(device));
}

static void draw_scene(const struct engine *engine, unsigned threads, bool finish)
{
    struct scene scene = {.seed = 3, .finish = finish};
    open_engine(engine, &(struct device_options){.threads = threads});
    OK(triptych_set_declaration(device, elements, 2));
    OK(triptych_set_state(device, TRIPTYCH_STATE_ZENABLE, 0));
    for (int i = 0; i < BUFFERS; i++)
        replace_buffer(&scene, &scene.buffer[i]);
    replace_buffer(&scene, &scene.ring);
    OK(triptych_buffer_create(device, NULL, INDICES * 2, &scene.indices));
    OK(triptych_set_indices(device, scene.indices, 16));
    for (int i = 0; i < STEPS; i++)
        step(&scene);
    read_image();
    close_device();
}

static void draws_read_what_was_there_with_any_number_of_threads(void)
{
    static uint32_t expected[SIZE * SIZE];
    draw_scene(&engine_emulate, 1, true);
    memcpy(expected, image, sizeof expected);
    for (unsigned threads = 1; threads <= 4; threads *= 2) {
        draw_scene(&engine_emulate, threads, false);
        TEST_ASSERT_EQUAL_MEMORY(expected, image, sizeof expected);
        draw_scene(engine_find("tiered"), threads, false);
        TEST_ASSERT_EQUAL_MEMORY(expected, image, sizeof expected);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(an_update_does_not_change_earlier_draws);
    RUN_TEST(an_update_without_draws_is_in_place);
    RUN_TEST(an_update_of_bytes_that_no_draw_reads_is_in_place);
    RUN_TEST(a_buffer_without_data_is_zero);
    RUN_TEST(a_discard_clears_the_rest);
    RUN_TEST(a_discard_of_a_used_buffer_gives_other_storage);
    RUN_TEST(a_mapped_buffer_may_be_drawn);
    RUN_TEST(changed_indices_are_checked_again);
    RUN_TEST(immediate_vertices_are_copied);
    RUN_TEST(immediate_draws_share_a_job);
    RUN_TEST(immediate_indices_are_copied);
    RUN_TEST(other_streams_are_read_from_their_first_vertex);
    RUN_TEST(immediate_instances_are_drawn);
    RUN_TEST(immediate_vertices_have_any_alignment);
    RUN_TEST(large_immediate_draws_are_copied_too);
    RUN_TEST(discards_take_bounded_memory);
    RUN_TEST(destroyed_buffers_take_bounded_memory);
    RUN_TEST(wrong_changes_are_refused);
    RUN_TEST(wrong_immediate_draws_are_refused);
    RUN_TEST(draws_read_what_was_there_with_any_number_of_threads);
    return UNITY_END();
}
