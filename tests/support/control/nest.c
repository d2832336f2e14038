#include "nest.h"

#include <string.h>

/* The lengths of loops: the low bits of a datum, when the loop begins. */
enum { LIMIT_MASK = 3 };

static uint32_t word(uint64_t *seed)
{
    *seed ^= *seed << 13;
    *seed ^= *seed >> 7;
    *seed ^= *seed << 17;
    return (uint32_t)(*seed >> 16);
}

/* --- Making --------------------------------------------------------------------------------------------- */

static uint8_t make_list(struct nest *nest, unsigned depth, enum nest_kind inside, uint64_t *seed);

static enum nest_kind choose(unsigned depth, enum nest_kind inside, uint64_t *seed)
{
    enum nest_kind kind = (enum nest_kind)(word(seed) % NEST_KINDS);
    bool opens = kind == NEST_IF || kind == NEST_WHILE || kind == NEST_FLOW;
    bool leaves_loop = kind == NEST_BREAK || kind == NEST_CONTINUE;
    if ((opens && !depth) || (leaves_loop && inside != NEST_WHILE) ||
        (kind == NEST_GOTO && inside != NEST_FLOW))
        return NEST_STEP;
    return kind;
}

/* A condition belongs to the loop or flow around it. */
static void make_bodies(struct nest *nest, struct nest_node *node, unsigned depth, enum nest_kind inside,
                        uint64_t *seed)
{
    enum nest_kind within = node->kind == NEST_IF ? inside : (enum nest_kind)node->kind;
    unsigned bodies = node->kind == NEST_FLOW ? NEST_BLOCKS : 1;
    for (unsigned b = 0; b < bodies; b++)
        node->body[b] = make_list(nest, depth - 1, within, seed);
}

static uint8_t make_list(struct nest *nest, unsigned depth, enum nest_kind inside, uint64_t *seed)
{
    uint8_t first = 0, *link = &first;
    for (unsigned n = 1 + word(seed) % 3; n && nest->nodes < NEST_NODES; n--) {
        unsigned number = nest->nodes++;
        struct nest_node *node = &nest->node[number];
        *node = (struct nest_node){.kind = (uint8_t)choose(depth, inside, seed),
                                   .data = (uint8_t)(word(seed) % NEST_DATA),
                                   .block = (uint8_t)(word(seed) % (NEST_BLOCKS + 1)),
                                   .number = 1 + (int32_t)(word(seed) % 7)};
        nest->kinds[node->kind]++;
        *link = (uint8_t)number;
        link = &node->next;
        if (node->kind == NEST_IF || node->kind == NEST_WHILE || node->kind == NEST_FLOW)
            make_bodies(nest, node, depth, inside, seed);
    }
    return first;
}

void nest_make(struct nest *nest, uint64_t *seed)
{
    memset(nest, 0, sizeof *nest);
    nest->nodes = 1; /* 0 is none; the program begins at 1 */
    make_list(nest, 4, NEST_STEP, seed);
}

/* --- Computing ------------------------------------------------------------------------------------------ */

enum way { GOES_ON, LEAVES_LOOP, LEAVES_PASS, JUMPS };

struct lane {
    const struct nest *nest;
    int32_t *data;
    unsigned block; /* where it jumps to */
};

static enum way compute_list(struct lane *lane, unsigned number);

static bool holds(const struct lane *lane, const struct nest_node *node)
{
    return !(lane->data[node->data] & node->number);
}

static void compute_while(struct lane *lane, const struct nest_node *node)
{
    int32_t count = 0, limit = lane->data[node->data] & LIMIT_MASK;
    while (count < limit) {
        count++;
        if (compute_list(lane, node->body[0]) == LEAVES_LOOP)
            break;
    }
}

/* A block that is entered too often does nothing, so jumps backward end. */
static void compute_flow(struct lane *lane, const struct nest_node *node)
{
    int32_t jumps = 0;
    for (unsigned block = 0; block < NEST_BLOCKS;) {
        unsigned next = block + 1;
        if (jumps++ < 2 * NEST_BLOCKS && compute_list(lane, node->body[block]) == JUMPS)
            next = lane->block;
        block = next;
    }
}

static enum way compute_node(struct lane *lane, const struct nest_node *node)
{
    uint32_t *datum = (uint32_t *)&lane->data[node->data];
    switch ((enum nest_kind)node->kind) {
    case NEST_IF: return holds(lane, node) ? compute_list(lane, node->body[0]) : GOES_ON;
    case NEST_WHILE: compute_while(lane, node); return GOES_ON;
    case NEST_FLOW: compute_flow(lane, node); return GOES_ON;
    case NEST_BREAK: return holds(lane, node) ? LEAVES_LOOP : GOES_ON;
    case NEST_CONTINUE: return holds(lane, node) ? LEAVES_PASS : GOES_ON;
    case NEST_GOTO: lane->block = node->block; return holds(lane, node) ? JUMPS : GOES_ON;
    case NEST_STEP:
    case NEST_KINDS: break;
    }
    *datum = *datum * 3 + (uint32_t)node->number;
    *datum ^= (uint32_t)lane->data[(node->data + 1) % NEST_DATA];
    return GOES_ON;
}

static enum way compute_list(struct lane *lane, unsigned number)
{
    for (; number; number = lane->nest->node[number].next) {
        enum way way = compute_node(lane, &lane->nest->node[number]);
        if (way != GOES_ON)
            return way;
    }
    return GOES_ON;
}

void nest_compute(const struct nest *nest, int32_t data[NEST_DATA])
{
    struct lane lane = {nest, data, 0};
    compute_list(&lane, nest->nodes > 1);
}
