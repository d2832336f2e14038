/* The executable-code arena: one region of memory, mapped twice.
 *
 * A memfd of fixed capacity is mapped once writable and once executable; no address is ever both. Code is
 * written through the writable view and run through the executable one, and a pointer in one translates to
 * the other by adding a constant. Pages are had from the kernel a few ahead of what is written, so capacity costs
 * only address space.
 *
 * Writing a routine: `code_reserve` a span large enough for any outcome, write it, `code_commit` the bytes
 * really used. The commit gives the rest back and, if a smaller hole can take the code, MOVES it there:
 * without this, holes left by evicted routines would never be used again, since every routine starts in a
 * large span. Hence until committed, code must be position-independent with respect to itself and must not
 * refer to anything outside by a rip-relative distance (addresses in registers or 64-bit immediates are
 * fine).
 *
 * Spans are multiples of CODE_ALIGNMENT and aligned to it (or to pages: code_create_for). What surrounds code is 0xCC (int3): the tail of
 * its last unit, and spans that have been freed, so that a stray jump traps. All functions are thread-safe;
 * nobody else may touch a span between its reserve and its commit, or run it while it is freed. */
#ifndef BASE_CODE_H
#define BASE_CODE_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/types.h>

enum { CODE_ALIGNMENT = 64 };

/* The system calls that may refuse; tests replace them. As memfd_create, ftruncate and mmap. */
struct code_system {
    int (*create_file)(const char *name, unsigned flags);
    int (*set_size)(int file, off_t bytes);
    void *(*map)(void *address, size_t bytes, int protection, int flags, int file, off_t offset);
};

extern const struct code_system code_system_native;

struct code_arena;

/* Owned by whoever reserved it. `writable` and `executable` are the two views of the same `bytes`. */
struct code_span {
    uint8_t *writable;
    const uint8_t *executable;
    size_t bytes;
};

struct code_statistics {
    size_t capacity;     /* bytes */
    size_t used;         /* bytes reserved or committed, rounded up to CODE_ALIGNMENT */
    size_t peak;         /* the most `used` has been */
    size_t free_spans;   /* how many holes `capacity - used` is spread over */
    size_t largest_free; /* bytes */
};

/* An arena of `bytes` (rounded up to whole pages; 0: 64 MiB; at most 2 GiB). `system` may be null: the real
 * one. Returns null, with the reason, when the system refuses. */
struct code_arena *code_create(size_t bytes, const struct code_system *system, struct error *error);

/* The same for code that others look at.
 *
 * A debugger can write breakpoints only to pages that are private to the process. So the executable view is such a
 * mapping, which shows what the file has but for pages that the debugger has written to; spans are whole pages, and a
 * commit lets go of the debugger's, so that no routine keeps another's breakpoints.
 *
 * perf looks for names of code without symbols only where no file is mapped. So both views are of shared memory without a
 * file: the second one is made from the first, and made executable instead of writable before anything runs. */
enum code_purpose { CODE_TO_RUN, CODE_TO_DEBUG, CODE_TO_PROFILE };
struct code_arena *code_create_for(enum code_purpose purpose, size_t bytes, const struct code_system *system,
                                   struct error *error);

/* Null when generated code can run in this process now, which is tried with an arena of one page; else one line that
 * says why not, the calling thread's until it asks again. */
const char *code_unavailable(void);

/* Unmaps everything. No code of it may be running; null is allowed. */
void code_destroy(struct code_arena *arena);

/* A span of at least `bytes` (> 0) to write into. Returns 0, or -1 with the reason when no hole is that
 * large. */
int code_reserve(struct code_arena *arena, size_t bytes, struct code_span *span, struct error *error);

/* The bytes of the last reservation if it found no hole, else 0: who frees until there is a hole that large can try
 * again. */
size_t code_refused(struct code_arena *arena);

/* Ends the writing of a reserved span of which the first `bytes` (> 0) are code; at most CODE_ALIGNMENT bytes
 * beyond them have been written to. Updates `span` to where the code now is, and returns its executable
 * address. */
const void *code_commit(struct code_arena *arena, struct code_span *span, size_t bytes);

/* Gives back a span, reserved or committed, and empties `span`. An empty span is allowed. */
void code_free(struct code_arena *arena, struct code_span *span);

/* One view's address as the other's. */
const void *code_executable(const struct code_arena *arena, const void *writable);
void *code_writable(const struct code_arena *arena, const void *executable);

/* Whether `executable` lies in the arena: which routine's arena a profiler's or a crash's address is in. */
bool code_contains(const struct code_arena *arena, const void *executable);

struct code_statistics code_statistics(struct code_arena *arena);

#endif
