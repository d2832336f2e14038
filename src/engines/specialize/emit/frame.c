/* The code around the body of a routine: prologue, loop over the elements, epilogue.
 *
 * Registers: rdi has the address of the arguments, the bases have fixed registers (below), rax, r12 and r13
 * are scratch, and rbx has the coverage of a block that is still ahead, or counts windows in vain. Of the
 * callee-saved registers, rbp, rbx, r12 and r13 are used, and r14 if the key has a shader.
 *
 * Stack frame, from rsp on, aligned to 64 bytes: the saved MXCSR, the contract's MXCSR, room for one value,
 * the constant table, the spill slots, the variables, the arguments and results of calls, and the registers
 * that are saved around a call (call.c). Each entry has W words, one for each lane. With 16 lanes or one
 * there is no constant table: instructions read the words of the job. Literals follow the code
 * (literal.c), so a routine can be copied anywhere.
 *
 * The preamble (passes/preamble.c) follows the prologue. Its results are in registers that the body does not
 * write, or in spill slots.
 *
 * The pixel loop iterates over entries, and in each 4x4 block over chunks of the lanes of one pass: those of
 * a register, times the parts of a value. Chunks without coverage are skipped, and the block ends when no
 * coverage is ahead. With 16 pixels a pass, a block is one chunk. Span.c has the loops of the span reading,
 * whose table of columns follows the saved registers, and parts.c those of a program in two parts. */
#include "machine/mxcsr.h"
#include "engines/specialize/emit/emit.h"
#include "engines/specialize/emit/frame.h"
#include "shader/program/program.h"

#include <assert.h>
#include <stddef.h>
#include <string.h>

const uint8_t emit_base_register[BASE_COUNT] = {
#define BASE(name, meaning) [BASE_##name] = name,
#include "def/base.def"
#undef BASE
};

struct address emit_base_address(enum base base, int32_t k)
{
    bool next = base == BASE_NEXT_COLOR || base == BASE_NEXT_DEPTH;
    return next ? address_indexed(emit_base_register[base], NEXT_BLOCK, 1, k)
                : address_at(emit_base_register[base], k);
}

static void note(struct emitter *m, uint32_t instruction, unsigned line)
{
    if (m->lines < sizeof m->line / sizeof m->line[0])
        m->line[m->lines++] =
            (struct code_line){(uint32_t)encode_size(&m->encoder), (uint16_t)instruction, (uint16_t)line};
}

void emit_note_line(struct emitter *m, uint32_t instruction)
{
    note(m, instruction, 0);
}

static void emit_note_frame_line(struct emitter *m, unsigned line)
{
    note(m, 0, line);
}

/* Notes a rule for unwinding from here on. */
static void note_unwind(struct emitter *m, enum debug_rule rule, unsigned reg, int32_t value)
{
    assert(m->unwinds < UNWIND_CAPACITY);
    m->unwind[m->unwinds++] = (struct debug_unwind){.offset = (uint32_t)encode_size(&m->encoder),
                                                    .rule = (uint8_t)rule,
                                                    .reg = (uint8_t)reg,
                                                    .value = value};
}

static void load(struct emitter *m, enum gpr to, size_t field)
{
    encode_gpr_rm(&m->encoder, X86_mov, X86_64, to, address_at(CALL, (int32_t)field));
}

static void broadcast_constants(struct emitter *m)
{
    for (uint32_t c = 0; emit_has_table(m) && c < m->ir->constant_count; c++) {
        const struct ir_constant *constant = &m->ir->constant[c];
        if (m->allocation->unread[c])
            continue;
        struct address slot = address_at(X86_RSP, m->frame_constants + (int32_t)(c * m->width * 4));
        encode_rm(&m->encoder, X86_vbroadcastss, m->length, 0,
                  address_at(emit_base_register[constant->base], constant->offset));
        encode_mr(&m->encoder, X86_vmovaps_store, m->length, slot, 0);
    }
}

