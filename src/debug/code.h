/* What debuggers and profilers want to know of a piece of generated code: its name, what it was made from, and how to
 * return from it at every instruction.
 *
 * Engines fill it in (engine->describe), asked only when somebody wants to debug. Rows are in the order of their
 * offsets; adding never fails at once, but notes that memory was short. */
#ifndef DEBUG_CODE_H
#define DEBUG_CODE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The code from `offset` on, until the next row, comes from this line. */
struct debug_source {
    uint32_t offset;
    uint32_t line;
    const char *file; /* lives as long as the process */
};

enum debug_rule {
    DEBUG_CFA,     /* when the code has returned, rsp will be what reg + value is now: the frame's address */
    DEBUG_SAVED,   /* the caller's reg is in memory, value bytes below the frame's address */
    DEBUG_RESTORED /* reg has the caller's value again */
};

/* What changes at `offset`. Before the first row, the frame's address is rsp + 8 and all registers are the caller's;
 * the return address is always 8 bytes below the frame's. Laid out as asm/fragment.inc writes it. */
struct debug_unwind {
    uint32_t offset;
    uint8_t rule; /* enum debug_rule */
    uint8_t reg;  /* hardware number: rax rcx rdx rbx rsp rbp rsi rdi r8 ... */
    uint16_t unused;
    int32_t value;
};

enum { DEBUG_NAME_CAPACITY = 96 };

struct debug_code {
    char name[DEBUG_NAME_CAPACITY]; /* letters, digits and underscores */
    const void *code;
    uint32_t bytes; /* of instructions; constants may follow */
    const char
        *folder; /* what files are relative to, itself relative to the project's folder; "": that one */
    struct debug_source *source;
    struct debug_unwind *unwind;
    uint32_t sources, source_capacity;
    uint32_t unwinds, unwind_capacity;
    bool failed; /* memory was short: the rows are not all */
};

/* Appends a row. Of source rows for no code the last counts, and one that says what the one before says is left out. */
void debug_add_source(struct debug_code *code, uint32_t offset, const char *file, uint32_t line);
void debug_add_unwind(struct debug_code *code, uint32_t offset, enum debug_rule rule, unsigned reg,
                      int32_t value);

/* Frees the rows. */
void debug_code_free(struct debug_code *code);

#endif
