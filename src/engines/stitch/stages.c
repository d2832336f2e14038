/* The planner of stage granularity: the hand-tuned fragments that a key needs, in the order of the
 * specification's parts.
 *
 * Values travel from fragment to fragment in the registers that the fragments' files describe. plan_check()
 * proves that the order respects that. Results that nothing reads are not planned: an overridden diffuse
 * colour, or a camera-space position without point lights. This planner never falls back to operation
 * fragments. */
#include "engines/stitch/stages.h"

void plan_stages(struct plan *plan, enum unit unit, const union key *key)
{
    static void (*const plan_unit[UNIT_COUNT])(struct plan *, const union key *) = {
        stages_vertex, stages_setup, stages_pixel};
    plan_unit[unit](plan, key);
}
