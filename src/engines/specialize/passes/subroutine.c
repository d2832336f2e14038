#include "engines/specialize/passes/subroutine.h"

#include <stddef.h>
#include <string.h>

/* --- What is called ------------------------------------------------------------------------------------- */

static const struct ir_sampling *sampling_of(const struct subroutines *s, uint32_t site)
{
    return &s->recording.sampling[site];
}

static const struct ir_instruction *recorded(const struct subroutines *s, uint32_t number)
{
    return &s->recording.instruction[number];
}

/* Notes the sampling around each instruction. Samplings do not overlap. */
static void find_around(struct subroutines *s)
{
    memset(s->around, 0, s->recording.count * sizeof s->around[0]);
    for (uint32_t site = 0; site < s->recording.samplings; site++)
        for (uint32_t n = sampling_of(s, site)->first; n < sampling_of(s, site)->end; n++)
            s->around[n] = (uint16_t)(site + 1);
}

static void find_results(struct subroutines *s)
{
    memset(s->result, 0, s->recording.count);
    memset(s->elsewhere, 0, sizeof s->elsewhere);
    memset(s->set_in, 0, sizeof s->set_in);
    for (uint32_t n = 1; n < s->recording.count; n++) {
        const struct ir_instruction *i = recorded(s, n);
        for (unsigned o = 0; o < ir_operands(i); o++)
            s->result[i->operand[o]] |= s->around[i->operand[o]] != s->around[n];
        if (ir_properties(i) & IR_VARIABLE && !s->around[n])
            s->elsewhere[i->k] = 1;
    }
}

static unsigned find_input(const struct sampling_site *site, unsigned value)
{
    unsigned input = 0;
    while (input < site->inputs && site->input[input] != value)
        input++;
    return input;
}

/* Returns false if there are too many. */
static bool add_inputs(const struct subroutines *s, struct sampling_site *site, uint32_t n)
{
    const struct ir_instruction *i = recorded(s, n);
    for (unsigned o = 0; o < ir_operands(i); o++) {
        unsigned value = i->operand[o];
        if (s->around[value] == s->around[n] || recorded(s, value)->op == IR_literal ||
            find_input(site, value) < site->inputs)
            continue;
        if (site->inputs == SUBROUTINE_INPUTS)
            return false;
        site->input[site->inputs++] = (uint16_t)value;
    }
    return true;
}

/* Returns true if a variable is the sampling's own: nothing else uses it, and it is set before it is read. */
static bool owns_variable(struct subroutines *s, uint32_t n)
{
    const struct ir_instruction *i = recorded(s, n);
    if (!(ir_properties(i) & IR_VARIABLE))
        return true;
    if (i->op == IR_set)
        s->set_in[i->k] = s->around[n];
    return !s->elsewhere[i->k] && s->set_in[i->k] == s->around[n];
}

static bool can_be_called(struct subroutines *s, uint32_t number)
{
    struct sampling_site *site = &s->site[number];
    unsigned results = 0;
    site->inputs = 0;
    for (uint32_t n = sampling_of(s, number)->first; n < sampling_of(s, number)->end; n++) {
        results += s->result[n];
        if (!add_inputs(s, site, n) || !owns_variable(s, n))
            return false;
    }
    return results && results <= SUBROUTINE_OUTPUTS;
}

/* --- What is equal -------------------------------------------------------------------------------------- */

struct comparison {
    const struct subroutines *s;
    uint32_t a, b; /* samplings */
    int32_t job;   /* the distance from the reads of a to those of b */
    bool compared; /* a read of the job has been */
};

