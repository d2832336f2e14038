#include "render/target/target.h"

#include "base/bits.h"
#include "base/minmax.h"
#include "machine/large.h"
#include "contract/lane.h"

#include <emmintrin.h>
#include <stdlib.h>
#include <string.h>

enum { ALL_CHANNELS = 15 };

const struct format *target_format(const struct triptych_target_description *description, unsigned t)
{
    enum triptych_surface_format number = description->color_format[t];
    return format_find(number || t ? number : TRIPTYCH_SURFACE_A8R8G8B8);
}

/* --- Attachments --- */

/* Absent colours take the room that the pixel routine's key gives them (spec/pixel/target.h). */
static void place_colors(struct target *target, const struct triptych_target_description *description,
                         const struct target_parts *parts)
{
    uint32_t plane = 0;
    for (unsigned t = 0; t < TARGETS; t++) {
        const struct format *format = target_format(description, t);
        struct attachment *a = parts->color[t];
        struct target_color *color = target->colors + t;
        *color = (struct target_color){.format = format, .attachment = a, .plane = plane};
        if (format)
            color->storage = (enum target_storage)format->target;
        plane += storage_planes[color->storage];
        if (!a)
            continue;
        color->clear = a->color_clear;
        color->columns = a->columns;
        target->planes = plane;
    }
}

/* Returns true if the colours that are stored have memory where a pixel routine finds them. */
static bool lie_together(const struct target *target)
{
    const struct tile_memory *memory = NULL;
    uint32_t before = 0; /* planes of the memory before those of the target */
    for (unsigned t = 0; t < TARGETS; t++) {
        const struct target_color *color = target->colors + t;
        const struct attachment *a = color->attachment;
        if (!a)
            continue;
        if (!a->memory || a->plane < color->plane || (memory && memory != a->memory) ||
            (memory && a->plane - color->plane != before))
            return false;
        memory = a->memory;
        before = a->plane - color->plane;
    }
    return true;
}

static struct attachment *first_color(const struct target *target)
{
    for (unsigned t = 0; t < TARGETS; t++)
        if (target->colors[t].attachment)
            return target->colors[t].attachment;
    return NULL;
}

/* New memory for all colours. Those with words have to move. */
static int gather_colors(struct target *target, struct error *error)
{
    uint32_t columns = 0, rows = 0;
    for (unsigned t = 0; t < TARGETS; t++)
        if (target->colors[t].attachment) {
            columns = max_u32(columns, target->colors[t].attachment->columns);
            rows = max_u32(rows, target->colors[t].attachment->rows);
        }
    uint32_t stride = target->planes * target->samples * TILE_PIXELS;
    struct tile_memory *memory = attachment_memory_create(columns, rows, stride, error);
    if (!memory)
        return -1;
    for (unsigned t = 0; t < TARGETS; t++) {
        struct attachment *a = target->colors[t].attachment;
        uint32_t plane = target->colors[t].plane;
        if (!a)
            continue;
        if (a->memory)
            target->move[target->moves++] = (struct tile_move){
                attachment_retain(a), a->memory, attachment_memory_retain(memory), a->plane, plane};
        a->memory = attachment_memory_retain(memory);
        a->plane = plane;
    }
    attachment_memory_release(memory);
    return 0;
}

static int give_depth_memory(struct attachment *a, struct error *error)
{
    if (a && !a->memory)
        a->memory = attachment_memory_create(a->columns, a->rows, a->samples * TILE_PIXELS, error);
    return !a || a->memory ? 0 : -1;
}

static void note_size(struct target *target, const struct attachment *a)
{
    if (a && a->width > target->width)
        target->whole_columns = min_u32(target->whole_columns, target->width / TILE_SIZE);
    if (a && a->height > target->height)
        target->whole_rows = min_u32(target->whole_rows, target->height / TILE_SIZE);
}

