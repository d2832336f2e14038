/* Buffers that change while draws that use them are queued or rendered. Each draw reads the bytes of the time
 * when it was queued. */
#include "tests/render/device/cover.h"
#include "engines/list.h"
#include "tests/support/system/seed.h"

#include <string.h>

enum { VERTICES = 192, INDICES = 96, BUFFERS = 3, STEPS = 4 * QUEUE_COMMANDS };

void setUp(void)
{
}

void tearDown(void)
{
    close_device();
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
#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
enum { DISCARDS = 300, DESTROYED = 200 };
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
    OK(triptych_set_viewport(device, &(struct triptych_viewport){0, 0, 2, 2, 0, 1}));
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
    read_image();
    TEST_ASSERT_EQUAL_UINT32(4, count_color(RED));
}

/* --- Refusals --- */

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
    for (unsigned i = 0; i < test_share_of(STEPS, 5); i++)
        step(&scene);
    read_image();
    close_device();
}

static void draws_read_what_was_there_with_any_number_of_threads(void)
{
    static uint32_t expected[SIZE * SIZE];
    draw_scene(&engine_emulate, 1, true);
    memcpy(expected, image, sizeof expected);
    for (unsigned threads = 1; threads <= 4; threads *= test_stride() > 1 ? 4 : 2) {
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
    RUN_TEST(discards_take_bounded_memory);
    RUN_TEST(destroyed_buffers_take_bounded_memory);
    RUN_TEST(wrong_changes_are_refused);
    RUN_TEST(draws_read_what_was_there_with_any_number_of_threads);
    return UNITY_END();
}
