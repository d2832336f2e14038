/* Packs for external:c=pixels: up to four values of one pixel that the same operation computes. */
#ifndef ENGINES_EXTERNAL_PACK_H
#define ENGINES_EXTERNAL_PACK_H

#include "engines/external/lanes.h"

enum { PACK_LANES = 4, PACK_OPEN = 32 };

/* For each instruction of a recording. A computed value is in a pack of one to four members. Other values
 * are equal in all lanes of their vector. */
struct packs {
    uint16_t pack[IR_CAPACITY];               /* the first member of its pack; 0: in no pack */
    uint8_t lane[IR_CAPACITY];                /* its lane in the vector of the pack */
    uint16_t member[IR_CAPACITY][PACK_LANES]; /* of a first member: the member in each lane, or 0 */

    /* memory of external_pack */
    uint16_t open[PACK_OPEN]; /* packs of the current group, a ring */
    uint32_t opened;
    uint32_t stamp, seen[IR_CAPACITY];
    uint16_t work[IR_CAPACITY];
};

/* Fills `packs`. Members of a pack are in one loop over pixels (lanes.h), come from the same line of the
 * specification in the same step of the shader, and do not depend on each other, not even by way of other
 * packs. A value has the lane of an operand if that lane is free. */
void external_pack(const struct ir *ir, const struct lanes *lanes, struct packs *packs);

#endif