/* Both operands are the same instruction of their sampling, the same input, or equal literals. */
static bool same_operand(const struct comparison *c, unsigned x, unsigned y)
{
    const struct subroutines *s = c->s;
    const struct sampling_site *a = &s->site[c->a], *b = &s->site[c->b];
    bool inside = s->around[x] == c->a + 1;
    if (inside || s->around[y] == c->b + 1)
        return inside && s->around[y] == c->b + 1 &&
               x - sampling_of(s, c->a)->first == y - sampling_of(s, c->b)->first;
    const struct ir_instruction *i = recorded(s, x), *j = recorded(s, y);
    if (i->op == IR_literal || j->op == IR_literal)
        return i->op == j->op && i->k == j->k && i->type == j->type;
    return i->type == j->type && find_input(a, x) == find_input(b, y);
}

/* A read of the job may be anywhere, if all are as far apart. */
static bool same_memory(struct comparison *c, const struct ir_instruction *i, const struct ir_instruction *j)
{
    if (!(ir_properties(i) & (IR_READS | IR_WRITES)) || i->base != BASE_JOB)
        return i->k == j->k && i->field == j->field;
    bool pointer = i->op == IR_gather && i->field != GATHER_DIRECT && j->field != GATHER_DIRECT;
    int32_t apart = pointer ? j->field - i->field : j->k - i->k;
    if (pointer ? i->k != j->k : i->field != j->field)
        return false;
    if (!c->compared)
        c->job = apart;
    c->compared = true;
    return c->job == apart;
}

static bool same_instruction(struct comparison *c, const struct ir_instruction *i,
                             const struct ir_instruction *j)
{
    if (i->op != j->op || i->type != j->type || i->base != j->base || i->scale != j->scale)
        return false;
    for (unsigned o = 0; o < ir_operands(i); o++)
        if (!i->operand[o] != !j->operand[o] ||
            (i->operand[o] && !same_operand(c, i->operand[o], j->operand[o])))
            return false;
    return same_memory(c, i, j);
}

static bool same_sampling(struct comparison *c)
{
    const struct ir_sampling *a = sampling_of(c->s, c->a), *b = sampling_of(c->s, c->b);
    if (a->end - a->first != b->end - b->first || c->s->site[c->a].inputs != c->s->site[c->b].inputs)
        return false;
    for (uint32_t n = 0; n < a->end - a->first; n++)
        if (!same_instruction(c, recorded(c->s, a->first + n), recorded(c->s, b->first + n)))
            return false;
    return true;
}

/* The results of a subroutine are those that any of its callers uses. */
static void unite_results(struct subroutines *s, uint32_t callee, uint32_t caller)
{
    const struct ir_sampling *to = sampling_of(s, callee), *from = sampling_of(s, caller);
    for (uint32_t n = 0; n < to->end - to->first; n++)
        s->result[to->first + n] |= s->result[from->first + n];
}

/* Finds or adds the subroutine of a sampling. */
static void choose_subroutine(struct subroutines *s, uint32_t number, bool fixed)
{
    struct sampling_site *site = &s->site[number];
    for (uint32_t k = 0; k < s->count; k++) {
        struct comparison c = {.s = s, .a = s->of[k].sampling, .b = number};
        if (!same_sampling(&c) || (fixed && c.job))
            continue;
        unite_results(s, s->of[k].sampling, number);
        site->callee = (uint16_t)(k + 1);
        site->job = c.job;
        s->of[k].callers++;
        s->of[k].moved |= c.job != 0;
        return;
    }
    if (s->count == SUBROUTINES)
        return;
    site->job = 0;
    s->of[s->count] = (struct subroutine){number, 1, false};
    site->callee = (uint16_t)++s->count;
}

/* Keeps the subroutines with at least two callers. */
static void keep_shared(struct subroutines *s)
{
    uint16_t renumbered[SUBROUTINES + 1] = {0};
    uint32_t kept = 0;
    for (uint32_t k = 0; k < s->count; k++)
        if (s->of[k].callers > 1) {
            s->of[kept++] = s->of[k];
            renumbered[k + 1] = (uint16_t)kept;
        }
    s->count = kept;
    for (uint32_t site = 0; site < s->recording.samplings; site++)
        s->site[site].callee = renumbered[s->site[site].callee];
}

