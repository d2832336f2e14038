#include "stream/place.h"

#include <stdlib.h>

static int compare_positions(const struct place *a, const struct place *b)
{
    for (int i = 0; i < 3; i++)
        if (a->position[i] != b->position[i])
            return a->position[i] < b->position[i] ? -1 : 1;
    return 0;
}

static int compare_places(const void *left, const void *right)
{
    const struct place *a = left, *b = right;
    int order = compare_positions(a, b);
    return order ? order : (a->vertex > b->vertex) - (a->vertex < b->vertex);
}

void place_group(struct place *places, uint32_t count, uint32_t *first)
{
    qsort(places, count, sizeof *places, compare_places);
    for (uint32_t i = 0; i < count; i++)
        first[places[i].vertex] = i && !compare_positions(&places[i], &places[i - 1])
                                      ? first[places[i - 1].vertex]
                                      : places[i].vertex;
}
