#include "bench/clients/matcher/matcher.h"

const struct kernel_text matcher_kernel = {"matcher", matcher_record, matcher_execute};

void matcher_kernel_lines(const struct kernel *kernel, const struct automaton *automaton, const uint8_t *text,
                          int32_t *line, uint32_t lines, uint32_t *found)
{
    const struct matcher_job job = {text, automaton->table[0]};
    uint32_t padded = (lines + KERNEL_ELEMENTS - 1) / KERNEL_ELEMENTS * KERNEL_ELEMENTS;
    for (uint32_t n = lines; n < padded; n++)
        line[n] = line[lines - 1];
    kernel_run(kernel, &job, line, found, padded);
}
