/* Programs (program.h) through the stitcher: each instruction of the IR as an operation. */
#ifndef TESTS_STITCHED_H
#define TESTS_STITCHED_H

#include "stitch/plan.h"
#include "tests/support/program.h"

/* Plans the program as a vertex routine. Returns the bytes of the frame's slots. */
int stitched_plan(struct plan *plan, const struct ir *ir);

/* A valid program of about `length` operations most of which the stitcher fuses (def/fusion.def), some of whose
 * parts are read again and some not. */
void stitched_make_fusing(struct ir *ir, unsigned length, uint64_t *seed);

/* Plans, joins and runs. Returns 0, or -1 with the reason. */
int stitched_run(struct plan *plan, const struct ir *ir, struct code_arena *arena, struct program_data *data,
                 struct error *error);

#endif
