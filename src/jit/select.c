/* Instruction selection: each IR instruction as one or a few machine instructions.
 *
 * Operands that live in memory (literals, frame constants, spilled values, loads used once) are memory
 * operands where the instruction has room for one, and are loaded into a scratch register elsewhere.
 * Three-operand VEX encodings need no copies; a fused multiply-add overwrites one of its operands, and the
 * form 132, 213 or 231 is chosen by which one shares the result's register. Peephole rules stand where they
 * apply: a selection with zero is a bitwise and, zero is made by an exclusive or, comparisons swap sides to
 * keep memory on the right.
 *
 * Sixteen lanes are EVEX's: masks are in registers of their own, and what is the same for all lanes is broadcast
 * from four bytes by the instruction that uses it, if it is one of 32-bit elements.
 *
 * Lanes are in memory order, so loads and stores are plain moves. Gathers and scatters have files of
 * their own (gather.c, scatter.c). */
#include "jit/emit.h"

enum form {
    FORM_NONE,
    FORM_BINARY,   /* D = a op b */
    FORM_REVERSED, /* D = b op a, for and-not */
    FORM_COMPARE,  /* predicate */
    FORM_UNARY,
    FORM_ROUND, /* rounding mode */
    FORM_SHIFT,
    FORM_NEGATE,
    FORM_HALF, /* there and back */
    FORM_MAD,
    FORM_SELECT,
    FORM_BLEND, /* the forms of mask registers */
    FORM_TEST,  /* predicate */
    FORM_MASKS
};

struct rule {
    uint16_t instruction; /* enum x86_vector */
    uint8_t form;
    uint8_t immediate;
};

static const struct rule rules[IR_OP_COUNT] = {
    [IR_add_f] = {X86_vaddps, FORM_BINARY, 0},
    [IR_sub_f] = {X86_vsubps, FORM_BINARY, 0},
    [IR_mul_f] = {X86_vmulps, FORM_BINARY, 0},
    [IR_div_f] = {X86_vdivps, FORM_BINARY, 0},
    [IR_mad_f] = {X86_vfmadd231ps, FORM_MAD, 0},
    [IR_sqrt_f] = {X86_vsqrtps, FORM_UNARY, 0},
    [IR_min_f] = {X86_vminps, FORM_BINARY, 0},
    [IR_max_f] = {X86_vmaxps, FORM_BINARY, 0},
    [IR_neg_f] = {X86_vxorps, FORM_NEGATE, 0},
    [IR_floor_f] = {X86_vroundps, FORM_ROUND, X86_ROUND_DOWN},
    [IR_half_f] = {X86_vcvtps2ph, FORM_HALF, 0 /* nearest even */},
    [IR_select_f] = {X86_vblendvps, FORM_SELECT, 0},
    [IR_lt_f] = {X86_vcmpps, FORM_COMPARE, X86_CMP_LT},
    [IR_le_f] = {X86_vcmpps, FORM_COMPARE, X86_CMP_LE},
    [IR_eq_f] = {X86_vcmpps, FORM_COMPARE, X86_CMP_EQ},
    [IR_ne_f] = {X86_vcmpps, FORM_COMPARE, X86_CMP_NEQ},
    [IR_round_i] = {X86_vcvtps2dq, FORM_UNARY, 0},
    [IR_trunc_i] = {X86_vcvttps2dq, FORM_UNARY, 0},
    [IR_float_f] = {X86_vcvtdq2ps, FORM_UNARY, 0},
    [IR_add_i] = {X86_vpaddd, FORM_BINARY, 0},
    [IR_sub_i] = {X86_vpsubd, FORM_BINARY, 0},
    [IR_mul_i] = {X86_vpmulld, FORM_BINARY, 0},
    [IR_dot_i] = {X86_vpmaddwd, FORM_BINARY, 0},
    [IR_and_i] = {X86_vpand, FORM_BINARY, 0},
    [IR_or_i] = {X86_vpor, FORM_BINARY, 0},
    [IR_xor_i] = {X86_vpxor, FORM_BINARY, 0},
    [IR_min_i] = {X86_vpminsd, FORM_BINARY, 0},
    [IR_max_i] = {X86_vpmaxsd, FORM_BINARY, 0},
    [IR_eq_i] = {X86_vpcmpeqd, FORM_BINARY, 0},
    [IR_gt_i] = {X86_vpcmpgtd, FORM_BINARY, 0},
    [IR_select_i] = {X86_vblendvps, FORM_SELECT, 0},
    [IR_shl_i] = {X86_vpslld_immediate, FORM_SHIFT, 0},
    [IR_shr_i] = {X86_vpsrad_immediate, FORM_SHIFT, 0},
    [IR_ushr_i] = {X86_vpsrld_immediate, FORM_SHIFT, 0},
    [IR_add_x] = {X86_vpaddw, FORM_BINARY, 0},
    [IR_sub_x] = {X86_vpsubw, FORM_BINARY, 0},
    [IR_mul_x] = {X86_vpmullw, FORM_BINARY, 0},
    [IR_min_x] = {X86_vpminuw, FORM_BINARY, 0},
    [IR_shl_x] = {X86_vpsllw_immediate, FORM_SHIFT, 0},
    [IR_ushr_x] = {X86_vpsrlw_immediate, FORM_SHIFT, 0},
    [IR_and_m] = {X86_vpand, FORM_BINARY, 0},
    [IR_or_m] = {X86_vpor, FORM_BINARY, 0},
    [IR_andn_m] = {X86_vpandn, FORM_REVERSED, 0},
    [IR_permute] = {X86_vpermilps_immediate, FORM_SHIFT, 0},
};

