/* The form decode=once: the build decodes each step of a shader. A run then decides nothing on the kind of
 * the instruction, on its swizzles or on its registers: it calls the step's function, which reads the sources
 * at known places, computes the operation, and writes known cells.
 *
 * The operations, modifiers and saturation are those of the specification (compute_result, modify,
 * write_result). So are flow control, setp and writes of the address register (execute_step). Their
 * conditions are decoded in each run, because they depend on lanes and on constants. */
#ifndef EMU_EMULATE_ONCE_H
#define EMU_EMULATE_ONCE_H

#include "emu/emulate/bind.h"
#include "emu/emulate/routine.h"

#include <stdlib.h>

struct step;
struct vector4;

static inline uint32_t once_execute(struct env *e, struct machine *m, uint32_t at);

/* Inlined, so that each function below has only its own case. */
static inline __attribute__((always_inline)) bool
compute_result(struct env *e, struct step *s, enum shader_opcode opcode, struct vector4 *result);

#include "spec/shader/shader_flow.h"

/* A read of a source, or of a row of a matrix. */
struct decoded_read {
    const struct shader_operand *operand;
    uint8_t kind; /* enum decoded_kind */
    uint8_t row;
    uint8_t places; /* the components that are read */
    uint8_t to;     /* the source; SHADER_SOURCES + r: row r of the matrix */
    int32_t at[4];  /* by place */
};

enum { DECODED_READS = SHADER_SOURCES + 3 };

typedef bool compute_function(struct env *e, struct step *s, struct vector4 *result);
typedef uint32_t run_function(struct env *e, struct machine *m, uint32_t at);

struct decoded_step {
    run_function *run;
    compute_function *compute;
    const struct shader_instruction *instruction;
    bool plain;    /* the result is written as it is, to cells from `cell` on */
    uint16_t cell; /* if plain */
    uint8_t reads;
    struct decoded_read read[DECODED_READS];
};

/* --- Operations ---------------------------------------------------------------------------------------- */

