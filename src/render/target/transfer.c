/* Transfers between texels of a texture and tiles of its attachment, a tile at a time. */
#include "base/bits.h"
#include "render/target/surface.h"

#include <string.h>

/* A tile of a transfer. */
struct part {
    struct rectangle area;
    uint32_t width, height;
    uint32_t *words; /* its first plane */
    const struct tile_order *order;
    struct texture_image image; /* the area's texels */
};

static struct part part_of(const struct surface_transfer *transfer, uint32_t tile)
{
    const struct attachment *a = transfer->attachment;
    const struct tile_memory *memory = transfer->memory;
    struct rectangle area = target_attachment_area(a, tile);
    struct part part = {
        area,
        (uint32_t)(area.x1 - area.x0),
        (uint32_t)(area.y1 - area.y0),
        tile_memory_words(memory, tile % a->columns, tile / a->columns, transfer->plane),
        &memory->order,
        transfer->image,
    };
    part.image.texels = texture_texel(&transfer->image, (size_t)area.x0, (size_t)area.y0);
    return part;
}

/* The word of a pixel in plane p. */
static uint32_t *word_of(const struct part *part, uint32_t p, uint32_t x, uint32_t y)
{
    return part->words + p * part->order->plane + tile_order_word(part->order, x, y);
}

/* The texels of row y: where they are, or copied to `copy` if they are in tiles or compact. */
static const uint32_t *load_row(const struct part *part, uint32_t y, uint32_t copy[4 * TILE_SIZE])
{
    if (texture_has_rows(&part->image))
        return texture_texel(&part->image, 0, y);
    texture_read_row(&part->image, 0, y, part->width, copy);
    return copy;
}

static void load_words(const struct part *part)
{
    uint32_t copy[4 * TILE_SIZE];
    for (uint32_t y = 0; y < part->height; y++) {
        const uint32_t *texel = load_row(part, y, copy);
        for (uint32_t x = 0; x < part->width; x++)
            *word_of(part, 0, x, y) = texel[x];
    }
}

static void load_numbers(const struct part *part)
{
    uint32_t copy[4 * TILE_SIZE];
    for (uint32_t y = 0; y < part->height; y++) {
        const uint32_t *texel = load_row(part, y, copy);
        for (uint32_t x = 0; x < part->width; x++, texel += 4)
            for (uint32_t c = 0; c < 4; c++)
                *word_of(part, c, x, y) = texel[c];
    }
}

/* Stencil stays. */
static void load_depth(const struct part *part, enum triptych_depth_format format, struct depth_clear *clear)
{
    uint32_t stencil = stencil_mask(format), copy[4 * TILE_SIZE];
    for (uint32_t y = 0; y < part->height; y++) {
        const uint32_t *texel = load_row(part, y, copy);
        for (uint32_t x = 0; x < part->width; x++, texel += 4) {
            uint32_t *word = word_of(part, 0, x, y);
            uint32_t old = clear->pending ? clear->word : *word;
            *word = depth_encode(format, bits_to_float(*texel)) | (old & stencil);
        }
    }
    clear->range = (struct depth_range){0, depth_mask(format)};
    clear->pending = false;
}

static void store_numbers(const struct part *part, const struct color_clear *clear)
{
    uint32_t row[4 * TILE_SIZE];
    for (uint32_t y = 0; y < part->height; y++) {
        uint32_t *texel = row;
        for (uint32_t x = 0; x < part->width; x++, texel += 4)
            for (uint32_t c = 0; c < 4; c++)
                texel[c] = clear->pending ? clear->word[c] : *word_of(part, c, x, y);
        texture_write_row(&part->image, 0, y, part->width, row);
    }
}

/* A tile's words as rows of TILE_SIZE. */
static void read_rows(const struct part *part, bool pending, uint32_t word, uint32_t rows[TILE_PIXELS])
{
    struct rectangle area = {0, 0, (int32_t)part->width, (int32_t)part->height};
    if (pending)
        target_read_constant(word, &area, rows, TILE_SIZE);
    else
        target_read_tile(part->order, part->words, &area, rows, TILE_SIZE);
}

/* Rows are converted where they are needed, unless they are in tiles. */
static void store_depth(const struct part *part, enum triptych_depth_format format,
                        const struct depth_clear *clear)
{
    uint32_t rows[TILE_PIXELS];
    float copy[4 * TILE_SIZE];
    bool tiled = part->image.tiled;
    read_rows(part, clear->pending, clear->word, rows);
    for (uint32_t y = 0; y < part->height; y++) {
        float *texels = tiled ? copy : texture_texel(&part->image, 0, y);
        depth_texels(format, rows + (size_t)y * TILE_SIZE, part->width, part->image.opaque, texels);
        if (tiled)
            texture_write_row(&part->image, 0, y, part->width, copy);
    }
}

