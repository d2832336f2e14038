#include "image/sheet.h"
#include "base/minmax.h"
#include "image/png.h"

#include <stdlib.h>

struct sheet sheet_create(unsigned columns, unsigned count)
{
    columns = min_u32(columns, count);
    return (struct sheet){.columns = columns, .rows = (count + columns - 1) / columns};
}

unsigned sheet_width(const struct sheet *sheet)
{
    return sheet->columns * (sheet->width / sheet->factor);
}

unsigned sheet_height(const struct sheet *sheet)
{
    return sheet->rows * (sheet->height / sheet->factor);
}

static int begin(struct sheet *sheet, unsigned width, unsigned height, struct error *error)
{
    sheet->width = width;
    sheet->height = height;
    for (sheet->factor = 1; sheet->factor <= min_u32(width, height); sheet->factor++)
        if ((uint64_t)sheet->columns * (width / sheet->factor) <= PNG_SIDE_MAXIMUM &&
            (uint64_t)sheet->rows * (height / sheet->factor) <= PNG_SIDE_MAXIMUM)
            break;
    if (sheet->factor > min_u32(width, height))
        return error_set(error,
                         "a sheet of %u columns and %u rows of pictures has too many, expected at most %d "
                         "pixels a side",
                         sheet->columns, sheet->rows, PNG_SIDE_MAXIMUM);
    sheet->rgba = calloc((size_t)sheet_width(sheet) * sheet_height(sheet), sizeof *sheet->rgba);
    return sheet->rgba ? 0
                       : error_set(error, "no memory for a sheet of %u x %u pixels", sheet_width(sheet),
                                   sheet_height(sheet));
}

/* The mean of factor x factor pixels in each channel, rounded to the nearest. */
static uint32_t reduce(const uint32_t *rgba, size_t stride, unsigned factor)
{
    uint64_t sum[4] = {0}, count = (uint64_t)factor * factor;
    uint32_t mean = 0;
    for (unsigned y = 0; y < factor; y++)
        for (unsigned x = 0; x < factor; x++)
            for (unsigned c = 0; c < 4; c++)
                sum[c] += rgba[y * stride + x] >> 8 * c & 255;
    for (unsigned c = 0; c < 4; c++)
        mean |= (uint32_t)((sum[c] + count / 2) / count) << 8 * c;
    return mean;
}

int sheet_add(struct sheet *sheet, unsigned width, unsigned height, const uint32_t *rgba, struct error *error)
{
    if (!sheet->rgba && begin(sheet, width, height, error))
        return -1;
    if (width != sheet->width || height != sheet->height)
        return error_set(error, "picture %u has %u x %u pixels, expected %u x %u, like the first",
                         sheet->added, width, height, sheet->width, sheet->height);
    const unsigned factor = sheet->factor, cell_width = width / factor, cell_height = height / factor;
    const size_t stride = sheet_width(sheet);
    uint32_t *cell = sheet->rgba + sheet->added / sheet->columns * cell_height * stride +
                     sheet->added % sheet->columns * cell_width;
    for (size_t y = 0; y < cell_height; y++)
        for (size_t x = 0; x < cell_width; x++)
            cell[y * stride + x] = reduce(rgba + y * factor * width + x * factor, width, factor);
    sheet->added++;
    return 0;
}

void sheet_free(struct sheet *sheet)
{
    free(sheet->rgba);
    sheet->rgba = NULL;
}
