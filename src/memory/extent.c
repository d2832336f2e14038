#include "memory/extent.h"

#include <stdint.h>
#include <stdlib.h>

void *extent_allocate(size_t bytes)
{
    const size_t most = SIZE_MAX - sizeof(struct extent) - EXTENT_ALIGNMENT - EXTENT_READABLE;
    size_t rounded = (bytes + EXTENT_READABLE + EXTENT_ALIGNMENT - 1) & ~(size_t)(EXTENT_ALIGNMENT - 1);
    if (bytes > most)
        return NULL;
    struct extent *extent = aligned_alloc(EXTENT_ALIGNMENT, sizeof *extent + rounded);
    if (!extent)
        return NULL;
    *extent = (struct extent){.bytes = bytes, .end = bytes};
    return extent + 1;
}

void extent_free(void *data)
{
    if (data)
        free(extent_of(data));
}

void extents_add(struct extents *list, void *data)
{
    struct extent *extent = extent_of(data);
    extent->next = list->first;
    list->first = extent;
    list->bytes += extent->bytes;
    list->count++;
}

/* Removes the extent that the link points to. */
static struct extent *unlink_extent(struct extents *list, struct extent **link)
{
    struct extent *extent = *link;
    *link = extent->next;
    list->bytes -= extent->bytes;
    list->count--;
    return extent;
}

void *extents_take(struct extents *list, size_t bytes)
{
    struct extent **link = &list->first;
    for (int i = 0; i < EXTENTS_SEARCHED && *link; i++, link = &(*link)->next)
        if ((*link)->bytes == bytes)
            return unlink_extent(list, link) + 1;
    return NULL;
}

void extents_move(struct extents *to, struct extents *from)
{
    while (from->first)
        extents_add(to, unlink_extent(from, &from->first) + 1);
}

void extents_trim(struct extents *list, size_t count, size_t bytes)
{
    struct extent **link = &list->first;
    for (size_t kept = 0; *link;) {
        size_t with = kept + (*link)->bytes;
        if (!count || with > bytes) {
            free(unlink_extent(list, link));
            continue;
        }
        kept = with;
        count--;
        link = &(*link)->next;
    }
}

void extents_free(struct extents *list)
{
    extents_trim(list, 0, 0);
}
