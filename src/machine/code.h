/* The executable-code arena: one region of memory, mapped twice.
 *
 * A memfd of fixed capacity is mapped once writable and once executable, so no address is both. Code is
 * written through the writable view and run through the executable one. Adding a constant converts a pointer
 * between them. Pages are populated shortly ahead of their use, so capacity costs only address space.
 *
 * To write a routine: code_reserve a span large enough for any result, write the code, code_commit the bytes
 * that were used. The commit returns the rest and, if a smaller hole fits the code, MOVES it there. Otherwise
 * holes of evicted routines would never be reused, since every routine starts in a large span. So, until it
 * is committed, code must be position-independent and must not refer to anything outside by a rip-relative
 * distance. Addresses in registers and 64-bit immediates are allowed.
 *
 * Spans are aligned to CODE_ALIGNMENT, or to pages (code_create_for), and their sizes are multiples of it.
 * Memory around code is filled with 0xCC (int3), so a stray jump traps: the tail of the last unit, and freed
 * spans. All functions are thread-safe. Only the owner may use a span between its reserve and its commit, and
 * freed spans must not be running. */
#ifndef MACHINE_CODE_H
#define MACHINE_CODE_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/types.h>

enum { CODE_ALIGNMENT = 64 };

/* The system calls that can fail; tests replace them. The interfaces are those of memfd_create, ftruncate and
 * mmap. */
struct code_system {
    int (*create_file)(const char *name, unsigned flags);
    int (*set_size)(int file, off_t bytes);
    void *(*map)(void *address, size_t bytes, int protection, int flags, int file, off_t offset);
};

/* For tests: system calls that are refused one by one. */
extern const struct code_system code_system_native;

struct code_arena;

/* A reserved or committed span. `writable` and `executable` are the two views of the same `bytes`. */
struct code_span {
    uint8_t *writable;
    const uint8_t *executable;
    size_t bytes;
};

struct code_statistics {
    size_t capacity;     /* bytes */
    size_t used;         /* bytes reserved or committed, rounded up to CODE_ALIGNMENT */
    size_t peak;         /* the maximum of `used` */
    size_t free_spans;   /* the number of holes in `capacity - used` */
    size_t largest_free; /* bytes */
};

/* Creates an arena of `bytes`: rounded up to whole pages, at most 2 GiB; 0 means 64 MiB. A null `system`
 * means the real one. Returns null with the reason if the system refuses. */
struct code_arena *code_create(size_t bytes, const struct code_system *system, struct error *error);

/* The same for code that other tools inspect.
 *
 * CODE_TO_DEBUG: a debugger can write breakpoints only to private pages. So the executable view is a private
 * mapping of the file, except for pages that the debugger has written. Spans are whole pages, and a commit
 * discards the debugger's copies, so no routine has the breakpoints of another.
 *
 * CODE_TO_PROFILE: perf looks for names of code without symbols only where no file is mapped. So both views
 * are of shared memory without a file. The second view is made from the first, and becomes executable instead
 * of writable before any code runs. */
enum code_purpose { CODE_TO_RUN, CODE_TO_DEBUG, CODE_TO_PROFILE };
struct code_arena *code_create_for(enum code_purpose purpose, size_t bytes, const struct code_system *system,
                                   struct error *error);

/* Tests generated code in an arena of one page. Returns null if it can run in this process, else a reason of
 * one line, valid until the calling thread's next call. */
const char *code_unavailable(void);

/* Unmaps the arena. None of its code may be running. Null is allowed. */
void code_destroy(struct code_arena *arena);

/* Reserves a span of at least `bytes` (> 0) for writing. Returns 0, or -1 with the reason if no hole is that
 * large. */
int code_reserve(struct code_arena *arena, size_t bytes, struct code_span *span, struct error *error);

/* The bytes of the last reservation if it found no hole, else 0. After freeing, a caller can retry it once a
 * hole is that large. */
size_t code_refused(struct code_arena *arena);

/* Commits a reserved span whose first `bytes` (> 0) are code; at most CODE_ALIGNMENT bytes after them have
 * been written. Updates `span` to the final place of the code and returns its executable address. */
const void *code_commit(struct code_arena *arena, struct code_span *span, size_t bytes);

/* A 64-bit word of committed code, `offset` bytes from its start, and its new value. */
struct code_word {
    uint32_t offset;
    uint64_t value;
};

/* Returns true if words of committed code can be replaced: the kernel serializes the processor's cores. */
bool code_can_patch(const struct code_arena *arena);

/* Replaces words of committed code, through its writable view. No thread may run the code from before the
 * call until it returns; then every thread runs the new words. Needs code_can_patch. In an arena for
 * debuggers, the code's pages lose their breakpoints. */
void code_patch(struct code_arena *arena, const struct code_span *span, const struct code_word *words,
                size_t count);

/* Frees a span, reserved or committed, and empties `span`. An empty span is allowed. */
void code_free(struct code_arena *arena, struct code_span *span);

/* For tests: whether an address is in the executable view. */
bool code_contains(const struct code_arena *arena, const void *executable);

/* Convert an address of one view to the other's. For tests: the executable view of a writable address. */
const void *code_executable(const struct code_arena *arena, const void *writable);
void *code_writable(const struct code_arena *arena, const void *executable);

struct code_statistics code_statistics(struct code_arena *arena);

#endif
