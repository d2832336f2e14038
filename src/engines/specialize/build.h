/* Building a routine: its phases in order, and the options of a build. */
#ifndef ENGINES_SPECIALIZE_BUILD_H
#define ENGINES_SPECIALIZE_BUILD_H

#include "contract/engine.h"
#include "engines/specialize/emit/emit.h"
#include "engines/specialize/passes/pass.h"
#include "engines/specialize/passes/subroutine.h"

enum encoding { ENCODING_BYTES, ENCODING_TEXT };

/* Where a routine's code has the pointers that its gathers start from: it loads them from the job, or they
 * are literals of the code, which threads take turns to change or have copies of (pointers.c). */
enum addresses { ADDRESSES_LOADED, ADDRESSES_PATCHED, ADDRESSES_SHARED };

/* The label of a routine in the cache: its key, or the hash of its recording (label.c). */
enum labels { LABELS_KEY, LABELS_RECORDING };

/* The constants of shaders are words of a block (shader/program/program.h). The first TRACKED_WORDS of it can
 * be tracked. */
enum { TRACKED_WORDS = 1024 };

/* The engine specialize builds the second code after as many blocks as 16 tiles have. By then it would have
 * saved about the time of its build. */
enum { SIXTEEN_BLOCKS = 16 * TILE_BLOCKS };

/* Words of the block that are literals of the code. */
struct burnt_words {
    uint32_t count;
    const uint32_t *at; /* number of a word in the block, ascending */
    const uint32_t *word;
};

struct build_options {
    unsigned width; /* lanes of a register: 1, 4, 8 or 16 */
    unsigned parts; /* registers of each value, a power of two; 0: 1. width * parts: up to 16, pixels 32 */
    enum profile profile;
    uint32_t enabled;       /* bit p: pass p runs although the profile is without it */
    uint32_t disabled;      /* bit p: pass p does not run */
    uint64_t without_rules; /* bit r: peephole rule r is left out */
    bool limited;           /* `registers` is a limit; specialize_options makes `file` of it */
    unsigned registers;     /* vector registers for values, and half as many mask registers */
    enum allocator allocator;
    enum encoding encoding; /* how instructions become bytes: directly, or by way of text */
    struct register_file file;
    enum addresses addresses;
    enum labels labels;
    enum calls calls;
    uint32_t track;                  /* draws after which a constant is burnt in; 0: never */
    const struct burnt_words *burnt; /* of a variant; null: none */
    uint32_t
        sixteen; /* blocks after which a pixel routine of 8 lanes gets a second code; 0: never (sixteen.h) */
    struct pass_shapes
        *shapes;   /* receives the estimates of the pass shape that it lacks; null: nothing is estimated */
    bool may_pair; /* with `shapes`: values have four parts, and a pass two blocks, where that is faster */
};

/* Returns the options of one of the specializer's engines, with the width that it chooses for the unit. */
struct build_options specialize_options(const struct engine *engine, enum unit unit);

/* Builds a routine with the given options, or returns null with the reason. The engine frees the routine. For
 * tests: builds with few registers. */
struct routine *specialize_routine(const struct engine *engine, const struct build_options *options,
                                   struct code_arena *arena, enum unit unit, const union key *key,
                                   struct error *error);

/* As engine.label (label.c). */
int specialize_label(const struct engine *engine, enum unit unit, const union key *key,
                     struct packed_key *label, struct error *error);

/* The memory of one build. It is reused; a build allocates nothing else. */
struct builder {
    struct ir ir;
    bool hinted;                            /* specialize_write_hints has run for the program */
    uint64_t constants[TRACKED_WORDS / 64]; /* bits: words that the recording reads, if they are tracked */
    struct pass_memory pass;
    struct subroutines subroutines;
    struct allocation allocation;
    struct emitter emitter;
};

/* Returns a builder, or null with the reason. Return it with specialize_give. */
struct builder *specialize_take(struct error *error);
void specialize_give(struct builder *builder);

/* Runs the passes on the program in builder->ir, and makes calls of its samplings if the options have
 * them. */
void specialize_run_passes(struct builder *builder, const struct build_options *options,
                           pass_observer *observer, void *context);

/* For the allocator `hints`: writes the hints for the program in builder->ir. Otherwise specialize_allocate
 * does it. */
void specialize_write_hints(struct builder *builder, const struct build_options *options);

/* Allocates registers for the program in builder->ir, and prepares the emission of its code. Returns 0, or -1
 * with the reason. */
int specialize_allocate(struct builder *builder, const struct build_options *options, struct error *error);

/* Records, optimises, allocates and encodes to builder->emitter.code, under the contract's MXCSR. Returns the
 * number of bytes, or 0 with the reason. `observer` may be null. */
size_t specialize_code(struct builder *builder, const struct build_options *options, enum unit unit,
                       const union key *key, pass_observer *observer, void *context, struct error *error);

/* The same, from a recording instead of the key's specification. */
size_t specialize_recording(struct builder *builder, const struct ir *ir, const struct build_options *options,
                            enum unit unit, const union key *key, pass_observer *observer, void *context,
                            struct error *error);

/* Builds a routine of one of the specializer's engines from a recording, without the passes whose bit is set
 * in `disabled`. Returns null with the reason; the engine frees the routine. */
struct routine *specialize_routine_of(const struct engine *engine, const struct ir *ir, uint32_t disabled,
                                      pass_observer *observer, void *context, struct code_arena *arena,
                                      enum unit unit, const union key *key, struct error *error);

#endif
