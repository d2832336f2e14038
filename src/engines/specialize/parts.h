/* The parts of a build: the time that each takes, and what each pass does to the program. They are measured
 * only by this function; other builds read no clock. */
#ifndef ENGINES_SPECIALIZE_PARTS_H
#define ENGINES_SPECIALIZE_PARTS_H

#include "contract/engine.h"
#include "engines/specialize/passes/pass.h"

#include <stdio.h>

/* Passes have the numbers from BUILD_PASSES on, in the order of def/engine/pass.def. */
enum {
    BUILD_RECORD,
    BUILD_PASSES,
    BUILD_COMPACT = BUILD_PASSES + PASS_COUNT, /* the passes leave gaps, which are removed */
    BUILD_HINTS, /* for the allocator `hints`: finding the last uses, which a programmer would give */
    BUILD_ALLOCATE,
    BUILD_SELECT,
    BUILD_ENCODE,
    BUILD_ASSEMBLE, /* by way of text: reading it; `encode` is then printing */
    BUILD_PARTS
};

struct build_part {
    uint64_t ns;
    uint32_t runs;       /* of a pass */
    int32_t removed;     /* by all runs of a pass: instructions of the IR; negative: it adds some */
    uint32_t first_left; /* instructions after the first run; without a run, what the part before left */
};

struct build_parts {
    struct build_part part[BUILD_PARTS];
    uint32_t recorded, left; /* instructions of the IR */
    uint32_t bytes;          /* of code and its constants */
    uint32_t spills;
};

/* The name of a part, null past the last: "record", the names of passes, "compact", "hints", "allocate",
 * "select", "encode", "assemble". */
const char *specialize_part_name(unsigned part);

/* Builds a routine of one of the specializer's engines and discards it. To distinguish selection from
 * encoding, the code is written again with an encoder that writes nothing; encoding is the difference.
 * Returns 0, or -1 with the reason. */
int specialize_measure(const struct engine *engine, enum unit unit, const union key *key,
                       struct build_parts *parts, struct error *error);

/* A peephole rule in a build, compared with the same build without the rule. */
struct build_rule {
    uint32_t fired;
    int32_t instructions, bytes; /* of machine code: how many fewer the rule makes; negative: more */
};

/* Builds a routine, and once again without each rule that applies. Writes the number of machine instructions.
 * Returns 0, or -1 with the reason. */
int specialize_measure_rules(const struct engine *engine, enum unit unit, const union key *key,
                             struct build_rule rules[PEEPHOLES], uint32_t *instructions, struct error *error);

/* Prints the parts as a table, one a line. */
void specialize_print_parts(const struct build_parts *parts, FILE *out);

#endif