/* Holds the attachments and their memory, and takes the addresses. */
static void hold_parts(struct target *target, const struct target_parts *parts)
{
    const struct attachment *first = first_color(target);
    for (unsigned t = 0; t < TARGETS; t++)
        note_size(target, attachment_retain(parts->color[t]));
    if (first) {
        target->memory[0] = attachment_memory_retain(first->memory);
        target->color_columns = first->memory->columns;
        target->color_stride = first->memory->stride;
        for (unsigned t = 0; t < TARGETS && !target->color; t++)
            if (target->colors[t].attachment)
                target->color =
                    first->memory->words + (size_t)(first->plane - target->colors[t].plane) * TILE_PIXELS;
    }
    if (!parts->depth)
        return;
    note_size(target, attachment_retain(parts->depth));
    target->depth_attachment = parts->depth;
    target->memory[1] = attachment_memory_retain(parts->depth->memory);
    target->depth = parts->depth->memory->words;
    target->depth_columns = parts->depth->columns;
    target->depth_clear = parts->depth->depth_clear;
}

int target_bind(struct target *target, const struct triptych_target_description *description,
                const struct target_parts *parts, struct error *error)
{
    struct target t = {.width = description->width,
                       .height = description->height,
                       .samples = 1u << samples_exponent(description->samples),
                       .depth_format = description->depth_format};
    t.columns = t.whole_columns = (t.width + TILE_SIZE - 1) / TILE_SIZE;
    t.rows = t.whole_rows = (t.height + TILE_SIZE - 1) / TILE_SIZE;
    place_colors(&t, description, parts);
    if (give_depth_memory(parts->depth, error) || (!lie_together(&t) && gather_colors(&t, error)))
        return -1;
    hold_parts(&t, parts);
    *target = t;
    return 0;
}

/* Colours of the format NULL store nothing. */
static int create_parts(const struct triptych_target_description *description, struct target_parts *parts,
                        struct error *error)
{
    uint32_t width = description->width, height = description->height;
    uint32_t samples = 1u << samples_exponent(description->samples);
    for (unsigned t = 0; t < TARGETS; t++) {
        const struct format *format = target_format(description, t);
        if (!format || format->number == TRIPTYCH_SURFACE_NULL)
            continue;
        parts->color[t] = attachment_create_color(format, width, height, samples, error);
        if (!parts->color[t])
            return -1;
    }
    if (!depth_formats[description->depth_format].depth_bits)
        return 0;
    parts->depth = attachment_create_depth(description->depth_format, width, height, samples, error);
    return parts->depth ? 0 : -1;
}

int target_create(struct target *target, const struct triptych_target_description *description,
                  struct error *error)
{
    struct target_parts parts = {{NULL}, NULL};
    int result = create_parts(description, &parts, error);
    if (!result)
        result = target_bind(target, description, &parts, error);
    for (unsigned t = 0; t < TARGETS; t++)
        attachment_release(parts.color[t]);
    attachment_release(parts.depth);
    return result;
}

void target_destroy(struct target *target)
{
    for (uint32_t i = 0; i < target->moves; i++) {
        attachment_release(target->move[i].attachment);
        attachment_memory_release(target->move[i].from);
        attachment_memory_release(target->move[i].to);
    }
    for (unsigned t = 0; t < TARGETS; t++)
        attachment_release(target->colors[t].attachment);
    attachment_release(target->depth_attachment);
    attachment_memory_release(target->memory[0]);
    attachment_memory_release(target->memory[1]);
    memset(target, 0, sizeof *target);
}

void target_move_tile(const struct tile_move *move, uint32_t tile)
{
    const struct attachment *a = move->attachment;
    const struct tile_memory *from = move->from, *to = move->to;
    uint32_t column = tile % a->columns, row = tile / a->columns;
    if (a->color_clear[tile].pending)
        return;
    memcpy(to->words + (size_t)(row * to->columns + column) * to->stride + move->to_plane * TILE_PIXELS,
           from->words + (size_t)(row * from->columns + column) * from->stride +
               move->from_plane * TILE_PIXELS,
           (size_t)attachment_planes(a) * a->samples * TILE_PLANE_BYTES);
}