/* --- Programs ------------------------------------------------------------------------------------------- */

static uint16_t add(struct ir *ir, struct ir_instruction i)
{
    if (ir->count == IR_CAPACITY) {
        ir->overflow = true;
        return 0;
    }
    ir->loops += i.op == IR_loop;
    ir->instruction[ir->count] = i;
    return (uint16_t)ir->count++;
}

static uint16_t add_like(struct ir *ir, const struct ir_instruction *at, enum ir_op op, unsigned type,
                         unsigned operand, uint32_t k)
{
    struct ir_instruction i = {.op = (uint8_t)op, .type = (uint8_t)type, .operand = {(uint16_t)operand}};
    i.line = at->line;
    i.file = at->file;
    i.origin = at->origin;
    i.k = (int32_t)k;
    return add(ir, i);
}

/* Pairs of 16-bit integers are passed on as words. */
static void put(struct ir *ir, const struct ir_instruction *at, uint32_t k, unsigned type, unsigned value)
{
    if (type == TYPE_fix)
        value = add_like(ir, at, IR_copy, type = TYPE_itg, value, 0);
    add_like(ir, at, IR_put, type, value, k);
    if (ir->exchanged <= k)
        ir->exchanged = k + 1;
}

static uint16_t take(struct ir *ir, const struct ir_instruction *at, uint32_t k, unsigned type)
{
    uint16_t taken = add_like(ir, at, IR_take, type == TYPE_fix ? TYPE_itg : type, 0, k);
    if (ir->exchanged <= k)
        ir->exchanged = k + 1;
    return type == TYPE_fix ? add_like(ir, at, IR_copy, type, taken, 0) : taken;
}

static void add_mapped(struct subroutines *s, struct ir *ir, uint32_t n)
{
    struct ir_instruction copy = *recorded(s, n);
    for (int o = 0; o < 3; o++)
        copy.operand[o] = s->map[copy.operand[o]];
    s->map[n] = add(ir, copy);
}

static void add_call(struct subroutines *s, struct ir *ir, uint32_t number)
{
    const struct sampling_site *site = &s->site[number];
    const struct ir_sampling *own = sampling_of(s, number);
    const struct ir_sampling *callee = sampling_of(s, s->of[site->callee - 1].sampling);
    const struct ir_instruction *at = recorded(s, own->first);
    for (unsigned k = 0; k < site->inputs; k++)
        put(ir, at, k, recorded(s, site->input[k])->type, s->map[site->input[k]]);
    uint16_t call = add_like(ir, at, IR_call, TYPE_non, 0, site->callee - 1u);
    ir->instruction[call].field = call ? site->job : 0;
    for (uint32_t n = 0, k = 0; n < own->end - own->first; n++) {
        if (s->result[own->first + n])
            s->map[own->first + n] = take(ir, at, k, recorded(s, own->first + n)->type);
        k += s->result[callee->first + n];
    }
}

/* Makes `ir` an empty program with the properties of the recording. */
static void begin(struct ir *ir, const struct ir *recording)
{
    memcpy(ir, recording, offsetof(struct ir, instruction));
    ir->instruction[0] = recording->instruction[0];
    ir->count = 1;
    ir->loops = ir->exchanged = 0;
    ir->steps = ir->samplings = 0;
}

static void replace_samplings(struct subroutines *s, struct ir *ir)
{
    begin(ir, &s->recording);
    ir->steps = s->recording.steps;
    ir->subroutines = s->count;
    s->map[0] = 0;
    for (uint32_t n = 1; n < s->recording.count;) {
        uint32_t around = s->around[n];
        if (around && s->site[around - 1].callee) {
            add_call(s, ir, around - 1);
            n = sampling_of(s, around - 1)->end;
        } else
            add_mapped(s, ir, n++);
    }
}