enum { PAGE = 4096, UNROLLED_PAGES = 16 };

/* Touches every page of the frame, from the highest on, since the stack grows only when its guard page is
 * touched. */
static void probe_stack(struct emitter *m, int32_t bytes)
{
    for (int32_t page = PAGE; page < bytes; page += PAGE)
        encode_gpr_mi(&m->encoder, X86_mov, X86_32, address_at(X86_RSP, -page), 0);
}

/* The same in a loop that moves rsp along, for large frames: a system may refuse to grow the stack for an
 * access far below rsp. */
static void descend_stack(struct emitter *m, int32_t bytes)
{
    struct encoder *e = &m->encoder;
    encode_gpr_rm(e, X86_lea, X86_64, X86_RAX, address_at(X86_RSP, -bytes));
    encode_label(e, LABEL_PAGE);
    encode_gpr_ri(e, X86_sub, X86_64, X86_RSP, PAGE);
    encode_gpr_mi(e, X86_mov, X86_32, address_at(X86_RSP, 0), 0);
    encode_gpr_rr(e, X86_cmp, X86_64, X86_RSP, X86_RAX);
    encode_jump_if(e, X86_IF_nbe, LABEL_PAGE);
    encode_gpr_rr(e, X86_mov, X86_64, X86_RSP, X86_RAX);
}

static void reserve_frame(struct emitter *m, int32_t bytes)
{
    if (bytes > UNROLLED_PAGES * PAGE) {
        descend_stack(m, bytes);
        return;
    }
    probe_stack(m, bytes);
    encode_gpr_ri(&m->encoder, X86_sub, X86_64, X86_RSP, bytes);
}

/* The callee-saved registers, in the order in which they are saved below rbp. The last ones are saved only
 * if the key has a shader, and if a pass has two blocks. */
static const uint8_t saved[] = {AHEAD, X86_R12, X86_R13, CONSTANT, NEXT_BLOCK};

static bool has_two_blocks(const struct emitter *m)
{
    return emit_lanes(m) == 2 * BLOCK_PIXELS;
}

static int saved_registers(const struct emitter *m)
{
    return (int)sizeof saved - (has_two_blocks(m) ? 0 : m->constants ? 1 : 2);
}

/* For unwinding: the rules in the routine, whose frame has a base pointer. */
static void note_frame(struct emitter *m)
{
    note_unwind(m, DEBUG_CFA, X86_RBP, 16);
    note_unwind(m, DEBUG_SAVED, X86_RBP, 16);
    for (int i = 0; i < saved_registers(m); i++)
        note_unwind(m, DEBUG_SAVED, saved[i], 24 + 8 * i);
}

/* Writes the subroutines, and the code outside of the loops that jumps back there. */
static void write_outside(struct emitter *m)
{
    if (!m->ir->subroutines && !m->other_ways)
        return;
    note_frame(m);
    emit_subroutines(m);
    emit_note_frame_line(m, __LINE__);
    emit_other_ways(m);
}

static bool has_row_windows(const struct emitter *m)
{
    for (uint32_t i = 1; m->width == 8 && i < m->ir->count; i++)
        if (m->ir->instruction[i].op == IR_window)
            return true;
    return false;
}

