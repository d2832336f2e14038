/* From the allocated program to machine code: the stack frame with the loop over the elements, the body, and
 * the literals. */
#ifndef ENGINES_SPECIALIZE_EMIT_EMIT_H
#define ENGINES_SPECIALIZE_EMIT_EMIT_H

#include "debug/code.h"
#include "contract/engine.h"
#include "engines/specialize/allocate/allocate.h"
#include "engines/specialize/encode/assemble.h"
#include "engines/specialize/encode/encode.h"
#include "engines/specialize/peephole/peephole.h"

#include <assert.h>

/* Large enough for a routine of IR_CAPACITY instructions of ordinary length. As with the arrays of the IR,
 * pages that a routine does not reach are never touched. */
enum {
    CODE_CAPACITY = 4 << 20,          /* bytes of one routine with its literals */
    FIXUP_CAPACITY = 4 * IR_CAPACITY, /* most instructions need at most two, a window seven */
    LITERAL_CAPACITY = 8192,
    LITERAL_TABLE = 2 * LITERAL_CAPACITY, /* a power of two */
    REGION_CAPACITY = 16384,
    REGION_DEPTH = 1024,
    SUBROUTINE_CAPACITY = 64,
    SPILL_BYTES = 2 << 20 /* of the stack for spill slots: enough for IR_CAPACITY slots of 8 lanes */
};

static_assert((int)CODE_CAPACITY <= (int)ROUTINE_BYTES_MAXIMUM, "code that fits a build fits a routine");

/* The first bytes of the stack frame, from rsp on: two MXCSR words, and room for the lanes of one value. */
enum {
    FRAME_SAVED_MXCSR = 0,
    FRAME_CONTRACT_MXCSR = 4,
    FRAME_RUN = 8,       /* the span reading: the address of the first entry of the next runs */
    FRAME_RUN_END = 16,  /* the same: of the entry after those of a run */
    FRAME_ROWS_END = 24, /* the same: after the last entry of the table of rows */
    FRAME_LIMIT = 32,    /* the same: the address after the last entry of the call */
    FRAME_BROKEN = 40,   /* the same, of copies: the last column that no straight run has after its first */
    FRAME_WIDTH = 48,    /* the same, of a rectangle that is copied: the bytes of a run's entries */
    FRAME_TEXELS = 56,   /* the same: the address of its first column's texel in the first row of texels */
    FRAME_LANES = 64,
    FRAME_HEAD = 128
};

/* Labels of the frame's code; those of regions and literals follow. */
enum frame_label { LABEL_LOOP, LABEL_CHUNK, LABEL_SKIP, LABEL_DONE, LABEL_PAGE, LABEL_FREE };

/* Each reciprocal uses two, each window two or three. */
enum {
    LABEL_CAPACITY =
        LABEL_FREE + LITERAL_CAPACITY + 2 * REGION_CAPACITY + 3 * IR_CAPACITY + SUBROUTINE_CAPACITY
};

/* The code from an offset on belongs to an instruction, or to the frame. */
struct code_line {
    uint32_t offset;
    uint16_t instruction; /* its number; 0: the frame */
    uint16_t frame_line;  /* for the frame: the line in frame.c */
};

enum { UNWIND_CAPACITY = 32 };

/* A pointer of the job that is a literal in the code: the 64-bit immediate of a move, at an offset of the
 * code, is to become the pointer that is stored in the job at `field`. */
struct code_pointer {
    uint32_t offset;
    int32_t field;
};

/* A hint of the pass near, or texels of the pass stretch, which have other ways after the routine. */
struct other_way {
    uint32_t position;     /* of the hint */
    uint32_t begin, after; /* labels */
};

/* The labels of the loops of stretched rows (stretch.c): where the search for each of a chunk's rows goes on;
 * after the loop that computes one; the loop of blocks; and its end. */
enum { STRETCH_NEEDS = 4 };
struct stretch_labels {
    uint32_t found[STRETCH_NEEDS], done, usual, end;
};

enum { POINTER_CAPACITY = 1024, OTHER_WAYS = 64 };

/* The immediate until a pointer is written there: no address, so that code without it faults. */
enum { POINTER_PLACEHOLDER = 0x5c5c5c5c /* the high half; the field is the low half */ };

/* Where a value is at the current position. */
struct location {
    unsigned value;
    uint8_t reg;      /* NO_REGISTER: in memory, at `address` */
    bool addressable; /* in memory, with all lanes or to be broadcast: `address` can be an operand */
    bool mask;        /* in memory, with one bit for each lane */
    struct address address;
};

