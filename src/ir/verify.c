/* Verifies a program, in one walk from front to back (ir.h lists the rules). */
#include "base/slab.h"
#include "ir/ir.h"

#include <pthread.h>
#include <stdarg.h>
#include <string.h>

/* The state of the walk: the open regions, the values that can be used, the variables and the phis.
 *
 * A value can be used while the `when` around it is open. It can also be used after a loop, since the body of
 * a loop runs before what follows it. After the end of a `when`, a variable that only the `when` sets may
 * have no value; after a loop, a variable that the loop sets has one. */
struct walk {
    const struct ir *ir;
    uint32_t number;
    uint16_t scope[IR_CAPACITY];  /* of each value: the `when` around it, 0: none */
    uint16_t parent[IR_CAPACITY]; /* of each region: the one around it */
    uint16_t outer[IR_CAPACITY];  /* of each `when`: the one around it */
    uint16_t held[IR_CAPACITY];   /* of each `when`: the number of variables with a value before it */
    uint16_t owner[IR_CAPACITY];  /* of each phi: its loop until `next` gives it a value, then 0 */
    uint16_t phis[IR_CAPACITY];   /* of each loop: its phis that have no `next` yet */
    uint8_t open[IR_CAPACITY];
    uint8_t type[VARIABLES * IR_PARTS];
    uint8_t holds[VARIABLES * IR_PARTS];
    uint16_t holding[VARIABLES * IR_PARTS]; /* variables with a value, in the order of their first set */
    uint16_t holding_count;
    uint16_t region;  /* the innermost */
    uint16_t when;    /* the innermost `when` */
    uint16_t ended;   /* the `when` that ended last */
    uint16_t waiting; /* phis without a loop yet */
    uint8_t previous; /* operation */
};

/* Almost a megabyte, and only checked builds and tests verify. */
static struct slab walks = SLAB(sizeof(struct walk));
SLAB_CLEAR_AT_UNLOAD(walks)

__attribute__((format(printf, 2, 3))) static const char *wrong(struct walk *walk, const char *format, ...)
{
    static _Thread_local char text[128];
    int length = snprintf(text, sizeof text, "instruction %u: ", walk->number);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text + length, sizeof text - (size_t)length, format, arguments);
    va_end(arguments);
    return text;
}

static const struct ir_instruction *instruction(const struct walk *walk, unsigned number)
{
    return &walk->ir->instruction[number];
}

static bool is_value(const struct ir_instruction *i)
{
    return i->type && !(ir_properties(i) & IR_EFFECT);
}

/* Returns true if an operand can be used. The second operand of a join may be in the region that has just
 * ended. */
static bool is_usable(const struct walk *walk, const struct ir_instruction *i, int o)
{
    unsigned scope = walk->scope[i->operand[o]];
    return walk->open[scope] || (i->op == IR_join && o == 1 && scope == walk->ended);
}

static const char *verify_operands(struct walk *walk, const struct ir_instruction *i)
{
    for (int o = 0; o < 3; o++) {
        unsigned operand = i->operand[o];
        if (o >= (int)ir_operands(i)) {
            if (operand)
                return wrong(walk, "operand %d is superfluous", o);
            continue;
        }
        if (!operand || operand >= walk->number)
            return wrong(walk, "operand %d is not defined before", o);
        if (!is_value(instruction(walk, operand)))
            return wrong(walk, "operand %d is not a value", o);
        if (!is_usable(walk, i, o))
            return wrong(walk, "operand %d leaves its region", o);
    }
    return NULL;
}

static const char *verify_variable(struct walk *walk, const struct ir_instruction *i)
{
    if (i->k < 0 || i->k >= VARIABLES * IR_PARTS || (uint32_t)i->k >= walk->ir->variables)
        return wrong(walk, "there is no variable %d", (int)i->k);
    if (i->type == TYPE_non || i->type == TYPE_fix || (walk->type[i->k] && walk->type[i->k] != i->type))
        return wrong(walk, "variable %d is of another type", (int)i->k);
    walk->type[i->k] = i->type;
    if (i->op == IR_get && !walk->holds[i->k])
        return wrong(walk, "variable %d may have no value", (int)i->k);
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
        return wrong(walk, "%u is not a phi of this loop without a next value", phi);
    walk->owner[phi] = 0;
    walk->phis[walk->region]--;
    return NULL;
}

static const char *verify_join(struct walk *walk, const struct ir_instruction *i)
{
    if (walk->previous != IR_end && walk->previous != IR_join)
        return wrong(walk, "a join does not follow a region's end");
    if (i->operand[0] > walk->ended)
        return wrong(walk, "operand 0 is not defined before the region");
    for (int o = 0; o < 2; o++)
        if (instruction(walk, i->operand[o])->op == IR_join && i->operand[o] > walk->ended &&
            walk->scope[i->operand[o]] == walk->when)
            return wrong(walk, "operand %d is a join of the same region", o);
    return NULL;
}

/* Phis directly precede their loop, and next values its end. */
static const char *verify_position(struct walk *walk, const struct ir_instruction *i)
{
    if (walk->previous == IR_phi && i->op != IR_phi && i->op != IR_loop)
        return wrong(walk, "a phi does not precede a loop");
    if (walk->previous == IR_next && i->op != IR_next && i->op != IR_again)
        return wrong(walk, "a next value does not precede a loop's end");
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
        return wrong(walk, "no region of its kind is open");
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
    unsigned properties = ir_properties(i);
    const char *what = verify_operands(walk, i);
    if (!what)
        what = verify_position(walk, i);
    if (!what && properties & IR_CLOSES)
        what = leave(walk, i);
    walk->scope[walk->number] = walk->when;
    if (properties & IR_OPENS)
        enter(walk, i);
    walk->waiting += i->op == IR_phi;
    walk->previous = i->op;
    return what;
}

static const char *verify(struct walk *walk, const struct ir *ir)
{
    memset(walk->type, 0, sizeof walk->type);
    memset(walk->holds, 0, sizeof walk->holds);
    walk->ir = ir;
    walk->open[0] = 1;
    walk->region = walk->when = walk->ended = walk->holding_count = walk->waiting = 0;
    walk->previous = IR_nop;
    for (walk->number = 1; walk->number < ir->count; walk->number++) {
        const struct ir_instruction *i = instruction(walk, walk->number);
        const char *what = i->op == IR_nop ? NULL : verify_instruction(walk, i);
        if (what)
            return what;
    }
    return walk->region || walk->waiting ? "a region is not ended" : NULL;
}

const char *ir_verify(const struct ir *ir)
{
    struct walk *walk = slab_take(&walks);
    if (!walk)
        return "out of memory for its verification";
    const char *what = verify(walk, ir);
    slab_give(&walks, walk);
    return what;
}

int ir_check(const struct ir *ir, const char *name, struct error *error)
{
    static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
    pthread_mutex_lock(&lock);
    const char *what = ir_verify(ir);
    int result = what ? error_set(error, "%s is not a valid program: %s", name, what) : 0;
    pthread_mutex_unlock(&lock);
    return result;
}
