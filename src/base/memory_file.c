#define _GNU_SOURCE /* fopencookie */
#include "base/memory_file.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { FIRST_CAPACITY = 4096 };

/* The state of an open file. Its last bytes arrive when the file is closed; memory_file_close then takes
 * them. */
struct memory {
    char *text;
    size_t bytes, capacity;
    bool failed;
};

static _Thread_local struct memory closed;

/* Makes room for more bytes and a final zero. */
static bool grow(struct memory *memory, size_t more)
{
    size_t capacity = memory->capacity;
    while (capacity - memory->bytes <= more)
        capacity = capacity ? 2 * capacity : FIRST_CAPACITY;
    if (capacity == memory->capacity)
        return true;
    char *text = realloc(memory->text, capacity);
    if (!text)
        return false;
    memory->text = text;
    memory->capacity = capacity;
    return true;
}

static ssize_t write_memory(void *user, const char *data, size_t bytes)
{
    struct memory *memory = user;
    memory->failed |= !grow(memory, bytes);
    if (memory->failed)
        return 0;
    memcpy(memory->text + memory->bytes, data, bytes);
    memory->bytes += bytes;
    return (ssize_t)bytes;
}

static int close_memory(void *user)
{
    closed = *(struct memory *)user;
    free(user);
    return 0;
}

FILE *memory_file_open(void)
{
    struct memory *memory = calloc(1, sizeof *memory);
    FILE *file = memory ? fopencookie(memory, "w",
                                      (cookie_io_functions_t){.write = write_memory, .close = close_memory})
                        : NULL;
    if (!file)
        free(memory);
    return file;
}

int memory_file_close(FILE *file, char **text, size_t *bytes)
{
    int bad = fclose(file);
    if (bad || closed.failed || !grow(&closed, 0)) {
        free(closed.text);
        *text = NULL;
        return -1;
    }
    closed.text[closed.bytes] = 0;
    *text = closed.text;
    *bytes = closed.bytes;
    return 0;
}
