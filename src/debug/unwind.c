/* The process's own unwinder, libgcc, to which the call frame information of generated code has to be
 * registered. Source: libgcc's unwind-dw2-fde.h. The usual function, __register_frame, allocates memory
 * without a check for failure; __register_frame_info uses memory of the caller. */
#include "debug/debug.h"
#include "debug/dwarf.h"

#include <stdint.h>
#include <stdlib.h>

enum { OBJECT_WORDS = 16 }; /* libgcc's struct object has 6 to 8 */

struct registered {
    void *frames;
    uintptr_t object[OBJECT_WORDS];
};

void __register_frame_info(const void *begin, void *object);
void *__deregister_frame_info(const void *begin);

static int open_unwinder(struct error *error)
{
    (void)error;
    return 0;
}

static int add(const struct debug_code *code, void **record, struct error *error)
{
    struct registered *registered = calloc(1, sizeof *registered);
    struct bytes frames = {0};
    dwarf_frame(code, DWARF_EH_FRAME, &frames);
    if (frames.failed || !registered) {
        bytes_free(&frames);
        free(registered);
        return error_set(error, "out of memory for unwinding %s", code->name);
    }
    registered->frames = frames.data;
    __register_frame_info(frames.data, registered->object);
    *record = registered;
    return 0;
}

static void remove_frame(void *record)
{
    struct registered *registered = record;
    __deregister_frame_info(registered->frames);
    free(registered->frames);
    free(registered);
}

const struct debug_interface debug_to_unwind = {open_unwinder, add, remove_frame};
