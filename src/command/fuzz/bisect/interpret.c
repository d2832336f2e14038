#include "command/fuzz/bisect/interpret.h"

#include "base/bits.h"
#include "machine/mxcsr.h"
#include "contract/lane.h"
#include "contract/arguments.h"

#include <stdlib.h>
#include <string.h>

enum { STEPS_MAXIMUM = 1 << 26, TABLE_BYTES = 1 << 12 /* an entry of the span reading's tables, and more */ };

typedef struct {
    uint32_t lane[QUAD_LANES];
} quad;

struct interpreter {
    const struct ir *ir;
    uint32_t lane; /* the first */
    const uint8_t *base[BASE_COUNT];
    uint8_t column[TABLE_BYTES], row[TABLE_BYTES];
    quad value[IR_CAPACITY];
    quad next[IR_CAPACITY]; /* of each phi */
    quad variable[VARIABLES];
    uint8_t ran[IR_CAPACITY];   /* of each `end`: whether its region ran the last time */
    uint16_t loop[IR_CAPACITY]; /* of each `loop`: its number */
    bool notes, cut;
    uint32_t visits, visit; /* the one that control is in */
    struct visit visit_of[VISIT_CAPACITY];
    uint32_t events;
    struct event event[EVENT_CAPACITY];
};

struct interpreter *interpreter_create(void)
{
    return malloc(sizeof(struct interpreter));
}

void interpreter_free(struct interpreter *interpreter)
{
    free(interpreter);
}

struct event_list interpreter_events(const struct interpreter *i)
{
    return (struct event_list){i->event, i->visit_of, i->events, i->visits, i->cut};
}

/* --- Regions -------------------------------------------------------------------------------------------- */

static void enter_visit(struct interpreter *m, struct visit visit)
{
    if (!m->notes)
        return;
    if (m->visits == VISIT_CAPACITY) {
        m->cut = true;
        return;
    }
    m->visit = m->visits;
    m->visit_of[m->visits++] = visit;
}

static bool any(quad q)
{
    return (q.lane[0] | q.lane[1] | q.lane[2] | q.lane[3]) != 0;
}

/* After a region that ran or was skipped. */
static uint32_t skip(struct interpreter *m, uint32_t when, bool runs)
{
    uint32_t end = ir_other_end(m->ir, when);
    m->ran[end] = runs;
    return runs ? when + 1 : end + 1;
}

/* The loop's next pass, whose phis take their next values together; or the instruction after the loop. */
static uint32_t repeat(struct interpreter *m, uint32_t again, bool goes_on)
{
    struct visit visit = m->visit_of[m->visit];
    if (!goes_on) {
        m->visit = visit.outer;
        return again + 1;
    }
    for (uint32_t n = again - 1; m->ir->instruction[n].op == IR_next || m->ir->instruction[n].op == IR_nop;
         n--)
        if (m->ir->instruction[n].op == IR_next)
            m->value[m->ir->instruction[n].operand[0]] = m->next[m->ir->instruction[n].operand[0]];
    visit.pass++;
    enter_visit(m, visit);
    return ir_other_end(m->ir, again) + 1;
}

static quad join(const struct interpreter *m, uint32_t number)
{
    uint32_t end = number;
    while (m->ir->instruction[end].op != IR_end)
        end--;
    return m->value[m->ir->instruction[number].operand[m->ran[end]]];
}

/* --- Memory --------------------------------------------------------------------------------------------- */

static const uint8_t *place(const struct interpreter *m, const struct ir_instruction *i)
{
    return m->base[i->base] + i->k;
}

static quad all(const uint8_t *address)
{
    quad result;
    for (int l = 0; l < QUAD_LANES; l++)
        memcpy(&result.lane[l], address, 4);
    return result;
}

static quad load(const uint8_t *address)
{
    quad result;
    memcpy(&result, address, sizeof result);
    return result;
}

static quad gather(const struct interpreter *m, const struct ir_instruction *i, quad index)
{
    const uint8_t *start = m->base[i->base];
    quad result;
    if (i->field != GATHER_DIRECT)
        memcpy(&start, start + i->field, sizeof start);
    for (int l = 0; l < QUAD_LANES; l++)
        memcpy(&result.lane[l], start + (ptrdiff_t)(int32_t)index.lane[l] * i->scale + i->k, 4);
    return result;
}

static void scatter(const struct interpreter *m, const struct ir_instruction *i, quad value)
{
    for (int l = 0; l < QUAD_LANES; l++)
        memcpy((uint8_t *)(uintptr_t)place(m, i) + l * i->field, &value.lane[l], 4);
}

static void store_where(const struct interpreter *m, const struct ir_instruction *i, quad value, quad where)
{
    for (int l = 0; l < QUAD_LANES; l++)
        if (where.lane[l])
            memcpy((uint8_t *)(uintptr_t)place(m, i) + 4 * l, &value.lane[l], 4);
}

static quad coverage(const struct interpreter *m, const struct ir_instruction *i)
{
    quad result;
    uint16_t bits;
    memcpy(&bits, place(m, i), sizeof bits);
    for (uint32_t l = 0; l < QUAD_LANES; l++)
        result.lane[l] = bits >> (m->lane + l) & 1 ? UINT32_MAX : 0;
    return result;
}

/* --- Instructions --------------------------------------------------------------------------------------- */

static quad permute(quad a, int32_t k)
{
    quad result;
    for (int l = 0; l < QUAD_LANES; l++)
        result.lane[l] = a.lane[k >> 2 * l & 3];
    return result;
}

