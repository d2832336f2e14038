/* YUV4MPEG2: a line of text for the file and for each frame, then the planes Y', Cb and Cr of the frame. */
#include "image/animation_part.h"

#include <stdio.h>
#include <stdlib.h>

enum { HEADER_CAPACITY = 96 };

static int begin(struct animation *animation, struct error *error)
{
    char header[HEADER_CAPACITY];
    int length = snprintf(header, sizeof header, "YUV4MPEG2 W%u H%u F%u:1 Ip A1:1 C444 XCOLORRANGE=LIMITED\n",
                          animation->width, animation->height, animation->rate);
    animation->planes = malloc((size_t)3 * animation->width * animation->height);
    if (!animation->planes)
        return error_set(error, "%s: no memory for a picture of %u x %u", animation->path, animation->width,
                         animation->height);
    return file_append(&animation->output, header, (size_t)length, error);
}

/* BT.601: R', G', B' from 0 to 255 become Y' from 16 to 235, Cb and Cr from 16 to 240. The factors are
 * multiples of 1/65536; those of Cb and of Cr have the sum 0, so that grey has no colour. */
static void convert(uint32_t rgba, uint8_t *y, uint8_t *cb, uint8_t *cr)
{
    const int32_t r = rgba & 255, g = rgba >> 8 & 255, b = rgba >> 16 & 255, half = 32768;
    *y = (uint8_t)((16829 * r + 33039 * g + 6416 * b + half) / 65536 + 16);
    *cb = (uint8_t)((-9714 * r - 19070 * g + 28784 * b + half + 128 * 65536) / 65536);
    *cr = (uint8_t)((28784 * r - 24103 * g - 4681 * b + half + 128 * 65536) / 65536);
}

int y4m_frame(struct animation *animation, const uint32_t *rgba, struct error *error)
{
    static const char frame[] = "FRAME\n";
    const size_t pixels = (size_t)animation->width * animation->height;
    if (!animation->added && begin(animation, error))
        return -1;
    uint8_t *planes = animation->planes;
    for (size_t i = 0; i < pixels; i++)
        convert(rgba[i], planes + i, planes + pixels + i, planes + 2 * pixels + i);
    return file_append(&animation->output, frame, sizeof frame - 1, error) ||
                   file_append(&animation->output, planes, 3 * pixels, error)
               ? -1
               : 0;
}