/* Predicates of vpcmpd. */
enum { VPCMP_EQUAL = 0, VPCMP_LESS = 1, VPCMP_GREATER = 6 };

/* What is different with 16 lanes. */
static const struct rule wide_rules[IR_OP_COUNT] = {
    [IR_select_f] = {X86_vblendmps, FORM_BLEND, 0},
    [IR_select_i] = {X86_vblendmps, FORM_BLEND, 0},
    [IR_lt_f] = {X86_vcmpps_mask, FORM_TEST, X86_CMP_LT},
    [IR_le_f] = {X86_vcmpps_mask, FORM_TEST, X86_CMP_LE},
    [IR_eq_f] = {X86_vcmpps_mask, FORM_TEST, X86_CMP_EQ},
    [IR_ne_f] = {X86_vcmpps_mask, FORM_TEST, X86_CMP_NEQ},
    [IR_eq_i] = {X86_vpcmpd_mask, FORM_TEST, VPCMP_EQUAL},
    [IR_gt_i] = {X86_vpcmpd_mask, FORM_TEST, VPCMP_GREATER},
    [IR_and_m] = {X86_kandw, FORM_MASKS, 0},
    [IR_or_m] = {X86_korw, FORM_MASKS, 0},
    [IR_andn_m] = {X86_kandnw, FORM_MASKS, 0},
};

static void select_binary(struct emitter *m, const struct rule *rule, unsigned left, unsigned right,
                          int commutes)
{
    struct place a = place_of(m, left), b = place_of(m, right);
    if (commutes && a.reg == NO_REGISTER && a.addressable && b.reg != NO_REGISTER) {
        struct place swapped = a;
        a = b;
        b = swapped;
    }
    unsigned first = need_register(m, &a, SCRATCH_FIRST);
    if (folds(m, rule->instruction, &b))
        vector_rrm(&m->encoder, rule->instruction, m->length, result_register(m), first, b.address);
    else
        vector_rrr(&m->encoder, rule->instruction, m->length, result_register(m), first,
                   need_register(m, &b, SCRATCH_SECOND));
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
    struct place a = place_of(m, i->operand[0]), b = place_of(m, i->operand[1]);
    unsigned predicate = rule->immediate;
    if (a.reg == NO_REGISTER && a.addressable && b.reg != NO_REGISTER) {
        struct place swapped = a;
        a = b;
        b = swapped;
        predicate = swapped_predicate(predicate);
    }
    unsigned first = need_register(m, &a, SCRATCH_FIRST);
    if (folds(m, rule->instruction, &b))
        vector_rrmi(&m->encoder, rule->instruction, m->length, result_register(m), first, b.address,
                    predicate);
    else
        vector_rrri(&m->encoder, rule->instruction, m->length, result_register(m), first,
                    need_register(m, &b, SCRATCH_SECOND), predicate);
}

