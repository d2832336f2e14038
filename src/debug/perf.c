/* perf's map: a line for each routine with start and size in hexadecimal and the name. Source: the Linux
 * kernel's tools/perf/Documentation/jit-interface.txt, which defines the path.
 *
 * A map has no times: if a routine has the address of an evicted one, both have a line. Jitdump distinguishes
 * them. */
#include "debug/debug.h"
#include "debug/log.h"

#include <stdio.h>
#include <unistd.h>

static struct log map = {.lock = PTHREAD_MUTEX_INITIALIZER};

static int open_map(struct error *error)
{
    char path[LOG_PATH_CAPACITY];
    snprintf(path, sizeof path, "/tmp/perf-%d.map", (int)getpid());
    return log_open(&map, path, error) < 0 ? -1 : 0;
}

static int add(const struct debug_code *code, void **record, struct error *error)
{
    char line[DEBUG_NAME_CAPACITY + 64];
    (void)record;
    int length =
        snprintf(line, sizeof line, "%zx %x %s\n", (size_t)(uintptr_t)code->code, code->bytes, code->name);
    return log_append(&map, &(struct bytes){.data = (uint8_t *)line, .count = (size_t)length}, error);
}

const struct debug_interface debug_to_perf = {open_map, add, NULL};
