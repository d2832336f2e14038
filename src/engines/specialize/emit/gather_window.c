/* Gathers of texels that are close together: the code loads a window of the texture, and each lane chooses
 * its texels in it (passes/window.c).
 *
 * The window is eight texels wide and four rows high: two vectors, from which one permutation can choose. It
 * begins at the least x and the least y of the block's corners. Both are computed together, in the halves of
 * words:
 *
 *   t = y << 16 | x        least = the least of t's halves over the corners      r = t - least
 *
 * If r.x and r.y are small enough in all lanes, the number of a lane's texel in the window is r.x + 8 * r.y.
 * For a bilinear filter, the right neighbour has the next number, so the largest r.x is one less; the lower
 * neighbours have the same numbers in a second window that begins one row below, if y' is y + 1 in all lanes.
 * If a condition fails, as at a texture's border or under minification, texels are gathered lane by lane.
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
 * A window of 16 lanes reaches at most four rows and eight texels past a texel that a lane reads, one of 8
 * lanes eight texels: every texture has this padding after its last texel (TEXTURE_MARGIN_ROWS). Coordinates
 * of texels are below 2^15.
 *
 * Eight lanes are two rows of four pixels, lanes 0 1 4 5 and 2 3 6 7. Each has a window of eight texels that
 * begins at the texel of its first lane; for right neighbours another one, a texel further; and for lower
 * neighbours the same where those are. So two or eight permutations of texels in memory (`vpermd`) replace
 * the gathers, and the rows of pixels can be any distance apart. The condition:
 *
 *   0 <= index - index of the row's first lane < 8, also for the lower neighbours
 *
 * Compact texels have windows of 16 bytes. A lane's word begins at the byte of its texel, so a permutation of
 * bytes (`vpshufb`) takes it from there. The index of a texel of two bytes is less than 4 away.
 *
 * It fails if texels are passed from right to left, or across rows of the texture. A register counts windows
 * in vain: a failure adds PATIENCE, an attempt subtracts one, and there is no attempt while it is positive.
 * The windows of a routine have one count. */
#include "engines/specialize/emit/emit.h"

enum { WINDOW_WIDTH = 8, WINDOW_HEIGHT = 4, CORNER_LANES = 5, WINDOW_BYTES = 16 };

static_assert((int)WINDOW_HEIGHT <= (int)TEXTURE_MARGIN_ROWS &&
                  (int)WINDOW_WIDTH <= (int)TEXTURE_MARGIN_TEXELS &&
                  (int)WINDOW_BYTES <= (int)TEXTURE_MARGIN_TEXELS,
              "a window ends in its texture's margin");

/* Attempts that a window in vain puts off: enough that a texture without windows is about as fast as if there
 * were none. */
enum { PATIENCE = 16 };

/* Scratch registers, named by their last contents. */
enum { NUMBERS = SCRATCH_RESULT, NEXT_NUMBERS = SCRATCH_FIRST, OTHER = SCRATCH_SECOND };

/* The gathers of a window. With eight lanes they are all that belongs to it. */
static unsigned gathers_of(const struct emitter *m, const struct ir_instruction *window)
{
    if (!emit_is_wide(m))
        return window->scale;
    return window->operand[1] == window->operand[2] ? 1 : 4;
}

/* Returns true if an instruction is gather n of a window. With 16 lanes every gather is. */
static bool is_gather_of(const struct emitter *m, const struct ir_instruction *window, unsigned n,
                         const struct ir_instruction *i)
{
    bool same = emit_is_wide(m) || (i->operand[0] == window->operand[n / 2] && i->k == 4 * (int32_t)(n % 2) &&
                                    i->base == window->base && i->field == window->field);
    return i->op == IR_gather && same;
}

/* Returns true if an index leaves its register between the window and its last gather, so that a result can
 * have the register. With 16 lanes the coordinates are read before. */
static bool loses_index(const struct emitter *m, const struct ir_instruction *window)
{
    const struct allocation *a = m->allocation;
    for (int o = 0; o < 2 && !emit_is_wide(m); o++) {
        unsigned index = window->operand[o], split = a->split[allocate_web(a, index)];
        if (a->residence[index] == RESIDENCE_REGISTER && split >= m->position &&
            split < m->position + window->scale)
            return true;
    }
    return false;
}

