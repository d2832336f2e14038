#include "render/geometry/bin_pair.h"

#include "base/minmax.h"
#include "contract/key_query.h"

#include <string.h>

uint32_t bin_pair_bytes(const struct setup_key *setup)
{
    struct triangle_layout layout = layout_of_setup(setup);
    uint32_t bytes = sizeof(struct triangle_head);
    if (setup->primitive != PRIMITIVE_TRIANGLE || setup->facing || setup->smooth || layout.smooth)
        return 0;
    for (int v = 0; v < VARYING_COUNT; v++) {
        if (setup->varying[v] == INTERPOLATION_NONE)
            continue;
        if (layout.varying[v] != bytes)
            return 0; /* the record has more than these words */
        bytes += (uint32_t)sizeof(float) * varying_components[v];
    }
    return setup->depth || layout.stride != (bytes + 63) / 64 * 64 ? 0 : bytes;
}

/* The bounds of a triangle, and the one of their corners, 0 to 3, without a vertex: bit 0 is set to the
 * right, bit 1 below. */
struct half {
    int32_t low_x, low_y, high_x, high_y;
    unsigned free_corner;
};

/* Returns false if a vertex is not a corner of the bounds. */
static bool find_half(const struct triangle_head *head, struct half *half)
{
    const int32_t *x = head->x, *y = head->y;
    half->low_x = min_i32(x[0], min_i32(x[1], x[2]));
    half->low_y = min_i32(y[0], min_i32(y[1], y[2]));
    half->high_x = max_i32(x[0], max_i32(x[1], x[2]));
    half->high_y = max_i32(y[0], max_i32(y[1], y[2]));
    half->free_corner = 0;
    for (int i = 0; i < 3; i++) {
        bool right = x[i] == half->high_x, below = y[i] == half->high_y;
        if ((!right && x[i] != half->low_x) || (!below && y[i] != half->low_y))
            return false;
        half->free_corner ^= (unsigned)right | (unsigned)below << 1;
    }
    return true;
}

/* The corners of all four together are 0, so three of them give the fourth, which is opposite if all bits
 * differ. */
static bool are_halves(const struct half *a, const struct half *b)
{
    return a->low_x == b->low_x && a->low_y == b->low_y && a->high_x == b->high_x && a->high_y == b->high_y &&
           (a->free_corner ^ b->free_corner) == 3;
}

static bool is_far(int32_t from, int32_t to)
{
    return (uint32_t)(to - from + PAIR_EXTENT - 1) >= 2 * PAIR_EXTENT - 1;
}

/* Returns true if a half of a rectangle is as large as a pair that is joined. Most triangles are not. */
static bool may_be_large(const struct triangle_head *head)
{
    const int32_t *x = head->x, *y = head->y;
    return is_far(x[0], x[1]) || is_far(x[0], x[2]) || is_far(y[0], y[1]) || is_far(y[0], y[2]);
}

bool bin_pair_join(uint8_t *first, const uint8_t *second, uint32_t bytes)
{
    struct triangle_head *head = (struct triangle_head *)(void *)first;
    const struct triangle_head *other = (const struct triangle_head *)(const void *)second;
    struct half a, b;
    if (!may_be_large(head) || memcmp(first + sizeof *head, second + sizeof *head, bytes - sizeof *head))
        return false;
    if (!find_half(head, &a) || !find_half(other, &b) || !are_halves(&a, &b))
        return false;
    head->visible = HEAD_RECTANGLE;
    head->x[0] = head->x[2] = a.low_x;
    head->x[1] = a.high_x;
    head->y[0] = a.low_y;
    head->y[1] = head->y[2] = a.high_y;
    return true;
}
