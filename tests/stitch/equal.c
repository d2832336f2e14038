/* The stitchers against the emulator: random keys, normalised or not, on random data, the same bytes out.
 *
 * Every routine is asked for through struct engine and run on a copy of the same buffers. Compared are all
 * bytes of the outputs with two exceptions that the specification leaves open: NaN payloads in vertex batches
 * and planes, and the planes of triangles that setup found invisible. Colour and depth are compared as they
 * are. Data come in two moods: plausible, and wild, where any float may be a NaN, an infinity, a denormal or
 * huge. Seeds are fixed. */
#include "base/code.h"
#include "emu/emulate.h"
#include "stitch/stitch.h"

#include <stdlib.h>
#include <string.h>
#include <unity.h>
#include <xmmintrin.h>

enum { ROUNDS = 3000, VERTICES = 64, ATTRIBUTE_BYTES = VERTICES * 40, TRIANGLES = 8, ENTRIES = 24 };
enum { TEXTURE_SIDE_MAXIMUM = 32, STRIDE_MAXIMUM = 256 };

static struct code_arena *arena;
static uint64_t seed;

static uint32_t random_word(void)
{
    seed ^= seed >> 12;
    seed ^= seed << 25;
    seed ^= seed >> 27;
    return (uint32_t)(seed * 0x2545f4914f6cdd1dull >> 32);
}

static uint32_t below(uint32_t limit)
{
    return random_word() % limit;
}

static float between(float low, float high)
{
    return low + (high - low) * ((float)(random_word() >> 8) / 16777216.0f);
}

static float special(void)
{
    static const uint32_t bits[] = {0,          0x80000000, 0x7f800000, 0xff800000, 0x7fc00000,
                                    0xffc12345, 0x7f800001, 1,          0x80000001, 0x007fffff,
                                    0x00800000, 0x7f7fffff, 0xff7fffff, 0x3f800000, 0xbf800000,
                                    0x4f000000, 0xcf000000, 0x2b800000, 0x3f000000, 0x5f000000};
    float value;
    uint32_t word = below(8) ? bits[below(sizeof bits / sizeof *bits)] : random_word();
    memcpy(&value, &word, sizeof value);
    return value;
}

/* Plausible, or one time in eight anything. */
static float number(int wild, float low, float high)
{
    return wild && !below(8) ? special() : between(low, high);
}

static void random_floats(float *out, size_t count, int wild, float low, float high)
{
    for (size_t i = 0; i < count; i++)
        out[i] = number(wild, low, high);
}

static int nan_bits(uint32_t bits)
{
    return (bits & 0x7fffffff) > 0x7f800000;
}

/* Both NaN, or the same. */
static int same_float(const uint8_t *a, const uint8_t *b)
{
    uint32_t x, y;
    memcpy(&x, a, sizeof x);
    memcpy(&y, b, sizeof y);
    return x == y || (nan_bits(x) && nan_bits(y));
}

static const struct engine *const stitchers[] = {&engine_stitch_operation, &engine_stitch};
enum { STITCHERS = sizeof stitchers / sizeof *stitchers };