uint32_t pass_find_subroutines(struct ir *ir, struct subroutines *s, enum calls calls, bool fixed)
{
    s->count = 0;
    if (calls == CALLS_INLINE || !ir->samplings)
        return 0;
    ir_duplicate(&s->recording, ir);
    find_around(s);
    find_results(s);
    for (uint32_t site = 0; site < ir->samplings; site++) {
        s->site[site].callee = 0;
        if (can_be_called(s, site))
            choose_subroutine(s, site, fixed);
    }
    if (calls == CALLS_SHARED)
        keep_shared(s);
    if (s->count)
        replace_samplings(s, ir);
    return s->count;
}

/* The literals that a sampling uses and that precede it become its own. */
static void add_literals(struct subroutines *s, const struct ir_sampling *sampling)
{
    for (int round = 0; round < 2; round++)
        for (uint32_t n = sampling->first; n < sampling->end; n++)
            for (unsigned o = 0; o < ir_operands(recorded(s, n)); o++) {
                unsigned value = recorded(s, n)->operand[o];
                if (s->around[value] == s->around[n] || recorded(s, value)->op != IR_literal)
                    continue;
                if (!round)
                    s->map[value] = 0;
                else if (!s->map[value])
                    s->map[value] = add(&s->body, *recorded(s, value));
            }
}

void pass_take_subroutine(struct subroutines *s, uint32_t number)
{
    const uint32_t from = s->of[number].sampling;
    const struct sampling_site *site = &s->site[from];
    const struct ir_sampling *sampling = sampling_of(s, from);
    const struct ir_instruction *first = recorded(s, sampling->first);
    uint32_t results = 0;
    begin(&s->body, &s->recording);
    s->body.subroutines = s->count;
    for (unsigned k = 0; k < site->inputs; k++)
        s->map[site->input[k]] = take(&s->body, first, k, recorded(s, site->input[k])->type);
    add_literals(s, sampling);
    for (uint32_t n = sampling->first; n < sampling->end; n++)
        add_mapped(s, &s->body, n);
    for (uint32_t n = sampling->first; n < sampling->end; n++)
        if (s->result[n])
            put(&s->body, recorded(s, n), results++, recorded(s, n)->type, s->map[n]);
}

/* Gives a slot of the constant table the number that it has in the program; or reads the word, if the table
 * is full. */
static void move_constant(struct ir *ir, const struct ir *body, struct ir_instruction *i)
{
    const struct ir_constant *constant = &body->constant[i->k];
    uint32_t slot = 0;
    while (slot < ir->constant_count &&
           (ir->constant[slot].base != constant->base || ir->constant[slot].offset != constant->offset))
        slot++;
    if (slot == IR_CONSTANTS) {
        i->op = IR_uniform;
        i->base = constant->base;
        i->k = constant->offset;
        return;
    }
    if (slot == ir->constant_count)
        ir->constant[ir->constant_count++] = *constant;
    i->base = 0;
    i->k = (int32_t)slot;
}

void pass_append_subroutine(struct ir *ir, const struct subroutines *s, uint32_t number,
                            uint16_t map[IR_CAPACITY])
{
    const struct ir *body = &s->body;
    add_like(ir, &ir->instruction[0], IR_subroutine, TYPE_non, 0, number);
    map[0] = 0;
    for (uint32_t n = 1; n < body->count; n++) {
        struct ir_instruction copy = body->instruction[n];
        if (copy.op == IR_nop)
            continue;
        for (int o = 0; o < 3; o++)
            copy.operand[o] = map[copy.operand[o]];
        if (copy.op == IR_constant)
            move_constant(ir, body, &copy);
        map[n] = add(ir, copy);
    }
    add_like(ir, &ir->instruction[0], IR_leave, TYPE_non, 0, 0);
    ir->phis += body->phis;
    ir->overflow |= body->overflow;
    ir->typed &= body->typed;
    if (ir->variables < body->variables)
        ir->variables = body->variables;
    if (ir->exchanged < body->exchanged)
        ir->exchanged = body->exchanged;
}
