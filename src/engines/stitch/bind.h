/* The operation stitcher's binding of the specification: a value is the number of the operation that
 * computes it, and each operation of the specification appends one. Registers and parts are chosen later,
 * when all operations are recorded (readers.c, locate.c).
 *
 * The host's decisions on the key are made here, once for a routine. Only the resulting operations remain.
 * Two cheap simplifications are made on the way: a literal or a word of the job that was appended before
 * is the same value, and a variable with a known value gives that value. */
#ifndef ENGINES_STITCH_BIND_H
#define ENGINES_STITCH_BIND_H

#include "base/bits.h"
#include "engines/stitch/plan.h"

#include <string.h>

typedef struct {
    uint32_t id;
} flt;
typedef struct {
    uint32_t id;
} itg;
typedef struct {
    uint32_t id;
} fix;
typedef struct {
    uint32_t id;
} msk;

enum { RECENT = 64 };

struct env {
    struct plan *plan;
    const struct program *program; /* of the shader, if the key has one */
    const char *file;              /* the line of the specification that is being read */
    int line;
    unsigned depth;                       /* of the open regions */
    uint32_t recent[RECENT];              /* by a hash of their bits or address */
    uint32_t region[NESTING_MAXIMUM + 1]; /* the operation that each open region begins with */
    uint32_t loop[NESTING_MAXIMUM + 1];   /* the innermost loop's begin at each depth, 0: none */
};

static inline void env_start(struct env *e, struct plan *plan, const struct program *program)
{
    e->plan = plan;
    e->program = program;
    e->depth = e->region[0] = e->loop[0] = 0;
    memset(e->recent, 0, sizeof e->recent);
    plan_enter(plan);
}

static inline struct env *env_at(struct env *e, const char *file, int line)
{
    e->file = file;
    e->line = line;
    return e;
}

#define E env_at(e, __FILE__, __LINE__)

/* Returns the operation's number, or 0 when there is no room. */
static inline uint32_t append(struct env *e, struct operation operation)
{
    struct plan *plan = e->plan;
    if (plan->operations == OPERATION_CAPACITY) {
        plan->unrecorded++;
        return 0;
    }
    operation.file = e->file;
    operation.line = (uint16_t)e->line;
    plan->operation[plan->operations] = operation;
    plan->value[plan->operations] = (struct value){.slot = SLOT_NONE, .vector = VECTOR_NONE};
    return plan->operations++;
}

/* A row of op.def, fused with the operations that compute its operands where a rule applies. */
static inline uint32_t append_row(struct env *e, struct operation operation)
{
    if (forms_that_fuse >> operation.form & 1)
        plan_fuse(e->plan, &operation);
    return operation.form == FORM_same ? operation.operand[0] : append(e, operation);
}

static inline uint32_t append_immediate(struct env *e, const struct fragment *fragment, uint32_t a, int k)
{
    return append(
        e, (struct operation){
               .kind = OPERATION_COMPUTE, .fragment = fragment, .operand = {a}, .operands = 1, .k = {k}});
}

enum { COMMUTES = 1 };

#define PARAMETER_flt(n) , flt n
#define PARAMETER_itg(n) , itg n
#define PARAMETER_fix(n) , fix n
#define PARAMETER_msk(n) , msk n
#define PARAMETER_non(n)
#define ID_flt(n)    n.id
#define ID_itg(n)    n.id
#define ID_fix(n)    n.id
#define ID_msk(n)    n.id
#define ID_non(n)    0
#define OPERANDS_flt 1
#define OPERANDS_itg 1
#define OPERANDS_fix 1
#define OPERANDS_msk 1
#define OPERANDS_non 0

