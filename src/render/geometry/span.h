/* The class of triangles that the span reading of a pixel routine can draw (docs/spans.md). It belongs to a
 * triangle, not to the state: geometry tests the planes of each record once, and bins those of the class with
 * a bit (bin.h).
 *
 * The span reading leaves out the steps of planes that are zero in its class: u along y, v along x, 1/w
 * and every other varying along both. This changes no bit of a triangle whose planes have 0 or -0 in
 * these steps, and 0 or at least 2^-90 in their other words. Distances are multiples of 2^-8, and such a
 * word is a multiple of 2^-113, so a plane along one axis is exactly 0 or at least 2^-121 before it is
 * rounded. It is therefore neither -0 nor a denormal, and adding the product of a distance and 0 or -0 to
 * it changes nothing.
 *
 * In SPAN_WHITE the four components of the diffuse colour have the value 1, and steps of 0 if the colour is
 * interpolated. 1/w has the value 1 and steps of 0. So the reading has literals in their place.
 *
 * SPAN_GRADIENT and SPAN_FADE evaluate the planes of colours that vary as the ordinary reading does, and
 * leave out two things. 1/w has the value 1 and steps of 0, so w is 1 exactly, if it has a step of 0; and
 * colours are rounded to 0 to 255 without limits. Limits change nothing if 255 times the colour is above -1/2
 * and below 255.5. A plane is affine, so it has its extremes over the triangle's bounds at their outermost
 * centres. Each is from -SPAN_STRAY to 1 + SPAN_STRAY; the value at the origin and that of the first step are
 * at most 2 in magnitude. The multiply-adds of a pixel round twice, by less than 2^-22 each, and the product
 * by 255 by less than 2^-15. So 255 times the colour is less than 1/4 + 2^-12 outside of 0 to 255. */
#ifndef RENDER_GEOMETRY_SPAN_H
#define RENDER_GEOMETRY_SPAN_H

#include "contract/arguments.h"

#include <stdbool.h>

enum { SPAN_PLANES = 1 + SLOT_POINT_SIZE - SLOT_diffuse }; /* 1/w, and the components of all varyings */

/* How far a colour that varies may be outside of 0 to 1. */
#define SPAN_STRAY 0x1p-10

/* The planes of a key's records, the axes along which each may vary, and what else holds for them; and those
 * of its flat numbers that have to be 1. */
struct span_class {
    unsigned count;
    struct {
        uint16_t offset;
        uint8_t axes; /* enum axes; AXES_BOTH: it is a colour that needs no limits */
        bool is_one;  /* its value */
        bool is_flat; /* it is a number without steps */
    } plane[SPAN_PLANES];
};

/* The narrowest and the widest reading that the pixel routine's key has. Each from the one to the other draws
 * triangles that those before it do not, or draws them with fewer instructions than those after it. */
enum span span_narrowest(const struct pixel_key *key);
enum span span_widest(const struct pixel_key *key);

/* The class of a reading of the key but SPAN_NONE; the key's own field does not count. */
struct span_class span_class(const struct pixel_key *key, enum span span);

/* Returns true if the record's triangle is in the class. */
bool span_includes(const struct span_class *class, const uint8_t *record);

#endif