/* The move of a value to a phi or a join, whose destination is a register, a slot, or both. */
struct move {
    struct location from;
    uint8_t to;     /* NO_REGISTER: only the slot */
    bool mask;      /* the value is a mask */
    uint16_t slot;  /* NO_SLOT: only the register */
    uint16_t waits; /* the number of other moves that read its destination */
};

/* The state of emission. It is large, and reused from build to build. */
struct emitter {
    const struct ir *ir;
    const struct allocation *allocation;
    struct encoder encoder;
    enum vector_length length;
    bool silent;  /* no code is written, and the result is 0: only the choice of instructions is measured */
    bool textual; /* the code is printed as text, which is then assembled */
    bool unread;  /* the text is not assembled, and the result is 0: only printing is measured */
    struct peepholes rules;
    unsigned width;    /* lanes of a register: 1, 4, 8 or 16 */
    uint32_t position; /* of the instruction whose code is written */
    uint32_t
        selected; /* the code of all instructions before this one is written; groups are written together */
    bool keeps_scratch; /* only emit_bring() writes SCRATCH_FIRST in the code of this instruction */
    bool holds_literal; /* SCRATCH_FIRST holds a literal in all lanes, that of these bits */
    int32_t held_bits;
    uint32_t literals;
    uint32_t regions;
    const char *exceeded; /* names what there is too much of, or null */
    int exceeded_limit;
    uint32_t lines;
    uint32_t code_bytes;     /* without the literals */
    int32_t frame_constants; /* offset from rsp of the constant table, then of spill slots and variables */
    int32_t frame_slots;
    int32_t frame_variables;
    int32_t frame_saved;   /* offset from rsp of the registers that are saved around a call */
    int32_t frame_places;  /* offset from rsp of the x of each of a tile's columns (span.c) */
    int32_t frame_columns; /* the same of the table of columns */
    int32_t frame_rows;    /* the same of the table of rows */
    int32_t frame_stretch; /* the same of stretched rows (stretch.c) */
    uint32_t part_label;   /* where the part of a block begins (parts.c) */
    uint32_t run_label;    /* where a run of the span reading begins */
    int32_t frame_shift;   /* how much further rsp is from the frame: 0, except in subroutines */
    uint32_t program_end;  /* the first `subroutine`, or the end of the program if there is none */
    uint32_t subroutine_label[SUBROUTINE_CAPACITY];
    uint64_t subroutine_writes[SUBROUTINE_CAPACITY]; /* registers, a bit each */
    int32_t constants; /* offset in the job of the pointer to the shader's constants; 0: no shader */
    int32_t literal_bits[LITERAL_CAPACITY];
    uint8_t literal_lanes[LITERAL_CAPACITY]; /* enum literal_kind */
    uint32_t literal_label[LITERAL_CAPACITY];
    uint16_t literal_table[LITERAL_TABLE]; /* by hash: 1 + the literal's number, 0: none; 0 between builds */
    uint32_t region_label[REGION_DEPTH];
    uint32_t region_depth;
    uint32_t moves; /* those that are not yet written */
    struct move move[VARIABLES * IR_PARTS];
    bool literal_pointers; /* pointers of the job are literals in the code, which are listed here */
    uint32_t pointers;
    struct code_pointer pointer[POINTER_CAPACITY];
    unsigned rows_stay; /* the number of rows of texels whose addresses stay in registers (gather_near.c) */
    uint8_t staying[2];
    bool copies;                   /* emit_is_copy() */
    uint32_t run_done;             /* of a copy: the label after the loop of blocks */
    bool rectangles;               /* emit_copies_rectangles() */
    uint32_t rectangle_done;       /* the label at the end of the loop of triangles */
    struct stretch_labels stretch; /* the loops of the pass stretch */
    uint32_t other_ways;
    struct other_way other_way[OTHER_WAYS];
    struct encode_text text; /* of the last routine that was built by way of text */
    struct mnemonics mnemonics;
    uint32_t unwinds;
    struct debug_unwind unwind[UNWIND_CAPACITY]; /* of the prologue and the epilogue */
    struct code_line line[IR_CAPACITY + 64];
    int32_t labels[LABEL_CAPACITY];
    struct fixup fixups[FIXUP_CAPACITY];
    uint8_t code[CODE_CAPACITY];
};

