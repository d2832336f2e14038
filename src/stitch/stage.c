/* placeholder while operation granularity is brought up */
#include "stitch/plan.h"
void plan_stages(struct plan *plan, enum unit unit, const union key *key)
{
    plan_operations(plan, unit, key);
}
