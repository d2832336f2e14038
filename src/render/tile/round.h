/* A round: the chunks that are rendered together, and their bins, tile by tile.
 *
 * Geometry writes the bins of each chunk. Then linking appends them to the bins of the tiles, in the order of
 * the chunks, so that each tile draws in that order. Several threads can link side by side, each a band of
 * tiles. A clear, or a chunk with wide triangles
 * (render/geometry/bin.h), is not in any bin but in the list `everywhere`, which every tile goes through
 * besides its own bin. */
#ifndef RENDER_TILE_ROUND_H
#define RENDER_TILE_ROUND_H

#include "render/draw/command.h"
#include "render/geometry/batch.h"
#include "setting/setting.h"

#include <stdbool.h>

enum { ROUND_CHUNKS = 4096 };

/* A run of one draw's primitives, or a clear. */
struct chunk {
    uint32_t command;
    uint32_t first, count;     /* primitives */
    uint32_t done;             /* how many of them are in the bins */
    uint32_t heads[BIN_BANDS]; /* head cells of its bins, of each of the round's bands */
    uint32_t head_count;       /* of all bands */
    uint32_t wide;             /* see struct bin_writer, like the next three */
    uint32_t covered;
    bool joined;
    uint64_t pixels;
    struct batch_counts counts;
};

/* The next primitive to render. */
struct cursor {
    uint32_t command, primitive;
};

struct round {
    /* The commands and resources that the chunks refer to. */
    const struct command *command;
    struct target *target;
    uint32_t farthest; /* the word of the target's greatest depth */
    struct setting_values settings;
    struct arena arena;
    _Atomic uint64_t *passed; /* for each command, samples that passed the tests if its key counts them */

    struct chunk chunk[ROUND_CHUNKS];
    uint32_t chunks;
    _Atomic uint32_t first_stopped; /* the first chunk that did not fit into the arena; UINT32_MAX: none */
    uint32_t bands, band_shift;     /* of its tiles (struct bin_writer); 1 and 31: no bands */

    /* From here on: what linking makes of the chunks' bins. */
    uint32_t linked;                   /* chunks that are done, and the one that is so in part */
    uint64_t head_count;               /* of these */
    uint32_t everywhere[ROUND_CHUNKS]; /* numbers of the chunks that are clears or have wide triangles */
    uint32_t everywhere_count;
    uint32_t
        wide_start[ROUND_CHUNKS]; /* those of them whose wide triangles overwrite tiles that they cover */
    uint32_t wide_starts;
    uint32_t tile_first[TARGET_TILES_MAXIMUM]; /* head cells of each tile's bin */
    uint32_t tile_last[TARGET_TILES_MAXIMUM];
    uint32_t
        tile_start[TARGET_TILES_MAXIMUM]; /* 1 + the last chunk whose bin has a triangle that overwrites the
                                                  tile; 0: there is none */
    uint16_t busy[TARGET_TILES_MAXIMUM]; /* the tiles that have a bin; until round_end_linking those of a band
                                            from the number of the band's first tile on */
    uint32_t busy_of_band[BIN_BANDS];
    uint32_t busy_count;
    uint32_t tiles;  /* to render: the busy ones, or all of them if a chunk is everywhere */
    uint64_t pixels; /* in the bounds of what is to be drawn */
    struct batch_counts counts;
};

static inline const struct command *round_command(const struct round *round, uint32_t chunk)
{
    return round->command + round->chunk[chunk].command;
}

/* Notes that this chunk is not complete. Called by any thread. */
void round_stop_at(struct round *round, uint32_t chunk);

/* Chooses the round's bands: one, or several so that threads can link side by side. Precedes geometry. */
void round_begin_bands(struct round *round, bool several);

/* Makes the bins of the tiles from those of the chunks that are done, in three steps. The first returns the
 * first primitive that is not done, and links a single band too. Different threads can do different bands. */
struct cursor round_begin_linking(struct round *round);
void round_link_band(struct round *round, uint32_t band);
void round_end_linking(struct round *round);

/* All steps. */
struct cursor round_link(struct round *round);

/* Returns true if something may have to be rendered into the tile. */
static inline bool round_has_tile(const struct round *round, uint32_t tile)
{
    return round->everywhere_count || round->tile_first[tile];
}

/* The triangles in the bins of all tiles that are rendered, each for every tile whose bin has it. */
uint64_t round_tile_triangles(const struct round *round);

/* The tile that is rendered as number i of round->tiles. */
static inline uint32_t round_tile(const struct round *round, uint32_t i)
{
    return round->everywhere_count ? i : round->busy[i];
}

#endif