/* Tiles of texels or compact ones, from rows. */
static void store_word_rows(const struct part *part, const struct color_clear *clear)
{
    uint32_t rows[TILE_PIXELS];
    read_rows(part, clear->pending, clear->word[0], rows);
    for (uint32_t y = 0; y < part->height; y++)
        texture_write_row(&part->image, 0, y, part->width, rows + (size_t)y * TILE_SIZE);
}

static void store_words(const struct part *part, const struct color_clear *clear)
{
    uint32_t *texels = (uint32_t *)(void *)part->image.texels;
    struct rectangle area = {0, 0, (int32_t)part->width, (int32_t)part->height};
    if (!texture_has_rows(&part->image))
        store_word_rows(part, clear);
    else if (clear->pending)
        target_read_constant(clear->word[0], &area, texels, part->image.pitch);
    else
        target_read_tile(part->order, part->words, &area, texels, part->image.pitch);
}

/* The padding of rows of texels (render/texture/texture.h), by the tiles that have their first texels. */
static void close_rows(const struct surface_transfer *transfer, const struct part *part)
{
    for (uint32_t y = 0; y < part->height && !part->area.x0 && !part->image.tiled; y++)
        memcpy(texture_texel(&part->image, transfer->attachment->width, y), texture_texel(&part->image, 0, y),
               part->image.bytes);
}

static void store_tile(const struct surface_transfer *transfer, const struct part *part, uint32_t tile)
{
    const struct attachment *a = transfer->attachment;
    if (!a->format)
        store_depth(part, a->depth_format, &a->depth_clear[tile]);
    else if (attachment_planes(a) == 1)
        store_words(part, &a->color_clear[tile]);
    else
        store_numbers(part, &a->color_clear[tile]);
    close_rows(transfer, part);
}

/* Words beyond the surface's edges have a value too: tools compare whole tiles. */
static void fill_partial(const struct attachment *a, const struct part *part, uint32_t tile)
{
    bool pending = a->format ? a->color_clear[tile].pending : a->depth_clear[tile].pending;
    bool whole = part->width == TILE_SIZE && part->height == TILE_SIZE;
    for (uint32_t p = 0; pending && !whole && p < attachment_planes(a); p++)
        tile_order_fill(part->order, part->words + p * part->order->plane, 0);
}

static void load_tile(const struct attachment *a, const struct part *part, uint32_t tile)
{
    fill_partial(a, part, tile);
    if (!a->format)
        load_depth(part, a->depth_format, &a->depth_clear[tile]);
    else if (attachment_planes(a) == 1)
        load_words(part);
    else
        load_numbers(part);
    if (a->format)
        a->color_clear[tile].pending = false;
}

/* The words that a clear gave all pixels of a tile; null: they can differ. */
static const uint32_t *cleared_words(const struct attachment *a, uint32_t tile)
{
    if (a->format)
        return a->color_clear[tile].pending ? a->color_clear[tile].word : NULL;
    return a->depth_clear[tile].pending ? &a->depth_clear[tile].word : NULL;
}

/* Notes the words that the tile's texels get. Returns true if they have them already. */
static bool note_stored(const struct surface_transfer *transfer, uint32_t tile)
{
    const struct attachment *a = transfer->attachment;
    const uint32_t *words = cleared_words(a, tile);
    size_t bytes = attachment_planes(a) * sizeof *words;
    struct stored_clear *stored = transfer->stored ? transfer->stored + tile : NULL;
    if (!stored)
        return false;
    if (words && stored->known && !memcmp(stored->word, words, bytes))
        return true;
    stored->known = words;
    if (words)
        memcpy(stored->word, words, bytes);
    return false;
}

static void forget_stored(const struct surface_transfer *transfer, uint32_t tile)
{
    if (transfer->stored)
        transfer->stored[tile].known = false;
}

/* Tiles that have not changed are the same as their texels, and so are tiles that are cleared once more to
 * what their texels are. */
void surface_transfer_tile(const struct surface_transfer *transfer, uint32_t tile)
{
    const struct attachment *a = transfer->attachment;
    bool *changed = a->format ? &a->color_clear[tile].changed : &a->depth_clear[tile].changed;
    struct part part = part_of(transfer, tile);
    if (!transfer->store) {
        load_tile(a, &part, tile);
        forget_stored(transfer, tile);
    } else if (*changed && !note_stored(transfer, tile)) {
        store_tile(transfer, &part, tile);
    }
    *changed = false;
}
