/* Contact sheets: pictures of one size in rows, row by row from the top left, without gaps.
 *
 * If the sheet would have more than PNG_SIDE_MAXIMUM pixels a side, all pictures are reduced by the least
 * whole factor with which it fits. Functions that return int return 0, or -1 with the reason. */
#ifndef IMAGE_SHEET_H
#define IMAGE_SHEET_H

#include "base/error.h"

#include <stdint.h>

struct sheet {
    unsigned columns, rows;
    unsigned added;
    unsigned width, height; /* of each picture as it is given */
    unsigned factor;        /* of the reduction */
    uint32_t *rgba;         /* of the whole sheet, transparent where there is no picture; or null */
};

/* An empty sheet for `count` pictures. */
struct sheet sheet_create(unsigned columns, unsigned count);

/* Adds the next picture of RGBA8 words. */
int sheet_add(struct sheet *sheet, unsigned width, unsigned height, const uint32_t *rgba,
              struct error *error);

unsigned sheet_width(const struct sheet *sheet);
unsigned sheet_height(const struct sheet *sheet);
void sheet_free(struct sheet *sheet);

#endif
