/* The loops over lanes of plain C: which instructions share one. */
#ifndef ENGINES_EXTERNAL_LANES_H
#define ENGINES_EXTERNAL_LANES_H

#include "ir/ir.h"

/* For each instruction of a recording. */
struct lanes {
    uint32_t group[IR_CAPACITY]; /* consecutive instructions of the same group share a loop; 0: outside */
    bool crosses[IR_CAPACITY];   /* another group uses the value: it is an array */
};

/* Returns true for a value that is the same in all lanes and needs no loop. */
bool external_is_one(const struct ir_instruction *instruction);

/* Fills `lanes`. An instruction begins a group
 *   - at the begin and the end of a region, which is a group of its own,
 *   - if it writes memory, which is a group of its own: no lane reads what another one writes in the loop,
 *   - if it sets a variable and `sets_alone` is true, a group of its own,
 *   - if it reads other lanes of a value of the current group (permute). */
void external_group_lanes(const struct ir *ir, bool sets_alone, struct lanes *lanes);

#endif
