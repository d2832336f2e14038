/* Recording: the specification, executed with the recorder's binding. */
#include "ir/bind.h"

#include "spec/spec.h"

void ir_note_records(struct ir *ir, enum unit unit, const union key *key)
{
    static_assert(sizeof key->setup.varying == sizeof ir->interpolation &&
                      sizeof key->pixel.varying == sizeof ir->interpolation,
                  "keys have an interpolation for each varying");
    if (unit == UNIT_BLIT) /* its memory is words of any type */
        return;
    ir->unit = (uint8_t)unit;
    ir->layout = layout_of_unit(unit, key);
    ir->span = unit == UNIT_PIXEL && key->pixel.span;
    if (unit != UNIT_VERTEX)
        memcpy(ir->interpolation, unit == UNIT_SETUP ? key->setup.varying : key->pixel.varying,
               sizeof ir->interpolation);
}

void ir_record(struct ir *ir, enum unit unit, const union key *key)
{
    struct env e = {.ir = ir, .program = key_shader(unit, key)};
    struct triangle_layout layout = layout_of_unit(unit, key);
    ir_start(ir);
    ir_note_records(ir, unit, key);
    switch (unit) {
    case UNIT_VERTEX: spec_vertex(&e, &key->vertex); break;
    case UNIT_SETUP: spec_setup(&e, &key->setup, &layout); break;
    case UNIT_BLIT: spec_blit(&e, &key->blit); break;
    default: spec_pixel(&e, &key->pixel, &layout); break;
    }
}