/* The number of gathers that belong to the window at the current position; 0 if one of them has no register
 * of its own, if an index leaves its register, if a pass of the loop is not a block, or if another
 * instruction was inserted between them (the bisector's probes). */
static unsigned gathers(const struct emitter *m, const struct ir_instruction *window)
{
    const struct allocation *a = m->allocation;
    unsigned n = gathers_of(m, window);
    uint32_t last = m->position + window->scale;
    uint32_t used = 0;
    if (emit_lanes(m) != BLOCK_PIXELS || loses_index(m, window))
        return 0;
    for (uint32_t at = last + 1 - n; at <= last; at++) {
        unsigned reg = a->reg[at];
        if (at >= m->ir->count || !is_gather_of(m, window, at - (last + 1 - n), &m->ir->instruction[at]))
            return 0;
        if (a->residence[at] != RESIDENCE_REGISTER || reg == SCRATCH_RESULT || used >> reg & 1)
            return 0;
        used |= 1u << reg;
    }
    return n;
}

/* Computes the least x and y of the block's corners, which are every fifth lane, as unsigned 16-bit words: to
 * all lanes of NEXT_NUMBERS, and to r12. A lane between the corners can have a lesser one, due to perspective
 * or at a texture's border; then the lane is outside of the window. */
static void least_words(struct emitter *m, unsigned of)
{
    static const uint8_t orders[] = {0x4e, 0xb1};
    struct encoder *e = &m->encoder;
    encode_rm(e, X86_vmovups, X86_512, NEXT_NUMBERS,
              emit_literal_address(m, CORNER_LANES, LITERAL_MULTIPLES));
    encode_rrr(e, X86_vpermd, X86_512, NEXT_NUMBERS, NEXT_NUMBERS, of);
    for (int half = 0; half < 2; half++) {
        encode_rri(e, X86_vpshufd, X86_128, OTHER, NEXT_NUMBERS, orders[half]);
        encode_rrr(e, X86_vpminuw, X86_128, NEXT_NUMBERS, NEXT_NUMBERS, OTHER);
    }
    encode_rr(e, X86_vmovd_store, X86_128, X86_R12, NEXT_NUMBERS);
    encode_rr(e, X86_vpbroadcastd, X86_512, NEXT_NUMBERS, NEXT_NUMBERS);
}

/* Computes each lane's coordinates in the window, to the halves of NUMBERS: x to the low ones, y to the high
 * ones. */
static void find_coordinates(struct emitter *m, const struct ir_instruction *window)
{
    struct encoder *e = &m->encoder;
    struct location x = emit_locate(m, window->operand[0]), y = emit_locate(m, window->operand[1]);
    encode_rri(e, X86_vpslld_immediate, X86_512, NUMBERS, emit_need_register(m, &y, SCRATCH_FIRST), 16);
    encode_rrr(e, X86_vpor, X86_512, NUMBERS, NUMBERS, emit_need_register(m, &x, SCRATCH_FIRST));
    least_words(m, NUMBERS);
    encode_rrr(e, X86_vpsubw, X86_512, NUMBERS, NUMBERS, NEXT_NUMBERS);
}

/* Jumps to `far` unless all lanes are in the window. */
static void check_coordinates(struct emitter *m, const struct ir_instruction *window, unsigned count,
                              uint32_t far)
{
    struct encoder *e = &m->encoder;
    int32_t most = (WINDOW_WIDTH - 1 - (count > 1)) | (WINDOW_HEIGHT - 1) << 16;
    struct address one = emit_literal_address(m, 1, LITERAL_ONCE);
    unsigned all = MASK_SCRATCH - MASKS, kept = all;
    if (count > 1) {
        struct location upper = emit_locate(m, window->operand[1]),
                        lower = emit_locate(m, window->operand[2]);
        unsigned below = emit_need_register(m, &lower, SCRATCH_SECOND);
        encode_rrr(e, X86_vpsubd, X86_512, OTHER, below, emit_need_register(m, &upper, SCRATCH_FIRST));
        encode_rrmi(e, X86_vpcmpd_mask, X86_512, all, OTHER, one, 0);
        kept = masked(all, all);
    }
    encode_rrm(e, X86_vpminuw, X86_512, OTHER, NUMBERS, emit_literal_address(m, most, LITERAL_LANES));
    encode_rrri(e, X86_vpcmpd_mask, X86_512, kept, OTHER, NUMBERS, 0);
    encode_rr(e, X86_kortestw, X86_128, all, all);
    encode_jump_if(e, X86_IF_nb, far);
}

