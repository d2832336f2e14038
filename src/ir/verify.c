/* What makes an IR valid: see ir.h. One walk from front to back. */
#include "ir/ir.h"

#include <pthread.h>
#include <stdarg.h>
#include <string.h>

/* Where control is, which values are there, and what each variable and phi is.
 *
 * A value is there as long as the `when` around it is open: a loop's body has run whenever what follows it
 * does. What a `when` sets, a variable does not hold behind the end for certain; what a loop sets, it does.
 */
struct walk {
    const struct ir *ir;
    uint32_t number;
    uint16_t scope[IR_CAPACITY];  /* of each value: the `when` that it is inside of, 0: none */
    uint16_t parent[IR_CAPACITY]; /* of each region: the one around it */
    uint16_t outer[IR_CAPACITY];  /* of each `when`: the one around it */
    uint16_t held[IR_CAPACITY];   /* of each `when`: how many variables were held before it */
    uint16_t owner[IR_CAPACITY];  /* of each phi: its loop until `next` gives it a value, then 0 */
    uint16_t phis[IR_CAPACITY];   /* of each loop: its phis that have no `next` yet */
    uint8_t open[IR_CAPACITY];
    uint8_t type[VARIABLES];
    uint8_t holds[VARIABLES];
    uint16_t holding[VARIABLES]; /* in the order in which they were set first */
    uint16_t holding_count;
    uint16_t region;  /* the innermost */
    uint16_t when;    /* the innermost `when` */
    uint16_t ended;   /* the `when` that ended last */
    uint16_t waiting; /* phis without a loop yet */
    uint8_t previous; /* operation */
    char text[128];
};

__attribute__((format(printf, 2, 3))) static const char *wrong(struct walk *walk, const char *format, ...)
{
    int length = snprintf(walk->text, sizeof walk->text, "instruction %u: ", walk->number);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(walk->text + length, sizeof walk->text - (size_t)length, format, arguments);
    va_end(arguments);
    return walk->text;
}

static const struct ir_instruction *instruction(const struct walk *walk, unsigned number)
{
    return &walk->ir->instruction[number];
}

static int is_value(const struct ir_instruction *i)
{
    return i->type && !(ir_op_information[i->op].properties & IR_EFFECT);
}

/* The second operand of a join is inside of the region that has just ended. */
static int is_there(const struct walk *walk, const struct ir_instruction *i, int o)
{
    unsigned scope = walk->scope[i->operand[o]];
    return walk->open[scope] || (i->op == IR_join && o == 1 && scope == walk->ended);
}

static const char *verify_operands(struct walk *walk, const struct ir_instruction *i)
{
    for (int o = 0; o < 3; o++) {
        unsigned operand = i->operand[o];
        if (o >= ir_op_information[i->op].operands) {
            if (operand)
                return wrong(walk, "operand %d is superfluous", o);
            continue;
        }
        if (!operand || operand >= walk->number)
            return wrong(walk, "operand %d is not defined before", o);
        if (!is_value(instruction(walk, operand)))
            return wrong(walk, "operand %d is no value", o);
        if (!is_there(walk, i, o))
            return wrong(walk, "operand %d leaves its region", o);
    }
    return NULL;
}

static const char *verify_variable(struct walk *walk, const struct ir_instruction *i)
{
    if (i->k < 0 || i->k >= VARIABLES || (uint32_t)i->k >= walk->ir->variables)
        return wrong(walk, "there is no variable %d", (int)i->k);
    if (i->type == TYPE_non || i->type == TYPE_fix || (walk->type[i->k] && walk->type[i->k] != i->type))
        return wrong(walk, "variable %d is of another type", (int)i->k);
    walk->type[i->k] = i->type;
    if (i->op == IR_get && !walk->holds[i->k])
        return wrong(walk, "variable %d may hold nothing", (int)i->k);
    if (i->op == IR_set && !walk->holds[i->k]) {
        walk->holds[i->k] = 1;
        walk->holding[walk->holding_count++] = (uint16_t)i->k;
    }
    return NULL;
}

static const char *verify_next(struct walk *walk, const struct ir_instruction *i)
{
    unsigned phi = i->operand[0];
    if (instruction(walk, phi)->op != IR_phi || !walk->region || walk->owner[phi] != walk->region)
        return wrong(walk, "%u is no phi of this loop that awaits its next value", phi);
    walk->owner[phi] = 0;
    walk->phis[walk->region]--;
    return NULL;
}