static void prologue(struct emitter *m, size_t job_field)
{
    struct encoder *e = &m->encoder;
    uint32_t saved_around_calls = emit_prepare_calls(m);
    m->frame_constants = FRAME_HEAD;
    m->frame_slots =
        m->frame_constants + (int32_t)(emit_has_table(m) ? m->ir->constant_count * m->width * 4 : 0);
    m->frame_variables = m->frame_slots + (int32_t)(m->allocation->slots * m->width * 4);
    m->frame_saved = m->frame_variables + (int32_t)((m->ir->variables + m->ir->exchanged) * m->width * 4);
    m->frame_places = m->frame_saved + (int32_t)(saved_around_calls * m->width * 4);
    m->frame_columns = m->frame_places + emit_places_bytes(m);
    m->frame_rows = m->frame_columns + emit_table_bytes(m);
    m->frame_stretch =
        m->frame_rows + (emit_is_early(m) ? emit_early_table_bytes(m) : emit_row_table_bytes(m));
    int32_t bytes = m->frame_stretch + emit_stretch_bytes(m);
    emit_note_frame_line(m, __LINE__);
    encode_gpr_r(e, X86_push, X86_64, X86_RBP);
    note_unwind(m, DEBUG_CFA, X86_RSP, 16);
    note_unwind(m, DEBUG_SAVED, X86_RBP, 16);
    encode_gpr_rr(e, X86_mov, X86_64, X86_RBP, X86_RSP);
    note_unwind(m, DEBUG_CFA, X86_RBP, 16);
    for (int i = 0; i < saved_registers(m); i++) {
        encode_gpr_r(e, X86_push, X86_64, saved[i]);
        note_unwind(m, DEBUG_SAVED, saved[i], 24 + 8 * i);
    }
    reserve_frame(m, bytes);
    encode_gpr_ri(e, X86_and, X86_64, X86_RSP, -64);
    encode_m(e, X86_vstmxcsr, address_at(X86_RSP, FRAME_SAVED_MXCSR));
    encode_gpr_mi(e, X86_mov, X86_32, address_at(X86_RSP, FRAME_CONTRACT_MXCSR), MXCSR_CONTRACT);
    encode_m(e, X86_vldmxcsr, address_at(X86_RSP, FRAME_CONTRACT_MXCSR));
    load(m, JOB, job_field);
    if (m->constants)
        encode_gpr_rm(e, X86_mov, X86_64, CONSTANT, address_at(JOB, m->constants));
    broadcast_constants(m);
    if (has_row_windows(m))
        encode_gpr_rr(e, X86_xor, X86_32, EMIT_VAIN, EMIT_VAIN);
    emit_preamble(m);
    emit_load_kept(m);
}

static void epilogue(struct emitter *m)
{
    struct encoder *e = &m->encoder;
    emit_note_frame_line(m, __LINE__);
    encode_m(e, X86_vldmxcsr, address_at(X86_RSP, FRAME_SAVED_MXCSR));
    encode_none(e, X86_vzeroupper);
    for (int i = 0; i < saved_registers(m); i++) {
        encode_gpr_rm(e, X86_mov, X86_64, saved[i], address_at(X86_RBP, -8 - 8 * i));
        note_unwind(m, DEBUG_RESTORED, saved[i], 0);
    }
    encode_gpr_rr(e, X86_mov, X86_64, X86_RSP, X86_RBP);
    encode_gpr_r(e, X86_pop, X86_64, X86_RBP);
    note_unwind(m, DEBUG_CFA, X86_RSP, 8);
    note_unwind(m, DEBUG_RESTORED, X86_RBP, 0);
    encode_return(e);
}

/* LIMIT = INPUT + count * 2^shift, the size of an element. */
static void load_limit(struct emitter *m, size_t count_field, unsigned shift)
{
    struct encoder *e = &m->encoder;
    encode_gpr_rm(e, X86_mov, X86_32, LIMIT, address_at(CALL, (int32_t)count_field));
    encode_gpr_ri(e, X86_shl, X86_64, LIMIT, (int32_t)shift);
    encode_gpr_rr(e, X86_add, X86_64, LIMIT, INPUT);
}

static void begin_loop(struct emitter *m)
{
    encode_gpr_rr(&m->encoder, X86_cmp, X86_64, INPUT, LIMIT);
    encode_jump_if(&m->encoder, X86_IF_nb, LABEL_DONE);
    encode_align(&m->encoder, 16);
    encode_label(&m->encoder, LABEL_LOOP);
}

