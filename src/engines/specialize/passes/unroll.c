/* Unrolling: an innermost loop whose number of iterations is a constant is replaced by its iterations.
 *
 * The pass runs before variables become values (phi.c), as if the specification's loop had been executed
 * while recording. It walks over the program with what is known of each variable: a literal, or that it is
 * the value of a certain instruction. From that state, an innermost loop is executed symbolically, until its
 * condition is known to be zero, and is left alone if the condition is ever unknown. A condition that is the
 * mask of a region around the loop repeats it, since a lane of that mask is set in the region. The loop must
 * be repeated exactly as often as it would be, because its condition need not decide what its lanes store.
 *
 * After an inner loop is unrolled, the loop around it is innermost in the next run. The limits below bound
 * the growth of a program. Precondition: variables; a program with phis is not changed. Run it under the
 * contract's MXCSR. */
#include "engines/specialize/passes/pass.h"

#include <string.h>

enum {
    UNROLL_LOOP = 2048,     /* the most instructions that one loop becomes */
    UNROLL_PROGRAM = 16384, /* a program that would be longer is not unrolled further */
    UNROLL_DEPTH = 256      /* regions deeper than this are not looked at */
};

/* The knowledge of a value. */
struct known {
    uint8_t kind; /* enum knowledge */
    uint32_t is;  /* the bits, or the number of the instruction */
};

enum knowledge { KNOWN_NOTHING, KNOWN_LITERAL, KNOWN_VALUE };

/* The knowledge of a variable. It is valid only in the region where it was set, and in regions inside. */
struct holding {
    struct known known;
    uint32_t serial; /* of the region; 0: the variable was not set */
    uint16_t depth;  /* of the region */
    uint16_t set;    /* the instruction that set it */
};

struct open_region {
    uint32_t serial;
    struct known mask; /* of a `when` */
};

struct unroll_memory {
    struct known value[IR_CAPACITY];  /* of each instruction, in the current iteration */
    uint16_t iterations[IR_CAPACITY]; /* of each `loop` that is unrolled; 0: it is not */
    struct holding held[VARIABLES];   /* before the loop that is executed */
    struct holding trial[VARIABLES];  /* set in it; valid if `tried` is the number of the execution */
    uint32_t tried[VARIABLES];
    uint16_t last_set[VARIABLES];   /* the last instruction of the program that sets the variable */
    uint16_t open_loop[PASS_LOOPS]; /* the loops around the position, the outermost first */
    struct open_region region[UNROLL_DEPTH];
};

static_assert(sizeof(struct unroll_memory) <= PASS_SCRATCH, "scratch memory is large enough");

struct unrolling {
    const struct ir *ir;
    struct unroll_memory *memory;
    uint32_t serial; /* of the latest region */
    unsigned depth, loops;
    uint32_t head;      /* of the loop that is executed, 0: none */
    uint32_t execution; /* its number */
    uint32_t growth;
    unsigned unrolled;
};

/* --- What is known ------------------------------------------------------------------------------------- */

static const struct known nothing = {KNOWN_NOTHING, 0};

static struct known literal(uint32_t bits)
{
    return (struct known){KNOWN_LITERAL, bits};
}

/* An unknown value, by the number of its instruction. In a loop that is executed that number names another
 * value in each iteration, so nothing is known. */
static struct known itself(const struct unrolling *u, uint32_t number)
{
    return u->head && number > u->head ? nothing : (struct known){KNOWN_VALUE, number};
}

static bool is_literal(struct known known, uint32_t bits)
{
    return known.kind == KNOWN_LITERAL && known.is == bits;
}

/* Returns true if a loop that is not executed symbolically may have changed the variable since it was set. */
static bool is_changed_by_loop(const struct unrolling *u, const struct holding *holding, unsigned variable)
{
    const struct unroll_memory *m = u->memory;
    for (unsigned loop = u->loops; loop && m->open_loop[loop - 1] > holding->set; loop--)
        if (m->last_set[variable] > m->open_loop[loop - 1])
            return true;
    return false;
}

