#include "command/support/difference.h"
#include "image/png.h"

#include <stdio.h>
#include <stdlib.h>

/* With red in the highest byte, as hexadecimal colours are written. */
static uint32_t red_first(uint32_t rgba)
{
    return __builtin_bswap32(rgba);
}

char *difference_describe(const struct picture *picture, const struct difference *difference,
                          char text[DIFFERENCE_TEXT])
{
    int length = snprintf(text, DIFFERENCE_TEXT, "pixel (%u, %u): RGBA %08x and %08x", difference->x,
                          difference->y, red_first(difference->color[0]), red_first(difference->color[1]));
    if (picture->depth)
        length +=
            snprintf(text + length, DIFFERENCE_TEXT - (size_t)length, ", depth %a (%.9g) and %a (%.9g)",
                     difference->depth[0], difference->depth[0], difference->depth[1], difference->depth[1]);
    if (picture->stencil)
        length += snprintf(text + length, DIFFERENCE_TEXT - (size_t)length, ", stencil %u and %u",
                           difference->stencil[0], difference->stencil[1]);
    if (difference->number_pixels)
        length += snprintf(text + length, DIFFERENCE_TEXT - (size_t)length,
                           ", channel %u of target %u %a (%.9g) and %a (%.9g)", difference->number_place % 4,
                           difference->number_place / 4, (double)difference->number[0],
                           (double)difference->number[0], (double)difference->number[1],
                           (double)difference->number[1]);
    unsigned long long pixels = (unsigned long long)picture->width * picture->height;
    length += snprintf(text + length, DIFFERENCE_TEXT - (size_t)length,
                       "; of %llu pixels %llu differ in colour, by at most %u of 255", pixels,
                       (unsigned long long)difference->color_pixels, difference->color_distance);
    if (picture->depth)
        length += snprintf(text + length, DIFFERENCE_TEXT - (size_t)length, ", %llu in depth",
                           (unsigned long long)difference->depth_pixels);
    if (picture->stencil)
        length += snprintf(text + length, DIFFERENCE_TEXT - (size_t)length, ", %llu in stencil",
                           (unsigned long long)difference->stencil_pixels);
    if (picture->numbers)
        snprintf(text + length, DIFFERENCE_TEXT - (size_t)length, ", %llu in the targets' numbers",
                 (unsigned long long)difference->number_pixels);
    return text;
}

int difference_save(const struct command *self, const char *path, const struct picture *first,
                    const struct picture *second, unsigned compression)
{
    struct error error = {""};
    uint32_t *painting = malloc((size_t)first->width * first->height * sizeof *painting);
    if (!painting)
        return tool_fail(self, "no memory for a picture of %u x %u", first->width, first->height);
    compare_paint(first, second, painting);
    int bad = png_save_level(path, first->width, first->height, painting, compression, &error);
    free(painting);
    return bad ? tool_fail(self, "%s", error.text) : STATUS_OK;
}