static quad compute(const struct interpreter *m, const struct ir_instruction *i)
{
    quad result;
    for (int l = 0; l < QUAD_LANES; l++)
        result.lane[l] = ir_evaluate(i->op, m->value[i->operand[0]].lane[l], m->value[i->operand[1]].lane[l],
                                     m->value[i->operand[2]].lane[l], i->k);
    return result;
}

/* 1 / (value + y dy + x dx), as ir.h has it. */
static quad reciprocal(const struct interpreter *m, const struct ir_instruction *i)
{
    const uint8_t *plane = place(m, i);
    quad value = all(plane + offsetof(struct plane, value)), dx = all(plane + offsetof(struct plane, dx));
    quad dy = all(plane + offsetof(struct plane, dy)), x = m->value[i->operand[0]],
         y = m->value[i->operand[1]], result;
    for (int l = 0; l < QUAD_LANES; l++) {
        uint32_t row = ir_evaluate(IR_mad_f, y.lane[l], dy.lane[l], value.lane[l], 0);
        uint32_t sum = ir_evaluate(IR_mad_f, x.lane[l], dx.lane[l], row, 0);
        result.lane[l] = ir_evaluate(IR_div_f, bits_of_float(1.0f), sum, 0, 0);
    }
    return result;
}

static quad value_of(const struct interpreter *m, uint32_t number)
{
    const struct ir_instruction *i = &m->ir->instruction[number];
    quad a = m->value[i->operand[0]];
    switch (i->op) {
    case IR_literal: return all((const uint8_t *)&i->k);
    case IR_phi:
    case IR_copy: return a;
    case IR_load: return load(place(m, i));
    case IR_uniform: return all(place(m, i));
    case IR_constant: return all(m->base[m->ir->constant[i->k].base] + m->ir->constant[i->k].offset);
    case IR_gather: return gather(m, i, a);
    case IR_get: return m->variable[i->k];
    case IR_join: return join(m, number);
    case IR_coverage: return coverage(m, i);
    case IR_reciprocal: return reciprocal(m, i);
    case IR_permute: return permute(a, i->k);
    default: return compute(m, i);
    }
}

static void note(struct interpreter *m, uint32_t number)
{
    if (m->events == EVENT_CAPACITY || m->cut) {
        m->cut = true;
        return;
    }
    struct event *event = &m->event[m->events++];
    memcpy(event->lane, m->value[number].lane, sizeof event->lane);
    event->instruction = (uint16_t)number;
    event->visit = (uint16_t)m->visit;
}

/* Returns the number of the next one. */
static uint32_t step(struct interpreter *m, uint32_t number)
{
    const struct ir_instruction *i = &m->ir->instruction[number];
    quad a = m->value[i->operand[0]];
    switch (i->op) {
    case IR_nop:
    case IR_section:
    case IR_repeat:
    case IR_rest:
    case IR_window:
    case IR_near:
    case IR_near_column:
    case IR_near_row:
    case IR_end: break;
    case IR_loop:
        if (i->k == IR_LOOP_STRETCH || i->k == IR_LOOP_PAIRS)
            return ir_other_end(m->ir, number) + 1;
        enter_visit(m, (struct visit){m->visit, m->loop[number], 0});
        break;
    case IR_store: memcpy((uint8_t *)(uintptr_t)place(m, i), &a, sizeof a); break;
    case IR_store_where: store_where(m, i, a, m->value[i->operand[1]]); break;
    case IR_scatter: scatter(m, i, a); break;
    case IR_set: m->variable[i->k] = a; break;
    case IR_next: m->next[i->operand[0]] = m->value[i->operand[1]]; break;
    case IR_when: return skip(m, number, any(a));
    case IR_again: return repeat(m, number, any(a));
    default:
        m->value[number] = value_of(m, number);
        if (m->notes)
            note(m, number);
    }
    return number + 1;
}

bool interpret(struct interpreter *m, const struct ir *ir, const struct replay *replay, uint8_t *image,
               uint32_t lane, bool notes)
{
    unsigned saved = mxcsr_enter();
    m->ir = ir;
    lane %= replay->unit == UNIT_PIXEL ? BLOCK_PIXELS / ir->chunks : UINT32_MAX;
    m->lane = lane;
    m->notes = notes;
    m->visit = 0;
    if (notes) {
        m->cut = false;
        m->events = 0;
        m->visits = 1;
        m->visit_of[0] = (struct visit){0, 0, 0};
    }
    for (uint32_t number = 1, loop = 0; number < ir->count; number++)
        if (ir->instruction[number].op == IR_loop)
            m->loop[number] = (uint16_t)loop++;
    replay_bases(replay, image, lane, m->base);
    m->base[BASE_COLUMN] = m->column;
    m->base[BASE_ROW] = m->row;
    uint32_t steps = 0;
    for (uint32_t number = 1; number < ir->count && steps < STEPS_MAXIMUM; steps++)
        number = step(m, number);
    mxcsr_leave(saved);
    return steps < STEPS_MAXIMUM;
}

bool interpret_all(struct interpreter *m, const struct ir *ir, const struct replay *replay, uint8_t *image)
{
    bool ended = true;
    uint32_t lanes = replay->unit == UNIT_PIXEL ? BLOCK_PIXELS / ir->chunks : replay->count;
    memcpy(image, replay->before, replay->output_bytes + replay->table_bytes);
    for (uint32_t lane = 0; lane < lanes && ended; lane += QUAD_LANES)
        if (replay_has_quad(replay, lane))
            ended = interpret(m, ir, replay, image, lane, false);
    return ended;
}
