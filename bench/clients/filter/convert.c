/* The conversion around its kernel: a run for each row, and the factors of the matrices. */
#include "bench/clients/filter/convert.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const struct kernel_text convert_kernel = {"convert", convert_record, convert_execute};

/* Kr and Kb of each matrix. */
static const double weight[CONVERT_MATRICES][2] = {[CONVERT_BT601] = {0.299, 0.114},
                                                   [CONVERT_BT709] = {0.2126, 0.0722},
                                                   [CONVERT_BT2020] = {0.2627, 0.0593}};

static int fixed(double value)
{
    return (int)lrint(value * (1 << CONVERT_BITS));
}

struct convert_factors convert_factors(const struct convert_choice *choice)
{
    const double kr = weight[choice->matrix][0], kb = weight[choice->matrix][1], kg = 1 - kr - kb;
    const double luma = choice->full ? 1 : 255.0 / 219, chroma = choice->full ? 1 : 255.0 / 224;
    const int black = choice->full ? 0 : 16;
    const double u[3] = {0, -2 * (1 - kb) * kb / kg, 2 * (1 - kb)};
    const double v[3] = {2 * (1 - kr), -2 * (1 - kr) * kr / kg, 0};
    struct convert_factors f = {.luma = fixed(luma)};
    for (int channel = 0; channel < 3; channel++) {
        f.u[channel] = fixed(u[channel] * chroma);
        f.v[channel] = fixed(v[channel] * chroma);
        f.offset[channel] = (1 << (CONVERT_BITS - 1)) - black * f.luma - 128 * (f.u[channel] + f.v[channel]);
    }
    return f;
}

/* Runs whole groups of elements into the row and the rest through a buffer. */
static void convert_row(const struct kernel *kernel, const struct convert_job *job, const int32_t *index,
                        int width, uint8_t *out)
{
    uint8_t buffer[KERNEL_ELEMENTS * CONVERT_STRIDE];
    size_t whole = (size_t)width / (4 * KERNEL_ELEMENTS) * KERNEL_ELEMENTS;
    if (whole)
        kernel_run(kernel, job, index, out, (uint32_t)whole);
    size_t rest = (size_t)width - 4 * whole;
    if (!rest)
        return;
    kernel_run(kernel, job, index + whole, buffer, KERNEL_ELEMENTS);
    memcpy(out + whole * CONVERT_STRIDE, buffer, 4 * rest);
}

/* The last elements, which fill a group of lanes, read the row's last element again. */
static int32_t *make_index(int width)
{
    size_t used = ((size_t)width + 3) / 4,
           count = (used + KERNEL_ELEMENTS - 1) / KERNEL_ELEMENTS * KERNEL_ELEMENTS;
    int32_t *index = malloc(count * sizeof *index);
    for (size_t i = 0; index && i < count; i++)
        index[i] = (int32_t)(i < used ? i : used - 1);
    return index;
}

int convert_kernel_picture(const struct kernel *kernel, const struct convert_choice *choice,
                           const struct convert_picture *picture, uint8_t *out, size_t pitch)
{
    int32_t *index = make_index(picture->width);
    if (!index)
        return -1;
    for (int row = 0; row < picture->height; row++) {
        ptrdiff_t below = row / choice->down;
        const struct convert_job job = {picture->y + (ptrdiff_t)row * picture->y_pitch,
                                        picture->u + below * picture->u_pitch,
                                        picture->v + below * picture->v_pitch};
        convert_row(kernel, &job, index, picture->width, out + (size_t)row * pitch);
    }
    free(index);
    return 0;
}
