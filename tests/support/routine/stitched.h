/* Programs (program.h) through the stitcher: each instruction of the IR as an operation. */
#ifndef TESTS_SUPPORT_ROUTINE_STITCHED_H
#define TESTS_SUPPORT_ROUTINE_STITCHED_H

#include "engines/stitch/plan.h"
#include "tests/support/shader/program.h"

/* Plans the program as a vertex routine. Returns the bytes of the frame's slots. */
int stitched_plan(struct plan *plan, const struct ir *ir);

/* A valid program of about `length` operations. The stitcher fuses most of them (def/engine/fusion.def).
 * Some of the fused operands are read again. */
void stitched_make_fusing(struct ir *ir, unsigned length, uint64_t *seed);

/* Plans, joins and runs. Returns 0, or -1 with the reason. */
int stitched_run(struct plan *plan, const struct ir *ir, struct code_arena *arena, struct program_data *data,
                 struct error *error);

#endif
