#include "command/fuzz/bisect/replay.h"

#include <stdlib.h>
#include <string.h>

enum { IMAGE_ALIGNMENT = 64 };

static size_t aligned(size_t bytes)
{
    return (bytes + IMAGE_ALIGNMENT - 1) / IMAGE_ALIGNMENT * IMAGE_ALIGNMENT;
}

static size_t bytes_of(const struct replay *r)
{
    return r->output_bytes + r->table_bytes + (size_t)r->probe_rows * PROBE_ROW_BYTES;
}

uint8_t *replay_image(const struct replay *r)
{
    return aligned_alloc(IMAGE_ALIGNMENT, aligned(bytes_of(r)));
}

/* --- Taking --------------------------------------------------------------------------------------------- */

static int take_image(struct replay *r)
{
    r->before = replay_image(r);
    return r->before ? 0 : -1;
}

static int take_vertices(struct replay *r, const struct vertex_arguments *call)
{
    r->count = call->count;
    r->job = call->job;
    r->output_bytes = SLOT_COUNT * VERTEX_SLOT_BYTES;
    r->table_bytes = SETUP_INDEX_BYTES;
    if (take_image(r))
        return -1;
    memcpy(r->before, call->out, r->output_bytes);
    memset(r->before + r->output_bytes, 0, r->table_bytes);
    memcpy(r->before + r->output_bytes, call->index, 4 * (size_t)call->count);
    return 0;
}

static int take_triangles(struct replay *r, const struct setup_arguments *call)
{
    r->count = call->count;
    r->job = call->job;
    r->vertices = call->vertices;
    r->layout = layout_of_setup(&r->key->setup);
    r->output_bytes = aligned((size_t)call->count * r->layout.stride);
    r->table_bytes = SETUP_INDEX_ROWS * SETUP_INDEX_BYTES;
    if (take_image(r))
        return -1;
    memcpy(r->before, call->out, (size_t)call->count * r->layout.stride);
    memcpy(r->before + r->output_bytes, call->index, r->table_bytes);
    return 0;
}

static int take_pixels(struct replay *r, const struct pixel_arguments *call,
                       const struct replay_target *target)
{
    r->count = call->count;
    r->job = call->job;
    r->triangles = call->triangles;
    r->layout = layout_of_pixel(&r->key->pixel);
    r->color_bytes = (size_t)target->color_planes * TILE_PLANE_BYTES;
    r->depth_bytes = (size_t)target->depth_planes * TILE_PLANE_BYTES;
    r->output_bytes = r->color_bytes + r->depth_bytes;
    r->table_bytes = aligned(sizeof(struct lane_table));
    r->entries = aligned_alloc(IMAGE_ALIGNMENT, aligned(sizeof *r->entries));
    if (!r->entries || take_image(r))
        return -1;
    memcpy(r->entries->entry, call->entries, call->count * sizeof *call->entries);
    if (r->key->pixel.samples)
        memcpy(r->entries->coverage, (const uint8_t *)call->entries + SAMPLE_COVERAGE,
               call->count * sizeof *r->entries->coverage);
    memcpy(r->before, call->color, r->color_bytes);
    if (r->depth_bytes)
        memcpy(r->before + r->color_bytes, call->depth, r->depth_bytes);
    memcpy(r->before + r->output_bytes, call->lanes, sizeof *call->lanes);
    return 0;
}

/* A blit with results of numbers writes four planes. */
static uint32_t blit_planes(const struct replay *r)
{
    return r->key->blit.number_results ? 4 : 1;
}

static size_t blit_plane(const struct replay *r)
{
    return 4 * (size_t)(blit_planes(r) > 1 ? BLIT_BLEND_PIXELS : r->count);
}

/* The bytes that a blit reads from its index on. */
static size_t blit_input(const struct replay *r)
{
    const struct blit_key *k = &r->key->blit;
    size_t row = 4 * (size_t)r->count;
    switch ((enum blit_operation)k->operation) {
    case BLIT_CLEAR: return k->part ? row : 0;
    case BLIT_RESOLVE: return row + (size_t)blit_sample_offset(k, (1 << k->samples) - 1);
    case BLIT_BLEND: return row + 2 * sizeof(uint32_t[BLIT_BLEND_PIXELS]);
    default: return row;
    }
}