/* --- The whole --- */

void target_describe(const struct target *target, struct triptych_target_description *description)
{
    *description = (struct triptych_target_description){.width = target->width,
                                                        .height = target->height,
                                                        .samples = target->samples,
                                                        .depth_format = target->depth_format};
    for (unsigned t = 0; t < TARGETS; t++)
        if (target->colors[t].format)
            description->color_format[t] = (enum triptych_surface_format)target->colors[t].format->number;
}

void target_clear_words(const struct target *target, const float color[4], uint32_t words[TARGET_PLANES])
{
    memset(words, 0, TARGET_PLANES * sizeof *words);
    for (unsigned t = 0; t < TARGETS; t++)
        if (target->colors[t].format) {
            uint32_t encoded[4];
            color_encode(target->colors[t].format, color, encoded);
            memcpy(words + target->colors[t].plane, encoded,
                   storage_planes[target->colors[t].storage] * sizeof *words);
        }
}

/* The pixels of a tile of an image, the last tiles cut. */
static struct rectangle area_in(uint32_t width, uint32_t height, uint32_t column, uint32_t row)
{
    int32_t x = (int32_t)column * TILE_SIZE, y = (int32_t)row * TILE_SIZE;
    return (struct rectangle){x, y, min_i32(x + TILE_SIZE, (int32_t)width),
                              min_i32(y + TILE_SIZE, (int32_t)height)};
}

static struct rectangle tile_area(const struct target *target, uint32_t tile)
{
    return area_in(target->width, target->height, tile % target->columns, tile / target->columns);
}

struct rectangle target_attachment_area(const struct attachment *a, uint32_t tile)
{
    return area_in(a->width, a->height, tile % a->columns, tile / a->columns);
}

/* --- Clears --- */

static void fill(void *words, uint32_t value)
{
    __m128i v = _mm_set1_epi32((int)value);
    for (int i = 0; i < TILE_PIXELS; i += 4)
        _mm_store_si128((__m128i *)((uint32_t *)words + i), v);
}

/* The first plane of a colour in a tile. */
static uint32_t *color_words(const struct target *target, const struct target_color *color, uint32_t tile)
{
    return target_tile_color(target, tile) + color->plane * TILE_PIXELS;
}

static uint32_t *fill_one(struct target *target, unsigned t, uint32_t tile)
{
    const struct target_color *color = target->colors + t;
    struct color_clear *clear = target_color_clear(target, t, tile);
    uint32_t *words = color_words(target, color, tile);
    uint32_t planes = storage_planes[color->storage];
    for (uint32_t p = 0; p < planes * target->samples && clear->pending; p++)
        fill(words + (p / planes * target->planes + p % planes) * TILE_PIXELS, clear->word[p % planes]);
    clear->pending = false;
    clear->changed = true;
    return words;
}

uint32_t *target_fill_color(struct target *target, uint32_t tile)
{
    for (unsigned t = 0; t < TARGETS; t++)
        if (target->colors[t].clear)
            fill_one(target, t, tile);
    return target_tile_color(target, tile);
}

