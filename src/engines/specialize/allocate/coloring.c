/* The allocator `coloring`: graph colouring (Chaitin 1982, Briggs 1994).
 *
 * The nodes are webs, and an edge joins two that are alive together, so that they need different registers. A
 * node with fewer neighbours than registers can always be coloured after the others: such nodes are removed
 * one by one. If none is left, the node with the least cost for its number of neighbours is removed, although
 * it may get no colour. Then the nodes return in reverse order, and each takes a register that none of its
 * neighbours has: if possible that of an operand that dies where it is defined. A node without a colour is
 * spilled, everywhere: unlike with `scan`, it is in no register before either. Scratch registers are reserved
 * for spilled values, so spilling adds no nodes and nothing is coloured twice.
 *
 * Intervals are those of `scan`, in which straight-line code has no gaps. Where more than ALIVE_LIMIT webs of
 * one kind are alive together, the cheapest are spilled before the graph is made, which bounds its edges. */
#include "engines/specialize/allocate/allocate.h"

#include <stdlib.h>
#include <string.h>

struct coloring {
    const struct ir *ir;
    struct allocation *allocation;
    struct allocate_graph *graph;
    uint64_t registers; /* a bit for each available register */
};

static bool is_node(const struct coloring *c, uint32_t number)
{
    const struct allocation *a = c->allocation;
    return a->residence[number] == RESIDENCE_REGISTER && allocate_web(a, number) == number &&
           !c->graph->spilled[number];
}

static unsigned kind_of(const struct coloring *c, unsigned web)
{
    return allocate_is_mask(c->allocation, &c->ir->instruction[web]);
}

static uint64_t registers_of_kind(const struct coloring *c, unsigned kind)
{
    return c->registers & (kind ? MASK_REGISTERS : WIDE_REGISTERS);
}

/* The cost of spilling a web: its uses, and its definitions if they are stored; in loops, each counts as
 * often as it may run. */
static uint32_t cost_of(const struct coloring *c, unsigned web)
{
    const struct allocation *a = c->allocation;
    return c->ir->loops ? a->weight[web] : a->uses[web] + 1;
}

/* --- The graph ------------------------------------------------------------------------------------------ */

/* The webs that are alive at a position of the walk, by kind. */
struct alive {
    unsigned count[2];
    uint16_t web[2][ALIVE_LIMIT + 1];
};

/* Removes webs that die before position `number` defines a value, or at the latest there. */
static void bury(const struct coloring *c, struct alive *alive, uint32_t number)
{
    const struct allocation *a = c->allocation;
    bool keeps = allocate_keeps_operands(&c->ir->instruction[number]);
    for (unsigned kind = 0; kind < 2; kind++) {
        unsigned kept = 0;
        for (unsigned n = 0; n < alive->count[kind]; n++) {
            unsigned web = alive->web[kind][n];
            if (a->last[web] > number || (a->last[web] == number && keeps))
                alive->web[kind][kept++] = (uint16_t)web;
        }
        alive->count[kind] = kept;
    }
}

/* Spills the cheapest of the webs that are alive, for the rest of its life. */
static void relieve(const struct coloring *c, struct alive *alive, unsigned kind)
{
    const struct allocation *a = c->allocation;
    unsigned cheapest = 0;
    for (unsigned n = 1; n < alive->count[kind]; n++) {
        unsigned x = alive->web[kind][n], y = alive->web[kind][cheapest];
        uint32_t cost = cost_of(c, x), least = cost_of(c, y);
        if (cost < least || (cost == least && a->last[x] > a->last[y]))
            cheapest = n;
    }
    c->graph->spilled[alive->web[kind][cheapest]] = 1;
    alive->web[kind][cheapest] = alive->web[kind][--alive->count[kind]];
}

typedef void edge_visitor(struct allocate_graph *graph, unsigned web, unsigned neighbour);

/* Visits each edge once. Without a visitor, limits the number of webs that are alive together. */
static void walk(const struct coloring *c, edge_visitor *visit)
{
    struct alive alive = {.count = {0}};
    for (uint32_t number = 1; number < c->ir->count; number++) {
        bury(c, &alive, number);
        if (!is_node(c, number))
            continue;
        unsigned kind = kind_of(c, number), count = alive.count[kind];
        for (unsigned n = 0; visit && n < count; n++)
            visit(c->graph, number, alive.web[kind][n]);
        alive.web[kind][alive.count[kind]++] = (uint16_t)number;
        if (alive.count[kind] > ALIVE_LIMIT)
            relieve(c, &alive, kind);
    }
}

static void count_edge(struct allocate_graph *g, unsigned web, unsigned neighbour)
{
    g->degree[web]++;
    g->degree[neighbour]++;
}

static void add_edge(struct allocate_graph *g, unsigned web, unsigned neighbour)
{
    g->edge[g->end[web]++] = (uint16_t)neighbour;
    g->edge[g->end[neighbour]++] = (uint16_t)web;
}

/* The neighbours of a web are the edges from its begin to its end. */
static void make_graph(const struct coloring *c)
{
    struct allocate_graph *g = c->graph;
    uint32_t edges = 0;
    memset(g->spilled, 0, c->ir->count * sizeof g->spilled[0]);
    memset(g->removed, 0, c->ir->count * sizeof g->removed[0]);
    memset(g->degree, 0, c->ir->count * sizeof g->degree[0]);
    walk(c, NULL);
    walk(c, count_edge);
    for (uint32_t number = 0; number < c->ir->count; number++) {
        g->begin[number] = g->end[number] = edges;
        edges += g->degree[number];
    }
    walk(c, add_edge);
}

