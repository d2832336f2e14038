/* The conversion in plain C: one loop for all choices, which are tested for each pixel or are values of
 * variables. */
#include "bench/clients/filter/convert.h"

static uint8_t channel(const struct convert_factors *f, int number, int y, int u, int v)
{
    int sum = y * f->luma + u * f->u[number] + v * f->v[number] + f->offset[number];
    int value = sum >> CONVERT_BITS;
    return (uint8_t)(value < 0 ? 0 : value > 255 ? 255 : value);
}

void convert_plain_picture(const struct convert_choice *choice, const struct convert_picture *picture,
                           uint8_t *out, size_t pitch)
{
    const struct convert_factors f = convert_factors(choice);
    for (int row = 0; row < picture->height; row++) {
        const uint8_t *y = picture->y + (ptrdiff_t)row * picture->y_pitch;
        const uint8_t *u = picture->u + (ptrdiff_t)(row / choice->down) * picture->u_pitch;
        const uint8_t *v = picture->v + (ptrdiff_t)(row / choice->down) * picture->v_pitch;
        uint8_t *pixel = out + (size_t)row * pitch;
        for (int column = 0; column < picture->width; column++, pixel += 4) {
            int at = column / choice->across;
            for (int n = 0; n < 3; n++)
                pixel[choice->place[n]] = channel(&f, n, y[column], u[at], v[at]);
            pixel[choice->place[3]] = 255;
        }
    }
}
