/* An allocator in one given range of memory: the memory that the server shares with a 32-bit program, from
 * which objects and lockable memory are allocated.
 *
 * The range is a row of blocks, each a header of 64 bytes and its contents. Neighbours are found by sizes in
 * headers (boundary tags: Knuth, The Art of Computer Programming 1, 2.5), so that free neighbours are joined
 * immediately. Free blocks are in lists by the power of two of their size. All bookkeeping is in the range;
 * offsets in it are in units of 64 bytes, so a range has at most 2^32 - 1 of them. One thread at a time. */
#ifndef D3D9_REMOTE_ARENA_H
#define D3D9_REMOTE_ARENA_H

#include <stddef.h>
#include <stdint.h>

enum { D3D9_ARENA_UNIT = 64, D3D9_ARENA_LISTS = 32 };

struct d3d9_arena {
    uint8_t *base;
    uint32_t units;
    uint32_t fresh;                  /* units from here on have never been allocated and are zeros */
    uint32_t free[D3D9_ARENA_LISTS]; /* the first block of each list; NONE */
};

/* Makes the whole range, which begins at a multiple of 64 and contains zeros, free. */
void d3d9_arena_create(struct d3d9_arena *arena, void *base, size_t bytes);

/* Zeros, aligned to 64 bytes; null if no free block is large enough. */
void *d3d9_arena_allocate(struct d3d9_arena *arena, size_t bytes);
void d3d9_arena_free(struct d3d9_arena *arena, void *memory);

/* For tests: bytes that are not free, with headers. After all memory is freed there must be none. */
size_t d3d9_arena_used(const struct d3d9_arena *arena);

#endif