static const char *verify_join(struct walk *walk, const struct ir_instruction *i)
{
    if (walk->previous != IR_end && walk->previous != IR_join)
        return wrong(walk, "a join stands behind no region's end");
    if (i->operand[0] > walk->ended)
        return wrong(walk, "operand 0 is not defined before the region");
    for (int o = 0; o < 2; o++)
        if (instruction(walk, i->operand[o])->op == IR_join && i->operand[o] > walk->ended &&
            walk->scope[i->operand[o]] == walk->when)
            return wrong(walk, "operand %d is joined at the same place", o);
    return NULL;
}

/* Phis stand directly before their loop, `next`s directly before its end. */
static const char *verify_place(struct walk *walk, const struct ir_instruction *i)
{
    if (walk->previous == IR_phi && i->op != IR_phi && i->op != IR_loop)
        return wrong(walk, "a phi stands before no loop");
    if (walk->previous == IR_next && i->op != IR_next && i->op != IR_again)
        return wrong(walk, "a next value stands before no loop's end");
    switch (i->op) {
    case IR_set:
    case IR_get: return verify_variable(walk, i);
    case IR_next: return verify_next(walk, i);
    case IR_join: return verify_join(walk, i);
    default: return NULL;
    }
}

static void enter(struct walk *walk, const struct ir_instruction *i)
{
    walk->parent[walk->number] = walk->region;
    walk->region = (uint16_t)walk->number;
    if (i->op == IR_loop) {
        walk->phis[walk->number] = walk->waiting;
        for (unsigned phi = walk->number - 1; walk->waiting; phi--)
            if (instruction(walk, phi)->op == IR_phi) {
                walk->owner[phi] = walk->region;
                walk->waiting--;
            }
        return;
    }
    walk->held[walk->number] = walk->holding_count;
    walk->outer[walk->number] = walk->when;
    walk->when = (uint16_t)walk->number;
    walk->open[walk->number] = 1;
}

static const char *leave(struct walk *walk, const struct ir_instruction *i)
{
    if (instruction(walk, walk->region)->op != (i->op == IR_end ? IR_when : IR_loop))
        return wrong(walk, "ends no region of its kind");
    if (i->op == IR_again && walk->phis[walk->region])
        return wrong(walk, "a phi of this loop has no next value");
    if (i->op == IR_end) {
        while (walk->holding_count > walk->held[walk->when])
            walk->holds[walk->holding[--walk->holding_count]] = 0;
        walk->open[walk->when] = 0;
        walk->ended = walk->when;
        walk->when = walk->outer[walk->when];
    }
    walk->region = walk->parent[walk->region];
    return NULL;
}

static const char *verify_instruction(struct walk *walk, const struct ir_instruction *i)
{
    unsigned properties = ir_op_information[i->op].properties;
    const char *what = verify_operands(walk, i);
    if (!what)
        what = verify_place(walk, i);
    if (!what && properties & IR_CLOSES)
        what = leave(walk, i);
    walk->scope[walk->number] = walk->when;
    if (properties & IR_OPENS)
        enter(walk, i);
    walk->waiting += i->op == IR_phi;
    walk->previous = i->op;
    return what;
}

const char *ir_verify(const struct ir *ir)
{
    static _Thread_local struct walk walk;
    memset(walk.type, 0, sizeof walk.type);
    memset(walk.holds, 0, sizeof walk.holds);
    walk.ir = ir;
    walk.open[0] = 1;
    walk.region = walk.when = walk.ended = walk.holding_count = walk.waiting = 0;
    walk.previous = IR_nop;
    for (walk.number = 1; walk.number < ir->count; walk.number++) {
        const struct ir_instruction *i = instruction(&walk, walk.number);
        const char *what = i->op == IR_nop ? NULL : verify_instruction(&walk, i);
        if (what)
            return what;
    }
    return walk.region || walk.waiting ? "a region is not ended" : NULL;
}

int ir_check(const struct ir *ir, const char *made, struct error *error)
{
    static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
    pthread_mutex_lock(&lock);
    const char *what = ir_verify(ir);
    int result = what ? error_set(error, "%s is no valid program: %s", made, what) : 0;
    pthread_mutex_unlock(&lock);
    return result;
}
