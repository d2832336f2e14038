/* Triangles in a tile that are not rasterized: those that its depths show to be hidden, and those of one
 * colour that cover it, whose words are stored once for the whole tile. */
#include "contract/key_query.h"
#include "render/tile/hidden.h"
#include "render/tile/tile_part.h"

static int32_t tile_start(uint32_t number)
{
    return (int32_t)number * TILE_SIZE;
}

/* The pixels of the tile that the triangle's own bounds meet. */
static struct rectangle meeting_area(const struct round *round, uint32_t tile, const struct draw *draw,
                                     const struct triangle_head *head)
{
    int32_t x = tile_start(tile % round->target->columns), y = tile_start(tile / round->target->columns);
    struct rectangle limit = {x, y, x + TILE_SIZE, y + TILE_SIZE}, area;
    return raster_shapes[draw->shape].bounds(head, &limit, &area) ? area : limit;
}

static void find_depths(struct meeting *m, const struct round *round, uint32_t tile, const struct draw *draw)
{
    const uint8_t *record = (const uint8_t *)m->head + draw->routine[UNIT_PIXEL]->depth_plane;
    const struct plane *plane = (const struct plane *)(const void *)record;
    const enum triptych_depth_format format = round->target->depth_format;
    m->constant = hidden_is_level(plane);
    if (m->constant) {
        m->depths = hidden_level_depths(plane, format);
        return;
    }
    struct rectangle area = meeting_area(round, tile, draw, m->head);
    m->depths = hidden_depths(m->head, plane, &area, format);
}

static void compare_depths(struct meeting *m, const struct round *round, uint32_t tile,
                           const struct draw *draw)
{
    find_depths(m, round, tile, draw);
    m->verdict = hidden_verdict(draw->routine[UNIT_PIXEL]->key.pixel.depth_function, m->depths,
                                target_depth_clear(round->target, tile)->range);
}

/* Returns true if the tile can store one value instead of its words: no word that is not written must
 * survive. */
static bool can_be_uniform(const struct target *target, uint32_t tile, const struct pixel_key *key)
{
    return hidden_writes_all_targets(key, target) &&
           (!key->depth_write || target_depth_clear(target, tile)->pending ||
            !stencil_mask(target->depth_format));
}

static void note_uniform_color(const struct target *target, uint32_t tile)
{
    const uint32_t *words = target_tile_color(target, tile);
    for (unsigned t = 0; t < TARGETS; t++) {
        const struct target_color *color = target->colors + t;
        if (!color->clear)
            continue;
        struct color_clear *clear = target_color_clear(target, t, tile);
        for (uint32_t p = 0; p < storage_planes[color->storage]; p++)
            clear->word[p] = words[(color->plane + p) * target->color_order.plane];
        clear->pending = clear->changed = true;
    }
}

/* Shades one block of a triangle whose pixels are all equal, and stores its words for the whole tile. */
static void shade_uniform(struct tile_worker *worker, const struct round *round, uint32_t tile,
                          const struct meeting *m)
{
    struct target *target = worker->target;
    const struct pixel_key *key = &worker->draw->routine[UNIT_PIXEL]->key.pixel;
    bool tests = pixel_tests_depth(key) && target->depth;
    uint32_t *depth = tests ? target_tile_depth(target, tile) : NULL;
    struct depth_clear *clear = tests ? target_depth_clear(target, tile) : NULL;
    for (int i = 0; depth && clear->pending && i < BLOCK_PIXELS; i++)
        depth[i] = clear->word;
    worker->entries.entry[0] = (struct entry){.x = (float)tile_start(tile % target->columns),
                                              .y = (float)tile_start(tile / target->columns),
                                              .coverage = UINT16_MAX,
                                              .triangle = m->triangle};
    worker->count = 1;
    tile_run_blocks(worker, round, tile);
    note_uniform_color(target, tile);
    if (!key->depth_write)
        return;
    *clear = (struct depth_clear){.word = depth[0], .range = m->depths, .pending = true, .changed = true};
}

void tile_note_depths(struct tile_worker *worker, const struct round *round, uint32_t tile,
                      const struct meeting *m)
{
    const struct routine *routine = worker->draw->routine[UNIT_PIXEL];
    int function = routine->key.pixel.depth_function;
    if (!(routine->traits & PIXEL_WRITES_DEPTH))
        return;
    struct depth_range *range = &target_depth_clear(round->target, tile)->range;
    if (m->covers && tile_uses_ranges(round) && routine->traits & PIXEL_DEPTH_KNOWN &&
        !pixel_waits(&routine->key.pixel)) {
        *range = hidden_narrowed(function, *range, m->depths);
    } else if (!worker->widened) {
        *range = hidden_widened(function, *range, (struct depth_range){0, UINT32_MAX});
        worker->widened = true;
    }
}

bool tile_deals_with(struct tile_worker *worker, const struct round *round, uint32_t tile, struct meeting *m)
{
    const struct routine *routine = worker->draw->routine[UNIT_PIXEL];
    bool tests = pixel_tests_depth(&routine->key.pixel);
    m->verdict = tests ? DEPTH_UNDECIDED : DEPTH_PASSES;
    m->constant = true;
    if (routine->traits & PIXEL_DEPTH_KNOWN)
        compare_depths(m, round, tile, worker->draw);
    if (m->verdict == DEPTH_FAILS && tile_uses_ranges(round))
        return true;
    bool uniform = m->covers && tile_uses_uniform(round) && routine->traits & PIXEL_UNIFORM &&
                   m->verdict == DEPTH_PASSES && (m->constant || !routine->key.pixel.depth_write) &&
                   can_be_uniform(round->target, tile, &routine->key.pixel);
    if (uniform) {
        tile_shade(worker, round, tile);
        shade_uniform(worker, round, tile, m);
    }
    return uniform;
}

bool tile_may_skip(const struct tile_worker *worker, const struct round *round, uint32_t tile, bool covers)
{
    const struct routine *routine = worker->draw->routine[UNIT_PIXEL];
    if (covers)
        return tile_uses_ranges(round) || tile_uses_uniform(round);
    if (!tile_uses_ranges(round) || !(routine->traits & PIXEL_DEPTH_KNOWN))
        return false;
    const struct depth_range *range = &target_depth_clear(round->target, tile)->range;
    switch (routine->key.pixel.depth_function) {
    case COMPARE_LESS:
    case COMPARE_LESS_EQUAL: return range->most < round->farthest;
    case COMPARE_GREATER:
    case COMPARE_GREATER_EQUAL: return range->least > 0;
    default: return false;
    }
}
