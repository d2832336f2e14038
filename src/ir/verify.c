/* Verifies a program, in one walk from front to back (ir.h lists the rules). */
#include "base/slab.h"
#include "ir/field.h"

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
    uint16_t region;   /* the innermost */
    uint16_t when;     /* the innermost `when` */
    uint16_t ended;    /* the `when` that ended last */
    uint16_t waiting;  /* phis without a loop yet */
    uint8_t previous;  /* operation */
    uint32_t began;    /* the `subroutine` whose instructions are verified, 0: the program before them */
    uint32_t section;  /* 0: none yet */
    uint32_t rest;     /* the `rest`, 0: none yet */
    uint32_t repeated; /* the `repeat`, 0: none yet */
    bool left;         /* its `leave` has been verified */
};

/* Almost a megabyte, and only checked builds and tests verify. */
static struct slab walks = SLAB(sizeof(struct walk));
SLAB_CLEAR_AT_UNLOAD(walks)

__attribute__((format(printf, 2, 3))) static const char *wrong(struct walk *walk, const char *format, ...)
{
    static _Thread_local char text[192];
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
        if (operand < walk->began)
            return wrong(walk, "operand %d is a value of another subroutine", o);
        if (operand < walk->rest && operand > walk->section)
            return wrong(walk, "operand %d is a value of the first part", o);
        if (!is_value(instruction(walk, operand)))
            return wrong(walk, "operand %d is not a value", o);
        if (!is_usable(walk, i, o))
            return wrong(walk, "operand %d leaves its region", o);
    }
    return NULL;
}

/* --- Types ---------------------------------------------------------------------------------------------- */

static const char *const type_text[] = {"without a type", "flt", "itg", "fix", "msk"};

/* Returns true if a value can be an operand of a type. After copy propagation the bits of any value may be
 * used as those of a word. As a mask only a mask may be used, or a literal or its copy: with 16 lanes, masks
 * have registers of their own, and literals have none. */
static bool fits(const struct walk *walk, unsigned value, unsigned want)
{
    const struct ir_instruction *i = instruction(walk, value);
    const struct ir_instruction *source = i->op == IR_copy ? instruction(walk, i->operand[0]) : i;
    return i->type == want || (!walk->ir->typed && (want != TYPE_msk || source->op == IR_literal));
}

/* Strength reduction uses `andn_m` for words too, and the type of the value is then that of words. */
static bool is_of_words(const struct walk *walk, const struct ir_instruction *i)
{
    return !walk->ir->typed && i->op == IR_andn_m && i->type == TYPE_itg;
}

static const char *verify_operand_types(struct walk *walk, const struct ir_instruction *i)
{
    for (unsigned o = 0; o < ir_operands(i); o++) {
        unsigned want = ir_op_information[i->op].operand[o], have = instruction(walk, i->operand[o])->type;
        if (want != TYPE_any && !is_of_words(walk, i) && !fits(walk, i->operand[o], want))
            return wrong(walk, "operand %u is %s, expected %s", o, type_text[have], type_text[want]);
    }
    return NULL;
}

/* The operands that have the instruction's own type: those of variables, phis and joins; of a next value, the
 * type of its phi. */
static const char *verify_same_types(struct walk *walk, const struct ir_instruction *i)
{
    bool next = i->op == IR_next,
         same = next || i->op == IR_set || i->op == IR_put || i->op == IR_phi || i->op == IR_join;
    unsigned want = next ? instruction(walk, i->operand[0])->type : i->type;
    for (unsigned o = 0; same && o < ir_operands(i); o++) {
        unsigned have = instruction(walk, i->operand[o])->type;
        if (!fits(walk, i->operand[o], want))
            return wrong(walk, "operand %u is %s, expected %s", o, type_text[have], type_text[want]);
    }
    return NULL;
}

static const char *verify_result_type(struct walk *walk, const struct ir_instruction *i)
{
    unsigned result = ir_op_information[i->op].result;
    if (ir_properties(i) & IR_EFFECT || is_of_words(walk, i))
        return NULL;
    if (result ? i->type != result : i->type == TYPE_non || i->type > TYPE_msk)
        return wrong(walk, "its value is %s, expected %s", type_text[i->type <= TYPE_msk ? i->type : 0],
                     result ? type_text[result] : "a type");
    if (i->op == IR_copy && i->type == TYPE_msk && !fits(walk, i->operand[0], TYPE_msk))
        return wrong(walk, "a word is copied to a mask");
    if (ir_properties(i) & IR_READS && !result && i->type == TYPE_msk)
        return wrong(walk, "it reads msk, expected a word");
    return NULL;
}

/* The type of what a memory instruction reads or writes; TYPE_non: any. */
static unsigned type_in_memory(const struct walk *walk, const struct ir_instruction *i)
{
    if (!(ir_properties(i) & IR_WRITES))
        return i->op == IR_coverage ? TYPE_non : i->type;
    return walk->ir->typed ? instruction(walk, i->operand[0])->type : TYPE_non;
}

/* A pixel key without a varying has the offset 0 for it, and reads the head of the triangle as its planes if
 * it uses the varying nevertheless. No draw has such a key, but tests of engines do. */
