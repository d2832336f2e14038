#include "render/target/copy.h"

#include <math.h>
#include <string.h>

/* The two neighbours of one axis, and the second one's weight. */
struct tap {
    uint32_t index[2];
    float weight;
};

static struct tap find_tap(uint32_t i, uint32_t size, uint32_t first, uint32_t source_size,
                           enum triptych_copy_filter filter)
{
    double place = ((double)i + 0.5) * (double)source_size / (double)size;
    uint32_t last = first + source_size - 1;
    if (filter == TRIPTYCH_COPY_POINT || source_size == size) {
        uint32_t index = first + (uint32_t)place;
        return (struct tap){{index < last ? index : last, last}, 0};
    }
    double low = floor(place - 0.5);
    struct tap tap = {.weight = (float)(place - 0.5 - low)};
    for (int n = 0; n < 2; n++) {
        double index = fmax(0, fmin(low + n, (double)source_size - 1));
        tap.index[n] = first + (uint32_t)index;
    }
    return tap;
}

static float blend(float a, float b, float weight)
{
    return weight > 0 ? a * (1 - weight) + b * weight : a;
}

void copy_scaled(const float *source, uint32_t width, const struct triptych_rectangle *from,
                 const struct triptych_rectangle *to, enum triptych_copy_filter filter, float *rows)
{
    for (uint32_t y = 0; y < to->height; y++) {
        struct tap v = find_tap(y, to->height, from->y, from->height, filter);
        const float *upper = source + (size_t)v.index[0] * width * 4;
        const float *lower = source + (size_t)v.index[1] * width * 4;
        for (uint32_t x = 0; x < to->width; x++) {
            struct tap u = find_tap(x, to->width, from->x, from->width, filter);
            size_t left = (size_t)u.index[0] * 4, right = (size_t)u.index[1] * 4;
            for (size_t c = 0; c < 4; c++) {
                float above = blend(upper[left + c], upper[right + c], u.weight);
                float below = blend(lower[left + c], lower[right + c], u.weight);
                *rows++ = blend(above, below, v.weight);
            }
        }
    }
}
