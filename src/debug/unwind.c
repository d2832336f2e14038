/* The process's own unwinder, libgcc's: it finds the call frame information of code that no file holds where it is
 * registered. Source: libgcc's unwind-dw2-fde.h; LLVM and others rely on the same two functions. */
#include "debug/debug.h"
#include "debug/dwarf.h"

#include <stdlib.h>

void __register_frame(void *begin);
void __deregister_frame(void *begin);

static int open_unwinder(struct error *error)
{
    (void)error;
    return 0;
}

static int add(const struct debug_code *code, void **record, struct error *error)
{
    struct bytes frame = {0};
    dwarf_frame(code, DWARF_EH_FRAME, &frame);
    if (frame.failed) {
        bytes_free(&frame);
        return error_set(error, "out of memory for unwinding %s", code->name);
    }
    __register_frame(frame.data);
    *record = frame.data;
    return 0;
}

static void remove_frame(void *record)
{
    __deregister_frame(record);
    free(record);
}

const struct debug_interface debug_to_unwind = {open_unwinder, add, remove_frame};
