#include "command/assets/weld.h"

#include <stdlib.h>

static int compare_positions(const struct weld_vertex *a, const struct weld_vertex *b)
{
    for (int i = 0; i < 3; i++)
        if (a->position[i] != b->position[i])
            return a->position[i] < b->position[i] ? -1 : 1;
    return 0;
}

static int compare_vertices(const void *left, const void *right)
{
    const struct weld_vertex *a = left, *b = right;
    int order = compare_positions(a, b);
    return order ? order : (a->vertex > b->vertex) - (a->vertex < b->vertex);
}

void weld_positions(struct weld_vertex *vertices, uint32_t count, uint32_t *first)
{
    qsort(vertices, count, sizeof *vertices, compare_vertices);
    for (uint32_t i = 0; i < count; i++)
        first[vertices[i].vertex] = i && !compare_positions(&vertices[i], &vertices[i - 1])
                                        ? first[vertices[i - 1].vertex]
                                        : vertices[i].vertex;
}
