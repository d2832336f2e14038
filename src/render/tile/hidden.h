/* Work that a tile can skip: triangles that are hidden by known depth, draws that are overwritten later, and
 * triangles whose pixels are all equal.
 *
 * Three properties of large triangles are found before any pixel is shaded. None of them changes a bit of the
 * image, and they are part of the renderer, the same for every engine.
 *
 * Depth. For each tile two words are kept, a lower and an upper bound of all stored depths (struct
 * depth_clear). A triangle whose depths within the tile fail the test against both bounds is not rasterized.
 * A draw that writes depth widens the bounds; a clear, or a triangle that covers the whole tile, narrows
 * them. (Greene, Kass and Miller, Hierarchical Z-Buffer Visibility, 1993, with one level: tiles are small
 * enough to be the coarse one.)
 *
 * Overwriting. A triangle that covers a whole tile, and whose draw writes every channel without reading it,
 * leaves nothing of earlier draws that wrote only colour. Those draws are skipped in this tile, and a clear
 * that the tile only remembers is not written.
 *
 * Uniform triangles. When a triangle covers the whole tile and its pixels cannot differ (nothing is
 * interpolated, sampled or blended), one block is shaded. The tile stores that colour, and the depth if it is
 * constant, as it stores a clear. Where it covers a part of a tile, its colour is stored
 * (render/tile/tile_fill.c).
 *
 * A bin marks the triangles that cover the whole tile (render/geometry/bin.h). */
#ifndef RENDER_TILE_HIDDEN_H
#define RENDER_TILE_HIDDEN_H

#include "render/draw/command.h"

/* Of a pixel routine, by its key. */
enum pixel_trait {
    PIXEL_OVERWRITES =
        1, /* all channels of those targets that it writes, in each pixel that passes the test of
                             depth, which is the only one */
    PIXEL_OVERWRITES_ALL = 2, /* there is no test either */
    PIXEL_COLORS_ONLY = 4,    /* only colour is written */
    PIXEL_UNIFORM = 8,        /* overwrites, and all pixels of a triangle get the same colour */
    PIXEL_DEPTH_KNOWN = 16,   /* depth is the triangle's plane, of one sample, tested without a stencil's */
    PIXEL_WRITES_DEPTH = 32,
    PIXEL_SPANS = 64 /* its span reading may be faster: one sample, and colours that can vary are computed */
};

/* PIXEL_... of the key. */
unsigned hidden_traits(const struct pixel_key *key);

/* Returns true if each of the target's colours that are stored is written. */
bool hidden_writes_all_targets(const struct pixel_key *key, const struct target *target);

/* Returns true if all depths of the record's pixels are equal. */
bool hidden_is_level(const struct plane *plane);

/* The range of depths of such a record: one word. */
struct depth_range hidden_level_depths(const struct plane *plane, enum triptych_depth_format format);

/* The range of depths of any other record's pixels, within `area`. */
struct depth_range hidden_depths(const struct triangle_head *head, const struct plane *plane,
                                 const struct rectangle *area, enum triptych_depth_format format);

/* The result of comparing any new depth with any stored one. */
enum depth_verdict { DEPTH_UNDECIDED, DEPTH_PASSES, DEPTH_FAILS };
enum depth_verdict hidden_verdict(int function, struct depth_range new, struct depth_range stored);

/* The bounds of a tile after any of its pixels may have been tested with this function against any depth
 * of `new`. */
struct depth_range hidden_widened(int function, struct depth_range stored, struct depth_range new);

/* The same after all of its pixels were tested. */
struct depth_range hidden_narrowed(int function, struct depth_range stored, struct depth_range new);

#endif