/* Writes the routine of a unit into emitter->code. Returns the number of bytes, or 0 with the reason. */
size_t emit_routine(struct emitter *emitter, enum unit unit, const union key *key, struct error *error);

/* Take memory for the text of routines, unless there is one: returns 0, or -1 with the reason; and return it
 * (text.c). */
int emit_take_text(struct emitter *emitter, struct error *error);
void emit_give_text(struct emitter *emitter);

/* Begin a text; and assemble it to emitter->code: the positions that were noted in the text become those in
 * the code. Returns 0, or -1 with the reason. */
void emit_start_text(struct emitter *emitter);
int emit_assemble(struct emitter *emitter, struct error *error);

/* Notes that the routine has too many of something, so that it is not built. */
static inline void emit_note_exceeded(struct emitter *emitter, const char *what, int limit)
{
    emitter->exceeded = what;
    emitter->exceeded_limit = limit;
}

/* Write the code of the program (select.c): what runs once a call, if there is such a part, and what is
 * repeated. */
void emit_preamble(struct emitter *emitter);
void emit_body(struct emitter *emitter);

/* Writes the code of the instructions from emitter->position up to `end`, which becomes the position. With
 * `lines`, notes where the code of each begins. */
void emit_instructions(struct emitter *emitter, uint32_t end, bool lines);

/* Writes the code of an operation that computes (compute.c). */
void emit_computed(struct emitter *emitter, const struct ir_instruction *instruction);

/* Stores the value of the current instruction to its spill slot, if it has one. */
void emit_store_spilled(struct emitter *emitter);

/* The general-purpose register that holds each base (frame.c). */
extern const uint8_t emit_base_register[BASE_COUNT];

/* A place in the stack frame of a routine that is in no subroutine, in bytes from rsp. */
static inline struct address emit_frame_at(int32_t offset)
{
    return address_at(X86_RSP, offset);
}

/* The address `k` bytes after a base (frame.c). */
struct address emit_base_address(enum base base, int32_t k);

/* The vector length of a number of lanes: 1, 4, 8 or 16. */
static inline enum vector_length emit_length_of(unsigned width)
{
    return width <= 4 ? X86_128 : width == 8 ? X86_256 : X86_512;
}

/* Returns true if there are 16 lanes: the code has EVEX encodings, mask registers and broadcast operands. */
static inline bool emit_is_wide(const struct emitter *emitter)
{
    return emitter->width == 16;
}

/* Returns true if there is one lane: floats are computed by scalar instructions, and a value in memory is one
 * word. Of the 16 bytes of a register only the first four have a meaning. */
static inline bool emit_is_scalar(const struct emitter *emitter)
{
    return emitter->width == 1;
}

/* The number of spill slots that a routine can have. */
static inline unsigned emit_most_slots(unsigned width)
{
    return SPILL_BYTES / (width * 4);
}

/* Returns true if the constant table is in the stack frame. With 16 lanes and with one, instructions read the
 * words of the job instead. */
static inline bool emit_has_table(const struct emitter *emitter)
{
    return !emit_is_wide(emitter) && !emit_is_scalar(emitter);
}

/* The elements that one pass of the routine's loop computes: the lanes of all parts of a value. */
static inline unsigned emit_lanes(const struct emitter *emitter)
{
    return emitter->width * emitter->ir->parts;
}

/* The layout of a literal after the code: one word to be broadcast; the same word for each lane; or for lane
 * l, l times the word, or the word plus the place of the lane's first byte in each of its four bytes. */
enum literal_kind { LITERAL_ONCE, LITERAL_LANES, LITERAL_MULTIPLES, LITERAL_PLACES };
struct address emit_literal_address(struct emitter *emitter, int32_t bits, enum literal_kind kind);

/* Write the literals after the code, and make room for those of the next routine (literal.c). */
void emit_literals(struct emitter *emitter);
void emit_forget_literals(struct emitter *emitter);

/* emit_locate returns where a value is at the current position; emit_need_register returns its vector
 * register, `scratch` if it has to be loaded or is a mask; emit_result_register returns the register of the
 * current instruction's result (location.c). */
struct location emit_locate(struct emitter *emitter, unsigned value);
unsigned emit_need_register(struct emitter *emitter, const struct location *location, unsigned scratch);
unsigned emit_result_register(const struct emitter *emitter);

/* The same for a mask register. The result is the number by which instructions name it, 0 to 7. */
unsigned emit_need_mask(struct emitter *emitter, const struct location *location, unsigned scratch);

