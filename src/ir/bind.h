/* The recorder's binding: a value is the number of an IR instruction, and an operation appends an
 * instruction.
 *
 * Control flow of the host depends on the key only and is executed while recording, so a recording is the
 * pipeline for one key. E notes the file and line of the specification that append each instruction. */
#ifndef IR_BIND_H
#define IR_BIND_H

#include "base/bits.h"
#include "ir/ir.h"

#include <assert.h>
#include <string.h>

typedef struct {
    uint16_t id;
} flt;
typedef struct {
    uint16_t id;
} itg;
typedef struct {
    uint16_t id;
} fix;
typedef struct {
    uint16_t id;
} msk;

enum { KNOWN_FILES = 2 * IR_FILES };

struct env {
    struct ir *ir;
    const struct program *program; /* of the shader, if the key has one */
    const char *path;              /* of the current file of the specification */
    uint8_t file;
    uint16_t line;
    /* A hash table from the address of a path to the number of the file. */
    const char *known_path[KNOWN_FILES];
    uint8_t known_number[KNOWN_FILES];
};

/* The part of a path from "spec/" on. */
static inline const char *spec_path(const char *path)
{
    const char *spec = strstr(path, "spec/");
    return spec ? spec : path;
}

/* The number of a path that is not in the hash table. A path may have several addresses. */
static inline uint8_t number_file(struct ir *ir, const char *path)
{
    uint32_t file = 0;
    path = spec_path(path);
    while (file < ir->file_count && strcmp(ir->file[file], path))
        file++;
    if (file == IR_FILES)
        return IR_FILES - 1;
    if (file == ir->file_count)
        ir->file[ir->file_count++] = path;
    return (uint8_t)file;
}

static_assert(KNOWN_FILES == 1 << 7, "the hash has 7 bits");

/* Called often, since functions of the specification call functions of other files. */
static inline void record_file(struct env *e, const char *path)
{
    uint32_t at = (uint32_t)(uintptr_t)path * 0x9e3779b1u >> 25;
    while (e->known_path[at] && e->known_path[at] != path)
        at = (at + 1) % KNOWN_FILES;
    if (!e->known_path[at]) {
        e->known_number[at] = number_file(e->ir, path);
        e->known_path[at] = e->ir->file_count < IR_FILES ? path : NULL;
    }
    e->path = path;
    e->file = e->known_number[at];
}

static inline struct env *record_at(struct env *e, const char *path, int line)
{
    e->line = (uint16_t)line;
    if (path != e->path)
        record_file(e, path);
    return e;
}

#ifndef E
#define E record_at(e, __FILE__, __LINE__)
#endif

#define NOTE_STEP(e, step)       ir_note_step((e)->ir, step)
#define NOTE_SAMPLING(e, begins) ir_note_sampling((e)->ir, begins)

static inline uint16_t record(struct env *e, enum ir_op op, enum ir_type type, uint16_t a, uint16_t b,
                              uint16_t c, int32_t k)
{
    return ir_append(e->ir, (struct ir_instruction){.op = (uint8_t)op,
                                                    .type = (uint8_t)type,
                                                    .operand = {a, b, c},
                                                    .line = e->line,
                                                    .file = e->file,
                                                    .k = k});
}

static inline uint16_t record_memory(struct env *e, enum ir_op op, enum ir_type type, uint16_t a,
                                     enum base base, int32_t k, int32_t field, int scale)
{
    return ir_append(e->ir, (struct ir_instruction){.op = (uint8_t)op,
                                                    .type = (uint8_t)type,
                                                    .base = (uint8_t)base,
                                                    .scale = (uint8_t)scale,
                                                    .operand = {a},
                                                    .line = e->line,
                                                    .file = e->file,
                                                    .k = k,
                                                    .field = field});
}

#define ARGUMENT_flt(n) , flt n
#define ARGUMENT_itg(n) , itg n
#define ARGUMENT_msk(n) , msk n
#define ARGUMENT_fix(n) , fix n
#define ARGUMENT_non(n)
#define ID_flt(n) n.id
#define ID_itg(n) n.id
#define ID_msk(n) n.id
#define ID_fix(n) n.id
#define ID_non(n) 0

