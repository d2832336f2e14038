/* The entry points for libFuzzer. The program runs the target whose name it is called by; each target has a
 * link to the program. */
#include "tests/command/fuzz/targets/target.h"

#include <string.h>

int LLVMFuzzerInitialize(int *argc, char ***argv);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t bytes);

static const struct fuzz_target *target;

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
    const char *slash = strrchr(**argv, '/');
    (void)argc;
    target = fuzz_target_named(slash ? slash + 1 : **argv);
    if (target)
        return 0;
    fprintf(stderr, "%s: no target of that name, expected", **argv);
    for (unsigned i = 0; fuzz_target_at(i); i++)
        fprintf(stderr, " %s", fuzz_target_at(i)->name);
    fputc('\n', stderr);
    exit(2);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t bytes)
{
    target->run(data, bytes);
    return 0;
}
