/* Gathers of texels that lie close together: a window of the texture is loaded, and lanes choose in it.
 *
 * The window is eight texels wide and four rows high, two vectors: what one permutation of two registers can choose from.
 * It begins at the least x and the least y of the block's corners, found for both at once in the halves of words,
 *
 *   t = y << 16 | x        least = the least of t's halves over the corners      r = t - least
 *
 * and a lane's texel has the number r.x + 8 * r.y in it, if r.x and r.y are small enough in all lanes. Where four texels
 * are blended, the right neighbours have the next number, so that x has one place less, and the lower ones the same in a
 * window that begins a row below, if y' is y + 1 in all lanes. Otherwise, where a texture ends or is minified, texels are
 * gathered lane by lane.
 *
 *                 x
 *          +-----------------+
 *       y  | 0 1 2 3 ...   7 |  -.
 *          | 8 9 ...         |   |-. upper
 *          |                 |   | | window
 *          | 24 ...       31 |  -' |
 *          +-----------------+     | lower
 *            ...                  -' window
 *
 * Windows reach past what lanes ask for, at most four rows and eight texels: storage has so much room behind its last
 * texel (TEXTURE_MARGIN_ROWS). Coordinates of texels are below 2^15. */
#include "jit/emit.h"

enum { WINDOW_WIDTH = 8, WINDOW_HEIGHT = 4, CORNER_LANES = 5 };

static_assert((int)WINDOW_HEIGHT <= (int)TEXTURE_MARGIN_ROWS &&
                  (int)WINDOW_WIDTH <= (int)TEXTURE_MARGIN_TEXELS,
              "a window ends in its texture's margin");

/* Scratch registers by what they hold last. */
enum { NUMBERS = SCRATCH_RESULT, NEXT_NUMBERS = SCRATCH_FIRST, OTHER = SCRATCH_SECOND };

/* How many gathers stand behind the window at the current position; 0 if one of them has no register of its own, if there
 * are not 16 lanes, or if something else was put in between (the bisector's probes). */
static unsigned gathers(const struct emitter *m, const struct ir_instruction *window)
{
    const struct allocation *a = m->allocation;
    unsigned n = window->operand[1] == window->operand[2] ? 1 : 4;
    uint32_t last = m->position + window->scale;
    uint32_t used = 0;
    if (!is_wide(m))
        return 0;
    for (uint32_t at = last + 1 - n; at <= last; at++) {
        unsigned reg = a->reg[at];
        if (at >= m->ir->count || m->ir->instruction[at].op != IR_gather)
            return 0;
        if (a->residence[at] != RESIDENCE_REGISTER || reg == SCRATCH_RESULT || used >> reg & 1)
            return 0;
        used |= 1u << reg;
    }
    return n;
}

/* The least of the unsigned words at the same place of the lanes that are the block's corners, every fifth one: to all lanes
 * of NEXT_NUMBERS and, of one lane, to r12. In between nothing is less, unless perspective or a texture's edge make it so:
 * then lanes are out of the window. */
static void least_words(struct emitter *m, unsigned of)
{
    static const uint8_t orders[] = {0x4e, 0xb1};
    struct encoder *e = &m->encoder;
    vector_rm(e, X86_vmovups, X86_512, NEXT_NUMBERS, literal_address(m, CORNER_LANES, LITERAL_MULTIPLES));
    vector_rrr(e, X86_vpermd, X86_512, NEXT_NUMBERS, NEXT_NUMBERS, of);
    for (int half = 0; half < 2; half++) {
        vector_rri(e, X86_vpshufd, X86_128, OTHER, NEXT_NUMBERS, orders[half]);
        vector_rrr(e, X86_vpminuw, X86_128, NEXT_NUMBERS, NEXT_NUMBERS, OTHER);
    }
    vector_rr(e, X86_vmovd_store, X86_128, X86_R12, NEXT_NUMBERS);
    vector_rr(e, X86_vpbroadcastd, X86_512, NEXT_NUMBERS, NEXT_NUMBERS);
}

/* Each lane's place in the window, in words: x in the low ones, y in the high ones of NUMBERS. */
static void find_places(struct emitter *m, const struct ir_instruction *window)
{
    struct encoder *e = &m->encoder;
    struct place x = place_of(m, window->operand[0]), y = place_of(m, window->operand[1]);
    vector_rri(e, X86_vpslld_immediate, X86_512, NUMBERS, need_register(m, &y, SCRATCH_FIRST), 16);
    vector_rrr(e, X86_vpor, X86_512, NUMBERS, NUMBERS, need_register(m, &x, SCRATCH_FIRST));
    least_words(m, NUMBERS);
    vector_rrr(e, X86_vpsubw, X86_512, NUMBERS, NUMBERS, NEXT_NUMBERS);
}