/* A comparison into a mask register. */
static void select_compare_masks(struct emitter *m, const struct rule *rule, const struct ir_instruction *i)
{
    struct place a = place_of(m, i->operand[0]), b = place_of(m, i->operand[1]);
    unsigned predicate = rule->immediate, to = result_register(m) - MASKS, right = i->operand[1];
    if (a.reg == NO_REGISTER && a.addressable && b.reg != NO_REGISTER) {
        struct place swapped = a;
        right = i->operand[0];
        a = b;
        b = swapped;
        predicate = rule->instruction == X86_vcmpps_mask ? swapped_predicate(predicate)
                    : predicate == VPCMP_GREATER         ? VPCMP_LESS
                                                         : predicate;
    }
    unsigned first = need_register(m, &a, SCRATCH_FIRST);
    if (rule->instruction == X86_vpcmpd_mask && predicate == VPCMP_EQUAL && is_zero(m, right))
        vector_rrr(&m->encoder, X86_vptestnmd, m->length, to, first, first);
    else if (folds(m, rule->instruction, &b))
        vector_rrmi(&m->encoder, rule->instruction, m->length, to, first, b.address, predicate);
    else
        vector_rrri(&m->encoder, rule->instruction, m->length, to, first,
                    need_register(m, &b, SCRATCH_SECOND), predicate);
}

/* The result's register may be read: the second operand is brought there when it has none. */
static void select_masks(struct emitter *m, const struct rule *rule, const struct ir_instruction *i)
{
    int reversed = rule->instruction == X86_kandnw;
    struct place a = place_of(m, i->operand[reversed]), b = place_of(m, i->operand[!reversed]);
    unsigned first = need_mask(m, &a, MASK_SCRATCH), second = need_mask(m, &b, MASK_RESULT);
    vector_rrr(&m->encoder, rule->instruction, X86_256, result_register(m) - MASKS, first, second);
}

static void select_unary(struct emitter *m, const struct rule *rule, const struct ir_instruction *i)
{
    struct place a = place_of(m, i->operand[0]);
    unsigned to = result_register(m);
    int in_memory = folds(m, rule->instruction, &a);
    unsigned from = in_memory ? 0 : need_register(m, &a, SCRATCH_FIRST);
    if (rule->form == FORM_ROUND && in_memory)
        vector_rmi(&m->encoder, rule->instruction, m->length, to, a.address, rule->immediate);
    else if (rule->form == FORM_ROUND)
        vector_rri(&m->encoder, rule->instruction, m->length, to, from, rule->immediate);
    else if (in_memory)
        vector_rm(&m->encoder, rule->instruction, m->length, to, a.address);
    else
        vector_rr(&m->encoder, rule->instruction, m->length, to, from);
}

static void select_shift(struct emitter *m, const struct rule *rule, const struct ir_instruction *i)
{
    struct place a = place_of(m, i->operand[0]);
    unsigned from = need_register(m, &a, SCRATCH_FIRST);
    vector_rri(&m->encoder, rule->instruction, m->length, result_register(m), from, (unsigned)i->k);
}

static void select_negate(struct emitter *m, const struct ir_instruction *i)
{
    struct place a = place_of(m, i->operand[0]);
    unsigned from = need_register(m, &a, SCRATCH_FIRST);
    vector_rrm(&m->encoder, X86_vxorps, m->length, result_register(m), from,
               literal_address(m, INT32_MIN, is_wide(m) ? LITERAL_ONCE : LITERAL_LANES));
}

static void select_half(struct emitter *m, const struct rule *rule, const struct ir_instruction *i)
{
    struct place a = place_of(m, i->operand[0]);
    unsigned from = need_register(m, &a, SCRATCH_FIRST);
    vector_rri(&m->encoder, rule->instruction, m->length, SCRATCH_SECOND, from, rule->immediate);
    vector_rr(&m->encoder, X86_vcvtph2ps, m->length, result_register(m), SCRATCH_SECOND);
}

/* mask ? b : c. With a zero on either side it is one bitwise operation. */
static void select_select(struct emitter *m, const struct ir_instruction *i)
{
    struct place mask = place_of(m, i->operand[0]);
    unsigned to = result_register(m);
    unsigned test = need_register(m, &mask, SCRATCH_FIRST);
    int zero_else = is_zero(m, i->operand[2]), zero_then = is_zero(m, i->operand[1]);
    if (zero_else || zero_then) {
        struct place other = place_of(m, i->operand[zero_else ? 1 : 2]);
        enum x86_vector operation = zero_else ? X86_vandps : X86_vandnps;
        if (other.reg == NO_REGISTER && other.addressable)
            vector_rrm(&m->encoder, operation, m->length, to, test, other.address);
        else
            vector_rrr(&m->encoder, operation, m->length, to, test, need_register(m, &other, SCRATCH_SECOND));
        return;
    }
    struct place then = place_of(m, i->operand[1]), otherwise = place_of(m, i->operand[2]);
    unsigned base = need_register(m, &otherwise, SCRATCH_SECOND);
    if (then.reg == NO_REGISTER && then.addressable)
        vector_rrmr(&m->encoder, X86_vblendvps, m->length, to, base, then.address, test);
    else
        vector_rrrr(&m->encoder, X86_vblendvps, m->length, to, base, need_register(m, &then, SCRATCH_RESULT),
                    test);
}