static void end_loop(struct emitter *m)
{
    encode_gpr_rr(&m->encoder, X86_cmp, X86_64, INPUT, LIMIT);
    encode_jump_if(&m->encoder, X86_IF_b, LABEL_LOOP);
    encode_label(&m->encoder, LABEL_DONE);
}

/* A loop over elements that reads a word and writes a word of each array. */
static void word_loop(struct emitter *m, size_t index_field, size_t out_field, size_t count_field)
{
    int32_t step = (int32_t)emit_lanes(m) * 4;
    emit_note_frame_line(m, __LINE__);
    load(m, INPUT, (int32_t)index_field);
    load(m, OUTPUT, (int32_t)out_field);
    load_limit(m, count_field, 2);
    begin_loop(m);
    emit_body(m);
    emit_note_frame_line(m, __LINE__);
    encode_gpr_ri(&m->encoder, X86_add, X86_64, INPUT, step);
    encode_gpr_ri(&m->encoder, X86_add, X86_64, OUTPUT, step);
    end_loop(m);
}

/* A loop over elements that reads a word and writes a record of `stride` bytes for each. */
static void record_loop(struct emitter *m, int32_t stride)
{
    begin_loop(m);
    emit_body(m);
    emit_note_frame_line(m, __LINE__);
    encode_gpr_ri(&m->encoder, X86_add, X86_64, INPUT, (int32_t)emit_lanes(m) * 4);
    encode_gpr_ri(&m->encoder, X86_add, X86_64, OUTPUT, (int32_t)emit_lanes(m) * stride);
    end_loop(m);
}

static void kernel_loop(struct emitter *m, const struct kernel_key *key)
{
    emit_note_frame_line(m, __LINE__);
    load(m, INPUT, offsetof(struct kernel_arguments, index));
    load(m, OUTPUT, offsetof(struct kernel_arguments, out));
    load_limit(m, offsetof(struct kernel_arguments, count), 2);
    record_loop(m, key->stride);
}

static void setup_loop(struct emitter *m, const struct setup_key *key)
{
    emit_note_frame_line(m, __LINE__);
    load(m, INPUT, offsetof(struct setup_arguments, index));
    load(m, OUTPUT, offsetof(struct setup_arguments, out));
    load(m, VERTICES, offsetof(struct setup_arguments, vertices));
    load_limit(m, offsetof(struct setup_arguments, count), 2);
    record_loop(m, layout_of_setup(key).stride);
}

/* Loads the base of the words of the block whose offset is in rax. */
static void begin_words(struct emitter *m, enum gpr base, size_t field)
{
    load(m, base, field);
    encode_gpr_rr(&m->encoder, X86_add, X86_64, base, X86_RAX);
}

void emit_begin_block(struct emitter *m, bool colors, bool depths)
{
    struct encoder *e = &m->encoder;
    encode_gpr_rm(e, X86_mov, X86_32, TRIANGLE, address_at(ENTRY, offsetof(struct entry, triangle)));
    encode_gpr_rm(e, X86_add, X86_64, TRIANGLE,
                  address_at(CALL, offsetof(struct pixel_arguments, triangles)));
    if (!colors && !depths)
        return;
    encode_gpr_rm(e, X86_movzx16, X86_32, X86_RAX, address_at(ENTRY, offsetof(struct entry, block)));
    encode_gpr_ri(e, X86_shl, X86_32, X86_RAX, 6); /* a block is 16 words */
    if (colors)
        begin_words(m, COLOR, offsetof(struct pixel_arguments, color));
    if (depths)
        begin_words(m, DEPTH, offsetof(struct pixel_arguments, depth));
}

