/* Gathers of the span reading, whose texels are close together in the rows of a texture (passes/span/near.c).
 *
 * Eight lanes are two rows of four pixels, lanes 0 1 4 5 and 2 3 6 7. A row of texels has an address for each
 * row of pixels, in the row's entry: that of the texel with x = 0. A column of texels has its least x, the
 * places of its lanes from there on, and a class. The least x and the class are one word of the column's
 * entry:
 *
 *   x            all places are below 4: one texel a pixel, or magnified
 *   NEAR | x     all places are below 8: minified up to twice
 *   FAR          neither
 *
 * In the first case, the code of a hint loads the four texels from x on of both rows, and the lanes choose
 * from these eight. So the places of the lanes of the second row are four more.
 *
 *   a  a0 a1 a2 a3       b  b0 b1 b2 b3       ->       a0 a1 b0 b1 a2 a3 b2 b3
 *
 * The other two are outside of the routine's loops, and jump back. In the second, the lanes of each row
 * choose from eight texels of it. In the third, the gathers are as usual. The branches go the same way for
 * almost all blocks of a triangle.
 *
 * Of compact texels, eight bytes of each row are broadcast, and each lane takes the bytes from its texel on
 * (`vpshufb`). So places of bytes can be up to 7 in the first case, and there is no second one. If the right
 * neighbours are read too, they are up to 3. A clip mask has no margin: four bytes of each row are broadcast.
 *
 * Right neighbours of words are one texel further. So the last texel that is read is the eighth after the one
 * at x, and a texture's margin has eight. */
#include "engines/specialize/emit/emit.h"
#include "engines/specialize/emit/frame.h"
#include "ir/near.h"

enum { REACH = 8, HALF = 4, NEAR = INT32_MIN, FAR = -1 };

static_assert((int)REACH <= (int)TEXTURE_MARGIN_TEXELS, "eight texels after one are in its texture's margin");

/* The place of the second row's first pixel, and its lanes. */
enum { SECOND_FIRST = 2, SECOND_ROW = 0xcc, HIGH_HALVES = 0xaa };

/* The registers with the addresses of a row of texels for two rows of pixels. Where the loop of blocks
 * accesses neither lanes nor depth, their registers have those of another row of texels. */
enum { STAYING = 2 };
static const uint8_t row_register[STAYING][2] = {{X86_R12, X86_R13}, {DEPTH, LANES}};

/* Returns true if the gathers of the hint at a position have registers of their own, and no other instruction
 * was inserted between them (the bisector's probes). */
static bool is_possible(const struct emitter *m, uint32_t position)
{
    const struct allocation *a = m->allocation;
    const struct ir_instruction *hint = &m->ir->instruction[position];
    uint32_t last = position + hint->scale, used = 0;
    if (last >= m->ir->count)
        return false;
    for (uint32_t at = last + 1 - ir_near_gathers(hint->k); at <= last; at++) {
        const struct ir_instruction *i = &m->ir->instruction[at];
        unsigned reg = a->reg[at];
        if (i->op != IR_gather || i->field != hint->field || a->residence[at] != RESIDENCE_REGISTER ||
            reg == SCRATCH_RESULT || used >> reg & 1)
            return false;
        used |= 1u << reg;
    }
    return true;
}

/* Where the addresses of a row of texels stay, or their number if that is nowhere. */
static unsigned place_of_row(const struct emitter *m, unsigned row)
{
    unsigned place = 0;
    while (place < m->rows_stay && m->staying[place] != row)
        place++;
    return place;
}

/* Adds the rows of a hint to those that stay. Returns false if there is no room. */
static bool add_rows(struct emitter *m, const struct ir_instruction *hint, unsigned room)
{
    for (unsigned other = 0; other < 2; other++) {
        unsigned row = ir_near_row(hint->k, other), place = place_of_row(m, row);
        if (place == room)
            return false;
        m->staying[place] = (uint8_t)row;
        m->rows_stay += place == m->rows_stay;
    }
    return true;
}

/* Finds the rows of texels whose addresses can stay in registers from a position on to the program's end:
 * those of all hints, if nothing else uses the registers; else none. */
