/* Bins: the triangles that touch each tile, in drawing order. Records and bins are in an arena
 * (render/geometry/arena.h).
 *
 * Geometry is processed in chunks (render/queue/queue.h). For each tile that a chunk touches there is a chain
 * of cells with the offsets of its triangles' records. The head cells of these chains are chained too: those
 * of one chunk while it is written (`sibling`), and those of one tile, in the order of chunks, when all
 * chunks are complete (`later`).
 *
 * A chunk that begins with a few triangles that reach over much of the target has no cells for these. They
 * would need a cell for every tile, written by one thread and linked by one. Instead the chunk lists them
 * (`struct wide`), and each tile tests whether they touch it.
 *
 * If threads are to link them side by side, the head cells of a chunk are in several chains, by bands of
 * tiles (render/tile/round.h). */
#ifndef RENDER_GEOMETRY_BIN_H
#define RENDER_GEOMETRY_BIN_H

#include "render/draw/command.h"
#include "render/geometry/arena.h"
#include "render/geometry/span.h"

enum {
    BIN_CELL_TRIANGLES = 11,
    BIN_BANDS = 16,
    STRIP_TILES = 0x7ffffffe,
    MANY_TILES = 0x7fffffff,
    PIXELS_GUESSED = 256,
    WIDE_TRIANGLES = 8, /* of a chunk, at most */
    WIDE_TILES = 16,    /* that they meet, at least, and this part of the target: */
    WIDE_PART = 4,
    TARGET_TILES_MAXIMUM = (TARGET_SIZE_MAXIMUM / TILE_SIZE) * (TARGET_SIZE_MAXIMUM / TILE_SIZE)
};

struct bin_cell {
    uint32_t next;    /* the cell with the following triangles */
    uint32_t sibling; /* of a head: another tile's head of the same chunk and band */
    uint32_t later;   /* of a head: the tile's head of a later chunk */
    uint32_t chunk;   /* of a head */
    uint16_t tile;
    uint8_t count;
    uint8_t bits; /* those of any of its triangles */
    uint32_t
        triangle[BIN_CELL_TRIANGLES]; /* offsets of records, with the bits that hold for the triangle here */
};

/* Offsets are multiples of ARENA_ALIGNMENT, and the bits are of triangles with one sample a pixel. A triangle
 * that covers a tile within the scissor has BIN_COVERS there, unless setup leaves it in several. */
enum {
    BIN_COVERS = 1,
    BIN_SPANS = 2,     /* it is in the class of its draw's span reading, and as large as the draw demands */
    BIN_RECTANGLE = 4, /* the record is a rectangle */
    BIN_READING = 8,   /* times the span reading with which its whole blocks are counted (enum span) */
    BIN_COUNTED = ARENA_ALIGNMENT - BIN_READING,
    BIN_BITS = BIN_COVERS | BIN_SPANS | BIN_RECTANGLE | BIN_COUNTED
};

_Static_assert((int)SPAN_COUNT <= (int)ARENA_ALIGNMENT / (int)BIN_READING,
               "offsets leave bits for each class");

/* The triangles that a chunk begins with and that are in no cells. */
struct wide {
    struct rectangle tiles; /* that their bounds meet */
    uint32_t count;
    struct {
        uint32_t offset; /* of its record, with its bits but BIN_COVERS */
        struct raster raster;
    } triangle[WIDE_TRIANGLES];
};

/* One thread's way into the arena, and the chunk it is writing. */
struct bin_writer {
    struct arena *arena;
    uint32_t at, end;       /* what is left of its block */
    uint32_t asked;         /* the end of what is prefetched */
    uint32_t columns, rows; /* of the target, in tiles */
    uint32_t chunk;
    uint32_t bands;
    uint32_t band_shift;       /* tiles with equal bits above these are a band */
    uint32_t heads[BIN_BANDS]; /* first head cell of the chunk, of each band */
    uint32_t head_count;       /* of all bands */
    uint32_t wide;             /* its struct wide; 0: it has none */
    uint32_t covered;          /* how many tiles its triangles cover, each counted for itself */
    bool joins;                /* pairs of records become rectangles (render/geometry/bin_pair.h) */
    bool joined;               /* all records of the chunk are, with bin_pair_has_unit_color() */
    uint64_t
        pixels; /* estimate: the pixels of bounds that meet several tiles, and a constant for each triangle */
    uint32_t open[TARGET_TILES_MAXIMUM]; /* the tile's last cell of the chunk */
    struct span_class class[SPAN_COUNT]; /* of the chunk's draw, for its readings */
    unsigned classified;                 /* a bit for each that has been found */
    bool marked;                         /* a triangle of the group has one of the bits but BIN_COVERS, */
    uint8_t marks[SETUP_CAPACITY];       /* and these are the bits of all of them */
    uint32_t tile[SETUP_CAPACITY]; /* that holds the bounds of a triangle of the group; STRIP_TILES: they meet
                                      several in a row or column, and cover none; MANY_TILES: several */
    struct rectangle tiles[SETUP_CAPACITY]; /* and these are the tiles that they meet */
};

static inline struct bin_cell *bin_cell(const struct arena *arena, uint32_t offset)
{
    return (struct bin_cell *)(void *)(arena->base + offset);
}

static inline struct wide *bin_wide(const struct arena *arena, uint32_t offset)
{
    return (struct wide *)(void *)(arena->base + offset);
}

/* Those of a wide chunk's triangles that may touch the tile (column, row), as a cell. */
void bin_wide_cell(const struct wide *wide, uint32_t column, uint32_t row, struct bin_cell *cell);

/* Returns true if any of a wide chunk's triangles covers the tile. */
bool bin_wide_covers(const struct wide *wide, uint32_t column, uint32_t row);

/* Returns true if any triangle of the chain that begins with this cell covers the tile. */
bool bin_covers(const struct arena *arena, uint32_t head);

/* The least shift of tile numbers by which `tiles` tiles are up to BIN_BANDS bands. */
uint32_t bin_band_shift(uint32_t tiles);

/* Before a round of chunks: forgets the block, whose arena has been reset. A band_shift of 31: one band. */
void bin_begin_round(struct bin_writer *writer, struct arena *arena, uint32_t columns, uint32_t rows,
                     uint32_t band_shift);

/* Between them, the chunk's heads are written. Some may be in each of writer->heads then. */
void bin_begin_chunk(struct bin_writer *writer, uint32_t chunk);
void bin_end_chunk(struct bin_writer *writer);

/* Room for `bytes` at writer->at, aligned; null when the arena is full. */
uint8_t *bin_reserve(struct bin_writer *writer, uint32_t bytes);

/* Takes the `count` records of the draw that setup has written at writer->at: drops those that touch no pixel
 * of the scissor rectangle, keeps and bins the others. Returns how many it kept, two for each
 * rectangle that it joins, or -1 when the arena is full: then none is binned. */
int bin_records(struct bin_writer *writer, uint32_t count, const struct draw *draw);

#endif
