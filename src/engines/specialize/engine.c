/* The specializer's engines (def/engine/specialize.def): one code generator for registers of 4, 8 and 16
 * lanes and for one or more registers a value, with all passes, only those of the thesis, or none. */
#include "machine/code.h"
#include "machine/cpu.h"
#include "debug/code.h"
#include "engines/specialize/build.h"
#include "engines/specialize/pointers.h"
#include "engines/specialize/sixteen.h"
#include "engines/specialize/specialize.h"
#include "engines/specialize/track.h"

#include <stdlib.h>
#include <string.h>

/* Makes a routine of the built code, which is copied into the arena. */
static struct routine *install(struct code_arena *arena, const struct builder *b, size_t bytes,
                               struct error *error)
{
    struct code_span span;
    struct routine *routine = calloc(1, sizeof *routine);
    if (!routine)
        return error_set(error, "out of memory for a routine"), NULL;
    if (code_reserve(arena, bytes, &span, error))
        return free(routine), NULL;
    memcpy(span.writable, b->emitter.code, bytes);
    routine->code = code_commit(arena, &span, bytes);
    memcpy(&routine->run, &routine->code, sizeof routine->run);
    return routine;
}

static void describe_build(const struct builder *b, size_t bytes, struct routine *routine)
{
    routine->code_bytes = (uint32_t)bytes;
    routine->constant_bytes = (uint32_t)bytes - b->emitter.code_bytes;
    routine->parts = b->ir.count - 1;
    routine->spills = b->allocation.spills;
    routine->lanes = emit_lanes(&b->emitter);
    routine->takes_tiles = b->emitter.rectangles;
}

/* True if the code contains pointers. */
static bool has_pointers(const struct routine *routine)
{
    return routine->patches != NULL;
}

static void free_routine(struct code_arena *arena, struct routine *routine)
{
    specialize_track_free(routine);
    specialize_sixteen_free(routine);
    if (has_pointers(routine)) {
        specialize_pointers_free(routine);
        return;
    }
    struct code_span span = {.writable = code_writable(arena, routine->code),
                             .executable = routine->code,
                             .bytes = routine->code_bytes};
    code_free(arena, &span);
    free(routine);
}

/* An order for a routine, with the observer of its passes. */
struct order {
    const struct ir *ir; /* null: record the specification for the key */
    struct build_options options;
    pass_observer *observer;
    void *context;
};

static struct routine *build_in(struct builder *b, const struct order *order, struct code_arena *arena,
                                enum unit unit, const union key *key, struct error *error)
{
    enum addresses addresses = order->options.addresses;
    size_t bytes = order->ir ? specialize_recording(b, order->ir, &order->options, unit, key, order->observer,
                                                    order->context, error)
                             : specialize_code(b, &order->options, unit, key, NULL, NULL, error);
    if (!bytes)
        return NULL;
    struct routine *routine = !b->emitter.pointers
                                  ? install(arena, b, bytes, error)
                                  : specialize_pointers_routine(b, arena, bytes, addresses, error);
    if (routine)
        describe_build(b, bytes, routine);
    return routine;
}

/* Prepares variants of the routine, which was built last. Returns 0, or -1 with the reason. */
static int prepare_variants(const struct builder *b, const struct order *order, struct code_arena *arena,
                            struct routine *routine, struct error *error)
{
    if (order->ir)
        return 0;
    if (order->options.track && specialize_track(b->constants, arena, routine, error))
        return -1;
    if (!specialize_may_sixteen(&order->options, routine->unit))
        return 0;
    const struct pass_shapes none = {0}, *shapes = order->options.shapes;
    return specialize_sixteen(arena, routine, shapes ? shapes : &none, error);
}

static struct routine *build_with(const struct engine *engine, const struct order *order,
                                  struct code_arena *arena, enum unit unit, const union key *key,
                                  struct error *error)
{
    if (!arena)
        return error_set(error, "generated code needs executable memory"), NULL;
    struct builder *b = specialize_take(error);
    if (!b)
        return NULL;
    struct routine *routine = build_in(b, order, arena, unit, key, error);
    if (routine) {
        routine->engine = engine;
        routine->unit = unit;
        routine->key = *key;
        if (prepare_variants(b, order, arena, routine, error)) {
            free_routine(arena, routine);
            routine = NULL;
        }
    }
    specialize_give(b);
    return routine;
}

static void describe_code(const struct builder *b, struct debug_code *code)
{
    const struct emitter *m = &b->emitter;
    code->folder = "src";
    code->bytes = m->code_bytes;
    for (uint32_t i = 0; i < m->lines; i++) {
        const struct code_line *line = m->line + i;
        const struct ir_instruction *instruction = &b->ir.instruction[line->instruction];
        if (line->instruction)
            debug_add_source(code, line->offset, b->ir.file[instruction->file], instruction->line);
        else
            debug_add_source(code, line->offset, "engines/specialize/emit/frame.c", line->frame_line);
    }
    for (uint32_t i = 0; i < m->unwinds; i++)
        debug_add_unwind(code, m->unwind[i].offset, m->unwind[i].rule, m->unwind[i].reg, m->unwind[i].value);
}