/* Brings a value into the register `to`, of either kind. The code does not change flags. */
void emit_bring(struct emitter *emitter, unsigned to, const struct location *location);

/* Loads the constants that the body has in registers. */
void emit_load_kept(struct emitter *emitter);

/* Stores a register of either kind. */
void emit_store_register(struct emitter *emitter, struct address to, unsigned reg);

/* The address of entry `slot` of the array that begins at an offset in the frame; of a spill slot. */
struct address emit_frame_address(const struct emitter *emitter, int32_t start, unsigned slot);
struct address emit_slot_address(const struct emitter *emitter, unsigned slot);

/* Returns true if a value is the literal 0. */
bool emit_is_zero(const struct emitter *emitter, unsigned value);

/* Returns true if an instruction can read the value from memory; `location` then has the address.
 * Instructions on 16-bit elements cannot broadcast, so the address becomes that of a literal with all lanes.
 * With one lane, instructions that read 16 bytes can read literals only. */
bool emit_folds(struct emitter *emitter, enum x86_vector instruction, struct location *location);

/* Returns true if the rule applies to the instruction, which it then must (peephole.h). */
static inline bool emit_applies(struct emitter *emitter, enum peephole rule)
{
    return peephole_applies(&emitter->rules, rule);
}

/* Write the code of the ends of a loop of the span reading, whose label is `head`; and the bytes of its
 * tables of columns, of rows, and of the columns' places (span.c). */
void emit_open_span(struct emitter *emitter, enum ir_loop kind, uint32_t head);
void emit_close_span(struct emitter *emitter, enum ir_loop kind, uint32_t head);
int32_t emit_table_bytes(const struct emitter *emitter);
int32_t emit_row_table_bytes(const struct emitter *emitter);
int32_t emit_places_bytes(const struct emitter *emitter);

/* Writes the search for the end of the run that begins at ENTRY: r12. rax and r13 are changed (span.c). */
void emit_find_run(struct emitter *emitter);

/* Returns the position of a loop of the span reading, which the program has. */
uint32_t emit_find_loop(const struct ir *ir, enum ir_loop kind);

/* Loads the bases of the block at ENTRY: its triangle, and those of its colours and depths (frame.c). */
void emit_begin_block(struct emitter *emitter, bool colors, bool depths);

/* Returns true if the program has two parts (passes/early.c). The first one is executed for several blocks
 * before the second. Write what precedes and follows the parts, and what is between them; the bytes of its
 * table (parts.c). */
static inline bool emit_is_early(const struct emitter *emitter)
{
    return emitter->ir->early;
}
void emit_open_parts(struct emitter *emitter);
void emit_close_parts(struct emitter *emitter);
void emit_rest(struct emitter *emitter);
int32_t emit_early_table_bytes(const struct emitter *emitter);

/* Returns true if the program accesses memory at a base in its loops of chunks and blocks, its last part. */
bool emit_chunks_access(const struct emitter *emitter, enum base base);

/* The bytes of an entry of the table of columns. */
static inline int32_t emit_column_bytes(const struct emitter *emitter)
{
    return (int32_t)(emitter->ir->column_words * emitter->width * 4);
}

/* Where a column's entry has the places of a column of texels, and its first texel; the least of eight signed
 * lanes, to all lanes of `to` (gather_near.c). */
int32_t emit_near_places(const struct emitter *emitter, unsigned column);
int32_t emit_near_first(const struct emitter *emitter, unsigned column);
void emit_find_least(struct emitter *emitter, unsigned to, unsigned of, unsigned other);

/* The offset in a row's entry of the address of row of texels `row`, for a first or second row of pixels. */
int32_t emit_texel_row(const struct emitter *emitter, unsigned row, unsigned second);

/* Note the moves at the current position, an `again`, to the phis of its loop; and, at a `when` (operand 0)
 * or an `end` (operand 1), to the joins after the region's `end` (move.c). */
void emit_note_next_moves(struct emitter *emitter);
void emit_note_join_moves(struct emitter *emitter, uint32_t end, int operand);

/* Writes the noted moves, as if they were simultaneous. The code does not change flags. */
void emit_write_moves(struct emitter *emitter);

/* Finds the subroutines of the program. Returns the largest number of registers that are saved around a call
 * (call.c). */
uint32_t emit_prepare_calls(struct emitter *emitter);