#define OP(name, result, ta, tb, tc, properties, expression)                                                 \
    static inline result name(struct env *e ARGUMENT_##ta(a) ARGUMENT_##tb(b) ARGUMENT_##tc(c))              \
    {                                                                                                        \
        return (result){record(e, IR_##name, TYPE_##result, ID_##ta(a), ID_##tb(b), ID_##tc(c), 0)};         \
    }
#define OPK(name, result, ta, tb, tc, properties, expression)                                                \
    static inline result name(struct env *e ARGUMENT_##ta(a), int k)                                         \
    {                                                                                                        \
        return (result){record(e, IR_##name, TYPE_##result, ID_##ta(a), 0, 0, k)};                           \
    }
#define CAST(name, result, from)                                                                             \
    static inline result name(struct env *e, from a)                                                         \
    {                                                                                                        \
        return (result){record(e, IR_copy, TYPE_##result, a.id, 0, 0, 0)};                                   \
    }
#include "def/op.def"
#undef OP
#undef OPK
#undef CAST

static inline flt lit_f(struct env *e, float value)
{
    return (flt){record(e, IR_literal, TYPE_flt, 0, 0, 0, (int32_t)bits_of_float(value))};
}

static inline itg lit_i(struct env *e, int32_t value)
{
    return (itg){record(e, IR_literal, TYPE_itg, 0, 0, 0, value)};
}

static inline fix lit_x(struct env *e, uint16_t value)
{
    return (fix){record(e, IR_literal, TYPE_fix, 0, 0, 0, (int32_t)(value * 0x10001u))};
}

static inline msk lit_m(struct env *e, int32_t value)
{
    return (msk){record(e, IR_literal, TYPE_msk, 0, 0, 0, value)};
}

static inline flt permute_f(struct env *e, flt a, int lanes)
{
    return (flt){record(e, IR_permute, TYPE_flt, a.id, 0, 0, lanes)};
}

static inline flt load_f(struct env *e, enum base base, int offset)
{
    return (flt){record_memory(e, IR_load, TYPE_flt, 0, base, offset, 0, 0)};
}

static inline itg load_i(struct env *e, enum base base, int offset)
{
    return (itg){record_memory(e, IR_load, TYPE_itg, 0, base, offset, 0, 0)};
}

static inline flt uniform_f(struct env *e, enum base base, int offset)
{
    return (flt){record_memory(e, IR_uniform, TYPE_flt, 0, base, offset, 0, 0)};
}

static inline flt uniform_unit_f(struct env *e, enum base base, int offset)
{
    return (flt){record_memory(e, IR_uniform, TYPE_flt, 0, base, offset, 0, IR_UNIT)};
}

static inline itg uniform_i(struct env *e, enum base base, int offset)
{
    return (itg){record_memory(e, IR_uniform, TYPE_itg, 0, base, offset, 0, 0)};
}

static inline flt gather_f(struct env *e, enum base base, int field, itg index, int scale, int displacement)
{
    return (flt){record_memory(e, IR_gather, TYPE_flt, index.id, base, displacement, field, scale)};
}

static inline itg gather_i(struct env *e, enum base base, int field, itg index, int scale, int displacement)
{
    return (itg){record_memory(e, IR_gather, TYPE_itg, index.id, base, displacement, field, scale)};
}

static inline void store_f(struct env *e, enum base base, int offset, flt value)
{
    record_memory(e, IR_store, TYPE_non, value.id, base, offset, 0, 0);
}

static inline void store_i(struct env *e, enum base base, int offset, itg value)
{
    record_memory(e, IR_store, TYPE_non, value.id, base, offset, 0, 0);
}

static inline void scatter_f(struct env *e, enum base base, int offset, int stride, flt value)
{
    record_memory(e, IR_scatter, TYPE_non, value.id, base, offset, stride, 0);
}

static inline void scatter_i(struct env *e, enum base base, int offset, int stride, itg value)
{
    record_memory(e, IR_scatter, TYPE_non, value.id, base, offset, stride, 0);
}

static inline uint16_t record_get(struct env *e, enum ir_type type, int variable)
{
    return record(e, IR_get, type, 0, 0, 0, variable);
}

static inline void record_set(struct env *e, enum ir_type type, int variable, uint16_t value)
{
    record(e, IR_set, type, value, 0, 0, variable);
}

static inline flt get_f(struct env *e, int variable)
{
    return (flt){record_get(e, TYPE_flt, variable)};
}

static inline itg get_i(struct env *e, int variable)
{
    return (itg){record_get(e, TYPE_itg, variable)};
}

static inline msk get_m(struct env *e, int variable)
{
    return (msk){record_get(e, TYPE_msk, variable)};
}

static inline void set_f(struct env *e, int variable, flt value)
{
    record_set(e, TYPE_flt, variable, value.id);
}

static inline void set_i(struct env *e, int variable, itg value)
{
    record_set(e, TYPE_itg, variable, value.id);
}

static inline void set_m(struct env *e, int variable, msk value)
{
    record_set(e, TYPE_msk, variable, value.id);
}

/* Ends the for statement of LOOP after one iteration, which records the body. */
static inline int record_again(struct env *e, int variable)
{
    msk mask = get_m(e, variable);
    record(e, IR_again, TYPE_non, mask.id, 0, 0, 0);
    return 0;
}

#define LOOP(e, variable)                                                                                    \
    for (int once_ = (record(e, IR_loop, TYPE_non, 0, 0, 0, 0), 1); once_; once_ = record_again(e, variable))

/* The for statement has one iteration, which records the body. */
#define WHEN(e, mask)                                                                                        \
    for (int once_ = (record(e, IR_when, TYPE_non, (mask).id, 0, 0, 0), 1); once_;                           \
         once_ = (record(e, IR_end, TYPE_non, 0, 0, 0, 0), 0))

#endif
