#include "differential.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    LANES = 64,
    STREAM_BYTES = 64 * 1024,
    TEXELS = 64 * 64,
    RECORDS = 64,
    RECORD_BYTES = 512,
    ENTRIES = 48,
    CAPACITY = SLOT_COUNT * VERTEX_SLOT_BYTES
};

/* What one engine writes. */
struct outputs {
    alignas(64) float vertices[SLOT_COUNT * VERTEX_CAPACITY];
    alignas(64) uint8_t records[RECORDS * RECORD_BYTES];
    alignas(64) uint32_t color[TILE_PIXELS];
    alignas(64) float depth[TILE_PIXELS];
};

struct differential {
    struct code_arena *arena;
    uint64_t seed;
    struct job job;
    uint8_t stream[STREAM_BYTES];
    uint32_t texels[TEXELS];
    uint32_t index[VERTEX_CAPACITY];
    uint32_t corner[3 * SETUP_CAPACITY];
    struct entry entries[ENTRIES];
    alignas(64) uint8_t triangles[RECORDS * RECORD_BYTES];
    struct outputs initial, result[2];
    char message[2048];
};

struct differential *differential_create(struct code_arena *arena)
{
    struct differential *d = aligned_alloc(64, (sizeof *d + 63) / 64 * 64);
    if (d) {
        memset(d, 0, sizeof *d);
        d->arena = arena;
    }
    return d;
}

void differential_destroy(struct differential *d)
{
    free(d);
}

static uint32_t word(struct differential *d)
{
    d->seed ^= d->seed >> 12;
    d->seed ^= d->seed << 25;
    d->seed ^= d->seed >> 27;
    return (uint32_t)(d->seed * 0x2545f4914f6cdd1dull >> 32);
}

static float uniform(struct differential *d, float low, float high)
{
    return low + (high - low) * (float)(word(d) >> 8) * 0x1p-24f;
}

/* Mostly ordinary; one in sixteen is a value at the edge of binary32. */
static float value(struct differential *d, float low, float high)
{
    static const uint32_t edges[] = {0x00000000, 0x80000000, 0x00000001, 0x80000001, 0x007fffff, 0x00800000,
                                     0x7f7fffff, 0xff7fffff, 0x7f800000, 0xff800000, 0x7fc00000, 0x3f800000,
                                     0xbf800000, 0x4b000000, 0x34000000, 0x7149f2ca};
    if (word(d) % 16)
        return uniform(d, low, high);
    float edge;
    memcpy(&edge, &edges[word(d) % 16], sizeof edge);
    return edge;
}

static void fill(struct differential *d, float *values, size_t count, float low, float high)
{
    for (size_t i = 0; i < count; i++)
        values[i] = value(d, low, high);
}

static void make_job(struct differential *d)
{
    struct job *job = &d->job;
    memset(job, 0, sizeof *job);
    for (int a = 0; a < ATTRIBUTE_COUNT; a++) {
        job->attribute[a].data = d->stream + word(d) % 256 * 4;
        job->attribute[a].stride = (int32_t)(word(d) % 12 * 4);
    }
    fill(d, &job->world_view_projection[0][0], 16, -2, 2);
    fill(d, &job->world_view[0][0], 16, -2, 2);
    fill(d, &job->normal[0][0], 12, -2, 2);
    fill(d, job->base_color, 4, 0, 1);
    fill(d, (float *)job->light, sizeof job->light / 4, -1, 3);
    job->guard_x = uniform(d, 1, 50);
    job->guard_y = uniform(d, 1, 50);
    job->scale_x = uniform(d, 1, 100000);
    job->scale_y = uniform(d, -100000, -1);
    job->offset_x = uniform(d, 0, 100000);
    job->offset_y = uniform(d, 0, 100000);
    job->depth_scale = 1;
    job->depth_offset = uniform(d, 0, 0.25f);
}

static int32_t texture_size(struct differential *d, int power_of_two)
{
    return power_of_two ? 1 << word(d) % 7 : (int32_t)(1 + word(d) % 64);
}

static void make_texture(struct differential *d, const struct pixel_key *key)
{
    struct texture_job *texture = &d->job.texture;
    for (int i = 0; i < TEXELS; i++)
        d->texels[i] = word(d);
    texture->texels = d->texels;
    texture->width = texture_size(d, key->address_u == ADDRESS_WRAP_POWER);
    texture->height = texture_size(d, key->address_v == ADDRESS_WRAP_POWER);
    texture->width_256 = (float)texture->width * 256;
    texture->height_256 = (float)texture->height * 256;
    texture->last_u = texture->width - 1;
    texture->last_v = texture->height - 1;
}

static void make_records(struct differential *d)
{
    for (int i = 0; i < RECORDS; i++) {
        float *record = (float *)(void *)(d->triangles + i * RECORD_BYTES);
        fill(d, record, RECORD_BYTES / 4, -0.25f, 1.25f);
        struct triangle_head *head = (void *)record;
        head->origin_x = uniform(d, 0, 64);
        head->origin_y = uniform(d, 0, 64);
    }
    for (int i = 0; i < ENTRIES; i++) {
        uint16_t block = (uint16_t)(word(d) % TILE_BLOCKS);
        uint32_t coverage = word(d) & word(d) & 0xffff;
        if (word(d) % 4 == 0)
            coverage = 0xffff;
        d->entries[i] = (struct entry){.x = (float)(block % 16 * 4 + 64),
                                       .y = (float)(block / 16 * 4 + 128),
                                       .coverage = (uint16_t)(coverage ? coverage : 1),
                                       .block = block,
                                       .triangle = word(d) % RECORDS * RECORD_BYTES};
    }
}

