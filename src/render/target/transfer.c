/* Transfers between texels of a texture and tiles of its attachment, a tile at a time. */
#include "base/bits.h"
#include "render/target/surface.h"

#include <string.h>

/* A tile of a transfer. */
struct part {
    struct rectangle area;
    uint32_t *words;  /* its first plane */
    uint32_t *texels; /* the area's first */
    size_t pitch;     /* words of a row of texels */
};

static struct part part_of(const struct surface_transfer *transfer, uint32_t tile)
{
    const struct attachment *a = transfer->attachment;
    const struct tile_memory *memory = transfer->memory;
    size_t texel = attachment_planes(a) == 1 && a->format ? 1 : 4;
    struct rectangle area = target_attachment_area(a, tile);
    size_t place = (size_t)(tile / a->columns * memory->columns + tile % a->columns) * memory->stride;
    size_t first = (size_t)area.y0 * transfer->pitch + (size_t)area.x0;
    return (struct part){area, memory->words + place + transfer->plane * TILE_PIXELS,
                         (uint32_t *)(void *)transfer->texels + first * texel, transfer->pitch * texel};
}

/* The words of four numbers per texel at x, y of the part, and the word in the tile. */
static uint32_t *texel_at(const struct part *part, int32_t x, int32_t y, uint32_t *word)
{
    *word = pixel_word((uint32_t)x, (uint32_t)y);
    return part->texels + (size_t)y * part->pitch + 4 * (size_t)x;
}

static void load_words(const struct part *part)
{
    for (int32_t y = 0; y < part->area.y1 - part->area.y0; y++)
        for (int32_t x = 0; x < part->area.x1 - part->area.x0; x++)
            part->words[pixel_word((uint32_t)x, (uint32_t)y)] =
                part->texels[(size_t)y * part->pitch + (size_t)x];
}

static void load_numbers(const struct part *part)
{
    for (int32_t y = 0; y < part->area.y1 - part->area.y0; y++)
        for (int32_t x = 0; x < part->area.x1 - part->area.x0; x++) {
            uint32_t word;
            const uint32_t *texel = texel_at(part, x, y, &word);
            for (int c = 0; c < 4; c++)
                part->words[c * TILE_PIXELS + word] = texel[c];
        }
}

/* Stencil stays. */
static void load_depth(const struct part *part, enum triptych_depth_format format, struct depth_clear *clear)
{
    uint32_t stencil = stencil_mask(format);
    for (int32_t y = 0; y < part->area.y1 - part->area.y0; y++)
        for (int32_t x = 0; x < part->area.x1 - part->area.x0; x++) {
            uint32_t word;
            const uint32_t *texel = texel_at(part, x, y, &word);
            uint32_t old = clear->pending ? clear->word : part->words[word];
            part->words[word] = depth_encode(format, bits_to_float(*texel)) | (old & stencil);
        }
    clear->range = (struct depth_range){0, depth_mask(format)};
    clear->pending = false;
}

static void store_numbers(const struct part *part, const struct color_clear *clear)
{
    for (int32_t y = 0; y < part->area.y1 - part->area.y0; y++)
        for (int32_t x = 0; x < part->area.x1 - part->area.x0; x++) {
            uint32_t word, *texel = texel_at(part, x, y, &word);
            for (int c = 0; c < 4; c++)
                texel[c] = clear->pending ? clear->word[c] : part->words[c * TILE_PIXELS + word];
        }
}

static void store_depth(const struct part *part, enum triptych_depth_format format,
                        const struct depth_clear *clear)
{
    for (int32_t y = 0; y < part->area.y1 - part->area.y0; y++)
        for (int32_t x = 0; x < part->area.x1 - part->area.x0; x++) {
            uint32_t word, *texel = texel_at(part, x, y, &word);
            uint32_t depth =
                bits_of_float(depth_decode(format, clear->pending ? clear->word : part->words[word]));
            texel[0] = texel[1] = texel[2] = texel[3] = depth;
        }
}

static void store_words(const struct part *part, const struct color_clear *clear)
{
    struct rectangle area = {0, 0, part->area.x1 - part->area.x0, part->area.y1 - part->area.y0};
    if (clear->pending)
        target_read_constant(clear->word[0], &area, part->texels, part->pitch);
    else
        target_read_tile(part->words, &area, part->texels, part->pitch);
}

/* The padding of rows of texels (render/texture/texture.h), by the tiles that have their first texels. */
static void close_rows(const struct surface_transfer *transfer, const struct part *part)
{
    size_t words = part->pitch / transfer->pitch;
    for (int32_t y = part->area.y0; y < part->area.y1 && !part->area.x0; y++) {
        uint32_t *row = part->texels + (size_t)(y - part->area.y0) * part->pitch;
        memcpy(row + transfer->attachment->width * words, row, words * sizeof *row);
    }
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
    bool whole = part->area.x1 - part->area.x0 == TILE_SIZE && part->area.y1 - part->area.y0 == TILE_SIZE;
    if (pending && !whole)
        memset(part->words, 0, attachment_planes(a) * TILE_PLANE_BYTES);
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

/* Tiles that have not changed are the same as their texels. */
void surface_transfer_tile(const struct surface_transfer *transfer, uint32_t tile)
{
    const struct attachment *a = transfer->attachment;
    bool *changed = a->format ? &a->color_clear[tile].changed : &a->depth_clear[tile].changed;
    struct part part = part_of(transfer, tile);
    if (!transfer->store)
        load_tile(a, &part, tile);
    else if (*changed)
        store_tile(transfer, &part, tile);
    *changed = false;
}