/* mask ? b : 0. */
static void select_or_zero(struct emitter *m, const struct place *mask, struct place *then)
{
    enum x86_vector how = then->address.broadcast ? X86_vbroadcastss : X86_vmovups;
    unsigned to = result_register(m);
    if (then->reg == NO_REGISTER && then->addressable) {
        then->address.broadcast = 0;
        vector_rm(&m->encoder, how, m->length, zeroed(to, need_mask(m, mask, MASK_SCRATCH)), then->address);
        return;
    }
    unsigned from = need_register(m, then, SCRATCH_RESULT);
    vector_rr(&m->encoder, X86_vmovaps, m->length, zeroed(to, need_mask(m, mask, MASK_SCRATCH)), from);
}

/* mask ? b : c by a mask register, which comes last: values that are masks themselves pass through the same scratch
 * registers. */
static void select_blend(struct emitter *m, const struct ir_instruction *i)
{
    struct place mask = place_of(m, i->operand[0]), then = place_of(m, i->operand[1]),
                 otherwise = place_of(m, i->operand[2]);
    unsigned to = result_register(m);
    if (is_zero(m, i->operand[2])) {
        select_or_zero(m, &mask, &then);
        return;
    }
    unsigned base = need_register(m, &otherwise, SCRATCH_SECOND);
    if (is_zero(m, i->operand[1])) {
        unsigned k = need_mask(m, &mask, MASK_SCRATCH);
        if (base != to)
            vector_copy(&m->encoder, m->length, to, base);
        vector_rrr(&m->encoder, X86_vxorps, m->length, masked(to, k), to, to);
    } else if (folds(m, X86_vblendmps, &then)) {
        unsigned k = need_mask(m, &mask, MASK_SCRATCH);
        vector_rrm(&m->encoder, X86_vblendmps, m->length, masked(to, k), base, then.address);
    } else {
        unsigned from = need_register(m, &then, SCRATCH_RESULT);
        unsigned k = need_mask(m, &mask, MASK_SCRATCH);
        vector_rrr(&m->encoder, X86_vblendmps, m->length, masked(to, k), base, from);
    }
}

/* to = to * x + y, or to = to * [x] + y, or to = to * x + [y]: the result's register holds a factor. */
static void multiply_in_place(struct emitter *m, unsigned to, const struct place *x, const struct place *y)
{
    if (y->reg == NO_REGISTER && y->addressable) {
        vector_rrm(&m->encoder, X86_vfmadd213ps, m->length, to, need_register(m, x, SCRATCH_FIRST),
                   y->address);
        return;
    }
    unsigned addend = need_register(m, y, SCRATCH_SECOND);
    if (x->reg == NO_REGISTER && x->addressable)
        vector_rrm(&m->encoder, X86_vfmadd132ps, m->length, to, addend, x->address);
    else
        vector_rrr(&m->encoder, X86_vfmadd213ps, m->length, to, need_register(m, x, SCRATCH_FIRST), addend);
}

/* to = a * b + to: the result's register holds the addend. */
static void add_in_place(struct emitter *m, unsigned to, const struct place *a, const struct place *b)
{
    if (a->reg == NO_REGISTER && a->addressable && b->reg != NO_REGISTER) {
        const struct place *swapped = a;
        a = b;
        b = swapped;
    }
    unsigned first = need_register(m, a, SCRATCH_FIRST);
    if (b->reg == NO_REGISTER && b->addressable)
        vector_rrm(&m->encoder, X86_vfmadd231ps, m->length, to, first, b->address);
    else
        vector_rrr(&m->encoder, X86_vfmadd231ps, m->length, to, first, need_register(m, b, SCRATCH_SECOND));
}