static void walk_chunks(struct emitter *m)
{
    struct encoder *e = &m->encoder;
    int32_t step = (int32_t)emit_lanes(m) * 4;
    load(m, LANES, offsetof(struct pixel_arguments, lanes));
    encode_gpr_rm(e, X86_movzx16, X86_32, AHEAD, address_at(ENTRY, offsetof(struct entry, coverage)));
    encode_label(e, LABEL_CHUNK);
    encode_gpr_ri(e, X86_test, X86_32, AHEAD, (1 << emit_lanes(m)) - 1);
    encode_jump_if(e, X86_IF_z, LABEL_SKIP);
    emit_body(m);
    emit_note_frame_line(m, __LINE__);
    encode_label(e, LABEL_SKIP);
    encode_gpr_ri(e, X86_add, X86_64, COLOR, step);
    encode_gpr_ri(e, X86_add, X86_64, DEPTH, step);
    encode_gpr_ri(e, X86_add, X86_64, LANES, step);
    encode_gpr_ri(e, X86_shr, X86_32, AHEAD, (int32_t)emit_lanes(m));
    encode_jump_if(e, X86_IF_nz, LABEL_CHUNK);
}

/* The program's own loops go over the entries (span.c). */
static void span_loop(struct emitter *m)
{
    emit_note_frame_line(m, __LINE__);
    load(m, ENTRY, offsetof(struct pixel_arguments, entries));
    load_limit(m, offsetof(struct pixel_arguments, count), 4);
    encode_gpr_rr(&m->encoder, X86_cmp, X86_64, ENTRY, LIMIT);
    encode_jump_if(&m->encoder, X86_IF_nb, LABEL_DONE);
    encode_gpr_mr(&m->encoder, X86_mov, X86_64, address_at(X86_RSP, FRAME_LIMIT), LIMIT);
    emit_body(m);
    emit_note_frame_line(m, __LINE__);
    encode_label(&m->encoder, LABEL_DONE);
}

/* Finds the second block of a pass: that of the next entry, if it is another block with the same record, and
 * otherwise the first one again. Computing a block twice has no effect, because both compute the same at the
 * same time. Two entries of one block have an order, so they are in two passes. */
static void begin_next(struct emitter *m)
{
    struct encoder *e = &m->encoder;
    const int32_t next = sizeof(struct entry), triangle = offsetof(struct entry, triangle);
    const int32_t block = offsetof(struct entry, block);
    encode_gpr_rm(e, X86_lea, X86_64, NEXT_ENTRY, address_at(ENTRY, next));
    encode_gpr_rr(e, X86_cmp, X86_64, NEXT_ENTRY, LIMIT);
    encode_jump_if(e, X86_IF_nb, LABEL_SKIP);
    encode_gpr_rm(e, X86_mov, X86_32, X86_RAX, address_at(ENTRY, triangle));
    encode_gpr_rm(e, X86_cmp, X86_32, X86_RAX, address_at(NEXT_ENTRY, triangle));
    encode_jump_if(e, X86_IF_nz, LABEL_SKIP);
    encode_gpr_rm(e, X86_movzx16, X86_32, NEXT_BLOCK, address_at(NEXT_ENTRY, block));
    encode_gpr_rm(e, X86_movzx16, X86_32, X86_RAX, address_at(ENTRY, block));
    encode_gpr_rr(e, X86_sub, X86_64, NEXT_BLOCK, X86_RAX);
    encode_gpr_ri(e, X86_shl, X86_64, NEXT_BLOCK, 6);
    encode_jump_if(e, X86_IF_nz, LABEL_CHUNK);
    encode_label(e, LABEL_SKIP);
    encode_gpr_rr(e, X86_mov, X86_64, NEXT_ENTRY, ENTRY);
    encode_gpr_rr(e, X86_xor, X86_32, NEXT_BLOCK, NEXT_BLOCK);
    encode_label(e, LABEL_CHUNK);
}