static int take_blit(struct replay *r, const struct blit_arguments *call)
{
    r->count = call->count;
    r->job = call->job;
    r->output_bytes = blit_planes(r) * blit_plane(r);
    r->table_bytes = aligned(blit_input(r));
    if (take_image(r))
        return -1;
    memcpy(r->before + r->output_bytes, call->index, blit_input(r));
    for (uint32_t p = 0; p < blit_planes(r); p++)
        memcpy(r->before + p * blit_plane(r), (const uint8_t *)call->out + p * blit_plane(r),
               4 * (size_t)call->count);
    return 0;
}

int replay_take(struct replay *replay, const struct routine *routine, const void *call,
                const struct replay_target *target)
{
    *replay = (struct replay){
        .unit = routine->unit, .key = &routine->key, .pixel_x = NO_PIXEL, .pixel_y = NO_PIXEL};
    switch (routine->unit) {
    case UNIT_VERTEX: return take_vertices(replay, call);
    case UNIT_SETUP: return take_triangles(replay, call);
    case UNIT_BLIT: return take_blit(replay, call);
    default: return take_pixels(replay, call, target);
    }
}

void replay_free(struct replay *replay)
{
    free(replay->before);
    free(replay->entries);
    *replay = (struct replay){0};
}

int replay_reserve(struct replay *r, uint32_t rows)
{
    if (rows <= r->probe_rows)
        return 0;
    size_t bytes = bytes_of(r);
    r->probe_rows = rows;
    uint8_t *larger = replay_image(r);
    if (!larger)
        return -1;
    memcpy(larger, r->before, bytes);
    free(r->before);
    r->before = larger;
    return 0;
}

/* --- Running -------------------------------------------------------------------------------------------- */

/* A routine is entered with the caller's MXCSR and leaves it. */
void replay_run(const struct replay *r, const struct routine *routine, uint8_t *image)
{
    uint8_t *table = image + r->output_bytes;
    void *depth = r->depth_bytes ? image + r->color_bytes : image;
    struct vertex_arguments vertex = {r->job, (void *)table, (void *)image, r->count};
    struct setup_arguments setup = {r->job, (void *)table, r->vertices, image, r->count, 0};
    struct pixel_arguments pixel = {r->job,        r->entries ? r->entries->entry : NULL,
                                    r->triangles,  (void *)table,
                                    (void *)image, depth,
                                    r->count,      0};
    struct blit_arguments blit = {r->job, (void *)table, (void *)image, r->count};
    const void *calls[UNIT_ALL] = {
        [UNIT_VERTEX] = &vertex, [UNIT_SETUP] = &setup, [UNIT_PIXEL] = &pixel, [UNIT_BLIT] = &blit};
    memcpy(image, r->before, r->output_bytes + r->table_bytes);
    routine->run(calls[r->unit], routine);
}

/* --- Comparing ------------------------------------------------------------------------------------------ */

static bool is_nan(uint32_t bits)
{
    return (bits & 0x7fffffff) > 0x7f800000;
}

static uint32_t word_at(const uint8_t *image, size_t at)
{
    uint32_t word;
    memcpy(&word, image + at, sizeof word);
    return word;
}

/* Pixel lane l of a block: x has bits 0 and 2, y bits 1 and 3. */
static int32_t lane_x(uint32_t lane)
{
    return (int32_t)((lane & 1) | (lane >> 1 & 2));
}

static int32_t lane_y(uint32_t lane)
{
    return (int32_t)((lane >> 1 & 1) | (lane >> 2 & 2));
}

void replay_pixel(const struct replay *r, uint32_t lane, int32_t *x, int32_t *y)
{
    *x = (int32_t)r->entries->entry[0].x + lane_x(lane);
    *y = (int32_t)r->entries->entry[0].y + lane_y(lane);
}

/* Returns true if the word of a tile belongs to the selected pixel. Entries contain the positions of their
 * blocks. */