uint32_t *target_fill_depth(struct target *target, uint32_t tile)
{
    uint32_t *words = target_tile_depth(target, tile);
    struct depth_clear *clear = target_depth_clear(target, tile);
    uint32_t planes = clear->pending ? target->samples : 0;
    for (uint32_t p = 0; p < planes; p++)
        fill(words + p * TILE_PIXELS, clear->word);
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

/* Sets the bits of the mask in a plane's words of the part of a tile. */
static void merge_part(uint32_t *plane, const struct rectangle *part, uint32_t value, uint32_t mask)
{
    uint32_t first = (uint32_t)part->x0 % TILE_SIZE, count = (uint32_t)(part->x1 - part->x0);
    uint32_t column[TILE_SIZE];
    for (uint32_t i = 0; i < count; i++)
        column[i] = pixel_word(first + i, 0);
    for (int32_t y = part->y0; y < part->y1; y++) {
        uint32_t *row = plane + pixel_word(0, (uint32_t)y % TILE_SIZE);
        for (uint32_t i = 0; i < count; i++)
            row[column[i]] = merged(row[column[i]], value, mask);
    }
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
    channel_masks(color, ALL_CHANNELS & ~clear->kept_channels, masks);
    if (same_area(part, &whole) && (pending->pending || !clear->kept_channels)) {
        for (uint32_t p = 0; p < planes; p++)
            pending->word[p] = merged(pending->word[p], value[p], masks[p]);
        pending->pending = pending->changed = true;
        return;
    }
    uint32_t *words = fill_one(target, t, tile);
    for (uint32_t p = 0; p < target->samples * planes; p++)
        merge_part(words + (p / planes * target->planes + p % planes) * TILE_PIXELS, part, value[p % planes],
                   masks[p % planes]);
}

/* Returns true if every used bit of the words is set, so their old values do not matter. */
static bool sets_whole_word(const struct target *target, const struct clear *clear)
{
    enum triptych_depth_format format = target->depth_format;
    return clear->depth_mask == (depth_mask(format) | stencil_mask(format));
}

/* Updates the bounds of a tile's depth for a clear, of the whole tile or of a part. */
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
    bool all = same_area(part, &whole) && (pending->pending || sets_whole_word(target, clear));
    note_cleared_depth(target, clear, pending, all);
    if (all) {
        pending->word = (pending->word & ~clear->depth_mask) | clear->depth;
        pending->pending = pending->changed = true;
        return;
    }
    uint32_t *words = target_fill_depth(target, tile);
    for (uint32_t p = 0; p < target->samples; p++)
        merge_part(words + p * TILE_PIXELS, part, clear->depth, clear->depth_mask);
}