/* Write the code of a call, of the beginning of a subroutine, of all subroutines. */
void emit_call(struct emitter *emitter, const struct ir_instruction *instruction);
void emit_begin_subroutine(struct emitter *emitter, const struct ir_instruction *instruction);
void emit_subroutines(struct emitter *emitter);

/* Loads the pointer at a field of a base to rax, or moves it there as a literal (gather.c). */
void emit_load_pointer(struct emitter *emitter, unsigned base, int32_t field);

/* Writes the gather at the current position, together with the following ones that read the next words of the
 * same elements (gather.c). */
void emit_gather(struct emitter *emitter, const struct ir_instruction *instruction);

/* Writes the window at the current position and the instructions that belong to it (gather_window.c). Writes
 * nothing if the allocation does not allow a window; the instructions then follow as usual. */
void emit_window(struct emitter *emitter, const struct ir_instruction *instruction);

/* Write the code of the pass near: the notes of a column and of a row of texels, the gathers of a hint by
 * loads, what precedes the loop of blocks, and, after the routine, the hints' other ways (gather_near.c). */
void emit_near_column(struct emitter *emitter, const struct ir_instruction *instruction);
void emit_near_row(struct emitter *emitter, const struct ir_instruction *instruction);
void emit_near(struct emitter *emitter, const struct ir_instruction *instruction);
void emit_open_rows(struct emitter *emitter);

/* Returns true if the addresses of all rows of texels stay in registers from a position on. */
bool emit_rows_stay(struct emitter *emitter, uint32_t from);
void emit_other_ways(struct emitter *emitter);

/* Returns true if the span reading's loop of blocks only copies texels. Its runs then have a loop for texels
 * that follow each other (straight.c): what precedes the columns; a column with the texels in `lanes`; what
 * follows the columns; and the loop itself, before the usual one, with the registers of each chunk's two rows
 * of texels. If a column is straight, its first texel is then in eax, and the places of its lanes are in
 * SCRATCH_SECOND; else the code jumps to `other`, where emit_break_column() notes that. `first` is the first
 * texel's word of the column's entry. */
bool emit_is_copy(struct emitter *emitter);
void emit_begin_links(struct emitter *emitter);
void emit_link_column(struct emitter *emitter, unsigned lanes, struct address first, uint32_t other);
void emit_break_column(struct emitter *emitter);
void emit_end_links(struct emitter *emitter);
void emit_straight_run(struct emitter *emitter, const uint8_t *const rows[2], struct address first);

/* Writes the copy of the blocks from COLOR to `end`, which is changed, at least one, whose first texels are
 * number eax of the rows. With an even number of blocks, the code jumps to `done`. */
void emit_copy_run(struct emitter *emitter, const uint8_t *const rows[2], enum gpr end, uint32_t done);

/* Returns true if the sections of columns and rows of a copy can compute those of a rectangle; and writes the
 * copy of the rectangle that a triangle begins with, if there is one (rectangle.c). */
bool emit_copies_rectangles(const struct ir *ir);
void emit_copy_rectangle(struct emitter *emitter);

/* Write the code of the pass stretch (stretch.c): the entries of pairs of columns, after the loop of columns;
 * the ends of its two loops; texels for a stretched row, those of far pairs, and lanes of stretched rows. The
 * bytes of its part of the frame. */
void emit_pair_columns(struct emitter *emitter);
void emit_open_stretch(struct emitter *emitter);
void emit_close_stretch(struct emitter *emitter, uint32_t head);
void emit_open_pairs(struct emitter *emitter);
void emit_close_pairs(struct emitter *emitter, uint32_t head);
void emit_stretch(struct emitter *emitter);
void emit_far_texels(struct emitter *emitter, const struct other_way *other);
void emit_stretched(struct emitter *emitter, const struct ir_instruction *instruction);
int32_t emit_stretch_bytes(const struct emitter *emitter);

/* With several parts of eight lanes, the register that counts windows in vain; 0 when a routine begins. It
 * otherwise has the coverage that is ahead, which a pass over whole blocks does not need. */
#define EMIT_VAIN X86_RBX

/* Writes the scatter at the current position, together with the following ones of neighbouring words
 * (scatter.c). */
void emit_scatter(struct emitter *emitter, const struct ir_instruction *instruction);

/* Note that the code from here on belongs to an instruction; to the frame, at a line of frame.c. */
void emit_note_line(struct emitter *emitter, uint32_t instruction);
#endif
