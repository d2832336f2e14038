/* Children under a system that refuses: seccomp filters on the calls that executable memory takes. */
#ifndef TESTS_SANDBOX_H
#define TESTS_SANDBOX_H

/* What mmap, mprotect and pkey_mprotect are not allowed: a protection that has all bits of `protection`. `shared` leaves
 * private mappings alone, which is how programs and libraries are loaded. */
struct sandbox {
    int protection; /* 0: all is allowed */
    int shared;
    int memory_files; /* memfd_create is refused as well */
    int error;        /* errno of what is refused; 0: it ends the process (SIGSYS) */
};

/* Systems as they are met. */
enum { SANDBOX_REFUSALS = 6 };
extern const struct sandbox sandbox_refusals[SANDBOX_REFUSALS];

/* Puts the calling process under the filter, for good. Fails the test when the system does not offer that. */
void sandbox_enter(const struct sandbox *sandbox);

/* Runs act() in a child, in which assertions may be used, and fails the test if one of them fails or the child does not
 * end by itself. */
void sandbox_child(void (*act)(const void *argument), const void *argument);

#endif
