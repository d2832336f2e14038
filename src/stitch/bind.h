/* The operation stitcher's binding of the spec: a value is a slot of the routine's frame, an operation
 * appends the fragment of its name to the plan and gives the slot where its result will be.
 *
 * One pass without any analysis: slots are numbered upwards, nothing is remembered but which arguments are
 * slots. Only where that makes a large frame are they shared afterwards (plan_share_slots). The host's
 * decisions on the key run here, once a routine; only the operations they lead to remain. */
#ifndef STITCH_BIND_H
#define STITCH_BIND_H

#include "def/binding.h"
#include "stitch/plan.h"

#include <string.h>

typedef struct {
    int32_t slot; /* bytes from the bottom of the frame */
} flt;
typedef struct {
    int32_t slot;
} itg;
typedef struct {
    int32_t slot;
} fix;
typedef struct {
    int32_t slot;
} msk;

struct env {
    struct plan *plan;
    const struct program *program; /* of the shader, if the key has one */
    int32_t variable[VARIABLES];   /* the slot of each variable that is used, plus 1 */
    int variables;                 /* how many are used */
    int32_t frame_bytes;
    const char *file; /* where in the spec the operation being appended stands */
    int line;
};

static inline struct env *env_at(struct env *e, const char *file, int line)
{
    e->file = file;
    e->line = line;
    return e;
}

#define E env_at(e, __FILE__, __LINE__)

static inline unsigned append(struct env *e, const struct fragment *fragment, struct arguments arguments,
                              unsigned slots)
{
    unsigned number = plan_append(e->plan, fragment, arguments);
    struct part *part = &e->plan->part[number];
    part->slots = (uint8_t)slots;
    part->file = e->file;
    part->line = (uint16_t)e->line;
    return number;
}

/* Argument 0 becomes a new slot, which is the result; the next `operands` arguments are slots too. */
static inline int32_t append_value(struct env *e, const struct fragment *fragment, struct arguments arguments,
                                   unsigned operands)
{
    arguments.value[0] = e->frame_bytes;
    e->frame_bytes += SLOT_BYTES;
    append(e, fragment, arguments, SLOTS_RESULT | ((2u << operands) - 1));
    return arguments.value[0];
}

#define PARAMETER_flt(n) , flt n
#define PARAMETER_itg(n) , itg n
#define PARAMETER_fix(n) , fix n
#define PARAMETER_msk(n) , msk n
#define PARAMETER_non(n)
#define SLOT_flt(n) , n.slot
#define SLOT_itg(n) , n.slot
#define SLOT_fix(n) , n.slot
#define SLOT_msk(n) , n.slot
#define SLOT_non(n)
#define OPERANDS_flt 1
#define OPERANDS_itg 1
#define OPERANDS_fix 1
#define OPERANDS_msk 1
#define OPERANDS_non 0

