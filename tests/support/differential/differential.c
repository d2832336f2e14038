#include "tests/support/differential/differential_part.h"
#include "tests/support/system/fence.h"
#include "tests/support/differential/trampoline.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <xmmintrin.h>

struct differential *differential_create(struct code_arena *arena)
{
    struct differential *d = aligned_alloc(64, (sizeof *d + 63) / 64 * 64);
    if (!d)
        return NULL;
    memset(d, 0, sizeof *d);
    d->arena = arena;
    d->texels = fence(TEXTURE_BYTES);
    d->palette = fence(PALETTE_BYTES);
    d->constants = fence(CONSTANT_BYTES);
    d->blit_input = fence(BLIT_INPUT_BYTES);
    d->blit_rows = fence(BLIT_ROWS_BYTES);
    int complete = d->texels && d->palette && d->constants && d->blit_input && d->blit_rows;
    for (int a = 0; a < ATTRIBUTE_COUNT; a++)
        complete &= (d->stream[a] = fence(STREAM_BYTES)) != NULL;
    if (complete)
        return d;
    differential_destroy(d);
    return NULL;
}

void differential_destroy(struct differential *d)
{
    if (!d)
        return;
    for (int a = 0; a < ATTRIBUTE_COUNT; a++)
        unfence(d->stream[a], STREAM_BYTES);
    unfence(d->texels, TEXTURE_BYTES);
    unfence(d->palette, PALETTE_BYTES);
    unfence(d->constants, CONSTANT_BYTES);
    unfence(d->blit_input, BLIT_INPUT_BYTES);
    unfence(d->blit_rows, BLIT_ROWS_BYTES);
    free(d);
}

/* --- Running and comparing --- */

static const char *call_plainly(const struct routine *routine, const void *call, unsigned foreign)
{
    const unsigned flags = 0x3f, own = _mm_getcsr();
    _mm_setcsr(foreign);
    routine->run(call, routine);
    unsigned after = _mm_getcsr();
    _mm_setcsr(own);
    return (after ^ foreign) & ~flags ? "does not restore MXCSR" : NULL;
}

struct differential_arguments differential_arguments(struct differential *d, struct outputs *o)
{
    struct lane_table *lanes = (void *)(o->lanes + 4);
    return (struct differential_arguments){
        .vertex = {&d->job, differential_indices(d), o->vertices, d->count},
        .setup = {&d->job, differential_indices(d), o->vertices, o->records, d->count, 0},
        .pixel = {&d->job, d->entries.entry, d->triangles, lanes, o->color, o->depth, d->count, 0},
        .blit = {&d->blit, (const void *)(d->blit_input + BLIT_INPUT_BYTES - d->blit_input_bytes), o->color,
                 d->count}};
}

/* Runs generated code through the trampoline, with a foreign MXCSR: rounding toward zero, and denormals
 * kept or only results flushed. Returns null, or the violation. */
static const char *run(struct differential *d, const struct routine *routine, struct outputs *o)
{
    struct differential_arguments arguments = differential_arguments(d, o);
    const void *calls[UNIT_ALL] = {[UNIT_VERTEX] = &arguments.vertex,
                                   [UNIT_SETUP] = &arguments.setup,
                                   [UNIT_PIXEL] = &arguments.pixel,
                                   [UNIT_BLIT] = &arguments.blit};
    const void *code;
    const unsigned foreign = 0x7f80 ^ differential_word(d) % 2 << 15;
    memcpy(&code, &routine->run, sizeof code);
    memcpy(o, &d->initial, sizeof *o);
    const char *offence = routine->code
                              ? trampoline_call(code, calls[routine->unit], routine, foreign, &d->seed)
                              : call_plainly(routine, calls[routine->unit], foreign);
    if (!offence && differential_hash(d) != d->inputs)
        offence = "writes to what it may only read";
    return offence;
}