#define INSTRUCTION(id, ...)                                                                                 \
    static bool compute_##id(struct env *e, struct step *s, struct vector4 *result)                          \
    {                                                                                                        \
        return compute_result(E, s, SHADER_##id, result);                                                    \
    }
#include "def/shader/shader.def"
#undef INSTRUCTION

static compute_function *const compute_functions[SHADER_COUNT] = {
#define INSTRUCTION(id, ...) [SHADER_##id] = compute_##id,
#include "def/shader/shader.def"
#undef INSTRUCTION
};

/* --- Registers ----------------------------------------------------------------------------------------- */

#if FORM_ARRAY

enum decoded_kind {
    DECODED_COMPONENT, /* at: numbers in the array */
    DECODED_OPERAND    /* a relative index: read by the specification */
};

static inline struct vector4 once_registers(struct env *e, const struct machine *m,
                                            const struct decoded_read *read)
{
    const flt *component = ((const union register_array *)(const void *)m)->component;
    struct vector4 r;
    if (read->kind == DECODED_OPERAND)
        return read_registers(E, m, read->operand, read->row, read->places);
    for (int p = 0; p < 4; p++)
        r.v[p] = component[read->at[p]];
    return r;
}

static void once_locate(const struct emulate_routine *routine, struct decoded_read *read)
{
    const struct shader_operand *o = read->operand;
    read->kind = o->relative ? DECODED_OPERAND : DECODED_COMPONENT;
    for (unsigned p = 0; p < 4 && !o->relative; p++)
        read->at[p] = (int32_t)(array_number(routine, o, read->row) + place_component(o, read->places, p));
}

#else

enum decoded_kind {
    DECODED_REGISTER, /* at: components; the file decides in each run where the register is */
    DECODED_UNIFORM,  /* at: offsets of a constant's words */
    DECODED_LITERAL,  /* at: the bits of a defined constant */
    DECODED_OPERAND   /* a relative index: read by the specification */
};

static inline flt once_literal(struct env *e, int32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return lit_f(E, value);
}

static inline struct vector4 once_registers(struct env *e, const struct machine *m,
                                            const struct decoded_read *read)
{
    struct vector4 r = {{m->cell[0], m->cell[0], m->cell[0], m->cell[0]}};
    if (read->kind == DECODED_OPERAND)
        return read_registers(E, m, read->operand, read->row, read->places);
    for (unsigned p = 0; p < 4; p++) {
        if (read->kind == DECODED_REGISTER)
            r.v[p] = read_component(E, m, read->operand, read->row, (unsigned)read->at[p]);
        else if (read->places >> p & 1)
            r.v[p] = read->kind == DECODED_UNIFORM ? uniform_f(E, BASE_CONSTANT, read->at[p])
                                                   : once_literal(E, read->at[p]);
    }
    return r;
}

static void once_locate(const struct emulate_routine *routine, struct decoded_read *read)
{
    const struct shader_operand *o = read->operand;
    unsigned index = o->index + (unsigned)read->row;
    const struct program_constant *defined = program_defined(routine->program, FILE_CONSTANT, index);
    read->kind = o->relative                ? DECODED_OPERAND
                 : o->file != FILE_CONSTANT ? DECODED_REGISTER
                 : defined                  ? DECODED_LITERAL
                                            : DECODED_UNIFORM;
    for (unsigned p = 0; p < 4; p++) {
        unsigned c = place_component(o, read->places, p);
        read->at[p] = read->kind == DECODED_UNIFORM   ? (int32_t)(16 * index + 4 * c)
                      : read->kind == DECODED_LITERAL ? (int32_t)defined->value[c]
                                                      : (int32_t)c;
    }
}

#endif

/* --- Execution ----------------------------------------------------------------------------------------- */

/* Reads the sources of the step and computes its result, as execute_instruction does. */
static inline bool once_compute(struct env *e, struct machine *m, const struct decoded_step *d,
                                struct vector4 *result)
{
    struct step s;
    s.instruction = d->instruction;
    s.machine = m;
    s.mask = d->instruction->destination.swizzle;
    s.legacy = m->legacy;
    for (const struct decoded_read *read = d->read; read < d->read + d->reads; read++) {
        struct vector4 *to =
            read->to < SHADER_SOURCES ? s.source + read->to : s.row + read->to - SHADER_SOURCES;
        *to = once_registers(E, m, read);
        if (read->operand->modifier)
            for (unsigned p = 0; p < 4; p++)
                if (read->places >> p & 1)
                    to->v[p] = modify(E, read->operand->modifier, to->v[p]);
    }
    return d->compute(E, &s, result);
}

static inline void once_write(struct env *e, struct machine *m, const struct decoded_step *d,
                              const struct vector4 *result)
{
    if (!d->plain) {
        write_result(E, m, d->instruction, result);
        return;
    }
    for (unsigned c = 0; c < 4; c++)
        if (d->instruction->destination.swizzle >> c & 1) {
            remember(m, d->cell + c);
            m->cell[d->cell + c] = result->v[c];
        }
}

static uint32_t once_run(struct env *e, struct machine *m, uint32_t at)
{
    const struct decoded_step *d = e->routine->step + at;
    struct vector4 result;
    if (once_compute(E, m, d, &result))
        once_write(E, m, d, &result);
    return at + 1;
}

/* Both steps read before either writes, as in execute_pair. */
static uint32_t once_run_pair(struct env *e, struct machine *m, uint32_t at)
{
    const struct decoded_step *d = e->routine->step + at;
    struct vector4 result[2];
    bool writes = once_compute(E, m, d, &result[0]);
    bool also = once_compute(E, m, d + 1, &result[1]);
    if (writes)
        once_write(E, m, d, &result[0]);
    if (also)
        once_write(E, m, d + 1, &result[1]);
    return at + 2;
}

static uint32_t once_run_other(struct env *e, struct machine *m, uint32_t at)
{
    return execute_step(E, m, at);
}

static inline uint32_t once_execute(struct env *e, struct machine *m, uint32_t at)
{
    return e->routine->step[at].run(E, m, at);
}

/* --- Decoding ------------------------------------------------------------------------------------------ */

static void once_add_read(const struct emulate_routine *routine, struct decoded_step *d, unsigned source,
                          int row, unsigned to)
{
    struct decoded_read *read = &d->read[d->reads++];
    read->operand = &d->instruction->source[source];
    read->places = (uint8_t)shader_source_components(d->instruction, source);
    read->row = (uint8_t)row;
    read->to = (uint8_t)to;
    once_locate(routine, read);
}

/* The reads of read_sources, but a matrix is read as rows only. */
static void once_decode_sources(const struct emulate_routine *routine, struct decoded_step *d)
{
    const struct shader_operation *operation = &shader_operations[d->instruction->opcode];
    for (unsigned i = 0; i < SHADER_SOURCES && operation->source[i]; i++) {
        bool matrix = operation->source[i] == OPERAND_MATRIX;
        if (!is_value(&d->instruction->source[i]))
            continue;
        if (!matrix)
            once_add_read(routine, d, i, 0, i);
        for (int row = 0; matrix && row < operation->rows; row++)
            once_add_read(routine, d, i, row, SHADER_SOURCES + (unsigned)row);
    }
}

static bool is_written_plainly(const struct program *program, const struct shader_instruction *i)
{
    const struct shader_operand *to = &i->destination;
    return to->file && shader_registers[to->file].access & IS_FLOAT && !to->relative && !to->shift &&
           !(to->modifier & RESULT_SATURATE) && !i->predicate.file && !shader_is_narrow(program->model);
}

static bool is_other(const struct shader_instruction *i)
{
    return shader_operations[i->opcode].flags & (IS_FLOW | IS_SETUP) || i->opcode == SHADER_SETP ||
           i->destination.file == FILE_ADDRESS;
}

static void once_decode(const struct emulate_routine *routine, uint32_t at)
{
    const struct program *program = routine->program;
    struct decoded_step *d = routine->step + at;
    d->instruction = &program->step[at].instruction;
    d->run = is_other(d->instruction) ? once_run_other : begins_pair(program, at) ? once_run_pair : once_run;
    d->compute = compute_functions[d->instruction->opcode];
    d->plain = is_written_plainly(program, d->instruction);
    if (d->plain)
        d->cell = (uint16_t)program_cell(&d->instruction->destination);
    if (d->run != once_run_other)
        once_decode_sources(routine, d);
}

static inline size_t once_prepare(struct emulate_routine *routine)
{
    const struct program *program = routine->program;
    routine->step = calloc(program->steps + 1, sizeof *routine->step);
    if (!routine->step)
        return SIZE_MAX;
    for (uint32_t at = 0; at < program->steps; at++)
        once_decode(routine, at);
    return program->steps * sizeof *routine->step;
}

#endif