/* --- Removing ------------------------------------------------------------------------------------------- */

static unsigned colors_for(const struct coloring *c, unsigned web)
{
    return (unsigned)__builtin_popcountll(registers_of_kind(c, kind_of(c, web)));
}

/* Removes a web, and notes neighbours that now have fewer neighbours than there are registers. */
static void remove_web(const struct coloring *c, unsigned web, uint32_t *easy)
{
    struct allocate_graph *g = c->graph;
    unsigned colors = colors_for(c, web);
    g->removed[web] = 1;
    g->order[g->ordered++] = (uint16_t)web;
    for (uint32_t e = g->begin[web]; e < g->end[web]; e++) {
        unsigned neighbour = g->edge[e];
        if (!g->removed[neighbour] && g->degree[neighbour]-- == colors)
            g->easy[(*easy)++] = (uint16_t)neighbour;
    }
}

static void remove_easy(const struct coloring *c, uint32_t *easy)
{
    struct allocate_graph *g = c->graph;
    while (*easy) {
        unsigned web = g->easy[--*easy];
        if (!g->removed[web])
            remove_web(c, web, easy);
    }
}

static int by_cost(const void *x, const void *y)
{
    const struct allocate_candidate *a = x, *b = y;
    return a->cost != b->cost ? (a->cost > b->cost) - (a->cost < b->cost) : a->web - b->web;
}

/* Finds the webs that are easy from the start, and orders the others by cost for each neighbour. */
static uint32_t find_candidates(const struct coloring *c, uint32_t *easy)
{
    struct allocate_graph *g = c->graph;
    uint32_t candidates = 0;
    for (uint32_t number = 1; number < c->ir->count; number++) {
        if (!is_node(c, number))
            continue;
        if (g->degree[number] < colors_for(c, number))
            g->easy[(*easy)++] = (uint16_t)number;
        else
            g->candidate[candidates++] = (struct allocate_candidate){
                .cost = (float)cost_of(c, number) / (float)(g->degree[number] + 1), .web = (uint16_t)number};
    }
    qsort(g->candidate, candidates, sizeof g->candidate[0], by_cost);
    return candidates;
}

static void order_webs(const struct coloring *c)
{
    struct allocate_graph *g = c->graph;
    uint32_t easy = 0;
    g->ordered = 0;
    uint32_t candidates = find_candidates(c, &easy);
    remove_easy(c, &easy);
    for (uint32_t n = 0; n < candidates; n++)
        if (!g->removed[g->candidate[n].web]) {
            remove_web(c, g->candidate[n].web, &easy);
            remove_easy(c, &easy);
        }
}

/* --- Colouring ------------------------------------------------------------------------------------------ */

/* The register of an operand that dies at the definition of a web, preferably of the last operand, which a
 * fused multiply-add overwrites; or of a web that is defined where this one dies. */
static unsigned preferred_color(const struct coloring *c, unsigned web, uint64_t free)
{
    const struct allocation *a = c->allocation;
    const struct ir_instruction *i = &c->ir->instruction[web];
    for (int o = 2; o >= 0; o--) {
        unsigned value = allocate_web(a, i->operand[o]);
        if (value && a->last[value] == web && a->reg[value] < REGISTERS && free >> a->reg[value] & 1)
            return a->reg[value];
    }
    unsigned heir = allocate_web(a, a->last[web]);
    if (a->residence[a->last[web]] == RESIDENCE_REGISTER && a->reg[heir] < REGISTERS &&
        free >> a->reg[heir] & 1)
        return a->reg[heir];
    return NO_REGISTER;
}

static void color(const struct coloring *c, unsigned web)
{
    struct allocation *a = c->allocation;
    const struct allocate_graph *g = c->graph;
    uint64_t free = registers_of_kind(c, kind_of(c, web));
    for (uint32_t e = g->begin[web]; e < g->end[web]; e++)
        if (a->reg[g->edge[e]] < REGISTERS)
            free &= ~(1ull << a->reg[g->edge[e]]);
    if (!free)
        return;
    uint64_t above = free & ~0ull << allocate_lot(a, REGISTERS);
    unsigned reg = preferred_color(c, web, free);
    if (reg == NO_REGISTER || allocate_lot(a, 4) == 1)
        reg = (unsigned)__builtin_ctzll(above ? above : free);
    a->reg[web] = (uint8_t)reg;
}

/* Every definition of a spilled web writes a scratch register, and stores it. */
static void assign_members(const struct coloring *c)
{
    struct allocation *a = c->allocation;
    for (uint32_t number = 1; number < c->ir->count; number++) {
        if (a->residence[number] != RESIDENCE_REGISTER)
            continue;
        unsigned web = allocate_web(a, number);
        if (web == number && a->reg[web] == NO_REGISTER) {
            a->reg[web] = kind_of(c, web) ? MASK_RESULT : SCRATCH_RESULT;
            a->split[web] = (uint16_t)web;
            a->spills++;
        }
        a->reg[number] = a->reg[web];
    }
}

void allocate_by_coloring(const struct ir *ir, struct allocation *allocation, uint64_t registers)
{
    const struct coloring c = {ir, allocation, &allocation->graph, registers};
    allocate_find_lives(ir, allocation);
    make_graph(&c);
    order_webs(&c);
    for (uint32_t n = allocation->graph.ordered; n-- > 0;)
        color(&c, allocation->graph.order[n]);
    assign_members(&c);
    allocate_slots(ir, allocation);
}