static size_t record_end(const struct setup_key *key, const struct triangle_layout *layout)
{
    static const size_t coverage[COVERAGE_COUNT] = {[COVERAGE_EDGES] = sizeof(struct smooth_triangle),
                                                    [COVERAGE_LINE] = sizeof(struct smooth_line),
                                                    [COVERAGE_POINT] = sizeof(struct smooth_point)};
    size_t end = RECORD_COVERAGE + coverage[layout->coverage];
    if (key->depth)
        end = layout->depth + sizeof(struct plane);
    if (layout->smooth)
        end = layout->reciprocal_w + sizeof(struct plane);
    for (int v = 0; v < VARYING_COUNT; v++)
        if (key->varying[v] != INTERPOLATION_NONE) {
            size_t bytes = key->varying[v] == INTERPOLATION_SMOOTH ? sizeof(struct plane) : sizeof(float);
            end = layout->varying[v] + varying_components[v] * bytes;
        }
    return end;
}

enum meaning { EXACT, ANY_NAN, OPEN };

/* The name of the output word at a byte. */
static enum meaning meaning(const struct differential *d, enum unit unit, const union key *key, size_t at)
{
    size_t vertices = at - offsetof(struct outputs, vertices);
    size_t records = at - offsetof(struct outputs, records);
    if (unit == UNIT_VERTEX)
        return vertices < sizeof d->initial.vertices && vertices / VERTEX_SLOT_BYTES != SLOT_CODE ? ANY_NAN
                                                                                                  : EXACT;
    if (unit != UNIT_SETUP || records >= (size_t)d->count * d->layout.stride)
        return EXACT;
    size_t within = records % d->layout.stride;
    if (within < sizeof(int32_t) || within >= record_end(&key->setup, &d->layout))
        return EXACT;
    struct triangle_head head;
    memcpy(&head, d->result[0].records + records - within, sizeof head);
    if (!head.visible)
        return OPEN;
    return within < sizeof head ? EXACT : ANY_NAN;
}

static int is_nan(uint32_t bits)
{
    return (bits & 0x7fffffff) > 0x7f800000;
}

/* The position of an output byte. */
static const char *place(size_t at, size_t *word)
{
    static const struct {
        size_t start;
        const char *name;
    } parts[] = {{offsetof(struct outputs, behind), "the memory after the outputs"},
                 {offsetof(struct outputs, lanes), "the lane table"},
                 {offsetof(struct outputs, depth), "depth"},
                 {offsetof(struct outputs, color), "colour"},
                 {offsetof(struct outputs, records), "records"},
                 {offsetof(struct outputs, vertices), "vertices"},
                 {0, "the memory before"}};
    size_t part = 0;
    while (at < parts[part].start)
        part++;
    *word = (at - parts[part].start) / 4;
    return parts[part].name;
}

const char *differential_results(struct differential *d, const struct engine *a, const struct engine *b,
                                 enum unit unit, const union key *key)
{
    const uint8_t *x = (const uint8_t *)&d->result[0], *y = (const uint8_t *)&d->result[1];
    if (!memcmp(x, y, sizeof d->result[0]))
        return NULL;
    for (size_t at = 0; at < sizeof d->result[0]; at += 4) {
        uint32_t left, right;
        memcpy(&left, x + at, sizeof left);
        memcpy(&right, y + at, sizeof right);
        enum meaning open = left == right ? OPEN : meaning(d, unit, key, at);
        if (open == OPEN || (open == ANY_NAN && is_nan(left) && is_nan(right)))
            continue;
        char text[KEY_TEXT_CAPACITY];
        size_t number;
        const char *where = place(at, &number);
        snprintf(d->message, sizeof d->message, "%s and %s differ in %s, word %zu: %08x and %08x; %s key: %s",
                 a->name, b->name, where, number, (unsigned)left, (unsigned)right, unit_name[unit],
                 key_print(unit, key, text));
        return d->message;
    }
    return NULL;
}

static const char *complain(struct differential *d, const struct engine *engine, enum unit unit,
                            const union key *key, const char *what)
{
    char text[KEY_TEXT_CAPACITY];
    snprintf(d->message, sizeof d->message, "%s: %s; %s key: %s", engine->name, what, unit_name[unit],
             key_print(unit, key, text));
    return d->message;
}

