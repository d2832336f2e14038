/* Welding: finding vertices at equal positions, which seams and creases have split. */
#ifndef COMMAND_ASSETS_WELD_H
#define COMMAND_ASSETS_WELD_H

#include <stdint.h>

struct weld_vertex {
    float position[3];
    uint32_t vertex;
};

/* Sorts the vertices by position. first[vertex] becomes the lowest vertex at the position of each vertex.
 * Positions are equal if their numbers are; -0 equals 0. */
void weld_positions(struct weld_vertex *vertices, uint32_t count, uint32_t *first);

#endif