static void find_staying_rows(struct emitter *m, uint32_t from)
{
    bool busy = emit_chunks_access(m, BASE_LANES) || emit_chunks_access(m, BASE_DEPTH);
    uint32_t hints = 0;
    bool stay = true;
    m->rows_stay = 0;
    for (uint32_t n = from; n < m->ir->count && stay; n++) {
        const struct ir_instruction *i = &m->ir->instruction[n];
        stay = i->op != IR_gather && i->op != IR_scatter;
        if (i->op != IR_near)
            continue;
        stay = is_possible(m, n) && add_rows(m, i, busy ? 1 : STAYING) && ++hints <= OTHER_WAYS;
        n += i->scale;
    }
    m->rows_stay = stay ? m->rows_stay : 0;
}

/* --- What is noted -------------------------------------------------------------------------------------- */

int32_t emit_near_places(const struct emitter *m, unsigned column)
{
    return (int32_t)((m->ir->near_words + column) * m->width * 4);
}

int32_t emit_near_first(const struct emitter *m, unsigned column)
{
    return (int32_t)((m->ir->near_words + m->ir->near_columns) * m->width * 4 + column * 4);
}

static struct address places_of(const struct emitter *m, unsigned column)
{
    return address_at(emit_base_register[BASE_COLUMN], emit_near_places(m, column));
}

static struct address first_of(const struct emitter *m, unsigned column)
{
    return address_at(emit_base_register[BASE_COLUMN], emit_near_first(m, column));
}

static struct address row_of(const struct emitter *m, unsigned row, unsigned second)
{
    return address_at(emit_base_register[BASE_ROW], emit_texel_row(m, row, second));
}

void emit_find_least(struct emitter *m, unsigned to, unsigned of, unsigned other)
{
    static const uint8_t orders[] = {0x4e, 0xb1};
    struct encoder *e = &m->encoder;
    encode_rri(e, X86_vextracti128, X86_256, other, of, 1);
    encode_rrr(e, X86_vpminsd, X86_128, to, of, other);
    for (int half = 0; half < 2; half++) {
        encode_rri(e, X86_vpshufd, X86_128, other, to, orders[half]);
        encode_rrr(e, X86_vpminsd, X86_128, to, to, other);
    }
    encode_rr(e, X86_vpbroadcastd, X86_256, to, to);
}

/* Makes the places of words those of both rows' four texels together; those of compact texels, the bytes that
 * each lane takes from both rows' eight bytes. */
static void join_places(struct emitter *m, unsigned places, unsigned other, unsigned texel)
{
    enum { BYTES = 0x03020100, EACH = 0x01010101 };
    struct encoder *e = &m->encoder;
    int32_t second = texel == 4 ? HALF : 8 * EACH;
    if (texel != 4) {
        encode_rrm(e, X86_vpmulld, X86_256, places, places,
                   emit_literal_address(m, (int32_t)texel * EACH, LITERAL_LANES));
        encode_rrm(e, X86_vpaddd, X86_256, places, places, emit_literal_address(m, BYTES, LITERAL_LANES));
    }
    encode_rrr(e, X86_vpxor, X86_256, other, other, other);
    encode_rrmi(e, X86_vpblendd, X86_256, other, other, emit_literal_address(m, second, LITERAL_LANES),
                SECOND_ROW);
    encode_rrr(e, X86_vpaddd, X86_256, places, places, other);
}

/* Adds the class of the places in `places` to the least x in eax, and makes them those of its class; `other`
 * is overwritten. No texel has a negative x. */
static void add_class(struct emitter *m, const struct ir_instruction *column, unsigned places, unsigned other)
{
    struct encoder *e = &m->encoder;
    const bool bytes = column->scale == 1;
    uint32_t wide = encode_add_label(e), far = encode_add_label(e), done = encode_add_label(e);
    encode_gpr_rr(e, X86_test, X86_32, X86_RAX, X86_RAX);
    encode_jump_if(e, X86_IF_s, far);
    encode_rm(e, X86_vptest, X86_256, places,
              emit_literal_address(m, bytes && !column->field ? -REACH : -HALF, LITERAL_LANES));
    encode_jump_if(e, X86_IF_nz, wide);
    join_places(m, places, other, column->scale);
    encode_jump(e, done);
    encode_label(e, wide);
    if (!bytes) {
        encode_gpr_ri(e, X86_or, X86_32, X86_RAX, NEAR);
        encode_rm(e, X86_vptest, X86_256, places, emit_literal_address(m, -REACH, LITERAL_LANES));
        encode_jump_if(e, X86_IF_z, done);
    }
    encode_label(e, far);
    encode_gpr_ri(e, X86_or, X86_32, X86_RAX, FAR);
    encode_label(e, done);
}

