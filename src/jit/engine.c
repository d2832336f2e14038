/* The specializer's engines: the same code generator for 4, 8 and 16 lanes, with the default profile, and for
 * 8 lanes with the passes of the thesis alone. */
#include "base/code.h"
#include "base/cpu.h"
#include "debug/code.h"
#include "jit/build.h"
#include "jit/jit.h"

#include <stdlib.h>
#include <string.h>

/* Copies the built code into the arena. */
static int install(struct code_arena *arena, const struct builder *b, size_t bytes, struct routine *routine,
                   struct error *error)
{
    struct code_span span;
    if (!arena)
        return error_set(error, "generated code needs executable memory, and there is none");
    if (code_reserve(arena, bytes, &span, error))
        return -1;
    memcpy(span.writable, b->emitter.code, bytes);
    routine->code = code_commit(arena, &span, bytes);
    memcpy(&routine->run, &routine->code, sizeof routine->run);
    routine->code_bytes = (uint32_t)bytes;
    routine->constant_bytes = (uint32_t)bytes - b->emitter.code_bytes;
    routine->parts = b->ir.count - 1;
    routine->spills = b->allocation.spills;
    return 0;
}

/* What is built, and who looks on. */
struct order {
    const struct ir *ir; /* null: the key's */
    struct build_options options;
    pass_observer *observer;
    void *context;
};

static struct routine *build_with(const struct engine *engine, const struct order *order,
                                  struct code_arena *arena, enum unit unit, const union key *key,
                                  struct error *error)
{
    struct builder *b = builder_take(error);
    struct routine *routine = b ? calloc(1, sizeof *routine) : NULL;
    if (!routine) {
        error_set(error, "out of memory for a routine");
        goto failed;
    }
    routine->engine = engine;
    routine->unit = unit;
    routine->key = *key;
    size_t bytes = order->ir ? build_recording(b, order->ir, &order->options, unit, key, order->observer,
                                               order->context, error)
                             : build_code(b, &order->options, unit, key, NULL, NULL, error);
    if (!bytes || install(arena, b, bytes, routine, error))
        goto failed;
    builder_give(b);
    return routine;
failed:
    if (b)
        builder_give(b);
    free(routine);
    return NULL;
}

static void free_routine(struct code_arena *arena, struct routine *routine)
{
    struct code_span span = {.writable = code_writable(arena, routine->code),
                             .executable = routine->code,
                             .bytes = routine->code_bytes};
    code_free(arena, &span);
    free(routine);
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
            debug_add_source(code, line->offset, "jit/frame.c", line->frame_line);
    }
    for (uint32_t i = 0; i < m->unwinds; i++)
        debug_add_unwind(code, m->unwind[i].offset, m->unwind[i].rule, m->unwind[i].reg, m->unwind[i].value);
}

static int describe(const struct routine *routine, struct debug_code *code, struct error *error)
{
    struct builder *b = builder_take(error);
    if (!b)
        return -1;
    size_t bytes = build_code(b, engine_options(routine->engine, routine->unit), routine->unit, &routine->key,
                              NULL, NULL, error);
    int result = bytes ? 0 : -1;
    if (bytes && (bytes != routine->code_bytes || memcmp(b->emitter.code, routine->code, bytes)))
        result =
            error_set(error, "a %s routine was built twice and is not the same", unit_name[routine->unit]);
    if (!result)
        describe_code(b, code);
    builder_give(b);
    return result;
}

/* --- The engines: def/specialize.def ------------------------------------------------------------------------ */

static const struct {
    const struct engine *engine;
    struct build_options options;
} variants[] = {
#define SPECIALIZE(id, name, lanes, passes, meaning)                                                         \
    {&engine_##id, {.width = lanes, .profile = PROFILE_##passes}},
#include "def/specialize.def"
#undef SPECIALIZE
};

/* Sixteen lanes where there are so many, but for setup: what it gathers and scatters goes lane by lane however many
 * there are. */
static const struct build_options *choose(enum unit unit)
{
    static const struct build_options eight = {.width = 8, .profile = PROFILE_FULL},
                                      sixteen = {.width = 16, .profile = PROFILE_FULL};
    return unit == UNIT_SETUP || cpu_lacks_avx512() ? &eight : &sixteen;
}

const struct build_options *engine_options(const struct engine *engine, enum unit unit)
{
    if (engine == &engine_specialize)
        return choose(unit);
    for (unsigned i = 0; i < sizeof variants / sizeof *variants; i++)
        if (variants[i].engine == engine)
            return &variants[i].options;
    return NULL;
}

int jit_is_engine(const struct engine *engine)
{
    return engine_options(engine, UNIT_VERTEX) != NULL;
}

static const char *unavailable_8(void)
{
    const char *reason = cpu_lacks_avx2_fma();
    return reason ? reason : code_unavailable();
}

static const char *unavailable_0(void)
{
    return unavailable_8();
}

static const char *unavailable_4(void)
{
    return unavailable_8();
}

static const char *unavailable_16(void)
{
    const char *reason = unavailable_8();
    return reason ? reason : cpu_lacks_avx512();
}

static struct routine *build_for(const struct engine *engine, struct code_arena *arena, enum unit unit,
                                 const union key *key, struct error *error)
{
    const struct order order = {.options = *engine_options(engine, unit)};
    struct routine *routine = build_with(engine, &order, arena, unit, key, error);
    if (routine)
        routine->lanes = (uint32_t)order.options.width;
    return routine;
}

#define SPECIALIZE(id, text, lanes, passes, meaning)                                                         \
    static struct routine *build_##id(struct code_arena *arena, enum unit unit, const union key *key,        \
                                      struct error *error)                                                   \
    {                                                                                                        \
        return build_for(&engine_##id, arena, unit, key, error);                                             \
    }                                                                                                        \
    const struct engine engine_##id = {                                                                      \
        .name = text,                                                                                        \
        .description = meaning,                                                                              \
        .width = lanes,                                                                                      \
        .unavailable = unavailable_##lanes,                                                                  \
        .build = build_##id,                                                                                 \
        .free = free_routine,                                                                                \
        .describe = describe,                                                                                \
    };
#include "def/specialize.def"
#undef SPECIALIZE

struct routine *jit_routine(const struct engine *engine, const struct ir *ir, uint32_t disabled,
                            pass_observer *observer, void *context, struct code_arena *arena, enum unit unit,
                            const union key *key, struct error *error)
{
    struct order order = {ir, *engine_options(engine, unit), observer, context};
    order.options.disabled |= disabled;
    return build_with(engine, &order, arena, unit, key, error);
}

struct routine *build_routine(const struct engine *engine, const struct build_options *options,
                              struct code_arena *arena, enum unit unit, const union key *key,
                              struct error *error)
{
    const struct order order = {.options = *options};
    return build_with(engine, &order, arena, unit, key, error);
}