const char *differential_compare(struct differential *d, const struct engine *a, const struct engine *b,
                                 enum unit unit, const union key *key, uint64_t seed)
{
    const struct engine *engines[2] = {a, b};
    struct error error = {{0}};
    differential_fill(d, unit, key, seed);
    for (int i = 0; i < 2; i++) {
        struct routine *routine = engine_build(engines[i], d->arena, unit, key, &error);
        if (!routine)
            return complain(d, engines[i], unit, key, error.text);
        const char *offence = run(d, routine, &d->result[i]);
        engines[i]->free(d->arena, routine);
        if (offence)
            return complain(d, engines[i], unit, key, offence);
    }
    return differential_results(d, a, b, unit, key);
}

const char *differential_rounds(struct differential *d, const struct engine *a, const struct engine *b,
                                enum unit unit, differential_shape *shape, uint64_t seed, int rounds)
{
    const char *difference = NULL;
    for (int i = 0; i < rounds && !difference; i++) {
        union key key;
        differential_key(unit, &seed, &key);
        if (shape)
            shape(unit, &key);
        difference = differential_compare(d, a, b, unit, &key, seed);
    }
    return difference;
}

/* --- Engines without a reference ------------------------------------------------------------------------ */

/* Restores the outputs to their values before the call. */
static void forget_written(struct differential *d, enum unit unit, const union key *key, struct outputs *o)
{
    const struct outputs *initial = &d->initial;
    size_t planes = 0, counters = 4 + offsetof(struct lane_table, passed);
    if (unit == UNIT_VERTEX)
        for (size_t first = 0; first < SLOT_COUNT * VERTEX_CAPACITY; first += VERTEX_CAPACITY)
            memcpy(o->vertices + first, initial->vertices + first, d->count * sizeof *o->vertices);
    if (unit == UNIT_SETUP)
        memcpy(o->records, initial->records, (size_t)d->count * d->layout.stride);
    for (uint32_t p = 0; unit == UNIT_BLIT && p < differential_blit_planes(&key->blit); p++)
        memcpy(o->color + p * BLIT_BLEND_PIXELS, initial->color + p * BLIT_BLEND_PIXELS,
               d->count * sizeof *o->color);
    if (unit != UNIT_PIXEL)
        return;
    for (int t = 0; t < (key->pixel.samples ? 1 : TARGETS); t++)
        planes += (size_t)storage_planes[key->pixel.target[t]] << key->pixel.samples;
    memcpy(o->color, initial->color, planes * TILE_PLANE_BYTES);
    memcpy(o->depth, initial->depth, (size_t)TILE_PLANE_BYTES << key->pixel.samples);
    memcpy(o->lanes + counters, initial->lanes + counters, sizeof o->lanes - counters);
}

static const char *check_written(struct differential *d, const struct engine *engine, enum unit unit,
                                 const union key *key, struct outputs *o)
{
    const uint8_t *before = (const uint8_t *)&d->initial, *after = (const uint8_t *)o;
    char what[100];
    size_t number, at = 0;
    forget_written(d, unit, key, o);
    if (!memcmp(before, after, sizeof *o))
        return NULL;
    while (before[at] == after[at])
        at++;
    const char *where = place(at & ~(size_t)3, &number);
    snprintf(what, sizeof what, "writes to %s, word %zu", where, number);
    return complain(d, engine, unit, key, what);
}

static const char *run_one(struct differential *d, const struct engine *const *engines, unsigned i,
                           enum unit unit, const union key *key)
{
    struct error error = {{0}};
    struct routine *routine = engine_build(engines[i], d->arena, unit, key, &error);
    if (!routine)
        return complain(d, engines[i], unit, key, error.text);
    const char *found = run(d, routine, &d->result[i ? 1 : 0]);
    engines[i]->free(d->arena, routine);
    if (found)
        return complain(d, engines[i], unit, key, found);
    if (i && (found = differential_results(d, engines[0], engines[i], unit, key)))
        return found;
    d->scratch = d->result[i ? 1 : 0];
    return check_written(d, engines[i], unit, key, &d->scratch);
}

const char *differential_run(struct differential *d, const struct engine *const *engines, unsigned count,
                             enum unit unit, const union key *key, uint64_t seed)
{
    const char *found = NULL;
    differential_fill(d, unit, key, seed);
    for (unsigned i = 0; i < count && !found; i++)
        found = run_one(d, engines, i, unit, key);
    return found;
}
