/* The stitcher's two engines: plan, join, hand out. They differ in the planner only. */
#include "stitch/stitch.h"

#include "base/cpu.h"
#include "stitch/plan.h"

#include <stdlib.h>

struct stitched {
    struct routine routine; /* first: the engine interface's pointer is this structure's */
    struct code_span span;
};

static const char *unavailable(void)
{
    return cpu_has_avx2_fma() ? NULL : "the stitcher's fragments need a CPU and a system with AVX2 and FMA";
}

static struct routine *build(planner *planner, const struct engine *engine, struct code_arena *arena,
                             enum unit unit, const union key *key, struct error *error)
{
    struct plan plan;
    struct stitched *stitched = calloc(1, sizeof *stitched);
    if (!stitched) {
        error_set(error, "out of memory for a routine");
        return NULL;
    }
    planner(&plan, unit, key);
    if (plan_join(&plan, arena, &stitched->span, error)) {
        free(stitched);
        return NULL;
    }
    struct routine *routine = &stitched->routine;
    const struct part *last = &plan.part[plan.count - 1];
    routine->run = (routine_function *)(uintptr_t)stitched->span.executable;
    routine->engine = engine;
    routine->unit = unit;
    routine->key = *key;
    routine->code = stitched->span.executable;
    routine->code_bytes = last->offset + last->fragment->bytes;
    routine->parts = plan.count;
    return routine;
}

static struct routine *build_stages(struct code_arena *arena, enum unit unit, const union key *key,
                                    struct error *error)
{
    return build(plan_stages, &engine_stitch, arena, unit, key, error);
}

static struct routine *build_operations(struct code_arena *arena, enum unit unit, const union key *key,
                                        struct error *error)
{
    return build(plan_operations, &engine_stitch_operation, arena, unit, key, error);
}

static void free_routine(struct code_arena *arena, struct routine *routine)
{
    struct stitched *stitched = (struct stitched *)routine;
    if (stitched)
        code_free(arena, &stitched->span);
    free(stitched);
}

const struct engine engine_stitch = {
    .name = "stitch",
    .description = "stitcher: hand-written fragments, a whole stage each, joined by copying",
    .width = 8,
    .unavailable = unavailable,
    .build = build_stages,
    .free = free_routine,
};

const struct engine engine_stitch_operation = {
    .name = "stitch-operation",
    .description = "stitcher: hand-written fragments, one operation each, joined by copying",
    .width = 8,
    .unavailable = unavailable,
    .build = build_operations,
    .free = free_routine,
};

int stitch_dump(struct code_arena *arena, const struct engine *engine, enum unit unit, const union key *key,
                FILE *out, struct error *error)
{
    struct plan plan;
    struct code_span span;
    char text[KEY_TEXT_CAPACITY];
    if (engine != &engine_stitch && engine != &engine_stitch_operation)
        return error_set(error, "engine %s does not stitch", engine->name);
    if (engine == &engine_stitch)
        plan_stages(&plan, unit, key);
    else
        plan_operations(&plan, unit, key);
    if (plan_check(&plan, error) || plan_join(&plan, arena, &span, error))
        return -1;
    fprintf(out, "%s %s %s\n", engine->name, unit_name[unit], key_print(unit, key, text));
    plan_print(&plan, &span, out);
    code_free(arena, &span);
    return 0;
}
