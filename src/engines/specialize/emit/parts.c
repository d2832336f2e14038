/* The loops of programs in two parts (passes/early.c): the first part for each block of a group, which writes
 * the block's entry of the table at ROW; then the second part for each of them, which reads the entry; then
 * the next group. FRAME_RUN and FRAME_RUN_END are the bounds of the group. */
#include "engines/specialize/emit/emit.h"
#include "engines/specialize/emit/frame.h"

enum { GROUP_MOST = 32, TABLE_MOST = 4096 /* bytes: it stays in the nearest cache */ };

static int32_t part_bytes(const struct emitter *m)
{
    return (int32_t)(m->ir->early_words * m->width * 4);
}

/* The blocks of a group. */
static int32_t group_blocks(const struct emitter *m)
{
    return part_bytes(m) * GROUP_MOST > TABLE_MOST ? TABLE_MOST / part_bytes(m) : GROUP_MOST;
}

int32_t emit_early_table_bytes(const struct emitter *m)
{
    return group_blocks(m) * part_bytes(m);
}

/* Returns true if the part that begins after instruction `from` accesses words at a base. */
static bool accesses(const struct emitter *m, uint32_t from, enum base base)
{
    for (uint32_t n = from + 1; n < m->ir->count && m->ir->instruction[n].op != IR_rest; n++)
        if (m->ir->instruction[n].base == base &&
            ir_properties(&m->ir->instruction[n]) & (IR_READS | IR_WRITES))
            return true;
    return false;
}

/* A part of a block, after instruction `from`. */
static void begin_part(struct emitter *m, uint32_t head, uint32_t from)
{
    encode_gpr_rm(&m->encoder, X86_lea, X86_64, ROW, emit_frame_at(m->frame_rows));
    encode_align(&m->encoder, 16);
    encode_label(&m->encoder, head);
    emit_begin_block(m, accesses(m, from, BASE_COLOR), accesses(m, from, BASE_DEPTH));
}

static void end_part(struct emitter *m, uint32_t head)
{
    struct encoder *e = &m->encoder;
    encode_gpr_ri(e, X86_add, X86_64, ENTRY, sizeof(struct entry));
    if (part_bytes(m))
        encode_gpr_ri(e, X86_add, X86_64, ROW, part_bytes(m));
    encode_gpr_rm(e, X86_cmp, X86_64, ENTRY, emit_frame_at(FRAME_RUN_END));
    encode_jump_if(e, X86_IF_b, head);
}

/* The end of the first part, at the instruction `rest`. */
void emit_rest(struct emitter *m)
{
    end_part(m, m->part_label);
    m->part_label = encode_add_label(&m->encoder);
    encode_gpr_rm(&m->encoder, X86_mov, X86_64, ENTRY, emit_frame_at(FRAME_RUN));
    begin_part(m, m->part_label, m->position);
}

/* Notes where the group begins and ends: at the end of the call, if not before. */
static void begin_group(struct emitter *m)
{
    struct encoder *e = &m->encoder;
    uint32_t bounded = encode_add_label(e);
    encode_gpr_mr(e, X86_mov, X86_64, emit_frame_at(FRAME_RUN), ENTRY);
    encode_gpr_rm(e, X86_lea, X86_64, X86_RAX,
                  address_at(ENTRY, group_blocks(m) * (int32_t)sizeof(struct entry)));
    encode_gpr_rm(e, X86_cmp, X86_64, X86_RAX, emit_frame_at(FRAME_LIMIT));
    encode_jump_if(e, X86_IF_b, bounded);
    encode_gpr_rm(e, X86_mov, X86_64, X86_RAX, emit_frame_at(FRAME_LIMIT));
    encode_label(e, bounded);
    encode_gpr_mr(e, X86_mov, X86_64, emit_frame_at(FRAME_RUN_END), X86_RAX);
}

void emit_open_parts(struct emitter *m)
{
    struct encoder *e = &m->encoder;
    encode_gpr_mr(e, X86_mov, X86_64, emit_frame_at(FRAME_LIMIT), LIMIT);
    encode_gpr_rr(e, X86_cmp, X86_64, ENTRY, LIMIT);
    encode_jump_if(e, X86_IF_nb, LABEL_DONE);
    encode_label(e, LABEL_LOOP);
    begin_group(m);
    m->part_label = encode_add_label(e);
    begin_part(m, m->part_label, ir_find_body(m->ir) - 1);
}

void emit_close_parts(struct emitter *m)
{
    struct encoder *e = &m->encoder;
    end_part(m, m->part_label);
    encode_gpr_rm(e, X86_cmp, X86_64, ENTRY, emit_frame_at(FRAME_LIMIT));
    encode_jump_if(e, X86_IF_b, LABEL_LOOP);
    encode_label(e, LABEL_DONE);
}