static void make_initial(struct differential *d, enum unit unit)
{
    struct outputs *o = &d->initial;
    memset(o, 0, sizeof *o);
    if (unit == UNIT_SETUP)
        for (int slot = 0; slot < SLOT_COUNT; slot++)
            fill(d, o->vertices + slot * VERTEX_CAPACITY, VERTEX_CAPACITY, slot == SLOT_W ? 0.5f : -1, 1.5f);
    for (int i = 0; i < TILE_PIXELS; i++) {
        o->color[i] = word(d);
        o->depth[i] = word(d) % 3 ? uniform(d, 0, 1) : (float)(word(d) & 1);
    }
}

static void make_inputs(struct differential *d, enum unit unit, const union key *key, uint64_t seed)
{
    d->seed = seed * 0x9e3779b97f4a7c15ull | 1;
    for (size_t i = 0; i < STREAM_BYTES; i += 4) {
        float stored = value(d, -1.5f, 1.5f);
        memcpy(d->stream + i, &stored, sizeof stored);
    }
    for (int i = 0; i < VERTEX_CAPACITY; i++)
        d->index[i] = word(d) % 256;
    for (int i = 0; i < 3 * SETUP_CAPACITY; i++)
        d->corner[i] = word(d) % VERTEX_CAPACITY * 4;
    make_job(d);
    make_initial(d, unit);
    if (unit == UNIT_PIXEL) {
        make_texture(d, &key->pixel);
        make_records(d);
    }
}

static void run(struct differential *d, const struct routine *routine, struct outputs *o)
{
    memcpy(o, &d->initial, sizeof *o);
    struct vertex_call vertex = {&d->job, d->index, o->vertices, LANES};
    struct setup_call setup = {&d->job, d->corner, o->vertices, o->records, RECORDS};
    struct pixel_call pixel = {&d->job, d->entries, d->triangles, &lane_table, o->color, o->depth, ENTRIES};
    const void *calls[UNIT_COUNT] = {&vertex, &setup, &pixel};
    routine->run(calls[routine->unit], routine);
}

static int same_float(const void *a, const void *b)
{
    float x, y;
    memcpy(&x, a, sizeof x);
    memcpy(&y, b, sizeof y);
    return !memcmp(a, b, sizeof x) || (isnan(x) && isnan(y));
}

/* The first differing word of two float arrays, or -1. */
static ptrdiff_t first_difference(const void *a, const void *b, size_t words)
{
    for (size_t i = 0; i < words; i++)
        if (!same_float((const char *)a + 4 * i, (const char *)b + 4 * i))
            return (ptrdiff_t)i;
    return -1;
}

static const char *report(struct differential *d, const struct engine *a, const struct engine *b,
                          enum unit unit, const union key *key, const char *where, size_t at, const void *x,
                          const void *y)
{
    char text[KEY_TEXT_CAPACITY];
    uint32_t left, right;
    memcpy(&left, x, sizeof left);
    memcpy(&right, y, sizeof right);
    snprintf(d->message, sizeof d->message, "%s and %s differ in %s, word %zu: %08x and %08x; %s key: %s",
             a->name, b->name, where, at, (unsigned)left, (unsigned)right, unit_name[unit],
             key_print(unit, key, text));
    return d->message;
}

static ptrdiff_t record_difference(const struct outputs *x, const struct outputs *y, size_t stride)
{
    for (size_t i = 0; i < RECORDS; i++) {
        const uint8_t *left = x->records + i * stride, *right = y->records + i * stride;
        int visible = ((const struct triangle_head *)(const void *)left)->visible;
        size_t bytes = visible ? stride : sizeof(struct triangle_head);
        ptrdiff_t at = first_difference(left, right, bytes / 4);
        if (at >= 0)
            return (ptrdiff_t)(i * stride / 4) + at;
    }
    return -1;
}

static const char *compare(struct differential *d, const struct engine *a, const struct engine *b,
                           enum unit unit, const union key *key)
{
    struct outputs *x = &d->result[0], *y = &d->result[1];
    if (unit == UNIT_VERTEX) {
        ptrdiff_t at = first_difference(x->vertices, y->vertices, sizeof x->vertices / 4);
        return at < 0
                   ? NULL
                   : report(d, a, b, unit, key, "vertices", (size_t)at, x->vertices + at, y->vertices + at);
    }
    if (unit == UNIT_SETUP) {
        size_t stride = triangle_layout(key->setup.depth, key->setup.varying).stride;
        ptrdiff_t at = record_difference(x, y, stride);
        return at < 0 ? NULL
                      : report(d, a, b, unit, key, "records", (size_t)at, x->records + 4 * at,
                               y->records + 4 * at);
    }
    for (int i = 0; i < TILE_PIXELS; i++) {
        if (x->color[i] != y->color[i])
            return report(d, a, b, unit, key, "colour", (size_t)i, &x->color[i], &y->color[i]);
        if (memcmp(&x->depth[i], &y->depth[i], 4))
            return report(d, a, b, unit, key, "depth", (size_t)i, &x->depth[i], &y->depth[i]);
    }
    return NULL;
}

const char *differential_compare(struct differential *d, const struct engine *a, const struct engine *b,
                                 enum unit unit, const union key *key, uint64_t seed)
{
    const struct engine *engines[2] = {a, b};
    struct error error = {{0}};
    make_inputs(d, unit, key, seed);
    for (int i = 0; i < 2; i++) {
        struct routine *routine = engines[i]->build(d->arena, unit, key, &error);
        if (!routine) {
            snprintf(d->message, sizeof d->message, "%s built nothing: %s", engines[i]->name, error.text);
            return d->message;
        }
        run(d, routine, &d->result[i]);
        engines[i]->free(d->arena, routine);
    }
    return compare(d, a, b, unit, key);
}