/* Finds the least x in eax, and the places of a column's lanes from there on, with their class. */
static void find_places(struct emitter *m, const struct ir_instruction *column, unsigned lanes)
{
    struct encoder *e = &m->encoder;
    emit_find_least(m, SCRATCH_SECOND, lanes, SCRATCH_RESULT);
    encode_rr(e, X86_vmovd_store, X86_128, X86_RAX, SCRATCH_SECOND);
    encode_rrr(e, X86_vpsubd, X86_256, SCRATCH_SECOND, lanes, SCRATCH_SECOND);
    add_class(m, column, SCRATCH_SECOND, SCRATCH_RESULT);
}

/* The same of a copy's column: most are straight, and their first lane has the least x. */
static void find_linked_places(struct emitter *m, const struct ir_instruction *column, unsigned lanes)
{
    struct encoder *e = &m->encoder;
    uint32_t usual = encode_add_label(e), done = encode_add_label(e);
    emit_link_column(m, lanes, first_of(m, (unsigned)column->k), usual);
    join_places(m, SCRATCH_SECOND, SCRATCH_RESULT, column->scale);
    encode_jump(e, done);
    encode_label(e, usual);
    emit_break_column(m);
    find_places(m, column, lanes);
    encode_label(e, done);
}

void emit_near_column(struct emitter *m, const struct ir_instruction *i)
{
    struct encoder *e = &m->encoder;
    struct location x = emit_locate(m, i->operand[0]);
    unsigned lanes = emit_need_register(m, &x, SCRATCH_FIRST), column = (unsigned)i->k;
    if (m->copies)
        find_linked_places(m, i, lanes);
    else
        find_places(m, i, lanes);
    encode_mr(e, X86_vmovups_store, X86_256, places_of(m, column), SCRATCH_SECOND);
    encode_gpr_mr(e, X86_mov, X86_32, first_of(m, column), X86_RAX);
}

/* Returns true if the instruction after the current one notes the next row of the same texels. */
static bool notes_two_rows(const struct emitter *m, const struct ir_instruction *i)
{
    const struct ir_instruction *next = i + 1;
    return m->position + 1 < m->ir->count && next->op == IR_near_row && next->k == i->k + 1 &&
           next->base == i->base && next->field == i->field && next->scale == i->scale;
}

/* Two rows of texels have four addresses, which are computed together. */
static void note_two_rows(struct emitter *m, const struct ir_instruction *i)
{
    enum { SHIFT_MOST = 2, FIRST_LANES = 0x88 }; /* the two rows of pixels of both operands */
    struct encoder *e = &m->encoder;
    struct location y[2] = {emit_locate(m, i[0].operand[0]), emit_locate(m, i[1].operand[0])};
    unsigned first = emit_need_register(m, &y[0], SCRATCH_FIRST),
             second = emit_need_register(m, &y[1], SCRATCH_SECOND), shift = 0;
    while (shift < SHIFT_MOST && 1u << shift < i->scale)
        shift++;
    emit_load_pointer(m, i->base, i->field);
    encode_rr(e, X86_vmovq_gpr, X86_128, SCRATCH_RESULT, X86_RAX);
    encode_rr(e, X86_vpbroadcastq, X86_256, SCRATCH_RESULT, SCRATCH_RESULT);
    encode_rrri(e, X86_vshufps, X86_128, SCRATCH_FIRST, first, second, FIRST_LANES);
    encode_rr(e, X86_vpmovsxdq, X86_256, SCRATCH_FIRST, SCRATCH_FIRST);
    if (shift)
        encode_rri(e, X86_vpsllq_immediate, X86_256, SCRATCH_FIRST, SCRATCH_FIRST, (uint8_t)shift);
    encode_rrr(e, X86_vpaddq, X86_256, SCRATCH_FIRST, SCRATCH_FIRST, SCRATCH_RESULT);
    encode_mr(e, X86_vmovups_store, X86_256, row_of(m, (unsigned)i->k, 0), SCRATCH_FIRST);
    m->selected = m->position + 2;
}

void emit_near_row(struct emitter *m, const struct ir_instruction *i)
{
    struct encoder *e = &m->encoder;
    if (notes_two_rows(m, i)) {
        note_two_rows(m, i);
        return;
    }
    struct location y = emit_locate(m, i->operand[0]);
    unsigned lanes = emit_need_register(m, &y, SCRATCH_FIRST), row = (unsigned)i->k;
    const uint8_t *to = row_register[0];
    emit_load_pointer(m, i->base, i->field);
    encode_rr(e, X86_vmovd_store, X86_128, to[0], lanes);
    encode_rri(e, X86_vpextrd, X86_128, to[1], lanes, SECOND_FIRST);
    for (unsigned second = 0; second < 2; second++) {
        encode_gpr_rr(e, X86_movsxd, X86_64, to[second], to[second]);
        encode_gpr_rm(e, X86_lea, X86_64, to[second], address_indexed(X86_RAX, to[second], i->scale, 0));
        encode_gpr_mr(e, X86_mov, X86_64, row_of(m, row, second), to[second]);
    }
}

