/* Code of operations that compute: the rows of def/op.def, and permute. The form of each is a row of
 * def/engine/select.def.
 *
 * Operands in memory (literals, constants, spilled values, loads used once) are memory operands if the form
 * has one, and are loaded into a scratch register otherwise. Three-operand encodings need no copies. A fused
 * multiply-add overwrites one of its operands; which one shares the result's register decides between the
 * forms 132, 213 and 231. Peephole rules: a selection with zero is a bitwise operation, a comparison
 * exchanges its sides to read the right one from memory, and a test of 16 lanes for zero needs no second
 * operand. */
#include "engines/specialize/emit/emit.h"

enum form {
    FORM_NONE,
    FORM_BINARY,
    FORM_REVERSED,
    FORM_COMPARE,
    FORM_UNARY,
    FORM_ROUND,
    FORM_SHIFT,
    FORM_ROTATE,
    FORM_PLACES,
    FORM_NEGATE,
    FORM_HALF,
    FORM_MAD,
    FORM_SELECT,
    FORM_BLEND,
    FORM_TEST,
    FORM_MASKS,
    FORM_MERGE,
    FORM_MERGE_ROUND,
    FORM_TO_INTEGER,
    FORM_FROM_INTEGER
};

struct rule {
    uint16_t instruction; /* enum x86_vector */
    uint8_t form;
    uint8_t immediate;
};

static const struct rule rules[IR_OP_COUNT] = {
#define SELECT(op, form, instruction, immediate) [IR_##op] = {X86_##instruction, FORM_##form, immediate},
#include "def/engine/select.def"
};

/* The rules that replace those for 16 lanes. */
static const struct rule wide_rules[IR_OP_COUNT] = {
#define SELECT_WIDE(op, form, instruction, immediate) [IR_##op] = {X86_##instruction, FORM_##form, immediate},
#include "def/engine/select.def"
};

