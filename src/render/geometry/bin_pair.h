/* Pairs of triangles that are one rectangle along the axes, such as the halves of a page's rectangle.
 *
 * A pair whose records have no planes, and the same words after the head, gives every pixel the same
 * values, whichever triangle covers it. The triangles share their longest edge, so each centre in their
 * bounds is in exactly one of them (render/raster/raster.h), and the pair can be drawn as one record: a
 * head with HEAD_RECTANGLE, whose first corners are the lowest and the highest position. It has no edges,
 * needs no coverage inside, and can cover a tile that neither triangle covers.
 *
 * Pairs of less than PAIR_EXTENT are left as they are: tiny triangles have a kernel of their own, which
 * does not read the head's `visible`. */
#ifndef RENDER_GEOMETRY_BIN_PAIR_H
#define RENDER_GEOMETRY_BIN_PAIR_H

#include "contract/layout.h"

#include <stdbool.h>

enum { PAIR_EXTENT = 32 << SUBPIXEL_BITS };

/* The end of a record, if records of these keys can be joined; 0 if not. */
uint32_t bin_pair_bytes(const struct setup_key *setup);

/* Makes the first of two visible records of `bytes` bytes a rectangle, if both are its halves. Returns true
 * if so: the second is not needed then. */
bool bin_pair_join(uint8_t *first, const uint8_t *second, uint32_t bytes);

#endif
