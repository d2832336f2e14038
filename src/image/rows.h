/* Rows of pictures. */
#ifndef IMAGE_ROWS_H
#define IMAGE_ROWS_H

#include <stddef.h>

/* Reverses the order of `count` rows of `bytes` each, which follow each other. */
void rows_reverse(void *rows, size_t bytes, unsigned count);

#endif