#define OP(name, result, ta, tb, tc, properties, expression)                                                 \
    static inline result name(struct env *e PARAMETER_##ta(a) PARAMETER_##tb(b) PARAMETER_##tc(c))           \
    {                                                                                                        \
        return (result){                                                                                     \
            append_row(e, (struct operation){.kind = OPERATION_COMPUTE,                                      \
                                             .fragment = &fragment_##name,                                   \
                                             .form = FORM_##name,                                            \
                                             .operand = {ID_##ta(a), ID_##tb(b), ID_##tc(c)},                \
                                             .operands = OPERANDS_##ta + OPERANDS_##tb + OPERANDS_##tc,      \
                                             .commutes = (properties)})};                                    \
    }
#define OPK(name, result, ta, tb, tc, properties, expression)                                                \
    static inline result name(struct env *e PARAMETER_##ta(a), int k)                                        \
    {                                                                                                        \
        return (result){append_immediate(e, &fragment_##name, a.id, k)};                                     \
    }
#define CAST(name, result, from)                                                                             \
    static inline result name(struct env *e, from a)                                                         \
    {                                                                                                        \
        (void)e;                                                                                             \
        return (result){a.id};                                                                               \
    }
#include "def/op.def"
#undef OP
#undef OPK
#undef CAST

/* Appends the operation, unless the same one was appended recently. Only for operations that are valid at
 * any point of the routine. */
static inline uint32_t append_once(struct env *e, struct operation operation)
{
    uint32_t hash = ((uint32_t)operation.k[0] * 0x9e3779b1u ^ (uint32_t)operation.k[1] << 26) >> 26;
    uint32_t *recent = &e->recent[hash % RECENT];
    const struct operation *same = &e->plan->operation[*recent];
    if (*recent && same->k[0] == operation.k[0] && same->kind == operation.kind &&
        same->fragment == operation.fragment &&
        (same->kind == OPERATION_LITERAL || same->k[1] == operation.k[1]))
        return *recent;
    return *recent = append(e, operation);
}

static inline uint32_t literal(struct env *e, uint32_t bits)
{
    uint8_t form = !bits ? FORM_zero : !~bits ? FORM_ones : FORM_literal;
    return append_once(e, (struct operation){.kind = OPERATION_LITERAL, .form = form, .k = {(int32_t)bits}});
}

static inline flt lit_f(struct env *e, float value)
{
    uint32_t bits = bits_of_float(value);
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
    return (flt){append_immediate(e, &fragment_permute, a.id, lanes)};
}

/* The register of each base, counted from r8 (asm/stitch/fragment.inc). */
static inline int32_t base_number(enum base base)
{
    static const uint8_t number[BASE_COUNT] = {
        [BASE_JOB] = 0,      [BASE_INPUT] = 1, [BASE_OUTPUT] = 2, [BASE_VERTICES] = 3, [BASE_ENTRY] = 1,
        [BASE_TRIANGLE] = 2, [BASE_LANES] = 3, [BASE_COLOR] = 5,  [BASE_DEPTH] = 6,    [BASE_CONSTANT] = 4};
    return number[base];
}

static inline struct operation read_operation(const struct fragment *fragment, enum base base, int offset)
{
    return (struct operation){.kind = OPERATION_READ, .fragment = fragment, .k = {offset, base_number(base)}};
}

static inline flt load_f(struct env *e, enum base base, int offset)
{
    return (flt){append(e, read_operation(&fragment_load, base, offset))};
}

static inline itg load_i(struct env *e, enum base base, int offset)
{
    return (itg){append(e, read_operation(&fragment_load, base, offset))};
}

/* Routines do not store to the bases that they read single words from. */
static inline flt uniform_f(struct env *e, enum base base, int offset)
{
    return (flt){append_once(e, read_operation(&fragment_uniform, base, offset))};
}

static inline flt uniform_unit_f(struct env *e, enum base base, int offset)
{
    return uniform_f(e, base, offset);
}

static inline itg uniform_i(struct env *e, enum base base, int offset)
{
    return (itg){append_once(e, read_operation(&fragment_uniform, base, offset))};
}

static inline void store_i(struct env *e, enum base base, int offset, itg value)
{
    append(e, (struct operation){.kind = OPERATION_STORE,
                                 .fragment = &fragment_store,
                                 .operand = {value.id},
                                 .operands = 1,
                                 .k = {offset, base_number(base)}});
    e->plan->stored |= 1u << base_number(base);
}

static inline void store_f(struct env *e, enum base base, int offset, flt value)
{
    store_i(e, base, offset, (itg){value.id});
}

/* The scale 1, 2, 4 or 8 in the encoding of a SIB byte. */
static inline int32_t scale_bits(int scale)
{
    return __builtin_ctz((unsigned)scale) << 6;
}

static inline itg gather_i(struct env *e, enum base base, int field, itg index, int scale, int displacement)
{
    int32_t from = base_number(base), times = scale_bits(scale);
    struct operation gather = {.kind = OPERATION_COMPUTE, .operand = {index.id}, .operands = 1};
    if (field == GATHER_DIRECT) {
        gather.fragment = &fragment_gather;
        memcpy(gather.k, (int32_t[]){from + times, displacement, 0, 0}, sizeof gather.k);
    } else {
        gather.fragment = &fragment_gather_indirect;
        memcpy(gather.k, (int32_t[]){from, field, times, displacement}, sizeof gather.k);
    }
    return (itg){append(e, gather)};
}

static inline flt gather_f(struct env *e, enum base base, int field, itg index, int scale, int displacement)
{
    return (flt){gather_i(e, base, field, index, scale, displacement).id};
}

static inline void scatter_i(struct env *e, enum base base, int offset, int stride, itg value)
{
    append(e, (struct operation){.kind = OPERATION_SCATTER,
                                 .fragment = &fragment_scatter,
                                 .operand = {value.id},
                                 .operands = 1,
                                 .k = {base_number(base), offset, stride}});
    e->plan->stored |= 1u << base_number(base);
}

static inline void scatter_f(struct env *e, enum base base, int offset, int stride, flt value)
{
    scatter_i(e, base, offset, stride, (itg){value.id});
}

/* --- Control ------------------------------------------------------------------------------------------- */

/* Opens the region that the operation begins. The plan is unusable if regions nest deeper than
 * NESTING_MAXIMUM. */
static inline int region_begin(struct env *e, struct operation begin)
{
    uint32_t number = append(e, begin), loop = e->loop[e->depth];
    if (e->depth == NESTING_MAXIMUM) {
        e->plan->depth++;
        return (int)number;
    }
    e->depth++;
    e->region[e->depth] = number;
    e->loop[e->depth] = begin.kind == OPERATION_LOOP ? number : loop;
    if (e->plan->depth < e->depth)
        e->plan->depth = e->depth;
    return (int)number;
}

static inline int region_end(struct env *e, struct operation end)
{
    uint32_t number = append(e, end);
    e->plan->operation[end.k[0]].k[0] = (int32_t)number;
    if (e->plan->depth <= NESTING_MAXIMUM)
        e->depth--;
    return -1;
}

static inline int when_begin(struct env *e, msk mask)
{
    return region_begin(
        e, (struct operation){
               .kind = OPERATION_WHEN, .fragment = &fragment_when, .operand = {mask.id}, .operands = 1});
}

/* Ends the C loop of WHEN after one iteration, so that its body is appended once. */
static inline int when_end(struct env *e, int begin)
{
    return region_end(e, (struct operation){.kind = OPERATION_END, .k = {begin}});
}

static inline int loop_begin(struct env *e)
{
    return region_begin(e, (struct operation){.kind = OPERATION_LOOP});
}

static inline int loop_again(struct env *e, msk mask, int begin)
{
    for (unsigned v = 0; v < e->plan->variables; v++) {
        struct variable_state *variable = &e->plan->variable[v];
        if (variable->first && variable->first < (uint32_t)begin && variable->last > (uint32_t)begin)
            variable->last = e->plan->operations;
    }
    return region_end(e, (struct operation){.kind = OPERATION_AGAIN,
                                            .fragment = &fragment_again,
                                            .operand = {mask.id},
                                            .operands = 1,
                                            .k = {begin}});
}

/* --- Variables ------------------------------------------------------------------------------------------
 *
 * The value that was last set or read is known to be the variable's value until control flow joins: while the
 * region of that operation is open, and no loop has begun since. */

static inline struct variable_state *variable_at(struct env *e, int number)
{
    struct plan *plan = e->plan;
    for (; plan->variables <= (unsigned)number; plan->variables++)
        plan->variable[plan->variables] = (struct variable_state){.slot = SLOT_NONE, .vector = VECTOR_NONE};
    return &plan->variable[number];
}

static inline void variable_known(struct env *e, struct variable_state *variable, uint32_t value)
{
    variable->value = value;
    variable->depth = e->depth;
    variable->region = e->region[e->depth];
    variable->known_at = e->plan->operations;
}

static inline bool variable_is_known(const struct env *e, const struct variable_state *variable)
{
    return variable->value && variable->depth <= e->depth && e->region[variable->depth] == variable->region &&
           variable->known_at > e->loop[e->depth];
}

static inline void variable_used(struct env *e, struct variable_state *variable)
{
    if (!variable->first)
        variable->first = e->plan->operations;
    variable->last = e->plan->operations;
}

static inline uint32_t variable_get(struct env *e, int number)
{
    struct variable_state *variable = variable_at(e, number);
    if (!variable_is_known(e, variable)) {
        variable_used(e, variable);
        variable_known(e, variable, append(e, (struct operation){.kind = OPERATION_GET, .k = {number}}));
    }
    return variable->value;
}

static inline void variable_set(struct env *e, int number, uint32_t value)
{
    struct variable_state *variable = variable_at(e, number);
    if (variable_is_known(e, variable) && variable->value == value)
        return;
    variable_used(e, variable);
    append(e, (struct operation){.kind = OPERATION_SET, .operand = {value}, .operands = 1, .k = {number}});
    variable_known(e, variable, value);
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
    variable_set(e, variable, value.id);
}

static inline void set_i(struct env *e, int variable, itg value)
{
    variable_set(e, variable, value.id);
}

static inline void set_m(struct env *e, int variable, msk value)
{
    variable_set(e, variable, value.id);
}

static inline int loop_end(struct env *e, int variable, int begin)
{
    return loop_again(e, get_m(e, variable), begin);
}

/* The body is appended once. The jump back to its first part follows it. */
#define LOOP(e, variable) for (int loop_ = loop_begin(e); loop_ >= 0; loop_ = loop_end(e, variable, loop_))

#define WHEN(e, mask) for (int when_ = when_begin(e, mask); when_ >= 0; when_ = when_end(e, when_))

#endif
