/* Dead-code elimination: backward, from the stores. A region in which nothing is left goes with its
 * condition.
 *
 * This is where a vertex output that the pixel routine does not read disappears with all that computed it:
 * the key has no store for it. */
#include "jit/pass.h"

#include <string.h>

/* Memory effects are live; regions are decided when their `when` is reached from behind. */
static int is_root(const struct ir_instruction *i)
{
    return i->op == IR_store || i->op == IR_scatter;
}

static void mark_operands(const struct ir_instruction *i, uint8_t *live)
{
    for (int o = 0; o < 3; o++)
        live[i->operand[o]] = 1;
}

unsigned pass_dead(struct ir *ir, struct pass_memory *memory)
{
    unsigned changes = 0;
    uint8_t *live = memory->flag;
    uint16_t *end = memory->table; /* stack of open regions' ends, seen from behind */
    uint16_t *kept = memory->map;  /* live instructions seen since, per level */
    unsigned depth = 0;
    memset(live, 0, ir->count);
    kept[0] = 0;
    for (uint32_t number = ir->count - 1; number > 0; number--) {
        struct ir_instruction *i = &ir->instruction[number];
        if (i->op == IR_nop)
            continue;
        if (i->op == IR_end) {
            end[++depth] = (uint16_t)number;
            kept[depth] = 0;
            continue;
        }
        int keep = live[number] || is_root(i);
        if (i->op == IR_when) {
            keep = kept[depth] != 0;
            if (!keep) {
                ir->instruction[end[depth]] = (struct ir_instruction){0};
                changes++;
            }
            depth--;
        }
        if (keep) {
            mark_operands(i, live);
            kept[depth]++;
        } else {
            *i = (struct ir_instruction){0};
            changes++;
        }
    }
    return changes;
}
