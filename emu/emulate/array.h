/* The form files=array: all float registers of a shader are numbered components of one array, so a source is
 * an index and not a choice between files (thesis, section 2.4.1).
 *
 * The array begins with the machine, whose members are its files, and constants follow. Writes go to the
 * members. The machine is kept for a whole run, so a constant is copied to all lanes once a run. Sources with
 * a relative index are read as with typed files, because each lane can have another register. */
#ifndef EMU_EMULATE_ARRAY_H
#define EMU_EMULATE_ARRAY_H

#include "emu/emulate/bind.h"
#include "emu/emulate/routine.h"

struct vector4;

static inline struct vector4 array_read(struct env *e, const struct machine *m,
                                        const struct shader_operand *o, int row, unsigned places);

#include "spec/shader/shader.h"

enum {
    ARRAY_MACHINE = (sizeof(struct machine) + sizeof(flt) - 1) / sizeof(flt),
    ARRAY_COMPONENTS = ARRAY_MACHINE + 4 * EMULATE_ROWS
};

union register_array {
    struct machine machine;
    flt component[ARRAY_COMPONENTS];
};

#define ARRAY_NUMBER(member) (offsetof(struct machine, member) / sizeof(flt))

/* The number of component x of a register. */
static inline size_t array_number(const struct emulate_routine *routine, const struct shader_operand *o,
                                  int row)
{
    size_t index = o->index + (size_t)row;
    bool more = o->file == FILE_TEMPORARY && index >= CELL_TEMPORARIES;
    return routine->first[o->file] + (more ? cell_of_temporary((unsigned)index) : 4 * index);
}

static inline struct vector4 array_read(struct env *e, const struct machine *m,
                                        const struct shader_operand *o, int row, unsigned places)
{
    const union register_array *array = (const union register_array *)(const void *)m;
    struct vector4 r;
    if (o->relative)
        return read_registers(E, m, o, row, places);
    const flt *from = array->component + array_number(e->routine, o, row);
    for (unsigned p = 0; p < 4; p++)
        r.v[p] = from[place_component(o, places, p)];
    return r;
}

/* Copies the constants that are read by number to all lanes. */
static inline void array_begin(struct env *e, union register_array *array)
{
    flt *to = array->component + e->routine->first[FILE_CONSTANT];
    e->machine = &array->machine;
    for (unsigned row = 0; row < EMULATE_ROWS; row++) {
        if (!(e->routine->rows[row / 64] >> row % 64))
            row |= 63;
        else if (e->routine->rows[row / 64] >> row % 64 & 1)
            for (unsigned c = 0; c < 4; c++) {
                const struct program_constant *defined = program_defined(e->program, FILE_CONSTANT, row);
                to[4 * row + c] = defined ? component_of_literal(E, defined, c)
                                          : uniform_f(E, BASE_CONSTANT, (int)(16 * row + 4 * c));
            }
    }
}

static inline void array_prepare(struct emulate_routine *routine)
{
    const struct program *program = routine->program;
    bool written = textures_are_written(program->model);
    routine->first[FILE_TEMPORARY] = ARRAY_NUMBER(cell) + CELL_TEMPORARY;
    routine->first[FILE_TEXTURE] = written ? ARRAY_NUMBER(cell) + CELL_TEXTURE : ARRAY_NUMBER(coordinate);
    routine->first[FILE_INPUT] = ARRAY_NUMBER(input);
    routine->first[FILE_PLACE] = ARRAY_NUMBER(place);
    routine->first[FILE_SPRITE] = ARRAY_NUMBER(sprite);
    routine->first[FILE_FACE] = ARRAY_NUMBER(face);
    routine->first[FILE_CONSTANT] = ARRAY_MACHINE;
}

#endif
