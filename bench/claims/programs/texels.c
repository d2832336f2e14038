/* Walks a texture of 32-bit texels in rows and in tiles of 4 x 4, along lines at 0, 45 and 90 degrees: ns a
 * texel and distinct cache lines of 64 bytes for each 1000 texels. Prints JSON. */
#include "measure.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIZE = 2048, LINES = 512, LENGTH = 512 };

struct walk {
    const uint32_t *texels;
    int tiled, dx, dy; /* steps in texels */
    uint32_t sum;
};

static uint32_t offset(int tiled, uint32_t x, uint32_t y)
{
    x &= SIZE - 1;
    y &= SIZE - 1;
    return tiled ? (y / 4 * (SIZE / 4) + x / 4) * 16 + y % 4 * 4 + x % 4 : y * SIZE + x;
}

/* Parallel lines, side by side, as rows of pixels are. */
static void position(const struct walk *w, int line, int step, uint32_t *x, uint32_t *y)
{
    *x = (uint32_t)(step * w->dx + line * (w->dy ? 1 : 0));
    *y = (uint32_t)(step * w->dy + line * (w->dy ? 0 : 1));
}

static void run(void *data)
{
    struct walk *w = data;
    uint32_t sum = 0, x, y;
    for (int line = 0; line < LINES; line++) {
        for (int step = 0; step < LENGTH; step++) {
            position(w, line, step, &x, &y);
            sum += w->texels[offset(w->tiled, x, y)];
        }
    }
    w->sum = sum;
}

/* Distinct lines of eight neighbouring walks of 16 texels: a block of pixels. */
static double lines_of_block(const struct walk *w)
{
    uint32_t seen[128], count = 0, x, y;
    for (int line = 0; line < 8; line++) {
        for (int step = 0; step < 16; step++) {
            position(w, line, step, &x, &y);
            uint32_t address = offset(w->tiled, x, y) / 16, i = 0;
            while (i < count && seen[i] != address)
                i++;
            if (i == count)
                seen[count++] = address;
        }
    }
    return 1000.0 * count / 128;
}

int main(void)
{
    uint32_t *texels = calloc(SIZE * SIZE, sizeof *texels);
    if (!texels)
        return 1;
    static const struct {
        const char *name;
        int dx, dy;
    } direction[] = {{"0", 1, 0}, {"45", 1, 1}, {"90", 0, 1}};
    printf("{\"walks\": [");
    for (int i = 0; i < 6; i++) {
        struct walk w = {texels, i % 2, direction[i / 2].dx, direction[i / 2].dy, 0};
        double time = measure_least(run, &w) / (LINES * LENGTH);
        printf("%s{\"degrees\": %s, \"layout\": \"%s\", \"ns\": %.4f, \"lines\": %.1f}", i ? ", " : "",
               direction[i / 2].name, w.tiled ? "tiles" : "rows", time, lines_of_block(&w));
    }
    printf("]}\n");
    free(texels);
    return 0;
}