/* The rules that replace those for one lane. */
static const struct rule scalar_rules[IR_OP_COUNT] = {
#define SELECT_SCALAR(op, form, instruction, immediate)                                                      \
    [IR_##op] = {X86_##instruction, FORM_##form, immediate},
#include "def/engine/select.def"
};

/* Returns true if the left operand is in memory and the right one is not. */
static bool is_better_exchanged(struct emitter *m, const struct location *a, const struct location *b)
{
    return a->reg == NO_REGISTER && a->addressable && b->reg != NO_REGISTER &&
           emit_applies(m, PEEPHOLE_exchange);
}

static void select_binary(struct emitter *m, const struct rule *rule, unsigned left, unsigned right,
                          bool commutes)
{
    struct location a = emit_locate(m, left), b = emit_locate(m, right);
    if (commutes && is_better_exchanged(m, &a, &b)) {
        struct location swapped = a;
        a = b;
        b = swapped;
    }
    unsigned first = emit_need_register(m, &a, SCRATCH_FIRST);
    if (emit_folds(m, rule->instruction, &b))
        encode_rrm(&m->encoder, rule->instruction, m->length, emit_result_register(m), first, b.address);
    else
        encode_rrr(&m->encoder, rule->instruction, m->length, emit_result_register(m), first,
                   emit_need_register(m, &b, SCRATCH_SECOND));
}

static unsigned swapped_predicate(unsigned predicate)
{
    switch (predicate) {
    case X86_CMP_LT: return X86_CMP_GT;
    case X86_CMP_LE: return X86_CMP_GE;
    default: return predicate;
    }
}

static void select_compare(struct emitter *m, const struct rule *rule, const struct ir_instruction *i)
{
    struct location a = emit_locate(m, i->operand[0]), b = emit_locate(m, i->operand[1]);
    unsigned predicate = rule->immediate;
    if (is_better_exchanged(m, &a, &b)) {
        struct location swapped = a;
        a = b;
        b = swapped;
        predicate = swapped_predicate(predicate);
    }
    unsigned first = emit_need_register(m, &a, SCRATCH_FIRST);
    if (emit_folds(m, rule->instruction, &b))
        encode_rrmi(&m->encoder, rule->instruction, m->length, emit_result_register(m), first, b.address,
                    predicate);
    else
        encode_rrri(&m->encoder, rule->instruction, m->length, emit_result_register(m), first,
                    emit_need_register(m, &b, SCRATCH_SECOND), predicate);
}

static unsigned swapped_mask_predicate(const struct rule *rule, unsigned predicate)
{
    if (rule->instruction == X86_vcmpps_mask)
        return swapped_predicate(predicate);
    return predicate == X86_VPCMP_GT ? X86_VPCMP_LT : predicate;
}

static void select_compare_masks(struct emitter *m, const struct rule *rule, const struct ir_instruction *i)
{
    struct location a = emit_locate(m, i->operand[0]), b = emit_locate(m, i->operand[1]);
    unsigned predicate = rule->immediate, to = emit_result_register(m) - MASKS, right = i->operand[1];
    if (is_better_exchanged(m, &a, &b)) {
        struct location swapped = a;
        right = i->operand[0];
        a = b;
        b = swapped;
        predicate = swapped_mask_predicate(rule, predicate);
    }
    unsigned first = emit_need_register(m, &a, SCRATCH_FIRST);
    if (rule->instruction == X86_vpcmpd_mask && predicate == X86_VPCMP_EQ && emit_is_zero(m, right) &&
        emit_applies(m, PEEPHOLE_test))
        encode_rrr(&m->encoder, X86_vptestnmd, m->length, to, first, first);
    else if (emit_folds(m, rule->instruction, &b))
        encode_rrmi(&m->encoder, rule->instruction, m->length, to, first, b.address, predicate);
    else
        encode_rrri(&m->encoder, rule->instruction, m->length, to, first,
                    emit_need_register(m, &b, SCRATCH_SECOND), predicate);
}

/* The result's register is written last, so it can hold the second operand. */
static void select_masks(struct emitter *m, const struct rule *rule, const struct ir_instruction *i)
{
    bool reversed = rule->instruction == X86_kandnw;
    struct location a = emit_locate(m, i->operand[reversed]), b = emit_locate(m, i->operand[!reversed]);
    unsigned first = emit_need_mask(m, &a, MASK_SCRATCH), second = emit_need_mask(m, &b, MASK_RESULT);
    encode_rrr(&m->encoder, rule->instruction, X86_256, emit_result_register(m) - MASKS, first, second);
}

static void select_unary(struct emitter *m, const struct rule *rule, const struct ir_instruction *i)
{
    struct location a = emit_locate(m, i->operand[0]);
    unsigned to = emit_result_register(m);
    bool in_memory = emit_folds(m, rule->instruction, &a);
    unsigned from = in_memory ? 0 : emit_need_register(m, &a, SCRATCH_FIRST);
    if (rule->form == FORM_ROUND && in_memory)
        encode_rmi(&m->encoder, rule->instruction, m->length, to, a.address, rule->immediate);
    else if (rule->form == FORM_ROUND)
        encode_rri(&m->encoder, rule->instruction, m->length, to, from, rule->immediate);
    else if (in_memory)
        encode_rm(&m->encoder, rule->instruction, m->length, to, a.address);
    else
        encode_rr(&m->encoder, rule->instruction, m->length, to, from);
}

static void select_shift(struct emitter *m, const struct rule *rule, const struct ir_instruction *i)
{
    struct location a = emit_locate(m, i->operand[0]);
    unsigned from = emit_need_register(m, &a, SCRATCH_FIRST);
    encode_rri(&m->encoder, rule->instruction, m->length, emit_result_register(m), from, (unsigned)i->k);
}

/* Rotations by whole bytes permute bytes. Each lane's literal has the places of its four bytes. */
static void select_rotate(struct emitter *m, const struct rule *rule, const struct ir_instruction *i)
{
    struct encoder *e = &m->encoder;
    struct location a = emit_locate(m, i->operand[0]);
    unsigned to = emit_result_register(m), from = emit_need_register(m, &a, SCRATCH_FIRST);
    if (i->k % 8 == 0) {
        int32_t places = (int32_t)ir_evaluate(IR_rotl_i, 0x03020100, 0, 0, i->k);
        encode_rrm(e, rule->instruction, m->length, to, from,
                   emit_literal_address(m, places, LITERAL_PLACES));
        return;
    }
    encode_rri(e, X86_vpslld_immediate, m->length, SCRATCH_SECOND, from, (unsigned)i->k);
    encode_rri(e, X86_vpsrld_immediate, m->length, to, from, 32 - (unsigned)i->k);
    encode_rrr(e, X86_vpor, m->length, to, to, SCRATCH_SECOND);
}

static void select_places(struct emitter *m, const struct rule *rule, const struct ir_instruction *i)
{
    struct location a = emit_locate(m, i->operand[0]);
    int32_t places = (int32_t)ir_evaluate(i->op, 0x03020100, 0, 0, 0);
    encode_rrm(&m->encoder, rule->instruction, m->length, emit_result_register(m),
               emit_need_register(m, &a, SCRATCH_FIRST), emit_literal_address(m, places, LITERAL_PLACES));
}

static void select_negate(struct emitter *m, const struct ir_instruction *i)
{
    struct location a = emit_locate(m, i->operand[0]);
    unsigned from = emit_need_register(m, &a, SCRATCH_FIRST);
    encode_rrm(&m->encoder, X86_vxorps, m->length, emit_result_register(m), from,
               emit_literal_address(m, INT32_MIN, emit_is_wide(m) ? LITERAL_ONCE : LITERAL_LANES));
}

static void select_half(struct emitter *m, const struct rule *rule, const struct ir_instruction *i)
{
    struct location a = emit_locate(m, i->operand[0]);
    unsigned from = emit_need_register(m, &a, SCRATCH_FIRST);
    encode_rri(&m->encoder, rule->instruction, m->length, SCRATCH_SECOND, from, rule->immediate);
    encode_rr(&m->encoder, X86_vcvtph2ps, m->length, emit_result_register(m), SCRATCH_SECOND);
}

/* mask ? b : c. If b or c is zero, one bitwise operation suffices. */
static void select_select(struct emitter *m, const struct ir_instruction *i)
{
    struct location mask = emit_locate(m, i->operand[0]);
    unsigned to = emit_result_register(m);
    unsigned test = emit_need_register(m, &mask, SCRATCH_FIRST);
    bool zero_else = emit_is_zero(m, i->operand[2]), zero_then = emit_is_zero(m, i->operand[1]);
    if ((zero_else || zero_then) && emit_applies(m, PEEPHOLE_mask)) {
        struct location other = emit_locate(m, i->operand[zero_else ? 1 : 2]);
        enum x86_vector operation = zero_else ? X86_vandps : X86_vandnps;
        if (emit_folds(m, operation, &other))
            encode_rrm(&m->encoder, operation, m->length, to, test, other.address);
        else
            encode_rrr(&m->encoder, operation, m->length, to, test,
                       emit_need_register(m, &other, SCRATCH_SECOND));
        return;
    }
    struct location then = emit_locate(m, i->operand[1]), otherwise = emit_locate(m, i->operand[2]);
    unsigned base = emit_need_register(m, &otherwise, SCRATCH_SECOND);
    if (emit_folds(m, X86_vblendvps, &then))
        encode_rrmr(&m->encoder, X86_vblendvps, m->length, to, base, then.address, test);
    else
        encode_rrrr(&m->encoder, X86_vblendvps, m->length, to, base,
                    emit_need_register(m, &then, SCRATCH_RESULT), test);
}

/* mask ? b : 0. */
static void select_or_zero(struct emitter *m, const struct location *mask, struct location *then)
{
    enum x86_vector how = then->address.broadcast ? X86_vbroadcastss : X86_vmovups;
    unsigned to = emit_result_register(m);
    if (then->reg == NO_REGISTER && then->addressable) {
        then->address.broadcast = 0;
        encode_rm(&m->encoder, how, m->length, zeroed(to, emit_need_mask(m, mask, MASK_SCRATCH)),
                  then->address);
        return;
    }
    unsigned from = emit_need_register(m, then, SCRATCH_RESULT);
    encode_rr(&m->encoder, X86_vmovaps, m->length, zeroed(to, emit_need_mask(m, mask, MASK_SCRATCH)), from);
}

/* mask ? b : c by a mask register. The mask is brought to a register last, because b and c may be masks
 * themselves, which pass through the same scratch registers. */
static void select_blend(struct emitter *m, const struct ir_instruction *i)
{
    struct location mask = emit_locate(m, i->operand[0]), then = emit_locate(m, i->operand[1]),
                    otherwise = emit_locate(m, i->operand[2]);
    unsigned to = emit_result_register(m);
    if (emit_is_zero(m, i->operand[2]) && emit_applies(m, PEEPHOLE_mask)) {
        select_or_zero(m, &mask, &then);
        return;
    }
    unsigned base = emit_need_register(m, &otherwise, SCRATCH_SECOND);
    if (emit_is_zero(m, i->operand[1]) && emit_applies(m, PEEPHOLE_mask)) {
        unsigned k = emit_need_mask(m, &mask, MASK_SCRATCH);
        if (base != to)
            encode_copy(&m->encoder, m->length, to, base);
        encode_rrr(&m->encoder, X86_vxorps, m->length, masked(to, k), to, to);
    } else if (emit_folds(m, X86_vblendmps, &then)) {
        unsigned k = emit_need_mask(m, &mask, MASK_SCRATCH);
        encode_rrm(&m->encoder, X86_vblendmps, m->length, masked(to, k), base, then.address);
    } else {
        unsigned from = emit_need_register(m, &then, SCRATCH_RESULT);
        unsigned k = emit_need_mask(m, &mask, MASK_SCRATCH);
        encode_rrr(&m->encoder, X86_vblendmps, m->length, masked(to, k), base, from);
    }
}

/* A form of the multiply-add for the number of lanes. */
static enum x86_vector fused(const struct emitter *m, enum x86_vector packed)
{
    if (!emit_is_scalar(m))
        return packed;
    switch (packed) {
    case X86_vfmadd132ps: return X86_vfmadd132ss;
    case X86_vfmadd213ps: return X86_vfmadd213ss;
    default: return X86_vfmadd231ss;
    }
}

static bool reads_memory(struct emitter *m, const struct location *p)
{
    return p->reg == NO_REGISTER && p->addressable && emit_applies(m, PEEPHOLE_memory);
}

/* to = to * x + y: the result's register holds a factor. x or y may be in memory. */
static void multiply_in_place(struct emitter *m, unsigned to, const struct location *x,
                              const struct location *y)
{
    if (reads_memory(m, y)) {
        encode_rrm(&m->encoder, fused(m, X86_vfmadd213ps), m->length, to,
                   emit_need_register(m, x, SCRATCH_FIRST), y->address);
        return;
    }
    unsigned addend = emit_need_register(m, y, SCRATCH_SECOND);
    if (reads_memory(m, x))
        encode_rrm(&m->encoder, fused(m, X86_vfmadd132ps), m->length, to, addend, x->address);
    else
        encode_rrr(&m->encoder, fused(m, X86_vfmadd213ps), m->length, to,
                   emit_need_register(m, x, SCRATCH_FIRST), addend);
}

/* to = a * b + to: the result's register holds the addend. a or b may be in memory. */
static void add_in_place(struct emitter *m, unsigned to, const struct location *a, const struct location *b)
{
    if (is_better_exchanged(m, a, b)) {
        const struct location *swapped = a;
        a = b;
        b = swapped;
    }
    unsigned first = emit_need_register(m, a, SCRATCH_FIRST);
    if (reads_memory(m, b))
        encode_rrm(&m->encoder, fused(m, X86_vfmadd231ps), m->length, to, first, b->address);
    else
        encode_rrr(&m->encoder, fused(m, X86_vfmadd231ps), m->length, to, first,
                   emit_need_register(m, b, SCRATCH_SECOND));
}

/* Without the choice of a form: the sum is made in a scratch register and copied. */
static void select_mad_aside(struct emitter *m, unsigned to, const struct location *a,
                             const struct location *b, const struct location *c)
{
    emit_bring(m, SCRATCH_RESULT, c);
    add_in_place(m, SCRATCH_RESULT, a, b);
    if (to != SCRATCH_RESULT)
        encode_copy(&m->encoder, m->length, to, SCRATCH_RESULT);
}

static void select_mad(struct emitter *m, const struct ir_instruction *i)
{
    struct location a = emit_locate(m, i->operand[0]), b = emit_locate(m, i->operand[1]),
                    c = emit_locate(m, i->operand[2]);
    unsigned to = emit_result_register(m);
    if (!emit_applies(m, PEEPHOLE_form))
        select_mad_aside(m, to, &a, &b, &c);
    else if (c.reg == to && a.reg != to && b.reg != to)
        add_in_place(m, to, &a, &b);
    else if (a.reg == to && c.reg != to)
        multiply_in_place(m, to, &b, &c);
    else if (b.reg == to && c.reg != to)
        multiply_in_place(m, to, &a, &c);
    else if (a.reg == to || b.reg == to) {
        /* The addend and a factor are the same value. */
        struct location addend = {.value = c.value, .reg = SCRATCH_SECOND};
        encode_copy(&m->encoder, m->length, SCRATCH_SECOND, c.reg);
        multiply_in_place(m, to, a.reg == to ? &b : &a, &addend);
    } else if (a.reg == NO_REGISTER && c.reg != NO_REGISTER) {
        emit_bring(m, to, &a);
        multiply_in_place(m, to, &b, &c);
    } else if (b.reg == NO_REGISTER && c.reg != NO_REGISTER) {
        emit_bring(m, to, &b);
        multiply_in_place(m, to, &a, &c);
    } else {
        emit_bring(m, to, &c);
        add_in_place(m, to, &a, &b);
    }
}

/* --- One lane ------------------------------------------------------------------------------------------ */

static void select_merge(struct emitter *m, const struct rule *rule, const struct ir_instruction *i)
{
    struct location a = emit_locate(m, i->operand[0]);
    unsigned from = emit_need_register(m, &a, SCRATCH_FIRST), to = emit_result_register(m);
    if (rule->form == FORM_MERGE_ROUND)
        encode_rrri(&m->encoder, rule->instruction, m->length, to, from, from, rule->immediate);
    else
        encode_rrr(&m->encoder, rule->instruction, m->length, to, from, from);
}

static void select_to_integer(struct emitter *m, const struct rule *rule, const struct ir_instruction *i)
{
    struct location a = emit_locate(m, i->operand[0]);
    if (emit_folds(m, rule->instruction, &a))
        encode_rm(&m->encoder, rule->instruction, m->length, X86_RAX, a.address);
    else
        encode_rr(&m->encoder, rule->instruction, m->length, X86_RAX,
                  emit_need_register(m, &a, SCRATCH_FIRST));
    encode_rr(&m->encoder, X86_vmovd, m->length, emit_result_register(m), X86_RAX);
}

static void select_from_integer(struct emitter *m, const struct rule *rule, const struct ir_instruction *i)
{
    struct location a = emit_locate(m, i->operand[0]);
    unsigned from = emit_need_register(m, &a, SCRATCH_FIRST);
    encode_rr(&m->encoder, X86_vmovd_store, m->length, X86_RAX, from);
    encode_rrr(&m->encoder, rule->instruction, m->length, emit_result_register(m), from, X86_RAX);
}

void emit_computed(struct emitter *m, const struct ir_instruction *i)
{
    const struct rule *rule = &rules[i->op], *wide = &wide_rules[i->op], *scalar = &scalar_rules[i->op];
    if (emit_is_wide(m) && wide->form && (wide->form != FORM_MASKS || i->type == TYPE_msk))
        rule = wide;
    if (emit_is_scalar(m) && scalar->form)
        rule = scalar;
    bool commutes = ir_properties(i) & IR_COMMUTES;
    switch (rule->form) {
    case FORM_BINARY: select_binary(m, rule, i->operand[0], i->operand[1], commutes); break;
    case FORM_REVERSED: select_binary(m, rule, i->operand[1], i->operand[0], false); break;
    case FORM_COMPARE: select_compare(m, rule, i); break;
    case FORM_UNARY:
    case FORM_ROUND: select_unary(m, rule, i); break;
    case FORM_SHIFT: select_shift(m, rule, i); break;
    case FORM_ROTATE: select_rotate(m, rule, i); break;
    case FORM_PLACES: select_places(m, rule, i); break;
    case FORM_NEGATE: select_negate(m, i); break;
    case FORM_HALF: select_half(m, rule, i); break;
    case FORM_MAD: select_mad(m, i); break;
    case FORM_SELECT: select_select(m, i); break;
    case FORM_BLEND: select_blend(m, i); break;
    case FORM_TEST: select_compare_masks(m, rule, i); break;
    case FORM_MASKS: select_masks(m, rule, i); break;
    case FORM_MERGE:
    case FORM_MERGE_ROUND: select_merge(m, rule, i); break;
    case FORM_TO_INTEGER: select_to_integer(m, rule, i); break;
    case FORM_FROM_INTEGER: select_from_integer(m, rule, i); break;
    }
}
