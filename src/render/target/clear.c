/* Clears. A tile that is cleared as a whole only remembers the values; its words are filled when they are
 * needed. Routines change the words of other tiles (spec/blit/clear.h).
 *
 * The rectangles of a clear are sorted by rows of tiles, so that a tile does not go through those of
 * other rows. */
#include "base/minmax.h"
#include "render/target/target.h"

#include <string.h>

enum { ALL_CHANNELS = 15 };

/* --- Rectangles --- */

static int32_t first_row(const struct rectangle *r)
{
    return r->y0 / TILE_SIZE;
}

static int32_t end_row(const struct rectangle *r)
{
    return (r->y1 + TILE_SIZE - 1) / TILE_SIZE;
}

size_t target_clear_bytes(const struct rectangle *rectangles, uint32_t count)
{
    size_t parts = 0;
    for (uint32_t i = 0; i < count; i++)
        parts += (size_t)(end_row(rectangles + i) - first_row(rectangles + i));
    return sizeof(struct clear_parts) + parts * sizeof(struct clear_part);
}

/* Counts the parts of each row, then places them: begin[r + 1] is where the next part of row r is placed
 * until all are. */
void target_clear_sort(const struct rectangle *rectangles, uint32_t count, struct clear_parts *parts)
{
    uint32_t *next = parts->begin + 1, sum = 0;
    memset(parts->begin, 0, sizeof parts->begin);
    for (uint32_t i = 0; i < count; i++)
        for (int32_t row = first_row(rectangles + i); row < end_row(rectangles + i); row++)
            next[row]++;
    for (uint32_t row = 0; row < TARGET_ROWS_MAXIMUM; row++) {
        uint32_t in_row = next[row];
        next[row] = sum;
        sum += in_row;
    }
    for (uint32_t i = 0; i < count; i++) {
        const struct rectangle *r = rectangles + i;
        for (int32_t row = first_row(r); row < end_row(r); row++)
            parts->part[next[row]++] =
                (struct clear_part){(uint16_t)r->x0, (uint16_t)max_i32(r->y0, row * TILE_SIZE),
                                    (uint16_t)r->x1, (uint16_t)min_i32(r->y1, (row + 1) * TILE_SIZE)};
    }
}

/* --- Tiles --- */

/* Writes the words of a tile that only remembers them. */
static void fill_one(struct target *target, const struct target_color *color, uint32_t tile,
                     struct color_clear *clear)
{
    uint32_t *words = target_color_words(target, color, tile);
    uint32_t planes = storage_planes[color->storage];
    for (uint32_t p = 0; p < planes * target->samples; p++)
        tile_order_fill(&target->color_order,
                        words + (p / planes * target->planes + p % planes) * target->color_order.plane,
                        clear->word[p % planes]);
    clear->pending = false;
}

/* Makes the words of a colour valid before they are changed. */
static void open_one(struct target *target, unsigned t, uint32_t tile)
{
    struct color_clear *clear = target_color_clear(target, t, tile);
    if (clear->pending)
        fill_one(target, target->colors + t, tile, clear);
    clear->changed = true;
}

uint32_t *target_fill_color(struct target *target, uint32_t tile)
{
    for (unsigned t = 0; t < TARGETS; t++)
        if (target->colors[t].clear)
            open_one(target, t, tile);
    return target_tile_color(target, tile);
}

void target_replace_color(struct target *target, uint32_t tile)
{
    for (unsigned t = 0; t < TARGETS; t++)
        if (target->colors[t].clear) {
            struct color_clear *clear = target_color_clear(target, t, tile);
            clear->pending = false;
            clear->changed = true;
        }
}

uint32_t *target_fill_depth(struct target *target, uint32_t tile)
{
    uint32_t *words = target_tile_depth(target, tile);
    struct depth_clear *clear = target_depth_clear(target, tile);
    uint32_t planes = clear->pending ? target->samples : 0;
    for (uint32_t p = 0; p < planes; p++)
        tile_order_fill(&target->depth_order, words + p * target->depth_order.plane, clear->word);
    clear->pending = false;
    clear->changed = true;
    return words;
}