static bool is_asked(const struct replay *r, size_t at)
{
    uint32_t pixel = (uint32_t)(at / 4 % TILE_PIXELS), block = pixel / BLOCK_PIXELS,
             lane = pixel % BLOCK_PIXELS;
    for (uint32_t i = 0; i < r->count; i++)
        if (r->entries->entry[i].block == block)
            return (int32_t)r->entries->entry[i].x + lane_x(lane) == r->pixel_x &&
                   (int32_t)r->entries->entry[i].y + lane_y(lane) == r->pixel_y;
    return false;
}

/* Returns true if two words at that position have the same meaning. */
static bool agree(const struct replay *r, const uint8_t *a, size_t at, const uint32_t word[2])
{
    bool both_nan = is_nan(word[0]) && is_nan(word[1]);
    if (r->unit == UNIT_BLIT)
        return false;
    if (r->unit == UNIT_VERTEX)
        return both_nan && at / VERTEX_SLOT_BYTES != SLOT_CODE;
    if (r->unit == UNIT_PIXEL)
        return r->pixel_x != NO_PIXEL && at < r->output_bytes && !is_asked(r, at);
    size_t within = at % r->layout.stride;
    bool open = at < r->output_bytes && within >= sizeof(int32_t) &&
                !word_at(a, at - within + offsetof(struct triangle_head, visible));
    return open || (both_nan && within > offsetof(struct triangle_head, y) + 8);
}

static uint32_t element_at(const struct replay *r, size_t at)
{
    switch (r->unit) {
    case UNIT_VERTEX: return (uint32_t)(at % VERTEX_SLOT_BYTES / 4);
    case UNIT_SETUP: return (uint32_t)(at / r->layout.stride);
    case UNIT_BLIT: return (uint32_t)(at % blit_plane(r) / 4);
    default:
        return (uint32_t)(at < r->output_bytes ? at / 4 % BLOCK_PIXELS
                                               : (at - r->output_bytes) / 4 % LANES_MAXIMUM);
    }
}

bool replay_differs(const struct replay *r, const uint8_t *a, const uint8_t *b, struct replay_place *place)
{
    size_t bytes = r->output_bytes + (r->unit == UNIT_PIXEL ? r->table_bytes : 0);
    if (!memcmp(a, b, bytes))
        return false;
    for (size_t at = 0; at < bytes; at += 4) {
        uint32_t word[2] = {word_at(a, at), word_at(b, at)};
        if (word[0] == word[1] || agree(r, a, at, word))
            continue;
        if (place)
            *place = (struct replay_place){at, element_at(r, at), {word[0], word[1]}};
        return true;
    }
    return false;
}

/* --- Narrowing ------------------------------------------------------------------------------------------ */

/* 1: a and b differ on this replay; their images are left. */
static bool both(const struct replay *r, const struct routine *a, const struct routine *b, uint8_t *image[2])
{
    replay_run(r, a, image[0]);
    replay_run(r, b, image[1]);
    return replay_differs(r, image[0], image[1], NULL);
}

/* Inputs and outputs of a blit move by as many words as its elements. */
static void move_blit(struct replay *r, uint32_t first)
{
    size_t bytes = 4 * (size_t)first, table = blit_input(r);
    for (uint32_t p = 0; p < blit_planes(r); p++) {
        uint8_t *plane = r->before + p * blit_plane(r);
        memmove(plane, plane + bytes, 4 * LANES_MAXIMUM);
    }
    if (table)
        memmove(r->before + r->output_bytes, r->before + r->output_bytes + bytes, table - bytes);
}

/* The lanes of a group move to the front: their outputs begin there, too. */
static void move_group(struct replay *r, const struct replay *whole, uint32_t first)
{
    *r = *whole;
    if (r->unit == UNIT_BLIT) {
        move_blit(r, first);
        r->count = LANES_MAXIMUM;
        return;
    }
    r->count = LANES_MAXIMUM;
    for (uint32_t row = 0; row < r->table_bytes / SETUP_INDEX_BYTES; row++)
        memmove(r->before + r->output_bytes + row * SETUP_INDEX_BYTES,
                r->before + r->output_bytes + row * SETUP_INDEX_BYTES + 4 * (size_t)first, 4 * LANES_MAXIMUM);
}

