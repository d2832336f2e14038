#include "render/device/derived.h"
#include "render/geometry/bin_pair.h"

#include <stdlib.h>
#include <string.h>

static const size_t key_bytes[UNIT_COUNT] = {[UNIT_VERTEX] = sizeof(struct vertex_key),
                                             [UNIT_SETUP] = sizeof(struct setup_key),
                                             [UNIT_PIXEL] = sizeof(struct pixel_key)};

bool device_same_key(enum unit unit, const union key *a, const union key *b)
{
    return !memcmp(a, b, key_bytes[unit]);
}

/* The form of records whose pixels read no more than a pair shares. */
static struct pair_form derive_pairs(const union key key[UNIT_COUNT])
{
    const struct pixel_key *pixel = &key[UNIT_PIXEL].pixel;
    uint16_t samplers[TEXTURE_STAGES];
    if (!derive_lookups(pixel, samplers))
        return (struct pair_form){0};
    return bin_pair_form(&key[UNIT_SETUP].setup, pixel->precision, samplers);
}

static uint32_t sampled_by(const union key key[UNIT_COUNT])
{
    uint32_t sampled = 0;
    for (unsigned i = 0; i < PIXEL_SAMPLERS; i++)
        sampled |= (uint32_t)(key[UNIT_PIXEL].pixel.texture[i] != 0) << i;
    for (unsigned i = 0; i < VERTEX_SAMPLERS; i++)
        sampled |= (uint32_t)(key[UNIT_VERTEX].vertex.texture[i] != 0) << (PIXEL_SAMPLERS + i);
    return sampled;
}

/* Routines are those of the keys, or none. Returns the parts that depend on what has changed. */
static unsigned derive_new_keys(struct derived_source *now, const struct state *state,
                                enum primitive primitive)
{
    union key key[UNIT_COUNT];
    unsigned parts = 0;
    derive_keys(state, primitive, key);
    for (int unit = 0; unit < UNIT_COUNT; unit++) {
        if (device_same_key(unit, &key[unit], &now->key[unit]))
            continue;
        now->key[unit] = key[unit];
        now->draw.routine[unit] = NULL;
        if (unit == UNIT_PIXEL)
            now->draw.routine[ROUTINE_SPAN] = now->draw.routine[ROUTINE_JOINED] = NULL;
        parts |= derive_parts_of_key(unit);
    }
    if (parts) {
        derive_live(&key[UNIT_VERTEX].vertex, &key[UNIT_PIXEL].pixel, &now->live);
        now->sampled = sampled_by(key);
        now->pairs = derive_pairs(key);
    }
    return parts;
}

/* The part of the draw that follows from the source. */
static void derive_setting(struct derived_source *now, const struct state *state)
{
    const struct setup_key *setup = &now->key[UNIT_SETUP].setup;
    struct draw *draw = &now->draw;
    draw->stride = layout_of_setup(setup).stride;
    draw->shape = derive_shape(setup);
    draw->sampling = derive_sampling(state);
    draw->pairs = draw->sampling.samples ? (struct pair_form){0} : now->pairs;
    draw->clip_ignored = derive_clip_ignored(state);
    draw->point_clipped = derive_point_clipped(state, setup->primitive);
    draw->last_pixel = derive_last_pixel(state);
    draw->line_extra = setup->primitive == PRIMITIVE_LINE ? derive_line_extra(state) : 0;
    draw->line_width = derive_line_width(state, setup->primitive);
    draw->edges = derive_edges(state);
    draw->wrapped = derive_wrapped(state, &now->key[UNIT_PIXEL].pixel);
    draw->flat = derive_flat(state);
    draw->last_provokes = derive_last_provokes(state);
}

/* The number of vertices that an element has. An element that steps with the instance does not limit it if
 * it has one for each instance. */
static uint64_t element_vertices(const struct state *state, const struct state_element *element)
{
    const struct state_stream *stream = state_source(state, element);
    size_t begin = stream->offset + element->offset, bytes = key_vertex_types[element->format].bytes;
    if (!stream->buffer || begin + bytes > stream->buffer->bytes)
        return 0;
    uint64_t last = state_last_vertex(state, element);
    if (stream->frequency == TRIPTYCH_FREQUENCY_INSTANCE)
        return (state_instances(state) - 1) / stream->count <= last ? UINT64_MAX : 0;
    return last == UINT64_MAX ? last : last + 1;
}

static bool derive_steps(const struct state *state)
{
    bool steps = false;
    for (unsigned i = 0; i < TRIPTYCH_STREAMS; i++)
        steps |= state->stream[i].frequency != TRIPTYCH_FREQUENCY_VERTEX;
    return steps;
}

