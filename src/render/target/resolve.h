/* Tiles of several samples per pixel as tiles of one: the averages of all samples (spec/blit/resolve.h). */
#ifndef RENDER_TARGET_RESOLVE_H
#define RENDER_TARGET_RESOLVE_H

#include "render/blit/blit.h"
#include "render/target/pixels.h"

/* The routine for a colour of a storage with several samples, in memory of this order; to be released. Null
 * with the reason. */
const struct routine *target_acquire_resolve(const struct blits *blits, enum target_storage storage,
                                             uint32_t samples, const struct tile_order *order,
                                             struct error *error);

/* Averages a tile, whose first sample's planes begin at `words`. `resolved` receives its planes in turn, in
 * the order tile_order_alone. */
void target_resolve_tile(const struct routine *resolve, const struct tile_order *order, const uint32_t *words,
                         uint32_t *resolved);

/* The same for tile number `tile` of the pixels' attachment, with several samples, into the one of `to` with
 * one, whose memory is in tiles. A tile that only remembers its clear gives another one that does. */
void pixels_resolve_tile(const struct routine *resolve, const struct pixels *from, const struct pixels *to,
                         uint32_t tile);

#endif
