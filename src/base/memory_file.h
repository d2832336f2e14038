/* A FILE that prints into memory: the text is complete, or an error is reported.
 *
 * Unlike open_memstream: when memory is refused, glibc drops characters, and neither ferror nor fclose
 * reports it. */
#ifndef BASE_MEMORY_FILE_H
#define BASE_MEMORY_FILE_H

#include <stdio.h>

/* Opens the file. Returns null when memory is refused. */
FILE *memory_file_open(void);

/* Closes the file. *text is the printed text, followed by a zero byte that *bytes does not count; the caller
 * frees it. Returns 0, or -1 with *text null if memory was refused at any time. */
int memory_file_close(FILE *file, char **text, size_t *bytes);

#endif