/* Takes account of an element that is read. Immediate vertices are checked when they are drawn. */
static void add_element(struct derived_source *now, const struct state *state,
                        const struct state_element *element)
{
    uint32_t *extent = now->extent + element->stream;
    uint64_t bit = (uint64_t)1 << element->stream;
    uint32_t end = (uint32_t)element->offset + key_vertex_types[element->format].bytes;
    *extent = now->streams & bit && *extent > end ? *extent : end;
    now->streams |= bit;
    if (key_vertex_types[element->format].bytes % 4)
        now->overread |= bit;
    if (state->immediate && !element->stream)
        return;
    uint64_t vertices = element_vertices(state, element);
    now->vertices = vertices < now->vertices ? vertices : now->vertices;
}

/* The masks of smooth edges, which no routine reads. */
static void derive_masks(struct derived_source *now, const struct state *state)
{
    const struct state_element *masks = derive_edge_masks(state);
    now->draw.edge_masks = (struct attribute_job){0};
    now->draw.edge_format = ATTRIBUTE_FORMAT_NONE;
    if (!masks)
        return;
    add_element(now, state, masks);
    now->draw.edge_masks = derive_element(state, masks);
    now->draw.edge_format = masks->format;
}

static void derive_vertices(struct derived_source *now, const struct state *state,
                            const struct vertex_key *key)
{
    _Static_assert(STREAM_COUNT <= 64, "a set of streams has a bit for each");
    now->vertices = UINT64_MAX;
    now->streams = 0;
    now->overread = 0;
    for (unsigned i = key_next(key->attribute, 0, ATTRIBUTE_COUNT); i < ATTRIBUTE_COUNT;
         i = key_next(key->attribute, i + 1, ATTRIBUTE_COUNT))
        add_element(now, state, state->element + i);
    for (unsigned i = key_next(key->input, 0, INPUTS); i < INPUTS; i = key_next(key->input, i + 1, INPUTS))
        add_element(now, state, derive_input(state, key, i));
    derive_masks(now, state);
}

static enum triptych_result make_palette(struct device_derived *derived, const struct state *state,
                                         struct error *error)
{
    struct palette *palette = malloc(sizeof *palette);
    if (!palette) {
        error_set(error, "out of memory for a palette of world matrices");
        return TRIPTYCH_NO_MEMORY;
    }
    derive_palette(state, palette->entry);
    palette->next = derived->palettes;
    derived->palettes = palette;
    derived->has_palette = true;
    return TRIPTYCH_OK;
}

/* --- Sources --- */

/* Notes in all sources what has changed. */
static void spread_changes(struct device_derived *derived)
{
    unsigned changed = derived->changed & ~PARTS(KEYS);
    derived->changed = 0;
    if (!changed)
        return;
    derived->has_palette &= !(changed & PARTS(PALETTE));
    for (unsigned i = 0; i < DERIVED_SOURCES; i++)
        derived->stale[i] |= changed;
}

/* The place of the state's source, or -1. */
static int find(const struct device_derived *derived, const struct state *state,
                const struct key_source_rest *rest, uint32_t hash)
{
    for (unsigned i = 0; i < derived->count; i++)
        if (derived->hash[i] == hash && device_source_is(&derived->kept[i].source, state, rest))
            return (int)i;
    return -1;
}

/* A place that is free, or that of the source which was not used for the longest time. */
static unsigned free_place(struct device_derived *derived)
{
    unsigned oldest = 0;
    if (derived->count < DERIVED_SOURCES)
        return derived->count++;
    for (unsigned i = 1; i < DERIVED_SOURCES; i++)
        oldest = derived->used[i] < derived->used[oldest] ? i : oldest;
    return oldest;
}

/* A new source begins with what the last one derives to: where their keys are the same, so is the rest. */
static unsigned add(struct device_derived *derived, const struct state *state,
                    const struct key_source_rest *rest, uint32_t hash)
{
    unsigned place = free_place(derived);
    struct derived_source *now = &derived->kept[place];
    if (now != derived->now)
        memcpy(now, derived->now, offsetof(struct derived_source, source));
    device_source_take(state, rest, &now->source);
    derived->hash[place] = hash;
    derived->stale[place] =
        derived->stale[derived->place] | derive_new_keys(now, state, (enum primitive)rest->primitive);
    derive_setting(now, state);
    return place;
}

/* Routines and jobs of a source that was not the last one may be those of an earlier epoch. */
static void enter(struct device_derived *derived, unsigned place, uint64_t epoch)
{
    struct derived_source *now = &derived->kept[place];
    derived->used[place] = ++derived->updates;
    derived->place = place;
    derived->now = now;
    if (now->epoch == epoch)
        return;
    memset(now->draw.routine, 0, sizeof now->draw.routine);
    now->draw.job = NULL;
    now->epoch = epoch;
}

static void change_source(struct device_derived *derived, const struct state *state, enum primitive primitive,
                          uint64_t epoch)
{
    struct key_source_rest rest;
    device_source_take_rest(state, primitive, &rest);
    uint32_t hash = device_source_hash(state, &rest);
    derived->now->epoch = epoch; /* since it began, they are null if they are not held and queued */
    int place = find(derived, state, &rest, hash);
    enter(derived, place < 0 ? add(derived, state, &rest, hash) : (unsigned)place, epoch);
}

