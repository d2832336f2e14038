/* Text that is printed into memory, whole or not at all.
 *
 * Not open_memstream: where it is refused memory glibc drops characters, and neither ferror nor fclose tells. */
#ifndef BASE_MEMORY_FILE_H
#define BASE_MEMORY_FILE_H

#include <stdio.h>

/* A file to print to. Null when memory is refused. */
FILE *memory_file_open(void);

/* Closes the file. *text is what was printed, to be freed, with a zero byte behind its *bytes. Returns 0, or -1 and *text
 * null when memory was refused at any time. */
int memory_file_close(FILE *file, char **text, size_t *bytes);

#endif