#define OP(name, result, ta, tb, tc, properties, expression)                                                 \
    static inline result name(struct env *e PARAMETER_##ta(a) PARAMETER_##tb(b) PARAMETER_##tc(c))           \
    {                                                                                                        \
        struct arguments slots = {{0 SLOT_##ta(a) SLOT_##tb(b) SLOT_##tc(c)}};                               \
        return (result){                                                                                     \
            append_value(e, &fragment_##name, slots, OPERANDS_##ta + OPERANDS_##tb + OPERANDS_##tc)};        \
    }
#define OPK(name, result, ta, tb, tc, properties, expression)                                                \
    static inline result name(struct env *e PARAMETER_##ta(a), int k)                                        \
    {                                                                                                        \
        return (result){append_value(e, &fragment_##name, (struct arguments){{0 SLOT_##ta(a), k}}, 1)};      \
    }
#define CAST(name, result, from)                                                                             \
    static inline result name(struct env *e, from a)                                                         \
    {                                                                                                        \
        (void)e;                                                                                             \
        return (result){a.slot};                                                                             \
    }
#include "def/op.def"
#undef OP
#undef OPK
#undef CAST

static inline int32_t literal(struct env *e, uint32_t bits)
{
    return append_value(e, &fragment_literal, (struct arguments){{0, (int32_t)bits}}, 0);
}

static inline flt lit_f(struct env *e, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return (flt){literal(e, bits)};
}

static inline itg lit_i(struct env *e, int32_t value)
{
    return (itg){literal(e, (uint32_t)value)};
}

static inline msk lit_m(struct env *e, int32_t value)
{
    return (msk){literal(e, (uint32_t)value)};
}

static inline fix lit_x(struct env *e, uint16_t value)
{
    return (fix){literal(e, value * 0x10001u)};
}

static inline flt permute_f(struct env *e, flt a, int lanes)
{
    return (flt){append_value(e, &fragment_permute, (struct arguments){{0, a.slot, lanes}}, 1)};
}

/* The register of each base, counted from r8 (asm/fragment.inc). */
static inline int32_t base_number(enum base base)
{
    static const uint8_t number[BASE_COUNT] = {
        [BASE_JOB] = 0,      [BASE_INPUT] = 1, [BASE_OUTPUT] = 2, [BASE_VERTICES] = 3, [BASE_ENTRY] = 1,
        [BASE_TRIANGLE] = 2, [BASE_LANES] = 3, [BASE_COLOR] = 5,  [BASE_DEPTH] = 6};
    return number[base];
}

static inline int32_t read_base(struct env *e, const struct fragment *fragment, enum base base, int offset)
{
    return append_value(e, fragment, (struct arguments){{0, base_number(base), offset}}, 0);
}

static inline flt load_f(struct env *e, enum base base, int offset)
{
    return (flt){read_base(e, &fragment_load, base, offset)};
}

static inline itg load_i(struct env *e, enum base base, int offset)
{
    return (itg){read_base(e, &fragment_load, base, offset)};
}

/* A shader's constants have no register: the job points at them. */
static inline int constants_field(const struct env *e)
{
    return (int)(offsetof(struct job, constants) + e->program->model->stage * sizeof(float *));
}

static inline int32_t read_uniform(struct env *e, enum base base, int offset)
{
    if (base != BASE_CONSTANT)
        return read_base(e, &fragment_uniform, base, offset);
    struct arguments indirect = {{0, base_number(BASE_JOB), constants_field(e), offset}};
    return append_value(e, &fragment_uniform_indirect, indirect, 0);
}

static inline flt uniform_f(struct env *e, enum base base, int offset)
{
    return (flt){read_uniform(e, base, offset)};
}

static inline itg uniform_i(struct env *e, enum base base, int offset)
{
    return (itg){read_uniform(e, base, offset)};
}

static inline void store_i(struct env *e, enum base base, int offset, itg value)
{
    append(e, &fragment_store, (struct arguments){{value.slot, base_number(base), offset}}, SLOTS_STORED);
}

static inline void store_f(struct env *e, enum base base, int offset, flt value)
{
    store_i(e, base, offset, (itg){value.slot});
}

/* The scale 1, 2, 4 or 8 as it stands in a SIB byte. */
static inline int32_t scale_bits(int scale)
{
    return __builtin_ctz((unsigned)scale) << 6;
}

static inline itg gather_i(struct env *e, enum base base, int field, itg index, int scale, int displacement)
{
    if (base == BASE_CONSTANT) {
        base = BASE_JOB;
        field = constants_field(e);
    }
    int32_t from = base_number(base), times = scale_bits(scale);
    if (field == GATHER_DIRECT)
        return (itg){append_value(e, &fragment_gather,
                                  (struct arguments){{0, index.slot, from + times, displacement}}, 1)};
    struct arguments indirect = {{0, index.slot, from, field, times, displacement}};
    return (itg){append_value(e, &fragment_gather_indirect, indirect, 1)};
}

static inline flt gather_f(struct env *e, enum base base, int field, itg index, int scale, int displacement)
{
    return (flt){gather_i(e, base, field, index, scale, displacement).slot};
}

static inline void scatter_i(struct env *e, enum base base, int offset, int stride, itg value)
{
    append(e, &fragment_scatter, (struct arguments){{value.slot, base_number(base), offset, stride}},
           SLOTS_STORED);
}

static inline void scatter_f(struct env *e, enum base base, int offset, int stride, flt value)
{
    scatter_i(e, base, offset, stride, (itg){value.slot});
}

static inline int when_begin(struct env *e, msk mask)
{
    return (int)append(e, &fragment_when, (struct arguments){{mask.slot}}, SLOTS_STORED);
}

/* Ends the loop that WHEN is, so that its body is appended once. */
static inline int when_end(struct env *e, int part)
{
    plan_land(e->plan, (unsigned)part, 1);
    return -1;
}

/* --- Variables: slots that many parts write ---------------------------------------------------------------
 */

static inline int32_t variable_slot(struct env *e, int variable)
{
    if (!e->variable[variable]) {
        e->variable[variable] = e->frame_bytes + 1;
        e->frame_bytes += SLOT_BYTES;
        e->variables++;
    }
    return e->variable[variable] - 1;
}

static inline int32_t variable_get(struct env *e, int variable)
{
    return append_value(e, &fragment_copy, (struct arguments){{0, variable_slot(e, variable)}}, 0);
}

static inline void variable_set(struct env *e, int variable, int32_t slot)
{
    append(e, &fragment_copy, (struct arguments){{variable_slot(e, variable), slot}}, 0);
}

static inline flt get_f(struct env *e, int variable)
{
    return (flt){variable_get(e, variable)};
}

static inline itg get_i(struct env *e, int variable)
{
    return (itg){variable_get(e, variable)};
}

static inline msk get_m(struct env *e, int variable)
{
    return (msk){variable_get(e, variable)};
}

static inline void set_f(struct env *e, int variable, flt value)
{
    variable_set(e, variable, value.slot);
}

static inline void set_i(struct env *e, int variable, itg value)
{
    variable_set(e, variable, value.slot);
}

static inline void set_m(struct env *e, int variable, msk value)
{
    variable_set(e, variable, value.slot);
}

static inline int loop_end(struct env *e, int variable, int first)
{
    append(e, &fragment_again, (struct arguments){{variable_slot(e, variable), first}}, 0);
    return -1;
}

/* The body is appended once; behind it stands the jump back to its first part. */
#define LOOP(e, variable)                                                                                    \
    for (int loop_ = (int)(e)->plan->count; loop_ >= 0; loop_ = loop_end(e, variable, loop_))

#define WHEN(e, mask) for (int when_ = when_begin(e, mask); when_ >= 0; when_ = when_end(e, when_))

#endif