/* --- Loads ---------------------------------------------------------------------------------------------- */

/* How texels are loaded: the bytes of each; the place of their row's addresses in the registers; whether from
 * eight texels for each row of pixels; and whether they have no margin. */
struct near_load {
    unsigned texel, place;
    bool wide, bare;
};

/* The addresses of the texels at the least x in the rows of two rows of pixels. */
struct pair {
    struct address row[2];
};

static struct pair texels_of(const struct near_load *load, int32_t k)
{
    const uint8_t *row = row_register[load->place];
    return (struct pair){
        {address_indexed(row[0], X86_RAX, load->texel, k), address_indexed(row[1], X86_RAX, load->texel, k)}};
}

/* Chooses each lane's texel from those of both rows, by the places in a register. Of compact texels, each
 * lane gets the four bytes that begin at its texel. */
static void choose_of_both(struct emitter *m, const struct near_load *load, unsigned to, int32_t k)
{
    const enum x86_vector broadcast = load->bare ? X86_vpbroadcastd : X86_vpbroadcastq;
    struct encoder *e = &m->encoder;
    const struct pair texels = texels_of(load, k);
    if (load->texel == 4) {
        encode_rm(e, X86_vmovups, X86_128, to, texels.row[0]);
        encode_rrmi(e, X86_vinserti128, X86_256, to, to, texels.row[1], 1);
        encode_rrr(e, X86_vpermd, X86_256, to, SCRATCH_FIRST, to);
        return;
    }
    encode_rm(e, broadcast, X86_256, to, texels.row[0]);
    encode_rm(e, broadcast, X86_256, SCRATCH_SECOND, texels.row[1]);
    encode_rrri(e, X86_vpblendd, X86_256, to, to, SCRATCH_SECOND, SECOND_ROW);
    encode_rrr(e, X86_vpshufb, X86_256, to, to, SCRATCH_FIRST);
}

/* The same from eight texels of each lane's row. Bytes are not that far apart. */
static void choose_of_each(struct emitter *m, const struct near_load *load, unsigned to, int32_t k)
{
    struct encoder *e = &m->encoder;
    const struct pair texels = texels_of(load, k);
    const unsigned row[2] = {to, SCRATCH_SECOND};
    for (int r = 0; r < 2; r++) {
        if (load->texel == 4)
            encode_rrm(e, X86_vpermd, X86_256, row[r], SCRATCH_FIRST, texels.row[r]);
        else {
            encode_rm(e, X86_vpmovzxwd, X86_256, row[r], texels.row[r]);
            encode_rrr(e, X86_vpermd, X86_256, row[r], SCRATCH_FIRST, row[r]);
        }
    }
    encode_rrri(e, X86_vpblendd, X86_256, to, to, SCRATCH_SECOND, SECOND_ROW);
}

/* Loads texels to `to`, by the places in SCRATCH_FIRST. */
static void load_texels(struct emitter *m, const struct near_load *load, unsigned to, int32_t k)
{
    if (load->wide)
        choose_of_each(m, load, to, k);
    else
        choose_of_both(m, load, to, k);
}

/* Loads the words of a gather to its register: texels, and their right neighbours if there are `pairs`. */
static void load_words(struct emitter *m, const struct near_load *load, int32_t k, bool pairs)
{
    unsigned to = emit_result_register(m);
    load_texels(m, load, to, k);
    if (!pairs || load->texel == 1)
        return;
    load_texels(m, load, SCRATCH_RESULT, (int32_t)load->texel);
    encode_rri(&m->encoder, X86_vpslld_immediate, X86_256, SCRATCH_RESULT, SCRATCH_RESULT, 16);
    encode_rrri(&m->encoder, X86_vpblendw, X86_256, to, to, SCRATCH_RESULT, HIGH_HALVES);
}

/* --- Hints ---------------------------------------------------------------------------------------------- */

bool emit_rows_stay(struct emitter *m, uint32_t from)
{
    find_staying_rows(m, from);
    return m->rows_stay > 0;
}