static void clear_area(struct target *target, uint32_t tile, const struct clear *clear,
                       const struct rectangle *area)
{
    struct rectangle has = tile_area(target, tile);
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

/* --- Reading --- */

/* Quad order to rows:  0 1 4 5 | 2 3 6 7 | 8 9 12 13 | 10 11 14 15 */
static void block_rows(const uint32_t *block, __m128i row[BLOCK_SIZE])
{
    const __m128i *quad = (const __m128i *)block;
    row[0] = _mm_unpacklo_epi64(quad[0], quad[1]);
    row[1] = _mm_unpackhi_epi64(quad[0], quad[1]);
    row[2] = _mm_unpacklo_epi64(quad[2], quad[3]);
    row[3] = _mm_unpackhi_epi64(quad[2], quad[3]);
}

/* The first `columns` (1 to 4) words of a block's row. */
static inline void store_row(uint32_t *image, __m128i row, uint32_t columns)
{
    if (columns == BLOCK_SIZE)
        _mm_storeu_si128((__m128i *)image, row);
    else
        memcpy(image, &row, columns * sizeof *image);
}

/* A block; `columns` and `rows` (1 to 4) of it lie in the image. */
static void read_block(const uint32_t *block, uint32_t *image, size_t pitch, uint32_t columns, uint32_t rows)
{
    __m128i row[BLOCK_SIZE];
    block_rows(block, row);
    for (uint32_t y = 0; y < rows; y++)
        store_row(image + y * pitch, row[y], columns);
}

static uint32_t block_part(int32_t edge, int32_t start)
{
    return (uint32_t)min_i32(edge - start, BLOCK_SIZE);
}

void target_read_tile(const uint32_t *words, const struct rectangle *area, uint32_t *image, size_t pitch)
{
    for (int32_t y = area->y0; y < area->y1; y += BLOCK_SIZE)
        for (int32_t x = area->x0; x < area->x1; x += BLOCK_SIZE) {
            uint32_t word = pixel_word((uint32_t)(x - area->x0), (uint32_t)(y - area->y0));
            read_block(words + word, image + (size_t)y * pitch + (size_t)x, pitch, block_part(area->x1, x),
                       block_part(area->y1, y));
        }
}

void target_read_constant(uint32_t value, const struct rectangle *area, uint32_t *image, size_t pitch)
{
    __m128i row = _mm_set1_epi32((int)value);
    for (int32_t y = area->y0; y < area->y1; y++)
        for (int32_t x = area->x0; x < area->x1; x += BLOCK_SIZE)
            store_row(image + (size_t)y * pitch + (size_t)x, row, block_part(area->x1, x));
}

/* The record of a colour's tile. Colours of the format NULL have all channels 1. */
static const struct color_clear *remembered(const struct target *target, const struct target_color *color,
                                            uint32_t tile)
{
    static const struct color_clear nothing = {.word = {UINT32_MAX}, .pending = true};
    return color->clear ? color->clear + target_tile_in(target, color->columns, tile) : &nothing;
}

/* A sample of a colour with one plane, in a row of tiles. */
static void read_plane(const struct target *target, uint32_t sample, const struct target_color *color,
                       uint32_t tile_row, uint32_t *image, size_t pitch)
{
    for (uint32_t i = 0; i < target->columns; i++) {
        uint32_t tile = tile_row * target->columns + i;
        struct rectangle area = tile_area(target, tile);
        const struct color_clear *clear = remembered(target, color, tile);
        if (clear->pending)
            target_read_constant(clear->word[0], &area, image, pitch);
        else
            target_read_tile(color_words(target, color, tile) + sample * target->planes * TILE_PIXELS, &area,
                             image, pitch);
    }
}

/* The words of a sample of pixel x, y of a colour, one for each of its planes. */
static void pixel_words(const struct target *target, const struct target_color *color, uint32_t sample,
                        uint32_t x, uint32_t y, uint32_t words[4])
{
    uint32_t tile = y / TILE_SIZE * target->columns + x / TILE_SIZE;
    const struct color_clear *clear = remembered(target, color, tile);
    if (clear->pending) {
        memcpy(words, clear->word, storage_planes[color->storage] * sizeof *words);
        return;
    }
    const uint32_t *place = color_words(target, color, tile) + pixel_word(x % TILE_SIZE, y % TILE_SIZE) +
                            sample * target->planes * TILE_PIXELS;
    for (int p = 0; p < storage_planes[color->storage]; p++)
        words[p] = place[p * TILE_PIXELS];
}

static void resolve_bytes(const struct target *target, const struct target_color *color, uint32_t x,
                          uint32_t y, uint32_t *word)
{
    uint32_t sum[4] = {0};
    for (uint32_t sample = 0; sample < target->samples; sample++) {
        pixel_words(target, color, sample, x, y, word);
        for (int c = 0; c < 4; c++)
            sum[c] += *word >> 8 * c & 255;
    }
    *word = 0;
    for (int c = 0; c < 4; c++)
        *word |= (sum[c] + target->samples / 2) / target->samples << 8 * c;
}

static void resolve_numbers(const struct target *target, const struct target_color *color, uint32_t x,
                            uint32_t y, uint32_t words[4])
{
    float sum[4] = {0};
    for (uint32_t sample = 0; sample < target->samples; sample++) {
        pixel_words(target, color, sample, x, y, words);
        for (int c = 0; c < 4; c++)
            sum[c] += bits_to_float(words[c]);
    }
    for (int c = 0; c < 4; c++)
        words[c] = bits_of_float(sum[c] / (float)target->samples);
}

/* The value that is read of a pixel. */
static void read_words(const struct target *target, const struct target_color *color, int sample, uint32_t x,
                       uint32_t y, uint32_t words[4])
{
    if (sample != SAMPLE_RESOLVED || target->samples == 1)
        pixel_words(target, color, sample < 0 ? 0 : (uint32_t)sample, x, y, words);
    else if (storage_planes[color->storage] == 1)
        resolve_bytes(target, color, x, y, words);
    else
        resolve_numbers(target, color, x, y, words);
}

static uint32_t row_end(const struct target *target, uint32_t tile_row)
{
    uint32_t end = (tile_row + 1) * TILE_SIZE;
    return end < target->height ? end : target->height;
}

void target_read_color(const struct target *target, unsigned t, int sample, uint32_t tile_row,
                       uint32_t *image, size_t pitch)
{
    const struct target_color *color = target->colors + t;
    bool single = sample != SAMPLE_RESOLVED || target->samples == 1;
    if (storage_planes[color->storage] == 1 && single) {
        read_plane(target, sample < 0 ? 0 : (uint32_t)sample, color, tile_row, image, pitch);
        return;
    }
    for (uint32_t y = tile_row * TILE_SIZE; y < row_end(target, tile_row); y++)
        for (uint32_t x = 0; x < target->width; x++) {
            uint32_t words[4];
            read_words(target, color, sample, x, y, words);
            image[y * pitch + x] = color_bytes(color->storage, words);
        }
}

void target_read_numbers(const struct target *target, unsigned t, int sample, uint32_t tile_row, float *image,
                         size_t pitch)
{
    const struct target_color *color = target->colors + t;
    for (uint32_t y = tile_row * TILE_SIZE; y < row_end(target, tile_row); y++)
        for (uint32_t x = 0; x < target->width; x++) {
            uint32_t words[4];
            read_words(target, color, sample, x, y, words);
            color_numbers(color->storage, words, image + (y * pitch + x) * 4);
        }
}

static const uint32_t *depth_plane(const struct target *target, uint32_t tile, int sample)
{
    return target_tile_depth(target, tile) + (sample < 0 ? 0 : sample) * TILE_PIXELS;
}

void target_read_depth(const struct target *target, int sample, uint32_t tile_row, float *image)
{
    uint32_t *words = (uint32_t *)(void *)image;
    for (uint32_t i = 0; i < target->columns; i++) {
        uint32_t tile = tile_row * target->columns + i;
        struct rectangle area = tile_area(target, tile);
        const struct depth_clear *clear = target_depth_clear(target, tile);
        if (clear->pending)
            target_read_constant(clear->word, &area, words, target->width);
        else
            target_read_tile(depth_plane(target, tile, sample), &area, words, target->width);
    }
    if (depth_formats[target->depth_format].storage == DEPTH_FLOAT)
        return;
    size_t first = (size_t)tile_row * TILE_SIZE * target->width;
    for (size_t p = first; p < (size_t)row_end(target, tile_row) * target->width; p++)
        image[p] = depth_decode(target->depth_format, words[p]);
}

void target_read_stencil(const struct target *target, int sample, uint32_t tile_row, uint8_t *image)
{
    uint32_t mask = stencil_mask(target->depth_format);
    for (uint32_t i = 0; i < target->columns; i++) {
        uint32_t tile = tile_row * target->columns + i;
        struct rectangle area = tile_area(target, tile);
        const uint32_t *words = depth_plane(target, tile, sample);
        const struct depth_clear *clear = target_depth_clear(target, tile);
        for (int32_t y = area.y0; y < area.y1; y++)
            for (int32_t x = area.x0; x < area.x1; x++) {
                uint32_t at = pixel_word((uint32_t)(x - area.x0), (uint32_t)(y - area.y0));
                uint32_t word = clear->pending ? clear->word : words[at];
                image[(size_t)y * target->width + (size_t)x] = (uint8_t)(word & mask);
            }
    }
}