static void run(const struct engine *engine, enum unit unit, const union key *key, const void *call)
{
    struct error error = {{0}};
    struct routine *routine = engine->build(arena, unit, key, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(routine, error.text);
    unsigned before = _mm_getcsr();
    unsigned odd = 0x7f80 ^ (below(2) << 15); /* rounding toward zero, nothing flushed or only results */
    _mm_setcsr(odd);
    routine->run(call, routine);
    unsigned after = _mm_getcsr();
    _mm_setcsr(before);
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(odd & ~0x3fu, after & ~0x3fu, "MXCSR not restored");
    engine->free(arena, routine);
}

static void fail(const struct engine *engine, enum unit unit, const union key *key, const char *what,
                 size_t where)
{
    char key_text[KEY_TEXT_CAPACITY], text[KEY_TEXT_CAPACITY + 200];
    key_print(unit, key, key_text);
    snprintf(text, sizeof text, "%s %s [%s]: %s differs at %zu", engine->name, unit_name[unit], key_text,
             what, where);
    TEST_FAIL_MESSAGE(text);
}

static void random_lights(struct job *job, int wild)
{
    random_floats(job->base_color, 4, wild, -0.2f, 1.0f);
    for (int i = 0; i < LIGHT_COUNT; i++) {
        random_floats(job->light[i].position, 3, wild, -3.0f, 3.0f);
        random_floats(job->light[i].diffuse, 3, wild, 0.0f, 1.0f);
        random_floats(job->light[i].ambient, 3, wild, 0.0f, 0.3f);
        job->light[i].range = number(wild, 0.0f, 8.0f);
        job->light[i].attenuation0 = number(wild, 0.0f, 1.0f);
        job->light[i].attenuation1 = number(wild, 0.0f, 1.0f);
        job->light[i].attenuation2 = number(wild, 0.0f, 1.0f);
    }
}

/* Every vertex at the camera and every light at exactly its range, where "within" and "below" differ. */
static void lights_at_their_range(struct job *job)
{
    memset(job->world_view, 0, sizeof job->world_view);
    for (int i = 0; i < LIGHT_COUNT; i++) {
        memset(job->light[i].position, 0, sizeof job->light[i].position);
        job->light[i].position[below(3)] = job->light[i].range = (float)(1u << below(4));
    }
}

static void random_job(struct job *job, int wild)
{
    memset(job, 0, sizeof *job);
    random_floats(&job->world_view_projection[0][0], 16, wild, -1.5f, 1.5f);
    random_floats(&job->world_view[0][0], 16, wild, -1.5f, 1.5f);
    random_floats(&job->normal[0][0], 12, wild, -1.5f, 1.5f);
    random_lights(job, wild);
    if (!below(8))
        lights_at_their_range(job);
    job->guard_x = between(1.0f, 8.0f);
    job->guard_y = between(1.0f, 8.0f);
    job->scale_x = number(wild, 100.0f, 80000.0f);
    job->scale_y = number(wild, -80000.0f, -100.0f);
    job->offset_x = number(wild, 0.0f, 80000.0f);
    job->offset_y = number(wild, 0.0f, 80000.0f);
    job->depth_scale = number(wild, 0.1f, 1.0f);
    job->depth_offset = number(wild, -0.1f, 0.5f);
}

/* ---- vertex */

static uint8_t attribute_data[ATTRIBUTE_COUNT][ATTRIBUTE_BYTES];
static _Alignas(64) uint32_t index_words[1 + 3 * SETUP_CAPACITY];
static uint32_t *const unaligned_index = index_words + 1; /* indices come from anywhere */
static _Alignas(64) float batch[2][SLOT_COUNT * VERTEX_CAPACITY];

static void random_attributes(struct job *job, const struct vertex_key *key, int wild)
{
    for (int a = 0; a < ATTRIBUTE_COUNT; a++) {
        job->attribute[a].stride = 16 + 4 * (int)below(6);
        job->attribute[a].data = attribute_data[a] + 4 * below(2);
        random_floats((float *)attribute_data[a], ATTRIBUTE_BYTES / 4, wild, -2.0f, 2.0f);
        if (key->attribute[a] == ATTRIBUTE_FORMAT_COLOR)
            for (int i = 0; i < ATTRIBUTE_BYTES / 4; i++)
                ((uint32_t *)attribute_data[a])[i] = random_word();
        if (!below(16)) /* zero vectors, whose length has no reciprocal */
            memset(attribute_data[a], 0, sizeof attribute_data[a]);
    }
}

static void compare_batches(const struct engine *engine, const union key *key)
{
    const uint8_t *a = (const uint8_t *)batch[0], *b = (const uint8_t *)batch[1];
    for (size_t i = 0; i < sizeof batch[0]; i += 4) {
        int is_code = i / VERTEX_SLOT_BYTES == SLOT_CODE;
        if (is_code ? memcmp(a + i, b + i, 4) != 0 : !same_float(a + i, b + i))
            fail(engine, UNIT_VERTEX, key, "word of the batch", i / 4);
    }
}

static void vertex_routines_agree(void)
{
    for (int round = 0; round < ROUNDS; round++) {
        union key key;
        struct job job;
        int wild = round & 1;
        key_random(UNIT_VERTEX, &seed, &key);
        random_job(&job, wild);
        random_attributes(&job, &key.vertex, wild);
        for (int i = 0; i < VERTEX_CAPACITY; i++)
            unaligned_index[i] = below(VERTICES - 1);
        uint32_t count = below(8) ? 16 * (1 + below(3)) : 16 * below(VERTEX_CAPACITY / 16 + 1);
        struct vertex_call call = {&job, unaligned_index, batch[0], count};
        memset(batch[0], 0x5a, sizeof batch[0]);
        run(&engine_emulate, UNIT_VERTEX, &key, &call);
        for (int i = 0; i < STITCHERS; i++) {
            memset(batch[1], 0x5a, sizeof batch[1]);
            call.out = batch[1];
            run(stitchers[i], UNIT_VERTEX, &key, &call);
            compare_batches(stitchers[i], &key);
        }
    }
}

/* ---- setup */

static _Alignas(64) uint8_t records[2][SETUP_CAPACITY * STRIDE_MAXIMUM];

static void random_batch(int wild)
{
    for (int slot = 0; slot < SLOT_COUNT; slot++)
        for (int i = 0; i < VERTEX_CAPACITY; i++)
            batch[0][slot * VERTEX_CAPACITY + i] =
                slot == SLOT_W ? number(wild, 0.5f, 4.0f) : number(wild, -2.0f, 2.0f);
    for (int i = 0; i < 3 * SETUP_CAPACITY; i++)
        unaligned_index[i] = 4 * below(VERTEX_CAPACITY);
}

/* The head, the planes of a visible triangle, and nothing behind them. */
static void compare_record(const struct engine *engine, const union key *key,
                           const struct triangle_layout *layout, size_t end, uint32_t i)
{
    const uint8_t *a = records[0] + (size_t)i * layout->stride, *b = records[1] + (size_t)i * layout->stride;
    if (memcmp(a, b, sizeof(struct triangle_head)))
        fail(engine, UNIT_SETUP, key, "head of record", i);
    if (memcmp(a + end, b + end, layout->stride - end))
        fail(engine, UNIT_SETUP, key, "padding of record", i);
    if (((const struct triangle_head *)a)->visible)
        for (size_t at = sizeof(struct triangle_head); at < end; at += 4)
            if (!same_float(a + at, b + at))
                fail(engine, UNIT_SETUP, key, "plane word of the records", i * layout->stride / 4 + at / 4);
}

static size_t record_end(const struct setup_key *key, const struct triangle_layout *layout)
{
    size_t end = sizeof(struct triangle_head);
    if (key->depth)
        end = layout->depth + sizeof(struct plane);
    if (layout->smooth)
        end = layout->reciprocal_w + sizeof(struct plane);
    for (int v = 0; v < VARYING_COUNT; v++)
        if (key->varying[v] != INTERPOLATION_NONE)
            end =
                layout->varying[v] +
                varying_components[v] * (key->varying[v] == INTERPOLATION_SMOOTH ? sizeof(struct plane) : 4);
    return end;
}

static void setup_routines_agree(void)
{
    for (int round = 0; round < ROUNDS; round++) {
        union key key;
        struct job job;
        int wild = round & 1;
        key_random(UNIT_SETUP, &seed, &key);
        random_job(&job, wild);
        random_batch(wild);
        struct triangle_layout layout = triangle_layout(key.setup.depth, key.setup.varying);
        size_t end = record_end(&key.setup, &layout);
        TEST_ASSERT_LESS_OR_EQUAL(STRIDE_MAXIMUM, layout.stride);
        uint32_t count = below(8) ? 16 * (1 + below(3)) : 16 * below(SETUP_CAPACITY / 16 + 1);
        struct setup_call call = {&job, unaligned_index, batch[0], records[0], count};
        memset(records[0], 0x5a, sizeof records[0]);
        run(&engine_emulate, UNIT_SETUP, &key, &call);
        for (int i = 0; i < STITCHERS; i++) {
            memset(records[1], 0x5a, sizeof records[1]);
            call.out = records[1];
            run(stitchers[i], UNIT_SETUP, &key, &call);
            for (uint32_t t = 0; t < count; t++)
                compare_record(stitchers[i], &key, &layout, end, t);
            size_t written = (size_t)count * layout.stride;
            if (memcmp(records[0] + written, records[1] + written, sizeof records[0] - written))
                fail(stitchers[i], UNIT_SETUP, &key, "memory behind the records", count);
        }
    }
}

/* ---- pixel */

static struct entry entries[ENTRIES];
static uint32_t texels[TEXTURE_SIDE_MAXIMUM * TEXTURE_SIDE_MAXIMUM];
static _Alignas(64) uint32_t color[3][TILE_PIXELS];
static _Alignas(64) float depth[3][TILE_PIXELS];

static void random_plane(uint8_t *record, size_t offset, int wild, float low, float high)
{
    struct plane plane = {number(wild, low, high), number(wild, -0.1f, 0.1f), number(wild, -0.1f, 0.1f)};
    memcpy(record + offset, &plane, sizeof plane);
}

static void random_varying(uint8_t *record, const struct pixel_key *key, const struct triangle_layout *layout,
                           int v, int wild)
{
    float reach = v == VARYING_texcoord ? 3.0f : 0.2f;
    for (size_t c = 0; c < varying_components[v]; c++) {
        float flat = number(wild, -reach, 1.0f + reach);
        if (key->varying[v] == INTERPOLATION_FLAT)
            memcpy(record + layout->varying[v] + 4 * c, &flat, sizeof flat);
        else if (key->varying[v] == INTERPOLATION_SMOOTH)
            random_plane(record, layout->varying[v] + sizeof(struct plane) * c, wild, -reach, 1.0f + reach);
    }
}

static void random_triangles(const struct pixel_key *key, const struct triangle_layout *layout, int wild)
{
    for (int i = 0; i < TRIANGLES; i++) {
        uint8_t *record = records[0] + (size_t)i * layout->stride;
        random_floats((float *)record, layout->stride / 4, wild, -4.0f, 4.0f);
        struct triangle_head *head = (struct triangle_head *)record;
        head->origin_x = between(-20.0f, 84.0f);
        head->origin_y = between(-20.0f, 84.0f);
        if (key->depth_function != COMPARE_ALWAYS || key->depth_write)
            random_plane(record, layout->depth, wild, -0.2f, 1.2f);
        if (layout->smooth)
            random_plane(record, layout->reciprocal_w, wild, 0.2f, 2.0f);
        for (int v = 0; v < VARYING_COUNT; v++)
            random_varying(record, key, layout, v, wild);
    }
}

static int32_t texture_side(int address)
{
    return address == ADDRESS_WRAP_POWER ? 1 << below(6) : 1 + (int)below(TEXTURE_SIDE_MAXIMUM);
}

static void random_texture(struct job *job, const struct pixel_key *key)
{
    struct texture_job *texture = &job->texture;
    texture->texels = texels;
    texture->width = texture_side(key->address_u);
    texture->height = texture_side(key->address_v);
    texture->width_256 = 256.0f * (float)texture->width;
    texture->height_256 = 256.0f * (float)texture->height;
    texture->last_u = texture->width - 1;
    texture->last_v = texture->height - 1;
    for (size_t i = 0; i < sizeof texels / sizeof *texels; i++)
        texels[i] = random_word();
}

static void random_entries(const struct triangle_layout *layout)
{
    for (int i = 0; i < ENTRIES; i++) {
        static const uint16_t half[4] = {0xffff, 0x00ff, 0xff00, 0x8001};
        uint16_t coverage = (uint16_t)(below(2) ? half[below(4)] : 1 + below(0xffff));
        uint16_t block = (uint16_t)(i % 5 ? below(TILE_BLOCKS) : entries[i ? i - 1 : 0].block);
        entries[i] = (struct entry){(float)(block % 16 * 4), (float)(block / 16 * 4), coverage, block,
                                    below(TRIANGLES) * layout->stride};
    }
}

static void random_tile(int wild)
{
    for (int i = 0; i < TILE_PIXELS; i++) {
        color[2][i] = random_word();
        depth[2][i] = number(wild, 0.0f, 1.0f);
    }
}

static void reset_tile(int which, struct pixel_call *call)
{
    memcpy(color[which], color[2], sizeof color[2]);
    memcpy(depth[which], depth[2], sizeof depth[2]);
    call->color = color[which];
    call->depth = depth[which];
}

/* The depth planes of a few rounds pass exactly through stored depths, so that EQUAL has something to find.
 */
static void plant_equal_depths(const struct pixel_key *key, const struct triangle_layout *layout)
{
    if (key->depth_function == COMPARE_ALWAYS && !key->depth_write)
        return;
    for (int i = 0; i < TRIANGLES; i++) {
        struct plane plane = {0.5f, 0.0f, 0.0f};
        memcpy(records[0] + (size_t)i * layout->stride + layout->depth, &plane, sizeof plane);
    }
    for (int i = 0; i < TILE_PIXELS; i++)
        depth[2][i] = 0.25f * (float)(1 + below(3));
}

/* A table's address may be that of any words. */
static const struct lane_table *unaligned_lanes(void)
{
    static _Alignas(64) uint8_t copy[4 + sizeof lane_table];
    memcpy(copy + 4, &lane_table, sizeof lane_table);
    return (const struct lane_table *)(copy + 4);
}

static void compare_tiles(const struct engine *engine, const union key *key)
{
    for (size_t i = 0; i < TILE_PIXELS; i++) {
        if (color[0][i] != color[1][i])
            fail(engine, UNIT_PIXEL, key, "colour", i);
        if (memcmp(&depth[0][i], &depth[1][i], 4))
            fail(engine, UNIT_PIXEL, key, "depth", i);
    }
}

static void pixel_routines_agree(void)
{
    for (int round = 0; round < ROUNDS; round++) {
        union key key;
        struct job job;
        int wild = round & 1;
        key_random(UNIT_PIXEL, &seed, &key);
        int reads_depth = key.pixel.depth_function != COMPARE_ALWAYS || key.pixel.depth_write;
        struct triangle_layout layout = triangle_layout(reads_depth, key.pixel.varying);
        random_job(&job, wild);
        random_triangles(&key.pixel, &layout, wild);
        random_texture(&job, &key.pixel);
        random_entries(&layout);
        random_tile(wild);
        if (!below(3))
            plant_equal_depths(&key.pixel, &layout);
        struct pixel_call call = {&job, entries, records[0],        unaligned_lanes(),
                                  NULL, NULL,    1 + below(ENTRIES)};
        reset_tile(0, &call);
        run(&engine_emulate, UNIT_PIXEL, &key, &call);
        for (int i = 0; i < STITCHERS; i++) {
            reset_tile(1, &call);
            run(stitchers[i], UNIT_PIXEL, &key, &call);
            compare_tiles(stitchers[i], &key);
        }
    }
}

void setUp(void)
{
    struct error error = {{0}};
    const char *reason = engine_stitch.unavailable();
    if (reason)
        TEST_IGNORE_MESSAGE(reason);
    seed = 0x5eed;
    arena = code_create(1 << 20, NULL, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(arena, error.text);
}

void tearDown(void)
{
    code_destroy(arena);
    arena = NULL;
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(vertex_routines_agree);
    RUN_TEST(setup_routines_agree);
    RUN_TEST(pixel_routines_agree);
    return UNITY_END();
}
