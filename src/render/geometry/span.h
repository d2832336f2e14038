/* The class of triangles that the span reading of a pixel routine can draw (docs/spans.md). It belongs to a
 * triangle, not to the state: geometry tests the planes of each record once, and bins those of the class with
 * a bit (bin.h).
 *
 * The span reading leaves out the steps of planes that are zero in its class: u along y, v along x, 1/w
 * and every other varying along both. This changes no bit of a triangle whose planes have 0 or -0 in
 * these steps, and 0 or at least 2^-90 in their other words. Distances are multiples of 2^-8, and such a
 * word is a multiple of 2^-113, so a plane along one axis is exactly 0 or at least 2^-121 before it is
 * rounded. It is therefore neither -0 nor a denormal, and adding the product of a distance and 0 or -0 to
 * it changes nothing. */
#ifndef RENDER_GEOMETRY_SPAN_H
#define RENDER_GEOMETRY_SPAN_H

#include "contract/arguments.h"

#include <stdbool.h>

enum { SPAN_PLANES = 1 + SLOT_POINT_SIZE - SLOT_diffuse }; /* 1/w, and the components of all varyings */

/* The planes of a key's records, and the axes along which each may vary. */
struct span_class {
    unsigned count;
    struct {
        uint16_t offset;
        uint8_t axes; /* enum axes */
    } plane[SPAN_PLANES];
};

/* The class of the pixel routine's key. */
struct span_class span_class(const struct pixel_key *key);

/* Returns true if the record's triangle is in the class. */
bool span_includes(const struct span_class *class, const uint8_t *record);

#endif
