/* The target: up to four colours and depth that are drawn to together. It is a set of attachments
 * (render/target/attachment.h), whose tiles are cleared lazily and made linear when they are read.
 *
 * The target's pixels are those that all its colours have; without colours, those that depth has. Depth has
 * at least these. Tiles are numbered by the target's columns; attachments that are wider number theirs by
 * their own. */
#ifndef RENDER_TARGET_TARGET_H
#define RENDER_TARGET_TARGET_H

#include "contract/arguments.h"
#include "render/blit/blit.h"
#include "render/target/attachment.h"
#include "render/raster/raster.h"

enum { TARGET_PLANES = 4 * TARGETS };

/* A colour of the target. A tile has one or four planes for it (def/state/target.def). */
struct target_color {
    const struct format *format;   /* null: there is none */
    struct attachment *attachment; /* null: there is none, or its format stores nothing */
    struct color_clear *clear;     /* the attachment's, by its own columns */
    uint32_t columns;
    enum target_storage storage;
    uint32_t plane; /* its first */
};

/* Words of an attachment that must move to other memory before the target is drawn to. */
struct tile_move {
    struct attachment *attachment;
    struct tile_memory *from, *to;
    uint32_t from_plane, to_plane;
};

struct target {
    uint32_t width, height;             /* pixels, 0 when there is no target */
    uint32_t columns, rows;             /* tiles */
    uint32_t whole_columns, whole_rows; /* tiles left of and above these have no pixels of an attachment that
                                           the target has not */
    uint32_t samples;                   /* per pixel */
    uint32_t *color; /* the first plane of the first colour: a tile has `planes` planes per sample, in turn;
                               null: no colour is stored */
    uint32_t planes; /* from the first colour to the last that is stored; absent ones have gaps */
    struct tile_order color_order, depth_order;
    struct target_color colors[TARGETS];
    uint32_t *depth; /* a plane per tile and sample (render/target/depth.h); null in a target without */
    uint32_t depth_columns; /* of its clears */
    struct attachment *depth_attachment;
    enum triptych_depth_format depth_format;
    struct depth_clear *depth_clear; /* by depth_columns */
    struct tile_memory *memory[2];   /* that of colours and that of depth, which the target holds */
    struct tile_move move[TARGETS];  /* to do before anything is drawn */
    uint32_t moves;
};

/* A rectangle of a clear in one row of tiles, as struct rectangle has it. */
struct clear_part {
    uint16_t x0, y0, x1, y1;
};

enum { CLEAR_PARTS = 256, TARGET_ROWS_MAXIMUM = TARGET_SIZE_MAXIMUM / TILE_SIZE };

/* The rectangles of a clear, by rows of tiles: those of row r are part[begin[r]] to part[begin[r + 1] - 1].
 */
struct clear_parts {
    uint32_t begin[TARGET_ROWS_MAXIMUM + 1];
    struct clear_part part[];
};

/* The kinds of words that a clear changes: colours with one plane, with four, and depth. */
enum clear_kind { CLEAR_WORDS, CLEAR_PLANES, CLEAR_DEPTH, CLEAR_KINDS };

/* The values and the area of a clear. */
struct clear {
    struct rectangle area;
    const struct clear_parts *parts; /* of the area; null: all of it */
    uint32_t kept_channels;          /* of the colours: bits as in a write mask */
    uint32_t color[TARGET_PLANES];
    uint32_t depth;      /* new bits of the word */
    uint32_t depth_mask; /* which of them are set: depth's, stencil's, both or none */
    bool set_color;
    const struct routine *merge[CLEAR_KINDS]; /* for tiles that do not only remember it; null: not needed */
};

/* A target of 1 to TARGET_SIZE_MAXIMUM pixels a side with attachments of its own: colour and stencil zero,
 * depth 1. Returns 0 or -1 with the reason. */
int target_create(struct target *target, const struct triptych_target_description *description,
                  bool quad_rows, struct error *error);

/* A target of existing attachments, which it holds. The description has its size, its number of samples and
 * the attachments' formats; a colour of format NULL has no attachment. Their words may have to move before
 * the target is drawn to (target_move_tile). Returns 0, or -1 with the reason and nothing changed. */
struct target_parts {
    struct attachment *color[TARGETS], *depth;
    bool quad_rows; /* the order of new memory */
};
int target_bind(struct target *target, const struct triptych_target_description *description,
                const struct target_parts *parts, struct error *error);
void target_destroy(struct target *target);

/* Sets the order of the target's memory. Nothing is queued that uses it. */
void target_set_order(struct target *target, bool quad_rows);

/* Moves the words of one of the attachment's tiles, from 0 to columns * rows - 1. */
void target_move_tile(const struct tile_move *move, uint32_t tile);

/* The format that a description has for colour target t; null: none. Its number is a format's. */
const struct format *target_format(const struct triptych_target_description *description, unsigned t);

/* The target's own description. */
void target_describe(const struct target *target, struct triptych_target_description *description);

/* The words of a clear to a colour. Called in the contract's floating-point environment. */
void target_clear_words(const struct target *target, const float color[4], uint32_t words[TARGET_PLANES]);

/* The word of a pixel within its tile: the block, then quad order (contract/layout.h). */
static inline uint32_t pixel_word(uint32_t x, uint32_t y)
{
    uint32_t block = y / BLOCK_SIZE * (TILE_SIZE / BLOCK_SIZE) + x / BLOCK_SIZE;
    uint32_t lane = (x & 1) | (y & 1) << 1 | (x & 2) << 1 | (y & 2) << 2;
    return block * BLOCK_PIXELS + lane;
}

