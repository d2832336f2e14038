/* The description of a piece of generated code for debuggers and profilers: its name, its source lines, and
 * how to unwind the stack at every instruction.
 *
 * Engines fill it in (engine->describe), only when a listener is enabled. Rows are in the order of their
 * offsets. A failed allocation while adding rows sets `failed`. */
#ifndef DEBUG_CODE_H
#define DEBUG_CODE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The source line of the code from `offset` up to the next row. */
struct debug_source {
    uint32_t offset;
    uint32_t line;
    const char *file; /* valid until the process ends */
};

enum debug_rule {
    DEBUG_CFA,     /* the frame's address, which is rsp after the return, is reg + value */
    DEBUG_SAVED,   /* the caller's reg is in memory, value bytes below the frame's address */
    DEBUG_RESTORED /* reg has the caller's value again */
};

/* A change of the unwinding rules at `offset`. Before the first row, the address of the stack frame is rsp +
 * 8 and all registers have the caller's values. The return address is always 8 bytes below the frame's
 * address. asm/stitch/fragment.inc writes this layout. */
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
    uint32_t bytes; /* of instructions; constants may follow them */
    const char
        *folder; /* files are relative to it, and it is relative to the project's folder; "": that folder */
    struct debug_source *source;
    struct debug_unwind *unwind;
    uint32_t sources, source_capacity;
    uint32_t unwinds, unwind_capacity;
    bool failed; /* an allocation failed: rows are missing */
};

/* Appends a row. A source row replaces the previous one at the same offset, and is omitted if it has the same
 * line as the one before. */
void debug_add_source(struct debug_code *code, uint32_t offset, const char *file, uint32_t line);
void debug_add_unwind(struct debug_code *code, uint32_t offset, enum debug_rule rule, unsigned reg,
                      int32_t value);

/* Frees the rows. */
void debug_code_free(struct debug_code *code);

#endif