static void select_mad(struct emitter *m, const struct ir_instruction *i)
{
    struct place a = place_of(m, i->operand[0]), b = place_of(m, i->operand[1]),
                 c = place_of(m, i->operand[2]);
    unsigned to = result_register(m);
    if (c.reg == to && a.reg != to && b.reg != to)
        add_in_place(m, to, &a, &b);
    else if (a.reg == to && c.reg != to)
        multiply_in_place(m, to, &b, &c);
    else if (b.reg == to && c.reg != to)
        multiply_in_place(m, to, &a, &c);
    else if (a.reg == to || b.reg == to) {
        /* The addend and a factor are the same value: keep the addend in a scratch register. */
        struct place addend = {.value = c.value, .reg = SCRATCH_SECOND};
        vector_copy(&m->encoder, m->length, SCRATCH_SECOND, c.reg);
        multiply_in_place(m, to, a.reg == to ? &b : &a, &addend);
    } else if (a.reg == NO_REGISTER && c.reg != NO_REGISTER) {
        bring(m, to, &a);
        multiply_in_place(m, to, &b, &c);
    } else if (b.reg == NO_REGISTER && c.reg != NO_REGISTER) {
        bring(m, to, &b);
        multiply_in_place(m, to, &a, &c);
    } else {
        bring(m, to, &c);
        add_in_place(m, to, &a, &b);
    }
}

static void select_variable(struct emitter *m, const struct ir_instruction *i)
{
    struct address variable = frame_address(m, m->frame_variables, (unsigned)i->k);
    int mask = is_wide(m) && i->type == TYPE_msk;
    struct place value = place_of(m, i->operand[0]);
    if (i->op == IR_get && mask)
        vector_rm(&m->encoder, X86_kmovw, X86_128, result_register(m) - MASKS, variable);
    else if (i->op == IR_get)
        vector_rm(&m->encoder, X86_vmovaps, m->length, result_register(m), variable);
    else
        store_register(m, variable,
                       mask ? MASKS + need_mask(m, &value, MASK_SCRATCH)
                            : need_register(m, &value, SCRATCH_FIRST));
}

static void select_memory(struct emitter *m, const struct ir_instruction *i)
{
    struct address at = address_at(base_register[i->base], i->k);
    if (i->op == IR_store) {
        struct place value = place_of(m, i->operand[0]);
        vector_mr(&m->encoder, X86_vmovups_store, m->length, at, need_register(m, &value, SCRATCH_FIRST));
    } else
        vector_rm(&m->encoder, i->op == IR_load ? X86_vmovups : X86_vbroadcastss, m->length,
                  result_register(m), at);
}

static void select_store_where(struct emitter *m, const struct ir_instruction *i)
{
    struct place value = place_of(m, i->operand[0]), mask = place_of(m, i->operand[1]);
    struct address at = address_at(base_register[i->base], i->k);
    unsigned from = need_register(m, &value, SCRATCH_FIRST);
    at.mask = (uint8_t)need_mask(m, &mask, MASK_SCRATCH);
    vector_mr(&m->encoder, X86_vmovups_store, m->length, at, from);
}

/* A literal for an instruction that broadcasts whatever it reads. */
enum { ONE = 0x3f800000 };

static struct address literal_word(struct emitter *m, int32_t bits)
{
    struct address word = literal_address(m, bits, LITERAL_ONCE);
    word.broadcast = 0;
    return word;
}

/* w: 1 where the plane of 1/w is 1 whatever the place, which its three words say. */
static void select_reciprocal(struct emitter *m, const struct ir_instruction *i)
{
    struct encoder *e = &m->encoder;
    struct place x = place_of(m, i->operand[0]), y = place_of(m, i->operand[1]);
    struct address value = address_at(base_register[i->base], i->k), dx = value, dy = value;
    uint32_t divide = encoder_add_label(e), done = encoder_add_label(e);
    unsigned to = result_register(m);
    dx.displacement += (int32_t)offsetof(struct plane, dx);
    dy.displacement += (int32_t)offsetof(struct plane, dy);
    vector_rm(e, X86_vbroadcastss, m->length, to, literal_word(m, ONE));
    gpr_mi(e, X86_cmp, X86_64, dx, 0);
    encode_jump_if(e, X86_IF_nz, divide);
    gpr_mi(e, X86_cmp, X86_32, value, ONE);
    encode_jump_if(e, X86_IF_z, done);
    encode_label(e, divide);
    vector_rm(e, X86_vbroadcastss, m->length, SCRATCH_SECOND, value);
    dx.broadcast = dy.broadcast = 1;
    vector_rrm(e, X86_vfmadd231ps, m->length, SCRATCH_SECOND, need_register(m, &y, SCRATCH_FIRST), dy);
    vector_rrm(e, X86_vfmadd231ps, m->length, SCRATCH_SECOND, need_register(m, &x, SCRATCH_FIRST), dx);
    vector_rrr(e, X86_vdivps, m->length, to, to, SCRATCH_SECOND);
    encode_label(e, done);
}

