/* Building a routine: the stages in order, and what a caller may vary. */
#ifndef JIT_BUILD_H
#define JIT_BUILD_H

#include "draw/engine.h"
#include "jit/emit.h"
#include "jit/pass.h"

struct build_options {
    unsigned width; /* 4, 8 or 16 */
    enum profile profile;
    uint32_t disabled; /* bit p: pass p is left out */
    struct register_file file;
};

/* What the engine varies, and chooses for a unit; null when it is none of the specializer's. */
const struct build_options *engine_options(const struct engine *engine, enum unit unit);

/* What the engines' `build` is: with their options, or a test's. The engine frees what comes of it. */
struct routine *build_routine(const struct engine *engine, const struct build_options *options,
                              struct code_arena *arena, enum unit unit, const union key *key,
                              struct error *error);

/* The memory of one build, reused: none is allocated while building. */
struct builder {
    struct ir ir;
    struct pass_memory pass;
    struct allocation allocation;
    struct emitter emitter;
    struct builder *next;
};

/* A builder of the process's pool, or null with the reason. Give it back. */
struct builder *builder_take(struct error *error);
void builder_give(struct builder *builder);

/* Records, optimises, allocates and encodes into builder->emitter.code, under the contract's MXCSR. Returns
 * the bytes, or 0 with the reason. `observer` may be null. */
size_t build_code(struct builder *builder, const struct build_options *options, enum unit unit,
                  const union key *key, pass_observer *observer, void *context, struct error *error);

/* The same for a recording instead of a key's. */
size_t build_recording(struct builder *builder, const struct ir *ir, const struct build_options *options,
                       enum unit unit, const union key *key, pass_observer *observer, void *context,
                       struct error *error);

/* A routine of one of the specializer's engines for a recording, with passes left out besides; free it like the
 * engine's. Null with the reason. */
struct routine *jit_routine(const struct engine *engine, const struct ir *ir, uint32_t disabled,
                            pass_observer *observer, void *context, struct code_arena *arena, enum unit unit,
                            const union key *key, struct error *error);

#endif