/* Every entry has coverage. */
static void pixel_loop(struct emitter *m)
{
    bool whole = emit_lanes(m) >= BLOCK_PIXELS;
    emit_note_frame_line(m, __LINE__);
    load(m, ENTRY, offsetof(struct pixel_arguments, entries));
    load_limit(m, offsetof(struct pixel_arguments, count), 4);
    if (whole)
        load(m, LANES, offsetof(struct pixel_arguments, lanes));
    if (emit_is_early(m)) {
        emit_open_parts(m);
        emit_body(m);
        emit_note_frame_line(m, __LINE__);
        emit_close_parts(m);
        return;
    }
    begin_loop(m);
    emit_begin_block(m, true, true);
    if (has_two_blocks(m))
        begin_next(m);
    if (whole) {
        emit_body(m);
        emit_note_frame_line(m, __LINE__);
    } else
        walk_chunks(m);
    if (has_two_blocks(m))
        encode_gpr_rr(&m->encoder, X86_mov, X86_64, ENTRY, NEXT_ENTRY);
    encode_gpr_ri(&m->encoder, X86_add, X86_64, ENTRY, sizeof(struct entry));
    end_loop(m);
}

static size_t job_field(enum unit unit)
{
    static const size_t field[] = {
        offsetof(struct vertex_arguments, job), offsetof(struct setup_arguments, job),
        offsetof(struct pixel_arguments, job), offsetof(struct kernel_arguments, job),
        offsetof(struct blit_arguments, job)};
    return field[unit];
}

/* The offset in the job of the pointer to the shader's constants; 0 if the key has no shader. */
static int32_t constants_field(enum unit unit, const union key *key)
{
    const struct program *program = key_shader(unit, key);
    return program ? (int32_t)(offsetof(struct job, constants) + program->model->stage * sizeof(float *)) : 0;
}

size_t emit_routine(struct emitter *m, enum unit unit, const union key *key, struct error *error)
{
    encode_start(&m->encoder, m->code, m->silent ? 0 : sizeof m->code, m->labels, LABEL_FREE, m->fixups,
                 FIXUP_CAPACITY);
    if (m->textual && !m->silent)
        emit_start_text(m);
    m->literals = m->lines = m->pointers = m->other_ways = m->unwinds = m->regions = m->region_depth = 0;
    m->exceeded = NULL;
    memset(m->rules.fired, 0, sizeof m->rules.fired);
    m->keeps_scratch = m->holds_literal = false;
    if (m->allocation->slots > emit_most_slots(m->width))
        emit_note_exceeded(m, "spill slots", (int)emit_most_slots(m->width));
    m->constants = constants_field(unit, key);
    m->copies = unit == UNIT_PIXEL && emit_is_copy(m);
    m->rectangles = m->copies && emit_copies_rectangles(m->ir);
    prologue(m, job_field(unit));
    switch (unit) {
    case UNIT_VERTEX:
        word_loop(m, offsetof(struct vertex_arguments, index), offsetof(struct vertex_arguments, out),
                  offsetof(struct vertex_arguments, count));
        break;
    case UNIT_BLIT:
        word_loop(m, offsetof(struct blit_arguments, index), offsetof(struct blit_arguments, out),
                  offsetof(struct blit_arguments, count));
        break;
    case UNIT_SETUP: setup_loop(m, &key->setup); break;
    case UNIT_KERNEL: kernel_loop(m, &key->kernel); break;
    default: m->ir->separated ? span_loop(m) : pixel_loop(m); break;
    }
    epilogue(m);
    write_outside(m);
    m->code_bytes = (uint32_t)encode_size(&m->encoder);
    encode_align(&m->encoder, 64);
    emit_literals(m);
    emit_forget_literals(m);
    if (m->exceeded) {
        error_set(error, "the %s routine has too many %s, expected at most %d", unit_name[unit], m->exceeded,
                  m->exceeded_limit);
        return 0;
    }
    bool textual = m->encoder.text && !m->encoder.failure;
    if (textual && (m->unread || emit_assemble(m, error)))
        return 0;
    if (encode_finish(&m->encoder, error))
        return 0;
    return encode_size(&m->encoder);
}
