/* The keys and the run-time values that a situation derives to, and their comparison. */
#ifndef TESTS_SUPPORT_CHANGE_DERIVED_H
#define TESTS_SUPPORT_CHANGE_DERIVED_H

#include "tests/support/picture/situation.h"

/* The values that a draw reads at run time. */
struct values {
    struct job job;
    struct rectangle scissor;
    uint64_t wrapped;
    uint32_t shape, clip_ignored, last_pixel, line_extra, line_width, edges, sample_mask;
    struct attribute_job masks; /* of smooth edges */
};

struct derived {
    union key key[UNIT_COUNT];
    struct packed_key packed[UNIT_COUNT];
    struct values values;
};

void derived_make(const struct situation *situation, struct derived *d);

bool derived_key_differs(const struct derived *a, const struct derived *b, int unit);

bool derived_values_differ(const struct derived *a, const struct derived *b);

bool derived_differ(const struct derived *a, const struct derived *b);

bool derived_later_reads_differ(const struct derived *a, const struct derived *b, int unit);

#endif
