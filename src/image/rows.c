#include "image/rows.h"

#include <stdint.h>
#include <string.h>

static void exchange(uint8_t *a, uint8_t *b, size_t bytes)
{
    uint8_t part[512];
    for (size_t done = 0, next; done < bytes; done += next) {
        next = bytes - done < sizeof part ? bytes - done : sizeof part;
        memcpy(part, a + done, next);
        memcpy(a + done, b + done, next);
        memcpy(b + done, part, next);
    }
}

void rows_reverse(void *rows, size_t bytes, unsigned count)
{
    uint8_t *first = rows;
    for (unsigned i = 0; i < count / 2; i++)
        exchange(first + i * bytes, first + (count - 1 - i) * bytes, bytes);
}
