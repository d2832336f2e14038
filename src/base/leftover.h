/* Files and folders that must not stay behind when a signal ends the process while somebody works with them.
 *
 * Who makes one notes it before, and forgets it once it is gone or has become what it was made for. A signal's handler
 * calls leftovers_remove and ends the process. A process that is killed (SIGKILL) or loses its power leaves them: base/file.h
 * and external/compile.c say how their names are recognised. */
#ifndef BASE_LEFTOVER_H
#define BASE_LEFTOVER_H

/* Notes a path, which must not change until it is forgotten. Returns its number, or -1 when too many are noted, which
 * only means that this one would stay. Thread-safe. */
int leftover_note(const char *path);

/* A number that leftover_note returned. */
void leftover_forget(int number);

/* Removes all files that are noted, then all folders, which must be empty then. Async-signal-safe. */
void leftovers_remove(void);

#endif
