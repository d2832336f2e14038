/* Child processes in which the system refuses executable memory: seccomp filters on the system calls that
 * allocate it. */
#ifndef TESTS_SUPPORT_SYSTEM_SANDBOX_H
#define TESTS_SUPPORT_SYSTEM_SANDBOX_H

/* The system calls that a filter refuses. */
struct sandbox {
    int protection;   /* mmap, mprotect and pkey_mprotect with all of these bits; 0: none */
    int shared;       /* of these only mmap with MAP_SHARED; private mappings load programs and libraries */
    int memory_files; /* memfd_create too */
    int error;        /* errno of a refused call; 0: the call ends the process (SIGSYS) */
};

/* The filters of common systems. */
enum { SANDBOX_REFUSALS = 6 };
extern const struct sandbox sandbox_refusals[SANDBOX_REFUSALS];

/* Installs the filter in the calling process, which cannot remove it. Fails the test if the system has no
 * seccomp filters. */
void sandbox_enter(const struct sandbox *sandbox);

/* Runs act() in a child process. act() may use assertions. Fails the test if an assertion fails or if a
 * signal ends the child. */
void sandbox_child(void (*act)(const void *argument), const void *argument);

#endif
