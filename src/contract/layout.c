#include "contract/layout.h"
#include "contract/key_query.h"

/* round(255 * (2 * b + 1) / 32) in both halves. */
#define DITHER(b) ((255 * (2 * (b) + 1) + 16) / 32 * 0x10001)

const struct lane_table lane_table = {
    .x = {.5f, 1.5f, .5f, 1.5f, 2.5f, 3.5f, 2.5f, 3.5f, .5f, 1.5f, .5f, 1.5f, 2.5f, 3.5f, 2.5f, 3.5f},
    .y = {.5f, .5f, 1.5f, 1.5f, .5f, .5f, 1.5f, 1.5f, 2.5f, 2.5f, 3.5f, 3.5f, 2.5f, 2.5f, 3.5f, 3.5f},
    .bit = {1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384, 32768},
    .dither = {DITHER(0), DITHER(8), DITHER(12), DITHER(4), DITHER(2), DITHER(10), DITHER(14), DITHER(6),
               DITHER(3), DITHER(11), DITHER(15), DITHER(7), DITHER(1), DITHER(9), DITHER(13), DITHER(5)},
};

const struct sample_position layout_samples[SAMPLES_RADIX][SAMPLES_MAXIMUM] = {
    {{0, 0}},
    {{4, 4}, {-4, -4}},
    {{-2, -6}, {6, -2}, {-6, 2}, {2, 6}},
    {{1, -3}, {-1, 3}, {5, 1}, {-3, -5}, {-5, 5}, {-7, -1}, {3, 7}, {7, -7}},
};

const uint8_t varying_components[VARYING_COUNT] = {
#define VARYING(name, components, text) components,
#include "def/state/varying.def"
#undef VARYING
};

const uint8_t varying_slot[VARYING_COUNT] = {
#define VARYING(name, components, text) SLOT_##name,
#include "def/state/varying.def"
#undef VARYING
};

static uint16_t reserve(uint16_t *end, size_t bytes)
{
    uint16_t offset = *end;
    *end = (uint16_t)(offset + bytes);
    return offset;
}

static const uint8_t coverage_bytes[COVERAGE_COUNT] = {[COVERAGE_EDGES] = sizeof(struct smooth_triangle),
                                                       [COVERAGE_LINE] = sizeof(struct smooth_line),
                                                       [COVERAGE_POINT] = sizeof(struct smooth_point)};

static struct triangle_layout triangle_layout(int coverage, int depth, int w,
                                              const uint8_t varying[VARYING_COUNT])
{
    struct triangle_layout layout = {.coverage = (uint16_t)coverage, .smooth = (uint16_t)w};
    uint16_t end = (uint16_t)(RECORD_COVERAGE + coverage_bytes[coverage]);
    for (unsigned v = key_next(varying, 0, VARYING_COUNT); v < VARYING_COUNT;
         v = key_next(varying, v + 1, VARYING_COUNT))
        layout.smooth |= varying[v] == INTERPOLATION_SMOOTH;
    if (depth)
        layout.depth = reserve(&end, sizeof(struct plane));
    if (layout.smooth)
        layout.reciprocal_w = reserve(&end, sizeof(struct plane));
    for (unsigned v = key_next(varying, 0, VARYING_COUNT); v < VARYING_COUNT;
         v = key_next(varying, v + 1, VARYING_COUNT)) {
        size_t bytes = varying[v] == INTERPOLATION_SMOOTH ? sizeof(struct plane) : sizeof(float);
        layout.varying[v] = reserve(&end, bytes * varying_components[v]);
    }
    layout.stride = (uint16_t)((end + 63) & ~63);
    return layout;
}

struct triangle_layout layout_of_setup(const struct setup_key *key)
{
    return triangle_layout(setup_coverage(key), key->depth, key->w, key->varying);
}

struct triangle_layout layout_of_pixel(const struct pixel_key *key)
{
    return triangle_layout(key->coverage, pixel_reads_depth(key), pixel_reads_w(key), key->varying);
}

struct triangle_layout layout_of_unit(enum unit unit, const union key *key)
{
    switch (unit) {
    case UNIT_SETUP: return layout_of_setup(&key->setup);
    case UNIT_PIXEL: return layout_of_pixel(&key->pixel);
    default: return (struct triangle_layout){0};
    }
}