/* Computes the address of the window's first texel, to rax, and the texels in one row, to r12, and in three
 * rows, to r13. */
static void find_window(struct emitter *m, const struct ir_instruction *window)
{
    struct encoder *e = &m->encoder;
    struct address pitch = address_at(emit_base_register[window->base], window->k);
    encode_gpr_rr(e, X86_movzx16, X86_32, X86_R13, X86_R12);
    encode_gpr_ri(e, X86_shr, X86_32, X86_R12, 16);
    encode_gpr_rm(e, X86_imul, X86_32, X86_R12, pitch);
    encode_gpr_rr(e, X86_add, X86_64, X86_R13, X86_R12);
    emit_load_pointer(m, window->base, window->field);
    encode_gpr_rm(e, X86_lea, X86_64, X86_RAX, address_indexed(X86_RAX, X86_R13, 4, 0));
    encode_gpr_rm(e, X86_mov, X86_32, X86_R12, pitch);
    encode_gpr_rm(e, X86_lea, X86_64, X86_R13, address_indexed(X86_R12, X86_R12, 2, 0));
}

/* Loads two rows of the window. */
static void load_two_rows(struct emitter *m, unsigned to, struct address first, struct address second)
{
    encode_rm(&m->encoder, X86_vmovups, X86_256, to, first);
    encode_rrmi(&m->encoder, X86_vinsertf64x4, X86_512, to, to, second, 1);
}

/* Loads rows 0 and 1 to `upper`, and rows 2 and 3 to `lower`. */
static void load_window(struct emitter *m, unsigned upper, unsigned lower)
{
    load_two_rows(m, upper, address_at(X86_RAX, 0), address_indexed(X86_RAX, X86_R12, 4, 0));
    load_two_rows(m, lower, address_indexed(X86_RAX, X86_R12, 8, 0), address_indexed(X86_RAX, X86_R13, 4, 0));
}

/* Chooses the lanes' texels and their right neighbours, to `left` and `right`. Before, `right` has rows 0 and
 * 1 of the window and `left` rows 2 and 3. The code overwrites `numbers`. */
static void choose_pairs(struct emitter *m, unsigned left, unsigned right, unsigned numbers)
{
    struct encoder *e = &m->encoder;
    encode_rrr(e, X86_vpermi2ps, X86_512, numbers, right, left);
    encode_rrr(e, X86_vpermt2ps, X86_512, right, NEXT_NUMBERS, left);
    encode_copy(e, X86_512, left, numbers);
}

/* Chooses all texels, to the registers of the window's gathers. */
static void choose(struct emitter *m, const struct ir_instruction *window, unsigned count)
{
    struct encoder *e = &m->encoder;
    const uint8_t *result = m->allocation->reg + m->position + window->scale + 1 - count;
    encode_rrm(e, X86_vpmaddwd, X86_512, NUMBERS, NUMBERS,
               emit_literal_address(m, WINDOW_WIDTH << 16 | 1, LITERAL_LANES));
    if (count == 1) {
        load_window(m, result[0], OTHER);
        encode_rrr(e, X86_vpermt2ps, X86_512, result[0], NUMBERS, OTHER);
        return;
    }
    load_window(m, result[1], result[0]);
    encode_gpr_rm(e, X86_lea, X86_64, X86_RAX, address_indexed(X86_RAX, X86_R12, 4, 0));
    load_window(m, result[3], result[2]);
    encode_rrm(e, X86_vpaddd, X86_512, NEXT_NUMBERS, NUMBERS, emit_literal_address(m, 1, LITERAL_ONCE));
    encode_copy(e, X86_512, OTHER, NUMBERS);
    choose_pairs(m, result[0], result[1], OTHER);
    choose_pairs(m, result[2], result[3], NUMBERS);
}

