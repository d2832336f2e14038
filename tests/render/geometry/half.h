/* Records of the halves of rectangles, with the same words in all, and random rectangles. */
#ifndef TESTS_RENDER_GEOMETRY_HALF_H
#define TESTS_RENDER_GEOMETRY_HALF_H

#include "render/geometry/bin_pair.h"

#include <string.h>

enum { WORDS = 4, BYTES = sizeof(struct triangle_head) + WORDS * sizeof(float), PIXEL = 1 << SUBPIXEL_BITS };

union record {
    struct triangle_head head;
    uint8_t bytes[BYTES];
};

static uint64_t state;

static inline uint32_t draw(void) /* xorshift64* */
{
    state ^= state >> 12;
    state ^= state << 25;
    state ^= state >> 27;
    return (uint32_t)(state * 0x2545F4914F6CDD1DULL >> 32);
}

static inline int below(int count)
{
    return (int)(draw() % (uint32_t)count);
}

/* A triangle of three of a box's corners, in an orientation that setup gives, with the same words in all. */
static inline union record half_of(const struct rectangle *box, const int corner[3])
{
    union record r;
    memset(&r, 0, sizeof r);
    r.head.visible = -1;
    for (int i = 0; i < 3; i++) {
        r.head.x[i] = corner[i] & 1 ? box->x1 : box->x0;
        r.head.y[i] = corner[i] & 2 ? box->y1 : box->y0;
    }
    int64_t area = (int64_t)(r.head.x[1] - r.head.x[0]) * (r.head.y[2] - r.head.y[0]) -
                   (int64_t)(r.head.x[2] - r.head.x[0]) * (r.head.y[1] - r.head.y[0]);
    if (area < 0) {
        int32_t x = r.head.x[1], y = r.head.y[1];
        r.head.x[1] = r.head.x[2], r.head.y[1] = r.head.y[2];
        r.head.x[2] = x, r.head.y[2] = y;
    }
    memset(r.bytes + sizeof r.head, 0x3c, BYTES - sizeof r.head);
    return r;
}

static inline union record half_without(const struct rectangle *box, int free_corner)
{
    int first = below(3), corner[3];
    for (int i = 0, n = first; i < 4; i++)
        if (i != free_corner)
            corner[n++ % 3] = i;
    return half_of(box, corner);
}

static inline struct rectangle random_box(int32_t least, int32_t most)
{
    struct rectangle box;
    box.x0 = below(100 * PIXEL) - 20 * PIXEL;
    box.y0 = below(100 * PIXEL) - 20 * PIXEL;
    box.x1 = box.x0 + least + below(most - least);
    box.y1 = box.y0 + 1 + below(most);
    return box;
}

/* The form of records whose third coordinates are those of these samplers. */
static inline struct pair_form form_of(const struct setup_key *key, unsigned samplers)
{
    uint16_t of_channels[TEXTURE_STAGES] = {[2] = (uint16_t)samplers};
    return bin_pair_form(key, PRECISION_EXACT, of_channels);
}

#endif