static void select_by_rule(struct emitter *m, const struct ir_instruction *i)
{
    const struct rule *rule = &rules[i->op], *wide = &wide_rules[i->op];
    if (is_wide(m) && wide->form && (wide->form != FORM_MASKS || i->type == TYPE_msk))
        rule = wide;
    int commutes = ir_op_information[i->op].properties & IR_COMMUTES;
    switch (rule->form) {
    case FORM_BINARY: select_binary(m, rule, i->operand[0], i->operand[1], commutes); break;
    case FORM_REVERSED: select_binary(m, rule, i->operand[1], i->operand[0], 0); break;
    case FORM_COMPARE: select_compare(m, rule, i); break;
    case FORM_UNARY:
    case FORM_ROUND: select_unary(m, rule, i); break;
    case FORM_SHIFT: select_shift(m, rule, i); break;
    case FORM_NEGATE: select_negate(m, i); break;
    case FORM_HALF: select_half(m, rule, i); break;
    case FORM_MAD: select_mad(m, i); break;
    case FORM_SELECT: select_select(m, i); break;
    case FORM_BLEND: select_blend(m, i); break;
    case FORM_TEST: select_compare_masks(m, rule, i); break;
    case FORM_MASKS: select_masks(m, rule, i); break;
    }
}

static void select_copy(struct emitter *m, const struct ir_instruction *i)
{
    struct place source = place_of(m, i->operand[0]);
    bring(m, result_register(m), &source);
}

static void select_instruction(struct emitter *m, const struct ir_instruction *i)
{
    switch (i->op) {
    case IR_gather: select_gather(m, i); break;
    case IR_reciprocal: select_reciprocal(m, i); break;
    case IR_store_where: select_store_where(m, i); break;
    case IR_coverage:
        vector_rm(&m->encoder, X86_kmovw, X86_128, result_register(m) - MASKS,
                  address_at(base_register[i->base], i->k));
        break;
    case IR_window: select_window(m, i); break;
    case IR_scatter: select_scatter(m, i); break;
    case IR_when: select_when(m, i); break;
    case IR_end: select_end(m); break;
    case IR_loop: select_loop(m); break;
    case IR_again: select_again(m, i); break;
    case IR_set:
    case IR_get: select_variable(m, i); break;
    case IR_load:
    case IR_uniform:
    case IR_store: select_memory(m, i); break;
    case IR_copy:
    case IR_phi: select_copy(m, i); break;
    case IR_next:
    case IR_join: break; /* written with the region's end */
    default: select_by_rule(m, i); break;
    }
}

/* Whether the instruction is where its value is put: not so for joins, nor for a phi that begins as a value
 * of its own web. */
static int writes_result(const struct emitter *m, const struct ir_instruction *i)
{
    const struct allocation *a = m->allocation;
    return i->op != IR_join &&
           (i->op != IR_phi || allocate_web(a, m->position) != allocate_web(a, i->operand[0]));
}

void store_spilled(struct emitter *m)
{
    unsigned slot = m->allocation->slot[allocate_web(m->allocation, m->position)];
    if (slot != NO_SLOT)
        store_register(m, slot_address(m, slot), result_register(m));
}

void emit_instructions(struct emitter *m, uint32_t end, int lines)
{
    m->selected = 0;
    for (; m->position < end && !m->exceeded; m->position++) {
        const struct ir_instruction *i = &m->ir->instruction[m->position];
        int effect = ir_op_information[i->op].properties & IR_EFFECT;
        if (!effect && (m->allocation->residence[m->position] != RESIDENCE_REGISTER || !writes_result(m, i)))
            continue;
        if (m->position >= m->selected) {
            if (lines)
                note_line(m, m->position);
            select_instruction(m, i);
        }
        if (!effect)
            store_spilled(m);
    }
}

void emit_body(struct emitter *m)
{
    m->position = 1;
    emit_instructions(m, m->ir->count, 1);
}
