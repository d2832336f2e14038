/* Extents: blocks of memory that may be kept after their owner, because others still read them. They are
 * linked into lists by a header, so that keeping one needs no memory. */
#ifndef MEMORY_EXTENT_H
#define MEMORY_EXTENT_H

#include <stdalign.h>
#include <stddef.h>

enum { EXTENT_ALIGNMENT = 64 };

/* The header. The data follow it. */
struct extent {
    alignas(EXTENT_ALIGNMENT) struct extent *next; /* in its list */
    size_t bytes;                                  /* of the data */
    size_t begin, end; /* of the data, the only bytes that may differ from 0. For the owner of the data */
};

/* A list. Initially zero. */
struct extents {
    struct extent *first;
    size_t bytes; /* of all data */
    size_t count;
};

static inline struct extent *extent_of(void *data)
{
    return (struct extent *)data - 1;
}

/* Bytes after the data of an extent that can be read, and have any values. */
enum { EXTENT_READABLE = 3 };

/* Returns the data of a new extent, aligned to EXTENT_ALIGNMENT: any bytes. Null if memory is short. */
void *extent_allocate(size_t bytes);
/* Frees an extent, which is in no list. Null is allowed. */
void extent_free(void *data);

/* Adds an extent to a list. */
void extents_add(struct extents *list, void *data);
/* Removes an extent of exactly this size from a list, and returns its data; null if none of the first
 * EXTENTS_SEARCHED has this size. */
enum { EXTENTS_SEARCHED = 16 };
void *extents_take(struct extents *list, size_t bytes);
/* Moves all extents of a list to another one. */
void extents_move(struct extents *to, struct extents *from);
/* Frees the extents at the end of a list, so that it keeps at most this number and these bytes. */
void extents_trim(struct extents *list, size_t count, size_t bytes);
/* Frees all extents of a list. */
void extents_free(struct extents *list);

#endif