void target_forget_depth(struct target *target, uint32_t tile)
{
    target_depth_clear(target, tile)->range = (struct depth_range){0, depth_mask(target->depth_format)};
}

static bool same_area(const struct rectangle *a, const struct rectangle *b)
{
    return !memcmp(a, b, sizeof *a);
}

static uint32_t merged(uint32_t old, uint32_t new, uint32_t mask)
{
    return (old & ~mask) | (new &mask);
}

/* The places of the pixels of a row of blocks, as spec/blit/clear.h reads them: block by block, and the upper
 * halves of all blocks before the lower ones. */
#define PLACE(x, y) ((x) | (uint32_t)(y) << 16)
#define HALF(x, y)                                                                                           \
    PLACE(x, y), PLACE((x) + 1, y), PLACE(x, (y) + 1), PLACE((x) + 1, (y) + 1), PLACE((x) + 2, y),           \
        PLACE((x) + 3, y), PLACE((x) + 2, (y) + 1), PLACE((x) + 3, (y) + 1)
#define UPPER(x)   HALF(x, 0)
#define LOWER(x)   HALF(x, 2)
#define WHOLE(x)   HALF(x, 0), HALF(x, 2)
#define FOUR(M, x) M(x), M((x) + 4), M((x) + 8), M((x) + 12)
#define BLOCKS(M)  FOUR(M, 0), FOUR(M, 16), FOUR(M, 32), FOUR(M, 48)
alignas(64) static const uint32_t by_blocks[BLIT_ROW_WORDS] = {BLOCKS(WHOLE)};
alignas(64) static const uint32_t by_halves[BLIT_ROW_WORDS] = {BLOCKS(UPPER), BLOCKS(LOWER)};

enum { HALF_WORDS = BLOCK_PIXELS / 2, HALF_ROW = BLIT_ROW_WORDS / 2 };

/* Clears blocks `first` to `end` - 1 of a row of blocks, whose upper left word is at `row`. Where halves of
 * blocks follow each other, two blocks have the elements of a call. */
static void merge_row(const struct routine *merge, const struct blit_job *job, const struct tile_order *order,
                      uint32_t *row, uint32_t first, uint32_t end)
{
    if (order->block == BLOCK_PIXELS) {
        blit_run(merge, job, by_blocks + first * BLOCK_PIXELS, row + first * BLOCK_PIXELS,
                 (end - first) * BLOCK_PIXELS);
        return;
    }
    first &= ~1u;
    end += end & 1;
    for (uint32_t half = 0; half < 2; half++)
        blit_run(merge, job, by_halves + half * HALF_ROW + first * HALF_WORDS,
                 row + half * order->lower + first * HALF_WORDS, (end - first) * HALF_WORDS);
}

/* Sets the bits of the mask in a plane's words of the part of a tile. */
static void merge_part(const struct routine *merge, const struct tile_order *order, uint32_t *plane,
                       const struct rectangle *part, uint32_t value, uint32_t mask)
{
    struct blit_job job = {.word = value, .mask = mask};
    if (!merge->key.blit.part && order->block == BLOCK_PIXELS) {
        blit_run(merge, &job, plane, plane, TILE_PIXELS);
        return;
    }
    int32_t x = part->x0 % TILE_SIZE, end_x = x + part->x1 - part->x0;
    int32_t y = part->y0 % TILE_SIZE, end_y = y + part->y1 - part->y0;
    job.left = x - 1;
    job.right = end_x;
    for (int32_t block = y / BLOCK_SIZE; block * BLOCK_SIZE < end_y; block++) {
        job.top = y - block * BLOCK_SIZE - 1;
        job.bottom = end_y - block * BLOCK_SIZE;
        merge_row(merge, &job, order, plane + (size_t)block * order->block_row, (uint32_t)x / BLOCK_SIZE,
                  ((uint32_t)end_x + BLOCK_SIZE - 1) / BLOCK_SIZE);
    }
}

/* If the part is all that the target has of the tile, the whole tile: so pixels outside of the target get
 * what a pending clear gives them, whether the tile's words were written before or not. */
static struct rectangle extended(const struct rectangle *part, const struct rectangle *whole)
{
    return same_area(part, whole)
               ? (struct rectangle){whole->x0, whole->y0, whole->x0 + TILE_SIZE, whole->y0 + TILE_SIZE}
               : *part;
}