/* A tile of the target by the numbers of an attachment with other columns. */
static inline uint32_t target_tile_in(const struct target *target, uint32_t columns, uint32_t tile)
{
    return columns == target->columns ? tile : tile / target->columns * columns + tile % target->columns;
}

/* The first of a tile's planes. The target has a colour that is stored. */
static inline uint32_t *target_tile_color(const struct target *target, uint32_t tile)
{
    return target->color +
           tile_order_place(&target->color_order, tile % target->columns, tile / target->columns);
}

/* The first plane of one of the colours. */
static inline uint32_t *target_color_words(const struct target *target, const struct target_color *color,
                                           uint32_t tile)
{
    return target_tile_color(target, tile) + color->plane * target->color_order.plane;
}

static inline uint32_t *target_tile_depth(const struct target *target, uint32_t tile)
{
    return target->depth +
           tile_order_place(&target->depth_order, tile % target->columns, tile / target->columns);
}

/* The record of a tile. The colour is stored; the target has depth. */
static inline struct color_clear *target_color_clear(const struct target *target, unsigned t, uint32_t tile)
{
    return target->colors[t].clear + target_tile_in(target, target->colors[t].columns, tile);
}

static inline struct depth_clear *target_depth_clear(const struct target *target, uint32_t tile)
{
    return target->depth_clear + target_tile_in(target, target->depth_columns, tile);
}

/* Returns true if the target has all pixels of the tile that its attachments have. */
static inline bool target_has_whole(const struct target *target, uint32_t tile)
{
    return tile % target->columns < target->whole_columns && tile / target->columns < target->whole_rows;
}

/* Sorts up to CLEAR_PARTS rectangles inside the target, none of them empty (render/target/clear.c): the
 * number of bytes, and the result. */
size_t target_clear_bytes(const struct rectangle *rectangles, uint32_t count);
void target_clear_sort(const struct rectangle *rectangles, uint32_t count, struct clear_parts *parts);

/* Finds the routines of a clear of the area, or with null of parts, to be released: the values are already
 * set. Returns 0, or -1 with the reason. */
int target_acquire_clear(const struct target *target, const struct blits *blits, const struct rectangle *area,
                         struct clear *clear, struct error *error);
void target_release_clear(const struct blits *blits, const struct clear *clear);

/* Applies the clear's part in one tile. */
void target_clear_tile(struct target *target, uint32_t tile, const struct clear *clear);

/* Makes the tile's words valid before they are read or changed; returns them. A caller that changes depth
 * then updates the known bounds, or calls target_forget_depth. The target has colours that are stored, or
 * depth. */
uint32_t *target_fill_color(struct target *target, uint32_t tile);
uint32_t *target_fill_depth(struct target *target, uint32_t tile);
void target_forget_depth(struct target *target, uint32_t tile);

/* The same for a caller that writes all words of the tile's colours before they are read. */
void target_replace_color(struct target *target, uint32_t tile);

/* A tile of a target in quad rows is drawn to in memory of its own: `view` is the target with only this tile,
 * at `words`, of TARGET_VIEW_WORDS. It has the tile's valid words. Parts in tiles stay where they are.
 * target_close_view copies the words that are valid then back. */
enum { TARGET_VIEW_WORDS = (4 * SAMPLES_MAXIMUM + SAMPLES_MAXIMUM) * TILE_PIXELS };
_Static_assert((int)TARGET_PLANES <= 4 * SAMPLES_MAXIMUM, "a target with several samples has one colour");
bool target_needs_view(const struct target *target);
void target_open_view(const struct target *target, uint32_t tile, uint32_t *words, struct target *view);
void target_close_view(const struct target *view, uint32_t tile, const struct target *target);

/* The part of a tile that has pixels of the target; of an attachment, by its own numbers. */
struct rectangle target_tile_area(const struct target *target, uint32_t tile);
struct rectangle target_attachment_area(const struct attachment *attachment, uint32_t tile);

/* Copies a plane of a tile to rows of an image that are `pitch` words apart; and a constant. `area` is the
 * part of the tile that is copied, in pixels of the image: it begins at the tile's corner. */
void target_read_tile(const struct tile_order *order, const uint32_t *words, const struct rectangle *area,
                      uint32_t *image, size_t pitch);
void target_read_constant(uint32_t value, const struct rectangle *area, uint32_t *image, size_t pitch);

/* Everything that the target holds, as it is stored (render/target/contents.c): the number of bytes, a
 * copy of them, and the way back. */
size_t target_contents_bytes(const struct triptych_target_description *description);
void target_read_contents(struct target *target, void *data);
void target_write_contents(struct target *target, const void *data);

/* Which of a pixel's samples is read; resolved is the average of all colours (spec/blit/resolve.h), and
 * sample 0 of depth and stencil. */
enum { SAMPLE_RESOLVED = -1 };

/* A colour that is read. */
struct target_reading {
    const struct target *target;
    unsigned t; /* its number */
    int sample;
    const struct routine *resolve; /* null: one sample (render/target/resolve.h) */
};

/* Copies one row of tiles into rows of a linear image of the target's size: a colour as RGBA8 (what
 * has more is clamped to 0..1 and rounded) or as four numbers a pixel. A row begins `pitch` pixels after the
 * one above. */
void target_read_color(const struct target_reading *reading, uint32_t tile_row, uint32_t *image,
                       size_t pitch);
void target_read_numbers(const struct target_reading *reading, uint32_t tile_row, float *image, size_t pitch);
void target_read_depth(const struct target *target, int sample, uint32_t tile_row, float *image);
void target_read_stencil(const struct target *target, int sample, uint32_t tile_row, uint8_t *image);

#endif
