/* Building kernels from recordings: each engine has a function that builds a routine of a given recording. */
#include "bench/clients/kernel.h"

#include "base/clock.h"
#include "contract/engine.h"
#include "emu/batch/batch.h"
#include "engines/external/external.h"
#include "engines/list.h"
#include "engines/specialize/build.h"
#include "engines/specialize/specialize.h"
#include "machine/code.h"

#include <stdlib.h>
#include <string.h>

struct kernel {
    const struct kernel_text *text;
    const void *choice;
    unsigned stride;
    struct code_arena *arena;
    struct routine *routine; /* null: emulate */
    struct kernel_size size;
};

static bool executes(const char *engine)
{
    return !strcmp(engine, "emulate");
}

static bool starts_with(const char *text, const char *start)
{
    return !strncmp(text, start, strlen(start));
}

const char *kernel_unavailable(const char *name)
{
    const struct engine *engine = engine_find(name);
    if (!engine)
        return "there is no such engine";
    bool builds = executes(name) || starts_with(name, "batch") || specialize_is_engine(engine) ||
                  !strcmp(name, "external");
    return builds ? engine_unavailable(engine) : "the engine builds no recordings";
}

static struct routine *build(struct kernel *kernel, const struct engine *engine, const struct ir *ir,
                             struct error *error)
{
    const union key key = {.kernel = {.stride = (uint16_t)kernel->stride}};
    struct routine *routine;
    if (specialize_is_engine(engine)) {
        kernel->arena = code_create(0, NULL, error);
        routine = kernel->arena ? specialize_routine_of(engine, ir, 0, NULL, NULL, kernel->arena, UNIT_KERNEL,
                                                        &key, error)
                                : NULL;
    } else if (starts_with(engine->name, "batch"))
        routine = batch_routine(ir, (unsigned)engine->width, batch_fuses(engine), UNIT_KERNEL, &key, error);
    else
        routine = external_routine(engine, ir, UNIT_KERNEL, &key, error);
    if (routine)
        routine->engine = engine;
    return routine;
}

static int record_and_build(struct kernel *kernel, const struct engine *engine, struct error *error)
{
    uint64_t begin = clock_ns();
    struct ir *ir = ir_take_recording(kernel->text->record, kernel->choice, kernel->text->name, error);
    if (!ir)
        return -1;
    kernel->routine = build(kernel, engine, ir, error);
    kernel->size.recorded = ir->count - 1;
    kernel->size.build_ns = clock_ns() - begin;
    ir_give(ir);
    if (!kernel->routine)
        return -1;
    kernel->size.instructions = kernel->routine->parts;
    if (kernel->routine->lanes)
        kernel->size.lanes = kernel->routine->lanes;
    kernel->size.code_bytes = kernel->routine->code_bytes;
    return 0;
}

struct kernel *kernel_create(const struct kernel_text *text, const void *choice, unsigned stride,
                             const char *name, struct error *error)
{
    const char *reason = kernel_unavailable(name);
    struct kernel *kernel = reason ? NULL : calloc(1, sizeof *kernel);
    if (!kernel) {
        error_set(error, "the kernel %s is not built by %s: %s", text->name, name,
                  reason ? reason : "out of memory");
        return NULL;
    }
    *kernel = (struct kernel){.text = text, .choice = choice, .stride = stride};
    kernel->size.lanes = (uint32_t)engine_find(name)->width;
    if (!executes(name) && record_and_build(kernel, engine_find(name), error)) {
        kernel_free(kernel);
        return NULL;
    }
    return kernel;
}

void kernel_free(struct kernel *kernel)
{
    if (!kernel)
        return;
    if (kernel->routine)
        kernel->routine->engine->free(kernel->arena, kernel->routine);
    code_destroy(kernel->arena);
    free(kernel);
}

void kernel_run(const struct kernel *kernel, const void *job, const int32_t *index, void *out, uint32_t count)
{
    const struct kernel_arguments call = {job, index, out, count};
    if (kernel->routine)
        kernel->routine->run(&call, kernel->routine);
    else
        kernel->text->execute(kernel->choice, &call, kernel->stride);
}

struct kernel_size kernel_size(const struct kernel *kernel)
{
    return kernel->size;
}
