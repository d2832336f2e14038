/* A diamond is the union of four convex pieces: its open inside, its two lower sides, and for steep lines its
 * right corner. Each piece is a list of linear conditions on the point. Along a line from t = 0 to 1 they are
 * linear in t, so exact fractions decide if some t fulfils all of them. */
#include "tests/support/picture/diamond.h"

#include <stdbool.h>
#include <stdlib.h>

/* value + change * t < 0, or <= 0. */
struct condition {
    int64_t value, change;
    bool strict;
};

/* Returns true if some t from 0 to 1 fulfils all conditions. Each condition cuts the interval of t, whose
 * ends are fractions. */
static bool feasible(const struct condition *c, int count)
{
    int64_t low = 0, low_over = 1, high = 1, high_over = 1;
    bool low_open = false, high_open = false;
    for (int i = 0; i < count; i++) {
        if (c[i].change == 0) {
            if (c[i].strict ? c[i].value >= 0 : c[i].value > 0)
                return false;
            continue;
        }
        bool upper = c[i].change > 0; /* t < -value / change */
        int64_t bound = upper ? -c[i].value : c[i].value, over = llabs(c[i].change);
        __int128 d = (__int128)bound * (upper ? high_over : low_over) - (__int128)(upper ? high : low) * over;
        if (upper && (d < 0 || (d == 0 && c[i].strict)))
            high = bound, high_over = over, high_open = c[i].strict;
        if (!upper && (d > 0 || (d == 0 && c[i].strict)))
            low = bound, low_over = over, low_open = c[i].strict;
    }
    __int128 length = (__int128)high * low_over - (__int128)low * high_over;
    return length > 0 || (length == 0 && !low_open && !high_open);
}

/* Returns the condition p * dx + q * dy < limit, or <= limit. dx and dy are the distances from the pixel's
 * centre to the line's point. */
static struct condition condition(const struct diamond_line *l, int32_t x, int32_t y, int p, int q, int limit,
                                  bool strict)
{
    int64_t dx = (int64_t)l->x0 - (x * 256 + 128), dy = (int64_t)l->y0 - (y * 256 + 128);
    int64_t along_x = l->x1 - l->x0, along_y = l->y1 - l->y0;
    return (struct condition){p * dx + q * dy - limit, p * along_x + q * along_y, strict};
}

/* Returns true if the line, both ends included, has a point in the pixel's diamond. */
static bool meets(const struct diamond_line *l, bool steep, int32_t x, int32_t y)
{
    struct condition inside[4], side[4];
    for (int i = 0; i < 4; i++)
        inside[i] = condition(l, x, y, i & 1 ? 1 : -1, i & 2 ? 1 : -1, 128, true);
    if (feasible(inside, 4))
        return true;
    for (int right = -1; right <= 1; right += 2) {
        side[0] = condition(l, x, y, right, 1, 128, false);
        side[1] = condition(l, x, y, -right, -1, -128, false);
        side[2] = condition(l, x, y, -right, 0, 0, false);
        side[3] = condition(l, x, y, 0, -1, 0, true);
        if (feasible(side, 4))
            return true;
    }
    side[0] = condition(l, x, y, 1, 0, 128, false);
    side[1] = condition(l, x, y, -1, 0, -128, false);
    side[2] = condition(l, x, y, 0, 1, 0, false);
    side[3] = condition(l, x, y, 0, -1, 0, false);
    return steep && feasible(side, 4);
}

int diamond_covers(const struct diamond_line *l, int32_t x, int32_t y)
{
    struct diamond_line end = {l->x1, l->y1, l->x1, l->y1, 0};
    bool steep = abs(l->y1 - l->y0) > abs(l->x1 - l->x0);
    if (meets(&end, steep, x, y))
        return l->last;
    return meets(l, steep, x, y);
}

int diamond_covers_wide(const struct diamond_line *line, int width, int32_t x, int32_t y)
{
    struct diamond_line first = *line;
    int steep = llabs((int64_t)line->y1 - line->y0) > llabs((int64_t)line->x1 - line->x0);
    int32_t *from = steep ? &first.x0 : &first.y0, *to = steep ? &first.x1 : &first.y1;
    *from -= (width - 1) * 128;
    *to -= (width - 1) * 128;
    for (int i = 0; i < width; i++)
        if (diamond_covers(&first, steep ? x - i : x, steep ? y : y - i))
            return 1;
    return 0;
}
