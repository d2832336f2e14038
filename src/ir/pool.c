/* Memory for recordings. Each reserves megabytes of address space; a routine touches only a part of it. */
#include "base/slab.h"
#include "machine/mxcsr.h"
#include "ir/ir.h"

static struct slab recordings = SLAB(sizeof(struct ir));
SLAB_CLEAR_AT_UNLOAD(recordings)

struct ir *ir_take_recording(ir_recorder *record, const void *context, const char *name, struct error *error)
{
    struct ir *ir = slab_take(&recordings);
    if (!ir) {
        error_set(error, "out of memory for a recording (%zu bytes)", sizeof *ir);
        return NULL;
    }
    unsigned saved = mxcsr_enter();
    record(ir, context);
    mxcsr_leave(saved);
    if (ir->overflow)
        error_set(error, "the %s routine takes more than %d operations", name, IR_CAPACITY - 1);
    else if (!IR_CHECKED || !ir_check(ir, "the recording", error))
        return ir;
    ir_give(ir);
    return NULL;
}

/* A routine of the pipeline. */
struct subject {
    enum unit unit;
    const union key *key;
};

static void record_subject(struct ir *ir, const void *context)
{
    const struct subject *subject = context;
    ir_record(ir, subject->unit, subject->key);
}

struct ir *ir_take(enum unit unit, const union key *key, struct error *error)
{
    const struct subject subject = {unit, key};
    return ir_take_recording(record_subject, &subject, unit_name[unit], error);
}

void ir_give(struct ir *ir)
{
    slab_give(&recordings, ir);
}
