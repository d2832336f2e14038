/* Children under a system that refuses: seccomp filters on the calls that executable memory takes. */
#ifndef TESTS_SUPPORT_SYSTEM_SANDBOX_H
#define TESTS_SUPPORT_SYSTEM_SANDBOX_H

/* The permissions that mmap, mprotect and pkey_mprotect refuse: a protection with all bits of `protection`.
 * `shared` excepts private mappings, which load programs and libraries. */
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

/* Runs act() in a child, in which assertions may be used, and fails the test if one of them fails or the
 * child does not end by itself. */
void sandbox_child(void (*act)(const void *argument), const void *argument);

#endif