static int narrow_lanes(struct replay *r, const struct routine *a, const struct routine *b, uint8_t *image[2])
{
    struct replay whole = *r;
    uint8_t *kept = replay_image(r);
    if (!kept)
        return -1;
    memcpy(kept, r->before, bytes_of(r));
    int found = 0;
    for (uint32_t first = 0; first < whole.count && !found; first += LANES_MAXIMUM) {
        memcpy(r->before, kept, bytes_of(&whole));
        move_group(r, &whole, first);
        found = both(r, a, b, image);
    }
    if (!found) {
        memcpy(whole.before, kept, bytes_of(&whole));
        *r = whole;
    }
    free(kept);
    return found;
}

static void put_entry(struct replay *r, const struct entry_list *all, uint32_t i)
{
    r->entries->entry[0] = all->entry[i];
    r->entries->coverage[0] = all->coverage[i];
    r->count = 1;
}

/* Entry by entry, each on what those before it have left. */
static int narrow_entries(struct replay *r, const struct routine *a, const struct routine *b,
                          uint8_t *image[2])
{
    struct entry_list *all = aligned_alloc(IMAGE_ALIGNMENT, aligned(sizeof *all));
    uint8_t *kept = replay_image(r);
    uint32_t count = r->count;
    int found = all && kept ? 0 : -1;
    if (!found) {
        memcpy(all, r->entries, sizeof *all);
        memcpy(kept, r->before, bytes_of(r));
        for (uint32_t i = 0; i < count && !found; i++) {
            put_entry(r, all, i);
            found = both(r, a, b, image);
            if (!found)
                memcpy(r->before, image[0], r->output_bytes + r->table_bytes);
        }
        if (!found) {
            memcpy(r->entries, all, sizeof *all);
            memcpy(r->before, kept, bytes_of(r));
            r->count = count;
        }
    }
    free(all);
    free(kept);
    return found;
}

int replay_narrow(struct replay *r, const struct routine *a, const struct routine *b)
{
    uint8_t *image[2] = {replay_image(r), replay_image(r)};
    int found = -1;
    if (image[0] && image[1])
        found = r->unit == UNIT_PIXEL ? narrow_entries(r, a, b, image) : narrow_lanes(r, a, b, image);
    free(image[0]);
    free(image[1]);
    return found;
}

/* --- Lanes ---------------------------------------------------------------------------------------------- */

bool replay_has_quad(const struct replay *r, uint32_t lane)
{
    return r->unit != UNIT_PIXEL || r->entries->entry[0].coverage >> lane & 15;
}

void replay_bases(const struct replay *r, uint8_t *image, uint32_t lane, const uint8_t *base[BASE_COUNT])
{
    uint8_t *table = image + r->output_bytes;
    const struct program *program = key_shader(r->unit, r->key);
    memset(base, 0, BASE_COUNT * sizeof *base);
    base[BASE_JOB] = r->job;
    if (program)
        base[BASE_CONSTANT] = (const uint8_t *)((const struct job *)r->job)->constants[program->model->stage];
    if (r->unit != UNIT_PIXEL) {
        base[BASE_INPUT] = table + 4 * lane;
        base[BASE_OUTPUT] = image + (size_t)lane * (r->unit == UNIT_SETUP ? r->layout.stride : 4);
        base[BASE_VERTICES] = (const uint8_t *)r->vertices;
        return;
    }
    size_t place = 4 * ((size_t)r->entries->entry[0].block * BLOCK_PIXELS + lane);
    base[BASE_ENTRY] = (const uint8_t *)r->entries->entry;
    base[BASE_TRIANGLE] = r->triangles + r->entries->entry[0].triangle;
    base[BASE_LANES] = table + 4 * lane;
    base[BASE_COLOR] = image + place;
    base[BASE_DEPTH] = image + (r->depth_bytes ? r->color_bytes : 0) + place;
}

enum base replay_probe_base(enum unit unit)
{
    return unit == UNIT_PIXEL ? BASE_LANES : BASE_INPUT;
}

int32_t replay_probe_place(const struct replay *r, uint32_t row)
{
    return (int32_t)(r->table_bytes + row * PROBE_ROW_BYTES);
}

uint32_t *replay_probe_row(const struct replay *r, uint8_t *image, uint32_t row)
{
    return (uint32_t *)(void *)(image + r->output_bytes + r->table_bytes + (size_t)row * PROBE_ROW_BYTES);
}