/* The channels of a colour that the clear sets: luminance if it sets red. */
static uint32_t cleared_channels(const struct target_color *color, const struct clear *clear)
{
    uint32_t channels = ALL_CHANNELS & ~clear->kept_channels;
    return color->storage == TARGET_L8 ? (channels & 8) | (channels & 1 ? 7 : 0) : channels;
}

/* The bits of the words of each of a colour's planes that belong to the channels. */
static void channel_masks(const struct target_color *color, uint32_t channels, uint32_t masks[4])
{
    bool packed = storage_planes[color->storage] == 1;
    memset(masks, 0, 4 * sizeof *masks);
    for (unsigned c = 0; c < 4; c++)
        if (channels >> c & 1)
            masks[packed ? 0 : c] |= packed ? 0xffu << 8 * c : UINT32_MAX;
}

/* Clears a colour's pixels of `part`. */
static void clear_color(struct target *target, unsigned t, uint32_t tile, const struct clear *clear,
                        const struct rectangle *part)
{
    const struct target_color *color = target->colors + t;
    uint32_t planes = storage_planes[color->storage], number = target_tile_in(target, color->columns, tile);
    struct rectangle whole = target_attachment_area(color->attachment, number);
    const uint32_t *value = clear->color + color->plane;
    struct color_clear *pending = color->clear + number;
    uint32_t masks[4];
    channel_masks(color, cleared_channels(color, clear), masks);
    if (same_area(part, &whole) && (pending->pending || !clear->kept_channels)) {
        for (uint32_t p = 0; p < planes; p++)
            pending->word[p] = merged(pending->word[p], value[p], masks[p]);
        pending->pending = pending->changed = true;
        return;
    }
    const struct rectangle pixels = extended(part, &whole);
    uint32_t *words = target_color_words(target, color, tile);
    open_one(target, t, tile);
    const struct routine *merge = clear->merge[planes == 1 ? CLEAR_WORDS : CLEAR_PLANES];
    for (uint32_t p = 0; p < target->samples * planes; p++)
        if (masks[p % planes])
            merge_part(merge, &target->color_order,
                       words + (p / planes * target->planes + p % planes) * target->color_order.plane,
                       &pixels, value[p % planes], masks[p % planes]);
}

/* Returns true if every used bit of the words is set, so their old values do not matter. */
static bool sets_whole_word(const struct target *target, const struct clear *clear)
{
    enum triptych_depth_format format = target->depth_format;
    return clear->depth_mask == (depth_mask(format) | stencil_mask(format));
}

/* Updates the bounds of a tile's depth for a clear of the whole tile or of a part. Whole tiles have only the
 * depth of the clear, whatever their stencil is. */
static void note_cleared_depth(const struct target *target, const struct clear *clear,
                               struct depth_clear *tile, bool whole)
{
    uint32_t mask = depth_mask(target->depth_format), depth = clear->depth & mask;
    if (!(clear->depth_mask & mask))
        return;
    if (whole)
        tile->range = (struct depth_range){depth, depth};
    tile->range.least = min_u32(depth, tile->range.least);
    tile->range.most = max_u32(depth, tile->range.most);
}

static void clear_depth(struct target *target, uint32_t tile, const struct clear *clear,
                        const struct rectangle *part)
{
    uint32_t number = target_tile_in(target, target->depth_columns, tile);
    struct rectangle whole = target_attachment_area(target->depth_attachment, number);
    struct depth_clear *pending = target->depth_clear + number;
    bool all = same_area(part, &whole);
    note_cleared_depth(target, clear, pending, all);
    if (all && (pending->pending || sets_whole_word(target, clear))) {
        pending->word = (pending->word & ~clear->depth_mask) | clear->depth;
        pending->pending = pending->changed = true;
        return;
    }
    const struct rectangle pixels = extended(part, &whole);
    uint32_t *words = target_fill_depth(target, tile);
    for (uint32_t p = 0; p < target->samples; p++)
        merge_part(clear->merge[CLEAR_DEPTH], &target->depth_order, words + p * target->depth_order.plane,
                   &pixels, clear->depth, clear->depth_mask);
}