/* Returns true if the code that was built last is the routine's. */
static bool is_same(const struct builder *b, const struct routine *routine)
{
    return has_pointers(routine) ? specialize_pointers_match(b, routine)
                                 : !memcmp(b->emitter.code, routine->code, routine->code_bytes);
}

static int describe(const struct routine *routine, struct debug_code *code, struct error *error)
{
    struct builder *b = specialize_take(error);
    if (!b)
        return -1;
    struct build_options options = specialize_options(routine->engine, routine->unit);
    if (specialize_may_sixteen(&options, routine->unit) && !routine->second)
        options.parts = routine->lanes / options.width; /* it is the second code of a routine */
    size_t bytes = specialize_code(b, &options, routine->unit, &routine->key, NULL, NULL, error);
    int result = bytes ? 0 : -1;
    if (bytes && (bytes != routine->code_bytes || !is_same(b, routine)))
        result =
            error_set(error, "a %s routine was built twice and is not the same", unit_name[routine->unit]);
    if (!result)
        describe_code(b, code);
    specialize_give(b);
    return result;
}

/* --- The engines: def/engine/specialize.def ------------------------------------------------------------ */

/* Sixteen lanes with AVX-512, except for setup: it gathers and scatters lane by lane, whatever the width. */
static unsigned best_width(enum unit unit)
{
    return unit == UNIT_SETUP || cpu_lacks_avx512() ? 8 : 16;
}

static const char *unavailable(const struct engine *self)
{
    const char *reason = cpu_lacks_avx2_fma();
    if (!reason)
        reason = code_unavailable();
    unsigned width = ((const struct build_options *)self->options)->width;
    return reason || width < 16 ? reason : cpu_lacks_avx512();
}

static struct routine *build(const struct engine *self, struct code_arena *arena, enum unit unit,
                             const union key *key, struct error *error)
{
    struct order order = {.options = specialize_options(self, unit)};
    struct pass_shapes shapes = {0};
    if (specialize_may_sixteen(&order.options, unit) && key->pixel.span)
        order.options.shapes = &shapes;
    return build_with(self, &order, arena, unit, key, error);
}

static const struct routine *select_routine(const struct routine *routine, const float *constants,
                                            uint64_t number)
{
    if (routine_wants_second(routine))
        specialize_build_sixteen(routine);
    return specialize_select(routine, constants, number);
}

bool specialize_is_engine(const struct engine *engine)
{
    return engine->build == build;
}

struct build_options specialize_options(const struct engine *engine, enum unit unit)
{
    struct build_options options = *(const struct build_options *)engine->options;
    if (!options.width)
        options.width = best_width(unit);
    /* Only pixels have lists that end anywhere. */
    if (unit != UNIT_PIXEL && options.parts * options.width > BLOCK_PIXELS)
        options.parts = BLOCK_PIXELS / options.width;
    if (options.limited)
        options.file = allocate_register_file(options.registers, options.width);
    return options;
}

enum { ALWAYS, NAMED };

#define SPECIALIZE(id, text, lanes, count, passes, allocate, runs, meaning)                                  \
    const struct engine engine_##id = {                                                                      \
        .name = text,                                                                                        \
        .description = meaning,                                                                              \
        .width = lanes * count > BLOCK_PIXELS ? BLOCK_PIXELS : lanes * count,                                \
        .options = &(const struct build_options){.width = lanes,                                             \
                                                 .parts = count,                                             \
                                                 .sixteen = lanes ? 0 : SIXTEEN_BLOCKS,                      \
                                                 .profile = PROFILE_##passes,                                \
                                                 .allocator = ALLOCATOR_##allocate},                         \
        .on_request = runs == NAMED,                                                                         \
        .unavailable = unavailable,                                                                          \
        .build = build,                                                                                      \
        .label = specialize_label,                                                                           \
        .select = select_routine,                                                                            \
        .free = free_routine,                                                                                \
        .describe = describe,                                                                                \
    };
#include "def/engine/specialize.def"
#undef SPECIALIZE

struct routine *specialize_routine_of(const struct engine *engine, const struct ir *ir, uint32_t disabled,
                                      pass_observer *observer, void *context, struct code_arena *arena,
                                      enum unit unit, const union key *key, struct error *error)
{
    struct order order = {ir, specialize_options(engine, unit), observer, context};
    order.options.disabled |= disabled;
    if (observer) /* an observer of passes looks at one program */
        order.options.calls = CALLS_INLINE;
    return build_with(engine, &order, arena, unit, key, error);
}

struct routine *specialize_routine(const struct engine *engine, const struct build_options *options,
                                   struct code_arena *arena, enum unit unit, const union key *key,
                                   struct error *error)
{
    const struct order order = {.options = *options};
    return build_with(engine, &order, arena, unit, key, error);
}