/* --- Updates --- */

static void derive_stale_job(struct derived_source *now, const struct state *state, unsigned stale)
{
    const struct vertex_key *vertex = &now->key[UNIT_VERTEX].vertex;
    const struct pixel_key *pixel = &now->key[UNIT_PIXEL].pixel;
    if (!stale)
        return;
    now->draw.job = NULL;
    if (stale == PARTS_OF_JOB)
        derive_job(state, vertex, pixel, &now->job);
    else
        derive_job_parts(state, vertex, pixel, stale, &now->job);
}

static enum triptych_result derive_stale(struct device_derived *derived, const struct state *state,
                                         struct error *error)
{
    struct derived_source *now = derived->now;
    const struct vertex_key *vertex = &now->key[UNIT_VERTEX].vertex;
    unsigned stale = derived->stale[derived->place];
    if (stale & PARTS(AREA))
        now->draw.scissor = derive_pixels(state, now->key[UNIT_SETUP].setup.primitive);
    if (stale & PARTS(VERTICES)) {
        now->steps = derive_steps(state);
        derive_vertices(now, state, vertex);
    }
    derive_stale_job(now, state, stale & PARTS_OF_JOB);
    if (stale & PARTS(PALETTE) && vertex->indexed_matrices) {
        if (!derived->has_palette && make_palette(derived, state, error))
            return TRIPTYCH_NO_MEMORY;
        now->job.palette = derived->palettes->entry;
    }
    derived->stale[derived->place] = 0;
    return TRIPTYCH_OK;
}

enum triptych_result device_derived_update(struct device_derived *derived, const struct state *state,
                                           enum triptych_primitive drawn, uint64_t epoch, struct error *error)
{
    enum primitive primitive = derive_primitive(state, drawn);
    bool keys = derived->changed & PARTS(KEYS) || derived->now->key[UNIT_SETUP].setup.primitive != primitive;
    if (derived->changed)
        spread_changes(derived);
    if (keys)
        change_source(derived, state, primitive, epoch);
    return derived->stale[derived->place] ? derive_stale(derived, state, error) : TRIPTYCH_OK;
}

void device_derived_update_streams(struct device_derived *derived, const struct state *state)
{
    spread_changes(derived);
    derive_stale(derived, state, NULL);
}

void device_derived_initialize(struct device_derived *derived)
{
    derived->now = derived->kept;
    derived->changed = derived->stale[0] = PARTS_ALL;
}

bool device_derived_samples(const struct device_derived *derived, int i)
{
    return derived->now->sampled >> i & 1;
}

bool device_derived_masks(const struct device_derived *derived)
{
    return derived->now->key[UNIT_PIXEL].pixel.clip_mask;
}

/* --- Checks --- */

static bool same_draw(const struct draw *a, const struct draw *b)
{
    struct draw x = *a, y = *b;
    x.job = y.job = NULL;
    memset(x.routine, 0, sizeof x.routine);
    memset(y.routine, 0, sizeof y.routine);
    x.primitive = y.primitive = 0;
    x.counts_spans = y.counts_spans = x.counts_joined = y.counts_joined = false;
    x.span = y.span = 0;
    x.span_narrowest = y.span_narrowest = x.span_widest = y.span_widest = 0;
    x.span_extent = y.span_extent = 0;
    return !memcmp(&x, &y, sizeof x);
}

bool device_derived_is_exact(const struct device_derived *derived, const struct state *state)
{
    const struct derived_source *now = derived->now;
    struct derived_source whole;
    memset(&whole, 0, sizeof whole);
    derive_new_keys(&whole, state, (enum primitive)now->key[UNIT_SETUP].setup.primitive);
    derive_setting(&whole, state);
    whole.draw.scissor = derive_pixels(state, now->key[UNIT_SETUP].setup.primitive);
    derive_vertices(&whole, state, &whole.key[UNIT_VERTEX].vertex);
    derive_job(state, &whole.key[UNIT_VERTEX].vertex, &whole.key[UNIT_PIXEL].pixel, &whole.job);
    whole.job.palette = now->job.palette;
    for (int unit = 0; unit < UNIT_COUNT; unit++)
        if (!device_same_key(unit, &whole.key[unit], &now->key[unit]))
            return false;
    return !memcmp(&whole.job, &now->job, sizeof whole.job) && same_draw(&whole.draw, &now->draw) &&
           whole.sampled == now->sampled && derive_steps(state) == now->steps &&
           whole.vertices == now->vertices && whole.streams == now->streams &&
           whole.overread == now->overread;
}

void device_free_palettes(struct palette *palette)
{
    for (struct palette *next; palette; palette = next) {
        next = palette->next;
        free(palette);
    }
}

struct palette *device_derived_take_palettes(struct device_derived *derived)
{
    struct palette *palettes = derived->palettes ? derived->palettes->next : NULL;
    if (derived->palettes)
        derived->palettes->next = NULL;
    return palettes;
}
