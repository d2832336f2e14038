/* What a tile need not draw: what is hidden by depth that is known, what is overwritten later, and pixels that
 * all come out alike.
 *
 * Three things are known of large triangles before any pixel is shaded. None of them changes a bit of what is
 * drawn, and all are the renderer's, the same for every engine.
 *
 * Depth. Of each tile two words are kept that no stored depth is below or above (struct tile_clear). A triangle
 * whose depth within the tile fails the test against both is not rasterized. A draw that writes depth widens
 * them; a clear, or a triangle that covers the whole tile, narrows them. (Greene, Kass and Miller,
 * Hierarchical Z-Buffer Visibility, 1993, with one level: tiles are small enough to be the coarse one.)
 *
 * Overwriting. Where a triangle covers a whole tile, and its draw writes every channel whatever was there,
 * nothing remains of what was drawn before and left only colour: those draws are passed over in this tile.
 *
 * Uniform triangles. Where the whole tile is covered by a triangle whose pixels cannot differ (nothing is
 * interpolated, sampled or blended), one block is shaded, and the tile remembers its colour, and its depth if
 * that is constant, as it does a clear's.
 *
 * A bin says which of its triangles cover the whole tile (draw/bin.h). */
#ifndef DRAW_HIDDEN_H
#define DRAW_HIDDEN_H

#include "draw/command.h"

/* Of a pixel routine, by its key. */
enum pixel_trait {
    PIXEL_OVERWRITES =
        1, /* all channels of those targets that it writes, in each pixel that passes the test of
                             depth, which is the only one */
    PIXEL_OVERWRITES_ALL = 2, /* there is no test either */
    PIXEL_COLORS_ONLY = 4,    /* nothing but colour is left behind */
    PIXEL_UNIFORM = 8,        /* overwrites, and all pixels of a triangle get the same colour */
    PIXEL_DEPTH_KNOWN = 16,   /* depth is the triangle's plane, of one sample, tested without a stencil's */
    PIXEL_WRITES_DEPTH = 32
};

/* PIXEL_... of the key. */
unsigned pixel_traits(const struct pixel_key *key);

/* Whether each of the target's colours is written. */
bool pixel_writes_all_targets(const struct pixel_key *key, const struct target *target);

/* Between which depths the record's pixels lie, within the pixels of `area`; `constant` is whether they are all the
 * same. */
struct depth_range triangle_depths(const struct triangle_head *head, const struct plane *plane,
                                   const struct rectangle *area, enum triptych_depth_format format,
                                   bool *constant);

/* What comparing any new depth with any stored one gives. */
enum depth_verdict { DEPTH_UNDECIDED, DEPTH_PASSES, DEPTH_FAILS };
enum depth_verdict depth_verdict(int function, struct depth_range new, struct depth_range stored);

/* What is known of a tile after anything of `new` may have been written by a test with this function, in any of
 * its pixels. */
struct depth_range depth_widened(int function, struct depth_range stored, struct depth_range new);

/* The same when the test was made in all of its pixels. */
struct depth_range depth_narrowed(int function, struct depth_range stored, struct depth_range new);

#endif