static void load_row(struct emitter *m, unsigned row, unsigned place)
{
    for (unsigned second = 0; second < 2; second++)
        encode_gpr_rm(&m->encoder, X86_mov, X86_64, row_register[place][second], row_of(m, row, second));
}

static void load_staying_rows(struct emitter *m)
{
    for (unsigned place = 0; place < m->rows_stay; place++)
        load_row(m, m->staying[place], place);
}

/* The rows of texels of a copy's hint all stay in registers. */
static void open_copy(struct emitter *m)
{
    uint32_t at = m->position;
    while (m->ir->instruction[at].op != IR_near)
        at++;
    const struct ir_instruction *hint = &m->ir->instruction[at];
    const struct ir_instruction *last = hint + hint->scale, *first = last - 1;
    const uint8_t *rows[2];
    for (unsigned chunk = 0; chunk < 2; chunk++) {
        unsigned row = ir_near_row(hint->k, chunk && last->operand[0] != first->operand[0]);
        rows[chunk] = row_register[place_of_row(m, row)];
    }
    emit_straight_run(m, rows, first_of(m, ir_near_column(hint->k)));
}

void emit_open_rows(struct emitter *m)
{
    find_staying_rows(m, m->position);
    load_staying_rows(m);
    if (m->copies)
        open_copy(m);
}

/* Writes the loads of the hint's gathers, from texels of both rows or of each, and stores those that are
 * spilled. The hint is at the current position, which becomes that of its last gather. */
static void load_gathers(struct emitter *m, const struct ir_instruction *hint, bool wide)
{
    struct encoder *e = &m->encoder;
    struct near_load load = {.wide = wide, .bare = ir_near_bare(hint->k)};
    uint32_t last = m->position + hint->scale, at = last + 1 - ir_near_gathers(hint->k);
    const unsigned upper = m->ir->instruction[at].operand[0];
    unsigned loaded = UINT32_MAX;
    encode_rm(e, X86_vmovups, X86_256, SCRATCH_FIRST, places_of(m, ir_near_column(hint->k)));
    for (; at <= last; at++) {
        const struct ir_instruction *i = &m->ir->instruction[at];
        unsigned row = ir_near_row(hint->k, i->operand[0] != upper);
        if (row != loaded && !m->rows_stay)
            load_row(m, row, 0);
        loaded = row;
        load.place = m->rows_stay ? place_of_row(m, row) : 0;
        load.texel = i->scale;
        m->position = at;
        load_words(m, &load, i->k, ir_near_pairs(hint->k));
        emit_store_spilled(m);
    }
    m->position = last;
}

void emit_near(struct emitter *m, const struct ir_instruction *hint)
{
    struct encoder *e = &m->encoder;
    if (m->other_ways == OTHER_WAYS || !is_possible(m, m->position))
        return;
    struct other_way *other = &m->other_way[m->other_ways++];
    *other = (struct other_way){m->position, encode_add_label(e), encode_add_label(e)};
    encode_gpr_rm(e, X86_mov, X86_32, X86_RAX, first_of(m, ir_near_column(hint->k)));
    encode_gpr_rr(e, X86_test, X86_32, X86_RAX, X86_RAX);
    encode_jump_if(e, X86_IF_s, other->begin);
    load_gathers(m, hint, false);
    encode_label(e, other->after);
}

static void emit_other_way(struct emitter *m, const struct other_way *other)
{
    struct encoder *e = &m->encoder;
    const struct ir_instruction *hint = &m->ir->instruction[other->position];
    uint32_t far = encode_add_label(e);
    m->position = other->position;
    emit_note_line(m, m->position);
    encode_label(e, other->begin);
    if (m->ir->instruction[other->position + hint->scale].scale != 1) {
        encode_gpr_ri(e, X86_cmp, X86_32, X86_RAX, FAR);
        encode_jump_if(e, X86_IF_z, far);
        encode_gpr_ri(e, X86_and, X86_32, X86_RAX, ~NEAR);
        load_gathers(m, hint, true);
        encode_jump(e, other->after);
    }
    encode_label(e, far);
    m->position = other->position + 1;
    emit_instructions(m, other->position + hint->scale + 1, false);
    load_staying_rows(m);
    encode_jump(e, other->after);
}

void emit_other_ways(struct emitter *m)
{
    for (uint32_t i = 0; i < m->other_ways && !m->exceeded; i++)
        if (m->ir->instruction[m->other_way[i].position].op == IR_stretch)
            emit_far_texels(m, &m->other_way[i]);
        else
            emit_other_way(m, &m->other_way[i]);
}