/* Stores the results of the window's gathers that are spilled. */
static void store_gathered(struct emitter *m, unsigned count, uint32_t last)
{
    for (m->position = last + 1 - count; m->position <= last; m->position++)
        emit_store_spilled(m);
}

/* --- Eight lanes --------------------------------------------------------------------------------------- */

/* The lanes of the second row of pixels; the first lane of each lane's row, in the first half. */
enum { SECOND_ROW = 0xcc, FIRST_LANES = 0xa0, SECOND_FIRST = 2 };

/* Computes the place of each lane's texel in the window of its row. */
static void find_places(struct emitter *m, unsigned to, unsigned index)
{
    struct encoder *e = &m->encoder;
    encode_rrri(e, X86_vinserti128, X86_256, to, index, index, 1);
    encode_rri(e, X86_vpshufd, X86_256, to, to, FIRST_LANES);
    encode_rrr(e, X86_vpsubd, X86_256, to, index, to);
}

/* The bytes of a texel in the window at the current position. */
static unsigned texel_bytes(const struct emitter *m)
{
    return m->ir->instruction[m->position + 1].scale;
}

/* Jumps to `vain` unless all lanes are in windows. Their places are in NEXT_NUMBERS and, of lower neighbours,
 * in NUMBERS. */
static void check_places(struct emitter *m, unsigned count, uint32_t vain)
{
    const int32_t width = texel_bytes(m) == 2 ? WINDOW_WIDTH / 2 : WINDOW_WIDTH;
    struct encoder *e = &m->encoder;
    unsigned both = NEXT_NUMBERS;
    if (count > 1)
        encode_rrr(e, X86_vpor, X86_256, both = OTHER, NEXT_NUMBERS, NUMBERS);
    encode_rm(e, X86_vptest, X86_256, both, emit_literal_address(m, -width, LITERAL_LANES));
    encode_jump_if(e, X86_IF_nz, vain);
}

/* Copies the indices of the rows' first lanes to r12 and r13. */
static void find_rows(struct emitter *m, const struct location *index)
{
    unsigned lanes = emit_need_register(m, index, OTHER);
    encode_rr(&m->encoder, X86_vmovd_store, X86_128, X86_R12, lanes);
    encode_rri(&m->encoder, X86_vpextrd, X86_128, X86_R13, lanes, SECOND_FIRST);
}

/* Chooses the texels of both rows of pixels, `right` texels further, to `to`. */
static void choose_row(struct emitter *m, unsigned to, unsigned other, unsigned places, int right)
{
    struct encoder *e = &m->encoder;
    encode_rrm(e, X86_vpermd, X86_256, other, places, address_indexed(X86_RAX, X86_R13, 4, 4 * right));
    encode_rrm(e, X86_vpermd, X86_256, to, places, address_indexed(X86_RAX, X86_R12, 4, 4 * right));
    encode_rrri(e, X86_vblendps, X86_256, to, to, other, SECOND_ROW);
}

/* Makes the places of compact texels the bytes that each lane takes from its row's window. */
static void find_bytes(struct emitter *m, unsigned places, unsigned texel)
{
    enum { EACH = 0x04040404, BYTES = 0x03020100 };
    struct encoder *e = &m->encoder;
    encode_rrm(e, X86_vpshufb, X86_256, places, places, emit_literal_address(m, EACH, LITERAL_MULTIPLES));
    if (texel == 2)
        encode_rrr(e, X86_vpaddd, X86_256, places, places, places);
    encode_rrm(e, X86_vpaddd, X86_256, places, places, emit_literal_address(m, BYTES, LITERAL_LANES));
}