/* --- Routines --- */

/* Returns true if the clear sets all pixels of every tile of its attachments. */
static bool clears_all(const struct target *target, const struct rectangle *area)
{
    return area && !area->x0 && !area->y0 && area->x1 == (int32_t)target->width &&
           area->y1 == (int32_t)target->height && target->whole_columns >= target->columns &&
           target->whole_rows >= target->rows;
}

/* The bytes that a mask consists of. */
static uint8_t bytes_of(uint32_t mask)
{
    uint8_t bytes = 0;
    for (int byte = 0; byte < 4; byte++) {
        uint32_t bits = mask >> 8 * byte & 255;
        if (bits && bits != 255)
            return BLIT_MASK_JOB;
        bytes |= (uint8_t)((bits != 0) << byte);
    }
    return bytes;
}

/* Adds the bytes that a clear of words sets in a colour to those in others. */
static uint8_t joined_mask(uint8_t mask, uint32_t channels)
{
    return !mask || mask == channels || !channels ? (uint8_t)(mask | channels) : BLIT_MASK_JOB;
}

/* The bytes that a clear of each kind sets; 0: there is none, or each tile remembers it. */
static void find_masks(const struct target *target, const struct clear *clear, bool all,
                       uint8_t mask[CLEAR_KINDS])
{
    memset(mask, 0, CLEAR_KINDS);
    for (unsigned t = 0; t < TARGETS && clear->set_color; t++)
        if (target->colors[t].clear && !(all && !clear->kept_channels)) {
            if (storage_planes[target->colors[t].storage] == 1)
                mask[CLEAR_WORDS] =
                    joined_mask(mask[CLEAR_WORDS], cleared_channels(target->colors + t, clear));
            else
                mask[CLEAR_PLANES] = BLIT_MASK_ALL;
        }
    if (clear->depth_mask && target->depth && !(all && sets_whole_word(target, clear)))
        mask[CLEAR_DEPTH] = bytes_of(clear->depth_mask);
}

int target_acquire_clear(const struct target *target, const struct blits *blits, const struct rectangle *area,
                         struct clear *clear, struct error *error)
{
    bool all = clears_all(target, area);
    uint8_t mask[CLEAR_KINDS];
    find_masks(target, clear, all, mask);
    for (int kind = 0; kind < CLEAR_KINDS; kind++) {
        const struct blit_key key = {.operation = BLIT_CLEAR, .write_mask = mask[kind], .part = !all};
        clear->merge[kind] = mask[kind] ? blit_acquire(blits, key, error) : NULL;
        if (mask[kind] && !clear->merge[kind]) {
            target_release_clear(blits, clear);
            return -1;
        }
    }
    return 0;
}

void target_release_clear(const struct blits *blits, const struct clear *clear)
{
    for (int kind = 0; kind < CLEAR_KINDS; kind++)
        blit_release(blits, clear->merge[kind]);
}

/* --- Areas --- */

static void clear_area(struct target *target, uint32_t tile, const struct clear *clear,
                       const struct rectangle *area)
{
    struct rectangle has = target_tile_area(target, tile);
    struct rectangle part = {max_i32(has.x0, area->x0), max_i32(has.y0, area->y0), min_i32(has.x1, area->x1),
                             min_i32(has.y1, area->y1)};
    if (part.x0 >= part.x1 || part.y0 >= part.y1)
        return;
    for (unsigned t = 0; t < TARGETS && clear->set_color; t++)
        if (target->colors[t].clear)
            clear_color(target, t, tile, clear, &part);
    if (clear->depth_mask && target->depth)
        clear_depth(target, tile, clear, &part);
}

void target_clear_tile(struct target *target, uint32_t tile, const struct clear *clear)
{
    const struct clear_parts *parts = clear->parts;
    uint32_t row = tile / target->columns;
    if (!parts) {
        clear_area(target, tile, clear, &clear->area);
        return;
    }
    for (uint32_t i = parts->begin[row]; i < parts->begin[row + 1]; i++) {
        const struct clear_part *part = parts->part + i;
        clear_area(target, tile, clear, &(struct rectangle){part->x0, part->y0, part->x1, part->y1});
    }
}
