/* Temporary files and folders to remove when a signal ends the process.
 *
 * Code that makes one notes its path first, and forgets it after removing or renaming it. A signal handler
 * calls leftovers_remove and ends the process. A process that is killed (SIGKILL) leaves its files;
 * base/file.h and engines/external/compile.c document their names. */
#ifndef BASE_LEFTOVER_H
#define BASE_LEFTOVER_H

/* Notes a path. The string must not change until it is forgotten. Returns its number, or -1 if too many are
 * noted; then the file is not removed after a signal. Thread-safe. */
int leftover_note(const char *path);

/* Forgets the path of that number; -1 is ignored. */
void leftover_forget(int number);

/* Removes all noted files, then all noted folders that are empty. Async-signal-safe. */
void leftovers_remove(void);

#endif
