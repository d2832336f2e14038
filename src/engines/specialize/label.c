/* Labels from recordings: the hash of the operations that the specification records for a key, before any
 * pass. The thesis proposes them instead of keys that are listed by hand, in which a missing field is found
 * late. A label costs a recording at each draw. Positions in the specification's text are not part of it. */
#include "engines/specialize/build.h"

#include <xxhash.h>

/* Operations without what only listings read. */
static void strip(struct ir *ir)
{
    for (uint32_t i = 0; i < ir->count; i++) {
        ir->instruction[i].line = ir->instruction[i].origin = 0;
        ir->instruction[i].file = 0;
    }
}

static void hash_recording(const struct ir *ir, enum unit unit, struct packed_key *label)
{
    XXH128_hash_t hash =
        XXH3_128bits_withSeed(ir->instruction, ir->count * sizeof *ir->instruction, (unsigned)unit);
    label->words = 2;
    label->word[0] = hash.low64;
    label->word[1] = hash.high64;
}

int specialize_label(const struct engine *engine, enum unit unit, const union key *key,
                     struct packed_key *label, struct error *error)
{
    if (((const struct build_options *)engine->options)->labels == LABELS_KEY)
        return 0;
    if (!key)
        return 1;
    struct ir *ir = ir_take(unit, key, error);
    if (!ir)
        return -1;
    strip(ir);
    hash_recording(ir, unit, label);
    ir_give(ir);
    return 1;
}
