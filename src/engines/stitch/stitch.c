/* The stitcher's two engines: plan, join, fill in the routine. They differ only in the choice of
 * granularity. */
#include "engines/stitch/stitch.h"

#include "machine/cpu.h"
#include "debug/code.h"
#include "engines/stitch/cover.h"
#include "engines/stitch/plan.h"

#include <stdlib.h>

struct stitched {
    struct routine routine; /* first: the engine interface's pointer is this structure's */
    struct code_span span;
};

static const char *unavailable(const struct engine *self)
{
    (void)self;
    const char *reason = cpu_lacks_avx2_fma();
    return reason ? reason : code_unavailable();
}

static const char *want_operations(enum unit unit, const union key *key)
{
    (void)unit;
    (void)key;
    return "";
}

const char *stitch_plan(struct plan *plan, const struct engine *engine, enum unit unit, const union key *key)
{
    const struct stitch_options *options = engine->options;
    const char *reason = options->lack(unit, key);
    if (reason)
        plan_operations(plan, unit, key);
    else
        plan_stages(plan, unit, key);
    return reason;
}

static void fill_in(struct stitched *stitched, const struct plan *plan)
{
    struct routine *routine = &stitched->routine;
    routine->run = (routine_function *)(uintptr_t)stitched->span.executable;
    routine->code = stitched->span.executable;
    routine->code_bytes = plan->bytes;
    routine->constant_bytes = plan->bytes - plan->code_bytes;
    routine->parts = plan->count;
    routine->spills = plan->counts.stored;
    routine->fused = plan->counts.fused;
    routine->carried = plan->counts.carried;
}

struct routine *plan_routine(struct plan *plan, const struct engine *engine, struct code_arena *arena,
                             enum unit unit, const union key *key, struct error *error)
{
    struct stitched *stitched = calloc(1, sizeof *stitched);
    if (!stitched) {
        error_set(error, "out of memory for a routine");
        return NULL;
    }
    struct routine *routine = &stitched->routine;
    routine->granularity = plan->operations > 1 ? "operation" : "stage";
    routine->engine = engine;
    routine->unit = unit;
    routine->key = *key;
    if (plan_join(plan, arena, &stitched->span, error)) {
        free(stitched);
        return NULL;
    }
    fill_in(stitched, plan);
    return routine;
}

/* A row of def/engine/cover.def promises stage fragments that a planner's table does not have. */
static void refuse_key(enum unit unit, const union key *key, struct error *error)
{
    char text[KEY_TEXT_CAPACITY];
    error_set(error,
              "the stitcher lacks a stage fragment that def/engine/cover.def promises for the %s key %s",
              unit_name[unit], key_print(unit, key, text));
}

static struct routine *build(const struct engine *self, struct code_arena *arena, enum unit unit,
                             const union key *key, struct error *error)
{
    struct plan *plan = plan_take(error);
    if (!plan)
        return NULL;
    stitch_plan(plan, self, unit, key);
    if (plan->missing)
        refuse_key(unit, key, error);
    struct routine *routine = plan_routine(plan, self, arena, unit, key, error);
    plan_give(plan);
    return routine;
}

static void free_routine(struct code_arena *arena, struct routine *routine)
{
    struct stitched *stitched = (struct stitched *)routine;
    if (stitched)
        code_free(arena, &stitched->span);
    free(stitched);
}

/* Parts of operations have lines of the specification. The others have the lines of their fragments in
 * asm/. */
static void describe_code(const struct plan *plan, struct debug_code *code)
{
    code->folder = "";
    code->bytes = plan->code_bytes;
    for (unsigned i = 0; i < plan->count; i++) {
        const struct part *part = plan->part + i;
        const struct fragment *fragment = part->fragment;
        if (part->file)
            debug_add_source(code, part->offset, part->file, part->line);
        else
            debug_add_source(code, part->offset, fragment->file, fragment->line);
        for (unsigned n = 0; n < fragment->unwinds; n++) {
            const struct debug_unwind *row = fragment->unwind + n;
            debug_add_unwind(code, part->offset + row->offset, row->rule, row->reg, row->value);
        }
    }
}

static int describe(const struct routine *routine, struct debug_code *code, struct error *error)
{
    struct plan *plan = plan_take(error);
    if (!plan)
        return -1;
    stitch_plan(plan, routine->engine, routine->unit, &routine->key);
    int result = plan_lay_out(plan, error);
    if (!result && (plan->bytes != routine->code_bytes || plan->count != routine->parts))
        result =
            error_set(error, "a %s routine was planned twice and is not the same", unit_name[routine->unit]);
    if (!result)
        describe_code(plan, code);
    plan_give(plan);
    return result;
}

const struct engine engine_stitch = {
    .name = "stitch",
    .description =
        "stitcher: hand-written stage fragments joined by copying; by operations where a key has none",
    .width = 8,
    .options = &(const struct stitch_options){stages_lack},
    .unavailable = unavailable,
    .build = build,
    .free = free_routine,
    .describe = describe,
};

const struct engine engine_stitch_operation = {
    .name = "stitch-operation",
    .description = "stitcher: hand-written fragments, one operation each, joined by copying",
    .width = 8,
    .options = &(const struct stitch_options){want_operations},
    .unavailable = unavailable,
    .build = build,
    .free = free_routine,
    .describe = describe,
};

bool stitch_is_engine(const struct engine *engine)
{
    return engine->build == build;
}

static int print_plan(struct plan *plan, struct code_arena *arena, FILE *out, struct error *error)
{
    struct code_span span;
    if (plan_check(plan, error) || plan_join(plan, arena, &span, error))
        return -1;
    plan_print(plan, &span, out);
    code_free(arena, &span);
    return 0;
}

int stitch_dump(const struct engine *engine, struct code_arena *arena, enum unit unit, const union key *key,
                FILE *out, struct error *error)
{
    char text[KEY_TEXT_CAPACITY];
    if (!stitch_is_engine(engine))
        return error_set(error, "engine %s does not stitch", engine->name);
    struct plan *plan = plan_take(error);
    if (!plan)
        return -1;
    const char *reason = stitch_plan(plan, engine, unit, key);
    fprintf(out, "%s %s %s\n", engine->name, unit_name[unit], key_print(unit, key, text));
    fprintf(out, "granularity: %s", reason ? "operation" : "stage");
    if (reason && *reason)
        fprintf(out, ", since stage fragments do not cover %s", reason);
    fputc('\n', out);
    int result = print_plan(plan, arena, out, error);
    plan_give(plan);
    return result;
}