/* Chooses the compact texels of both rows of pixels, to `to`. */
static void choose_bytes(struct emitter *m, unsigned to, unsigned other, unsigned bytes, unsigned texel)
{
    struct encoder *e = &m->encoder;
    encode_rm(e, X86_vbroadcasti128, X86_256, other, address_indexed(X86_RAX, X86_R13, (uint8_t)texel, 0));
    encode_rm(e, X86_vbroadcasti128, X86_256, to, address_indexed(X86_RAX, X86_R12, (uint8_t)texel, 0));
    encode_rrr(e, X86_vpshufb, X86_256, other, other, bytes);
    encode_rrr(e, X86_vpshufb, X86_256, to, to, bytes);
    encode_rrri(e, X86_vpblendd, X86_256, to, to, other, SECOND_ROW);
}

/* The results of the lower neighbours can have the register of the upper index, which is read before. */
static void choose_rows(struct emitter *m, const struct ir_instruction *window, unsigned count)
{
    const unsigned texel = texel_bytes(m);
    const uint8_t *result = m->allocation->reg + m->position + 1;
    struct location upper = emit_locate(m, window->operand[0]), lower = emit_locate(m, window->operand[1]);
    emit_load_pointer(m, window->base, window->field);
    find_rows(m, &upper);
    if (texel != 4) {
        find_bytes(m, NEXT_NUMBERS, texel);
        choose_bytes(m, result[0], OTHER, NEXT_NUMBERS, texel);
        return;
    }
    choose_row(m, result[0], OTHER, NEXT_NUMBERS, 0);
    if (count == 1)
        return;
    choose_row(m, result[1], OTHER, NEXT_NUMBERS, 1);
    find_rows(m, &lower);
    choose_row(m, result[2], OTHER, NUMBERS, 0);
    choose_row(m, result[3], OTHER, NUMBERS, 1);
}

/* The same as below for eight lanes, up to the end of the texels' choice: jumps to `far` without an attempt,
 * and to `vain` after one. */
static void try_rows(struct emitter *m, const struct ir_instruction *window, unsigned count, uint32_t vain,
                     uint32_t far)
{
    struct location upper = emit_locate(m, window->operand[0]), lower = emit_locate(m, window->operand[1]);
    encode_gpr_ri(&m->encoder, X86_sub, X86_32, EMIT_VAIN, 1);
    encode_jump_if(&m->encoder, X86_IF_ns, far);
    find_places(m, NEXT_NUMBERS, emit_need_register(m, &upper, OTHER));
    if (count > 1)
        find_places(m, NUMBERS, emit_need_register(m, &lower, OTHER));
    check_places(m, count, vain);
    choose_rows(m, window, count);
}

/* --- Both ---------------------------------------------------------------------------------------------- */

static void emit_usual_path(struct emitter *m, uint32_t first, uint32_t last)
{
    m->position = first;
    emit_instructions(m, last + 1, false);
    m->position = last;
}

static void emit_row_window(struct emitter *m, const struct ir_instruction *window, unsigned count)
{
    struct encoder *e = &m->encoder;
    uint32_t here = m->position, last = here + window->scale;
    uint32_t vain = encode_add_label(e), far = encode_add_label(e), done = encode_add_label(e);
    try_rows(m, window, count, vain, far);
    store_gathered(m, count, last);
    encode_jump(e, done);
    encode_label(e, vain);
    encode_gpr_ri(e, X86_add, X86_32, EMIT_VAIN, PATIENCE);
    encode_label(e, far);
    emit_usual_path(m, here + 1, last);
    encode_label(e, done);
}

static void emit_block_window(struct emitter *m, const struct ir_instruction *window, unsigned count)
{
    uint32_t here = m->position, last = here + window->scale;
    uint32_t far = encode_add_label(&m->encoder), done = encode_add_label(&m->encoder);
    find_coordinates(m, window);
    check_coordinates(m, window, count, far);
    find_window(m, window);
    choose(m, window, count);
    store_gathered(m, count, last);
    encode_jump(&m->encoder, done);
    encode_label(&m->encoder, far);
    emit_usual_path(m, here + 1, last);
    encode_label(&m->encoder, done);
}

void emit_window(struct emitter *m, const struct ir_instruction *window)
{
    unsigned count = gathers(m, window);
    if (count && emit_is_wide(m))
        emit_block_window(m, window, count);
    else if (count)
        emit_row_window(m, window, count);
}
