/* Recording: the specification, executed with the recorder's binding. */
#include "ir/bind.h"

#include "spec/spec.h"

void ir_record(struct ir *ir, enum unit unit, const union key *key)
{
    struct env e = {.ir = ir, .program = key_shader(unit, key)};
    struct triangle_layout layout = layout_of_unit(unit, key);
    ir_start(ir);
    switch (unit) {
    case UNIT_VERTEX: spec_vertex(&e, &key->vertex); break;
    case UNIT_SETUP: spec_setup(&e, &key->setup, &layout); break;
    default: spec_pixel(&e, &key->pixel, &layout); break;
    }
}
