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

/* Routines are those of the keys, or none. Returns the parts that depend on what has changed. */
static unsigned derive_new_keys(struct device_derived *derived, const struct state *state,
                                enum primitive primitive)
{
    union key key[UNIT_COUNT];
    unsigned parts = 0;
    derive_keys(state, primitive, key);
    for (int unit = 0; unit < UNIT_COUNT; unit++) {
        if (device_same_key(unit, &key[unit], &derived->key[unit]))
            continue;
        derived->key[unit] = key[unit];
        derived->draw.routine[unit] = NULL;
        if (unit == UNIT_PIXEL)
            derived->draw.routine[ROUTINE_SPAN] = NULL;
        parts |= derive_parts_of_key(unit);
    }
    if (parts)
        derive_live(&key[UNIT_VERTEX].vertex, &key[UNIT_PIXEL].pixel, &derived->live);
    if (parts & PARTS(SETTING))
        derived->pairs = derive_pairs(key);
    return parts;
}

static void derive_setting(struct device_derived *derived, const struct state *state)
{
    const struct setup_key *setup = &derived->key[UNIT_SETUP].setup;
    struct draw *draw = &derived->draw;
    draw->scissor = derive_pixels(state, setup->primitive);
    draw->stride = layout_of_setup(setup).stride;
    draw->shape = derive_shape(setup);
    draw->sampling = derive_sampling(state);
    draw->pairs = draw->sampling.samples ? (struct pair_form){0} : derived->pairs;
    draw->clip_ignored = derive_clip_ignored(state);
    draw->point_clipped = derive_point_clipped(state, setup->primitive);
    draw->last_pixel = derive_last_pixel(state);
    draw->line_extra = setup->primitive == PRIMITIVE_LINE ? derive_line_extra(state) : 0;
    draw->line_width = derive_line_width(state, setup->primitive);
    draw->edges = derive_edges(state);
    draw->wrapped = derive_wrapped(state, &derived->key[UNIT_PIXEL].pixel);
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
static void add_element(struct device_derived *derived, const struct state *state,
                        const struct state_element *element)
{
    uint32_t *extent = derived->extent + element->stream;
    uint64_t bit = (uint64_t)1 << element->stream;
    uint32_t end = (uint32_t)element->offset + key_vertex_types[element->format].bytes;
    *extent = derived->streams & bit && *extent > end ? *extent : end;
    derived->streams |= bit;
    if (key_vertex_types[element->format].bytes % 4)
        derived->overread |= bit;
    if (state->immediate && !element->stream)
        return;
    uint64_t vertices = element_vertices(state, element);
    derived->vertices = vertices < derived->vertices ? vertices : derived->vertices;
}

/* The masks of smooth edges, which no routine reads. */
static void derive_masks(struct device_derived *derived, const struct state *state)
{
    const struct state_element *masks = derive_edge_masks(state);
    derived->draw.edge_masks = (struct attribute_job){0};
    if (!masks)
        return;
    add_element(derived, state, masks);
    derived->draw.edge_masks = derive_element(state, masks);
    derived->draw.edge_format = masks->format;
}

static void derive_vertices(struct device_derived *derived, const struct state *state,
                            const struct vertex_key *key)
{
    _Static_assert(STREAM_COUNT <= 64, "a set of streams has a bit for each");
    derived->vertices = UINT64_MAX;
    derived->streams = 0;
    derived->overread = 0;
    for (unsigned i = key_next(key->attribute, 0, ATTRIBUTE_COUNT); i < ATTRIBUTE_COUNT;
         i = key_next(key->attribute, i + 1, ATTRIBUTE_COUNT))
        add_element(derived, state, state->element + i);
    for (unsigned i = 0; i < INPUTS; i++) {
        const struct state_element *element = derive_input(state, key, i);
        if (element)
            add_element(derived, state, element);
    }
    derive_masks(derived, state);
}

/* The newest palette is that of the job; recorded draws may use the others. */
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
    derived->job.palette = palette->entry;
    return TRIPTYCH_OK;
}

enum triptych_result device_derived_update(struct device_derived *derived, const struct state *state,
                                           enum triptych_primitive drawn, struct error *error)
{
    enum primitive primitive = derive_primitive(state, drawn);
    const struct vertex_key *vertex = &derived->key[UNIT_VERTEX].vertex;
    if (derived->key[UNIT_SETUP].setup.primitive != primitive)
        derived->stale = PARTS_ALL;
    unsigned stale = derived->stale;
    if (!stale)
        return TRIPTYCH_OK;
    if (stale & PARTS(KEYS))
        stale |= derive_new_keys(derived, state, primitive);
    if (stale & PARTS(SETTING))
        derive_setting(derived, state);
    if (stale & PARTS(VERTICES)) {
        derived->steps = derive_steps(state);
        derive_vertices(derived, state, vertex);
    }
    if (stale & PARTS_OF_JOB)
        derived->draw.job = NULL;
    if (stale == PARTS_ALL)
        derive_job(state, vertex, &derived->key[UNIT_PIXEL].pixel, &derived->job);
    else
        derive_job_parts(state, vertex, &derived->key[UNIT_PIXEL].pixel, stale, &derived->job);
    enum triptych_result result = TRIPTYCH_OK;
    if (stale & PARTS(PALETTE) && vertex->indexed_matrices)
        result = make_palette(derived, state, error);
    if (result == TRIPTYCH_OK)
        derived->stale = 0;
    return result;
}

void device_derived_update_streams(struct device_derived *derived, const struct state *state)
{
    const union key *key = derived->key;
    derived->draw.job = NULL;
    derive_vertices(derived, state, &key[UNIT_VERTEX].vertex);
    derive_job_parts(state, &key[UNIT_VERTEX].vertex, &key[UNIT_PIXEL].pixel, PARTS(ATTRIBUTES),
                     &derived->job);
    derived->stale = 0;
}

bool device_derived_samples(const struct device_derived *derived, int i)
{
    const struct pixel_key *pixel = &derived->key[UNIT_PIXEL].pixel;
    const struct vertex_key *vertex = &derived->key[UNIT_VERTEX].vertex;
    return i < PIXEL_SAMPLERS ? pixel->texture[i] : vertex->texture[i - PIXEL_SAMPLERS];
}

bool device_derived_masks(const struct device_derived *derived)
{
    return derived->key[UNIT_PIXEL].pixel.clip_mask;
}

bool device_derived_is_exact(const struct device_derived *derived, const struct state *state)
{
    union key key[UNIT_COUNT];
    struct job job;
    enum primitive primitive = (enum primitive)derived->key[UNIT_SETUP].setup.primitive;
    derive_keys(state, primitive, key);
    for (int unit = 0; unit < UNIT_COUNT; unit++)
        if (!device_same_key(unit, &key[unit], &derived->key[unit]))
            return false;
    derive_job(state, &key[UNIT_VERTEX].vertex, &key[UNIT_PIXEL].pixel, &job);
    job.palette = derived->job.palette;
    return !memcmp(&job, &derived->job, sizeof job);
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
