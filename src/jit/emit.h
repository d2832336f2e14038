/* From allocated IR to machine code: instruction selection with memory operands, peephole rules, and the
 * frame. */
#ifndef JIT_EMIT_H
#define JIT_EMIT_H

#include "debug/code.h"
#include "draw/engine.h"
#include "jit/allocate.h"
#include "jit/encode.h"

#include <assert.h>

/* Like the arrays of the IR, large but untouched: a routine of IR_CAPACITY instructions of ordinary length
 * fits. */
enum {
    CODE_CAPACITY = 4 << 20,          /* bytes of one routine, constants included */
    FIXUP_CAPACITY = 4 * IR_CAPACITY, /* of few instructions more than two, of a window seven */
    LITERAL_CAPACITY = 8192,
    LITERAL_TABLE = 2 * LITERAL_CAPACITY, /* a power of two */
    REGION_CAPACITY = 16384,
    REGION_DEPTH = 1024,
    SPILL_CAPACITY = 32768 /* slots; their frame, 1 MiB and 16 KiB of variables, fits any thread's stack */
};

static_assert((int)CODE_CAPACITY <= (int)ROUTINE_BYTES_MAXIMUM, "what fits a build is a routine");

/* The frame's head, upward from rsp: two MXCSR words, and room for the lanes of one value. */
enum { FRAME_SAVED_MXCSR = 0, FRAME_CONTRACT_MXCSR = 4, FRAME_LANES = 64, FRAME_HEAD = 128 };

/* Labels of the frame; regions and literals follow. */
enum frame_label { LABEL_LOOP, LABEL_CHUNK, LABEL_SKIP, LABEL_DONE, LABEL_PAGE, LABEL_FREE };

/* Windows and reciprocals have two of their own. */
enum { LABEL_CAPACITY = LABEL_FREE + LITERAL_CAPACITY + 2 * REGION_CAPACITY + 2 * IR_CAPACITY };

/* Where an instruction's code begins. */
struct code_line {
    uint32_t offset;
    uint16_t instruction; /* IR number; 0 for the frame */
    uint16_t frame_line;  /* of the frame, in frame.c */
};

enum { UNWIND_CAPACITY = 32 };

/* An operand at the current position. */
struct place {
    unsigned value;
    uint8_t reg;         /* NO_REGISTER: in memory */
    uint8_t addressable; /* in memory, lanes and all or to be broadcast: `address` can be an operand */
    uint8_t mask;        /* in memory, a bit a lane */
    struct address address;
};

/* A value becomes a phi or a join: to a register, to a slot, or to both. */
struct move {
    struct place from;
    uint8_t to;     /* NO_REGISTER: the slot alone */
    uint8_t mask;   /* what moves is a mask */
    uint16_t slot;  /* NO_SLOT: the register alone */
    uint16_t waits; /* for so many others that read its destination first */
};

/* Everything a build needs to write its code: big, reused from build to build. */
struct emitter {
    const struct ir *ir;
    const struct allocation *allocation;
    struct encoder encoder;
    enum vector_length length;
    unsigned width;    /* lanes: 4, 8 or 16 */
    uint32_t position; /* of the IR instruction being selected */
    uint32_t selected; /* instructions before this one are: a group may be selected together */
    uint32_t literals;
    uint32_t regions;
    const char *exceeded; /* what there are too many of, and how many there may be; null */
    int exceeded_limit;
    uint32_t lines;
    uint32_t code_bytes;     /* without the constants */
    int32_t frame_constants; /* rsp-relative place of the frame's constants and spill slots */
    int32_t frame_slots;
    int32_t frame_variables;
    int32_t constants; /* where in the job the address of the shader's constants is; 0: no shader */
    int32_t literal_bits[LITERAL_CAPACITY];
    uint8_t literal_lanes[LITERAL_CAPACITY]; /* enum literal_kind */
    uint32_t literal_label[LITERAL_CAPACITY];
    uint16_t
        literal_table[LITERAL_TABLE]; /* by hash: 1 + the literal's number, 0: none; all 0 between builds */
    uint32_t region_label[REGION_DEPTH];
    uint32_t region_depth;
    uint32_t moves; /* noted, not yet written */
    struct move move[VARIABLES];
    uint32_t unwinds;
    struct debug_unwind unwind[UNWIND_CAPACITY]; /* the frame's, as it is made and left */
    struct code_line line[IR_CAPACITY + 64];
    int32_t labels[LABEL_CAPACITY];
    struct fixup fixups[FIXUP_CAPACITY];
    uint8_t code[CODE_CAPACITY];
};