static bool may_lack_varying(const struct walk *walk, const struct ir_instruction *i)
{
    const int32_t planes = 4 * sizeof(struct plane);
    return walk->ir->unit == UNIT_PIXEL && i->base == BASE_TRIANGLE && i->type == TYPE_flt && i->k < planes;
}

static const char *verify_field(struct walk *walk, const struct ir_instruction *i)
{
    struct ir_field pointer, field;
    if (walk->ir->unit == UNIT_COUNT || !(ir_properties(i) & (IR_READS | IR_WRITES)) ||
        may_lack_varying(walk, i))
        return NULL;
    const char *what = ir_find_unnamed(walk->ir, i, &pointer, &field);
    if (what)
        return wrong(walk, "%s", what);
    unsigned type = type_in_memory(walk, i);
    if (!type || !field.type || type == field.type)
        return NULL;
    ir_find_memory(walk->ir, i, &pointer, &field);
    return wrong(walk, "%s is %s, found %s", field.name, type_text[field.type], type_text[type]);
}

static const char *verify_types(struct walk *walk, const struct ir_instruction *i)
{
    const char *what = verify_operand_types(walk, i);
    if (!what)
        what = verify_same_types(walk, i);
    if (!what)
        what = verify_result_type(walk, i);
    return what ? what : verify_field(walk, i);
}

/* --- Positions ------------------------------------------------------------------------------------------ */

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

/* --- Subroutines ---------------------------------------------------------------------------------------- */

/* Returns true for an instruction that a preamble can have: its value is the same in all lanes. */
static bool is_of_preamble(const struct ir_instruction *i)
{
    return ir_properties(i) & IR_COMPUTES || i->op == IR_copy || i->op == IR_literal ||
           i->op == IR_constant || ir_reads_call(i);
}

static const char *begin_section(struct walk *walk, const struct ir_instruction *i)
{
    if (walk->section || !walk->ir->preamble || i->k != IR_SECTION_BODY)
        return wrong(walk, "no section begins here");
    walk->section = walk->number;
    return NULL;
}

static const char *verify_section(struct walk *walk, const struct ir_instruction *i)
{
    if (i->op == IR_section)
        return begin_section(walk, i);
    if (i->op == IR_rest && (walk->region || walk->rest || walk->repeated || !walk->ir->early))
        return wrong(walk, "no second part begins here");
    if (i->op == IR_rest)
        walk->rest = walk->number;
    if (i->op == IR_repeat && (walk->region || !walk->section || walk->repeated))
        return wrong(walk, "no section ends here");
    if (walk->ir->preamble && !walk->section && !is_of_preamble(i))
        return wrong(walk, "its value is not the same in all lanes, or it has an effect, in the preamble");
    if (walk->repeated && !walk->began && i->op != IR_subroutine)
        return wrong(walk, "the sections have ended");
    if (i->op == IR_repeat)
        walk->repeated = walk->number;
    return NULL;
}

static const char *begin_subroutine(struct walk *walk)
{
    if (walk->region || (walk->began && !walk->left))
        return wrong(walk, "a subroutine begins before the end of what precedes it");
    walk->began = walk->number;
    walk->left = false;
    memset(walk->holds, 0, sizeof walk->holds);
    walk->holding_count = 0;
    return NULL;
}

static const char *verify_calls(struct walk *walk, const struct ir_instruction *i)
{
    uint32_t limit = ir_properties(i) & IR_EXCHANGED ? walk->ir->exchanged : walk->ir->subroutines;
    if (walk->left && i->op != IR_subroutine)
        return wrong(walk, "a subroutine has ended");
    if (!(ir_properties(i) & (IR_EXCHANGED | IR_CALLS)))
        return NULL;
    if (i->op != IR_leave && (i->k < 0 || (uint32_t)i->k >= limit))
        return wrong(walk, "there is no %s %d",
                     ir_properties(i) & IR_EXCHANGED ? "argument or result" : "subroutine", (int)i->k);
    if (i->op == IR_put && (i->type == TYPE_non || i->type == TYPE_fix))
        return wrong(walk, "its type cannot be passed on");
    if (i->op == IR_subroutine)
        return begin_subroutine(walk);
    if (i->op == IR_call && walk->began)
        return wrong(walk, "a subroutine calls another");
    if (i->op == IR_leave && (!walk->began || walk->region))
        return wrong(walk, "no subroutine ends here");
    walk->left = i->op == IR_leave;
    return NULL;
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
        what = verify_types(walk, i);
    if (!what)
        what = verify_position(walk, i);
    if (!what)
        what = verify_section(walk, i);
    if (!what)
        what = verify_calls(walk, i);
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
    walk->began = walk->section = walk->rest = walk->repeated = 0;
    walk->left = false;
    for (walk->number = 1; walk->number < ir->count; walk->number++) {
        const struct ir_instruction *i = instruction(walk, walk->number);
        const char *what = i->op == IR_nop ? NULL : verify_instruction(walk, i);
        if (what)
            return what;
    }
    if (walk->began && !walk->left)
        return "a subroutine is not ended";
    if (ir->preamble && !walk->repeated)
        return "a section is not ended";
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