static struct known read_variable(const struct unrolling *u, uint32_t number, unsigned variable)
{
    const struct unroll_memory *m = u->memory;
    bool tried = u->head && m->tried[variable] == u->execution;
    const struct holding *holding = tried ? &m->trial[variable] : &m->held[variable];
    bool valid =
        holding->serial && holding->depth <= u->depth && m->region[holding->depth].serial == holding->serial;
    if (!valid || (!tried && is_changed_by_loop(u, holding, variable)))
        return itself(u, number);
    return holding->known;
}

static void set_variable(struct unrolling *u, uint32_t number, unsigned variable, struct known known)
{
    struct unroll_memory *m = u->memory;
    struct holding *holding = u->head ? &m->trial[variable] : &m->held[variable];
    *holding = (struct holding){known, m->region[u->depth].serial, (uint16_t)u->depth, (uint16_t)number};
    if (u->head)
        m->tried[variable] = u->execution;
}

/* `and` with all lanes set is the other operand. */
static struct known compute(const struct unrolling *u, const struct ir_instruction *i, uint32_t number)
{
    struct known a[3] = {nothing, nothing, nothing};
    bool all = true;
    for (unsigned o = 0; o < ir_operands(i); o++) {
        a[o] = u->memory->value[i->operand[o]];
        all = all && a[o].kind == KNOWN_LITERAL;
    }
    if (all)
        return literal(ir_evaluate(i->op, a[0].is, a[1].is, a[2].is, i->k));
    for (unsigned o = 0; i->op == IR_and_m && o < 2; o++) {
        if (is_literal(a[o], 0))
            return literal(0);
        if (is_literal(a[o], UINT32_MAX))
            return a[1 - o].kind ? a[1 - o] : itself(u, i->operand[1 - o]);
    }
    return itself(u, number);
}

static struct known know(struct unrolling *u, uint32_t number)
{
    const struct ir_instruction *i = &u->ir->instruction[number];
    switch (i->op) {
    case IR_literal: return literal((uint32_t)i->k);
    case IR_copy: return u->memory->value[i->operand[0]];
    case IR_get: return read_variable(u, number, (unsigned)i->k);
    case IR_set: set_variable(u, number, (unsigned)i->k, u->memory->value[i->operand[0]]); return nothing;
    }
    return ir_properties(i) & IR_COMPUTES ? compute(u, i, number) : itself(u, number);
}

/* --- Regions ------------------------------------------------------------------------------------------- */

/* Returns false if there are too many. */
static bool open_region(struct unrolling *u, struct known mask)
{
    if (u->depth + 1 == UNROLL_DEPTH)
        return false;
    u->memory->region[++u->depth] = (struct open_region){++u->serial, mask};
    return true;
}

/* Returns true if the mask certainly has a lane that is set: all, or those of a region around. */
static bool is_set(const struct unrolling *u, struct known mask)
{
    if (is_literal(mask, UINT32_MAX))
        return true;
    for (unsigned d = u->depth; d && mask.kind == KNOWN_VALUE; d--)
        if (u->memory->region[d].mask.kind == KNOWN_VALUE && u->memory->region[d].mask.is == mask.is)
            return true;
    return false;
}

/* --- Execution of a loop ------------------------------------------------------------------------------- */

/* Executes the body once. Returns false if it has a loop, or too many regions. */
static bool execute(struct unrolling *u, uint32_t end)
{
    for (uint32_t number = u->head + 1; number < end; number++) {
        const struct ir_instruction *i = &u->ir->instruction[number];
        if (i->op == IR_loop || (i->op == IR_when && !open_region(u, u->memory->value[i->operand[0]])))
            return false;
        u->depth -= i->op == IR_end;
        u->memory->value[number] = know(u, number);
    }
    return true;
}