/* Jumps to `far` unless all lanes are in the window. */
static void check_places(struct emitter *m, const struct ir_instruction *window, unsigned count, uint32_t far)
{
    struct encoder *e = &m->encoder;
    int32_t most = (WINDOW_WIDTH - 1 - (count > 1)) | (WINDOW_HEIGHT - 1) << 16;
    struct address one = literal_address(m, 1, LITERAL_ONCE);
    unsigned all = MASK_SCRATCH - MASKS, kept = all;
    if (count > 1) {
        struct place upper = place_of(m, window->operand[1]), lower = place_of(m, window->operand[2]);
        unsigned below = need_register(m, &lower, SCRATCH_SECOND);
        vector_rrr(e, X86_vpsubd, X86_512, OTHER, below, need_register(m, &upper, SCRATCH_FIRST));
        vector_rrmi(e, X86_vpcmpd_mask, X86_512, all, OTHER, one, 0);
        kept = masked(all, all);
    }
    vector_rrm(e, X86_vpminuw, X86_512, OTHER, NUMBERS, literal_address(m, most, LITERAL_LANES));
    vector_rrri(e, X86_vpcmpd_mask, X86_512, kept, OTHER, NUMBERS, 0);
    vector_rr(e, X86_kortestw, X86_128, all, all);
    encode_jump_if(e, X86_IF_nb, far);
}

/* The window's first texel to rax, the texels of one row to r12 and of three to r13. */
static void find_window(struct emitter *m, const struct ir_instruction *window)
{
    struct encoder *e = &m->encoder;
    struct address pitch = address_at(base_register[window->base], window->k);
    gpr_rr(e, X86_movzx16, X86_32, X86_R13, X86_R12);
    gpr_ri(e, X86_shr, X86_32, X86_R12, 16);
    gpr_rm(e, X86_imul, X86_32, X86_R12, pitch);
    gpr_rr(e, X86_add, X86_64, X86_R13, X86_R12);
    gpr_rm(e, X86_mov, X86_64, X86_RAX, address_at(base_register[window->base], window->field));
    gpr_rm(e, X86_lea, X86_64, X86_RAX, address_indexed(X86_RAX, X86_R13, 4, 0));
    gpr_rm(e, X86_mov, X86_32, X86_R12, pitch);
    gpr_rm(e, X86_lea, X86_64, X86_R13, address_indexed(X86_R12, X86_R12, 2, 0));
}

/* Two rows of the window, which begin at these addresses. */
static void load_two_rows(struct emitter *m, unsigned to, struct address first, struct address second)
{
    vector_rm(&m->encoder, X86_vmovups, X86_256, to, first);
    vector_rrmi(&m->encoder, X86_vinsertf64x4, X86_512, to, to, second, 1);
}

/* Rows 0 and 1, and 2 and 3. */
static void load_window(struct emitter *m, unsigned upper, unsigned lower)
{
    load_two_rows(m, upper, address_at(X86_RAX, 0), address_indexed(X86_RAX, X86_R12, 4, 0));
    load_two_rows(m, lower, address_indexed(X86_RAX, X86_R12, 8, 0), address_indexed(X86_RAX, X86_R13, 4, 0));
}

/* The lanes' texels and their right neighbours, from a window of which `left` holds rows 2 and 3 and `right` rows 0 and 1;
 * `numbers` is lost. */
static void choose_pairs(struct emitter *m, unsigned left, unsigned right, unsigned numbers)
{
    struct encoder *e = &m->encoder;
    vector_rrr(e, X86_vpermi2ps, X86_512, numbers, right, left);
    vector_rrr(e, X86_vpermt2ps, X86_512, right, NEXT_NUMBERS, left);
    vector_copy(e, X86_512, left, numbers);
}

/* What is near, into the registers of the gathers behind the window. */
static void choose(struct emitter *m, const struct ir_instruction *window, unsigned count)
{
    struct encoder *e = &m->encoder;
    const uint8_t *result = m->allocation->reg + m->position + window->scale + 1 - count;
    vector_rrm(e, X86_vpmaddwd, X86_512, NUMBERS, NUMBERS,
               literal_address(m, WINDOW_WIDTH << 16 | 1, LITERAL_LANES));
    if (count == 1) {
        load_window(m, result[0], OTHER);
        vector_rrr(e, X86_vpermt2ps, X86_512, result[0], NUMBERS, OTHER);
        return;
    }
    load_window(m, result[1], result[0]);
    gpr_rm(e, X86_lea, X86_64, X86_RAX, address_indexed(X86_RAX, X86_R12, 4, 0));
    load_window(m, result[3], result[2]);
    vector_rrm(e, X86_vpaddd, X86_512, NEXT_NUMBERS, NUMBERS, literal_address(m, 1, LITERAL_ONCE));
    vector_copy(e, X86_512, OTHER, NUMBERS);
    choose_pairs(m, result[0], result[1], OTHER);
    choose_pairs(m, result[2], result[3], NUMBERS);
}

/* What a window's gathers are given where they have no register. */
static void store_gathered(struct emitter *m, unsigned count, uint32_t last)
{
    for (m->position = last + 1 - count; m->position <= last; m->position++)
        store_spilled(m);
}

void select_window(struct emitter *m, const struct ir_instruction *window)
{
    unsigned count = gathers(m, window);
    uint32_t here = m->position, last = here + window->scale;
    if (!count)
        return;
    uint32_t far = encoder_add_label(&m->encoder), done = encoder_add_label(&m->encoder);
    find_places(m, window);
    check_places(m, window, count, far);
    find_window(m, window);
    choose(m, window, count);
    store_gathered(m, count, last);
    encode_jump(&m->encoder, done);
    encode_label(&m->encoder, far);
    m->position = here + 1;
    emit_instructions(m, last + 1, 0);
    m->position = last;
    encode_label(&m->encoder, done);
}