/* Writes the whole routine of a unit into emitter->code. Returns its bytes, or 0 with the reason. */
size_t emit_routine(struct emitter *emitter, enum unit unit, const union key *key, struct error *error);

/* Notes that there is no room for another of something; the routine will be refused. */
static inline void note_exceeded(struct emitter *emitter, const char *what, int limit)
{
    emitter->exceeded = what;
    emitter->exceeded_limit = limit;
}

/* Writes the body: every IR instruction, at emitter->position (select.c). */
void emit_body(struct emitter *emitter);

/* Writes the instructions from emitter->position up to `end`, which becomes the position; with `lines`, it is noted where
 * each begins. */
void emit_instructions(struct emitter *emitter, uint32_t end, int lines);

/* A value that will be evicted is stored where it is defined: that of the current position. */
void store_spilled(struct emitter *emitter);

/* The general-purpose register that holds a base (frame.c). */
extern const uint8_t base_register[BASE_COUNT];

/* The vector length of a number of lanes. */
static inline enum vector_length length_of(unsigned width)
{
    return width == 4 ? X86_128 : width == 8 ? X86_256 : X86_512;
}

/* Whether there are 16 lanes: then EVEX encodings, mask registers and operands that are broadcast. */
static inline int is_wide(const struct emitter *emitter)
{
    return emitter->width == 16;
}

/* A literal in the constant pool: one word that is broadcast, or a word for each lane, the same or lane times as much. */
enum literal_kind { LITERAL_ONCE, LITERAL_LANES, LITERAL_MULTIPLES };
struct address literal_address(struct emitter *emitter, int32_t bits, enum literal_kind kind);

/* Where a value is at the current position; the vector register of an operand, loaded into `scratch` if it is in
 * memory or a mask; the register that the current instruction's value was given (place.c). */
struct place place_of(struct emitter *emitter, unsigned value);
unsigned need_register(struct emitter *emitter, const struct place *place, unsigned scratch);
unsigned result_register(const struct emitter *emitter);

/* The same for a mask register, the number that instructions have for it. */
unsigned need_mask(struct emitter *emitter, const struct place *place, unsigned scratch);

/* Brings a value into the register `to`, whichever kind it is of; flags stay. */
void bring(struct emitter *emitter, unsigned to, const struct place *place);

/* Stores a register, a mask or lanes, to where one of its kind can be read again. */
void store_register(struct emitter *emitter, struct address to, unsigned reg);

/* The lanes of number `slot` of those that begin at an offset in the frame; a spill slot. */
struct address frame_address(const struct emitter *emitter, int32_t start, unsigned slot);
struct address slot_address(const struct emitter *emitter, unsigned slot);

/* Whether a value is the literal 0. */
int is_zero(const struct emitter *emitter, unsigned value);

/* Whether an instruction can have the value as its operand in memory; `place` then says how. Those of 16-bit elements
 * broadcast nothing: of a literal they are given all lanes. */
int folds(struct emitter *emitter, enum x86_vector instruction, struct place *place);

/* The beginning and the end of a region and of a loop, at the current position (region.c). */
void select_when(struct emitter *emitter, const struct ir_instruction *instruction);
void select_end(struct emitter *emitter);
void select_loop(struct emitter *emitter);
void select_again(struct emitter *emitter, const struct ir_instruction *instruction);

/* Notes what moves from a loop's end at the current position to its next pass; or, at the current position,
 * to the joins behind a region's `end`: their operand 0 at its `when`, operand 1 at the end (move.c). */
void note_next_moves(struct emitter *emitter);
void note_join_moves(struct emitter *emitter, uint32_t end, int operand);

/* Writes them; flags stay. */
void write_moves(struct emitter *emitter);

/* Writes the gather at the current position, and with it those that follow of the same vertices (gather.c).
 */
void select_gather(struct emitter *emitter, const struct ir_instruction *instruction);

/* Writes what stands behind the window at the current position, and moves on to its last, if its texels can be chosen in
 * registers (gather_window.c). */
void select_window(struct emitter *emitter, const struct ir_instruction *instruction);

/* Writes the scatter at the current position, and with it those that follow of neighbouring words (scatter.c). */
void select_scatter(struct emitter *emitter, const struct ir_instruction *instruction);

/* Notes that the code from here on belongs to an IR instruction, or to the frame, a line of frame.c. */
void note_line(struct emitter *emitter, uint32_t instruction);
void note_frame_line(struct emitter *emitter, unsigned line);

#endif