/* The number of iterations of the loop from u->head to `end`, or 0 if it is not known or too large. */
static unsigned count_iterations(struct unrolling *u, uint32_t end)
{
    uint32_t body = end - u->head - 1, most = UNROLL_LOOP / (body ? body : 1);
    unsigned depth = u->depth;
    u->execution++;
    for (unsigned iterations = 1; iterations <= most && execute(u, end); iterations++) {
        struct known again = u->memory->value[u->ir->instruction[end].operand[0]];
        if (is_literal(again, 0))
            return iterations;
        if (!is_set(u, again))
            break;
    }
    u->depth = depth;
    return 0;
}

/* The end of an innermost loop, or 0 if it has a loop inside. */
static uint32_t innermost_end(const struct ir *ir, uint32_t head)
{
    for (uint32_t number = head + 1;; number++)
        if (ir->instruction[number].op == IR_again)
            return number;
        else if (ir->instruction[number].op == IR_loop)
            return 0;
}

static void try_loop(struct unrolling *u, uint32_t head)
{
    uint32_t end = innermost_end(u->ir, head);
    if (!end)
        return;
    u->head = head;
    unsigned iterations = count_iterations(u, end);
    u->head = 0;
    uint32_t growth = u->growth + (iterations ? iterations - 1 : 0) * (end - head - 1);
    if (!iterations || u->ir->count + growth > UNROLL_PROGRAM)
        return;
    u->growth = growth;
    u->memory->iterations[head] = (uint16_t)iterations;
    u->unrolled++;
}

/* --- The program --------------------------------------------------------------------------------------- */

static void find_last_sets(const struct ir *ir, struct unroll_memory *m)
{
    for (uint32_t number = 1; number < ir->count; number++)
        if (ir->instruction[number].op == IR_set)
            m->last_set[ir->instruction[number].k] = (uint16_t)number;
}

/* Finds the loops to unroll. */
static void find_loops(struct unrolling *u)
{
    struct unroll_memory *m = u->memory;
    open_region(u, nothing);
    for (uint32_t number = 1; number < u->ir->count; number++) {
        const struct ir_instruction *i = &u->ir->instruction[number];
        switch (i->op) {
        case IR_loop:
            try_loop(u, number);
            m->open_loop[u->loops++] = (uint16_t)number;
            break;
        case IR_again: u->loops--; break;
        case IR_when:
            if (!open_region(u, m->value[i->operand[0]]))
                return;
            break;
        case IR_end: u->depth--; break;
        }
        m->value[number] = know(u, number);
    }
}

/* Appends the iterations. The values of the last one are those that instructions after the loop read. */
static uint32_t append_iterations(const struct ir *ir, struct pass_memory *memory, uint32_t head,
                                  unsigned iterations, uint32_t *count)
{
    uint32_t end = innermost_end(ir, head);
    while (iterations--)
        for (uint32_t number = head + 1; number < end; number++)
            if (ir->instruction[number].op != IR_nop)
                pass_append(ir, memory, number, count);
    return end;
}

static void rebuild(struct ir *ir, struct pass_memory *memory, const struct unroll_memory *m)
{
    uint32_t count = pass_rebuild(ir, memory);
    for (uint32_t number = 1; number < ir->count; number++) {
        unsigned op = ir->instruction[number].op;
        if (op == IR_loop && m->iterations[number])
            number = append_iterations(ir, memory, number, m->iterations[number], &count);
        else if (op != IR_nop)
            pass_append(ir, memory, number, &count);
    }
    pass_replace(ir, memory, count);
}

unsigned pass_unroll(struct ir *ir, struct pass_memory *memory)
{
    struct unrolling u = {.ir = ir, .memory = pass_scratch(memory, sizeof *u.memory)};
    struct unroll_memory *m = u.memory;
    if (!ir->loops || !ir->variables || ir->phis)
        return 0;
    memset(m->iterations, 0, ir->count * sizeof m->iterations[0]);
    memset(m->held, 0, sizeof m->held);
    memset(m->tried, 0, sizeof m->tried);
    memset(m->last_set, 0, sizeof m->last_set);
    m->value[0] = nothing;
    find_last_sets(ir, m);
    find_loops(&u);
    if (u.unrolled)
        rebuild(ir, memory, m);
    ir->loops -= u.unrolled;
    return u.unrolled;
}
