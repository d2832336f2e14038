/* Programs (program.h) through the stitcher: each instruction of the IR as its operation fragment. */
#ifndef TESTS_STITCHED_H
#define TESTS_STITCHED_H

#include "stitch/plan.h"
#include "tests/support/program.h"

/* Plans the program as a vertex routine, with slots shared or not. Returns the bytes of the slots. */
int stitched_plan(struct plan *plan, const struct ir *ir, int share);

/* Plans, joins and runs. Returns 0, or -1 with the reason. */
int stitched_run(struct plan *plan, const struct ir *ir, int share, struct code_arena *arena,
                 struct program_data *data, struct error *error);

#endif
