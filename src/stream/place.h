/* Vertices by position: which of them are at the same place, for seams and creases split vertices that are one. */
#ifndef STREAM_PLACE_H
#define STREAM_PLACE_H

#include <stdint.h>

struct place {
    float position[3];
    uint32_t vertex;
};

/* Sorts the places by position, and writes for each place's vertex the lowest vertex at its position to first[vertex].
 * Positions are equal when their numbers are; -0 is 0. */
void place_group(struct place *places, uint32_t count, uint32_t *first);

#endif
