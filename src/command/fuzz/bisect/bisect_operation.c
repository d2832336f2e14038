/* The first operation of a call whose value differs: that of the recording, observed in both engines. */
#include "command/fuzz/bisect/hunt.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool hunt_agrees(const struct ir *ir, uint32_t instruction, uint32_t a, uint32_t b)
{
    const struct ir_instruction *i = &ir->instruction[instruction];
    while (i->op == IR_copy)
        i = &ir->instruction[i->operand[0]];
    return a == b || (i->type == TYPE_flt && (a & 0x7fffffff) > 0x7f800000 && (b & 0x7fffffff) > 0x7f800000);
}

void hunt_note_lane(struct bisection *b, const struct replay *r, uint32_t lane)
{
    b->lane = lane;
    if (r->unit == UNIT_PIXEL)
        replay_pixel(r, lane, &b->x, &b->y);
    else if (r->unit == UNIT_BLIT)
        b->element = lane;
    else
        memcpy(&b->element, r->before + r->output_bytes + 4 * (size_t)lane, sizeof b->element);
}

void hunt_note(struct hunt *hunt, const struct ir *ir, const struct event_list *events, uint32_t event,
               unsigned lane, const uint32_t value[2])
{
    struct bisection *b = hunt->bisection;
    const struct event *e = events->event + event;
    const struct ir_instruction *i = &ir->instruction[e->instruction];
    b->outcome = BISECT_FOUND;
    hunt_note_lane(b, hunt->replay, hunt->probing.lane + lane);
    b->operation = ir_op_information[i->op].name;
    b->type = i->type;
    b->value[0] = value[0];
    b->value[1] = value[1];
    b->expected = e->lane[lane];
    b->instruction = e->instruction;
    b->in_loop = e->visit != 0;
    b->visit_pass = events->visit[e->visit].pass;
    if (i->line)
        snprintf(b->place, sizeof b->place, "%s:%u", ir->file[i->file], i->line);
}

/* Of an instruction in the recording, in a lane of the four. */
static uint32_t last_value(const struct hunt *hunt, uint32_t instruction, uint32_t lane)
{
    const struct event_list *events = &hunt->probing.events;
    for (uint32_t n = events->count; n-- > 0;)
        if (events->event[n].instruction == instruction)
            return events->event[n].lane[lane];
    return 0;
}

/* The store of the recording that writes the first word that differs. */
static void note_store(struct hunt *hunt)
{
    struct bisection *b = hunt->bisection;
    const uint8_t *base[BASE_COUNT];
    uint8_t *image = hunt->replay->before;
    replay_bases(hunt->replay, image, hunt->probing.lane, base);
    for (uint32_t n = 1; n < hunt->ir->count; n++) {
        const struct ir_instruction *i = &hunt->ir->instruction[n];
        uint32_t lane = hunt->place.element - hunt->probing.lane;
        int32_t step = i->op == IR_scatter ? i->field : 4;
        if ((i->op != IR_store && i->op != IR_scatter) || lane >= QUAD_LANES ||
            base[i->base] + i->k + (ptrdiff_t)lane * step != image + hunt->place.at)
            continue;
        b->operation = ir_op_information[i->op].name;
        b->instruction = n;
        b->type = hunt->ir->instruction[i->operand[0]].type;
        b->expected = last_value(hunt, i->operand[0], lane);
        snprintf(b->place, sizeof b->place, "%s:%u", hunt->ir->file[i->file], i->line);
    }
}

/* No observed value differs. Then the store is wrong, unless some values were not observed. */
static void note_nothing(struct hunt *hunt, int wrong, uint32_t unseen)
{
    struct bisection *b = hunt->bisection;
    const char *why = "all %u values are equal: a store is wrong or missing";
    if (hunt->probing.events.cut)
        why = "the values of the first %u operations are equal; later ones were not observed";
    else if (unseen)
        why = "of %u values, none that was observed differs: probes make the difference disappear";
    else if (wrong >= 0 && probe_reading(hunt->routine[wrong]) == READING_TRACED)
        why = "all %u values are equal in a second compilation of the emulator, with which they are traced";
    else
        b->outcome = BISECT_FOUND;
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
    snprintf(b->reason, sizeof b->reason, why, hunt->probing.events.count);
#pragma GCC diagnostic pop
}

/* Finds the first event, in the order of execution, whose two values were observed and differ. */
static void compare_events(struct hunt *hunt, int wrong)
{
    const struct event_list *events = &hunt->probing.events;
    uint32_t unseen = 0;
    for (uint32_t n = 0; n < events->count; n++) {
        unsigned seen = hunt->seen[0].known[n] & hunt->seen[1].known[n];
        if (!seen) {
            unseen++;
            continue;
        }
        for (unsigned l = 0; l < QUAD_LANES; l++) {
            unsigned lane = (hunt->place.element + l) % QUAD_LANES; /* that of the output first */
            uint32_t value[2] = {hunt->seen[0].value[n][lane], hunt->seen[1].value[n][lane]};
            if (!(seen >> lane & 1) ||
                hunt_agrees(hunt->ir, events->event[n].instruction, value[0], value[1]))
                continue;
            hunt_note(hunt, hunt->ir, events, n, lane, value);
            if (unseen)
                snprintf(hunt->bisection->reason, sizeof hunt->bisection->reason,
                         "%u values before it were not observed: probes there make the difference disappear",
                         unseen);
            return;
        }
    }
    note_nothing(hunt, wrong, unseen);
}

/* The side whose value is not that of the recording; -1 if unknown. */
static int wrong_side(const struct hunt *hunt)
{
    uint8_t *image = replay_image(hunt->replay), *ran = replay_image(hunt->replay);
    int side = -1;
    if (image && ran && interpret_all(hunt->interpreter, hunt->ir, hunt->replay, image))
        for (int i = 0; i < 2 && side < 0; i++) {
            replay_run(hunt->replay, hunt->routine[i], ran);
            if (replay_differs(hunt->replay, image, ran, NULL))
                side = i;
        }
    free(image);
    free(ran);
    return side;
}

/* The outputs of these stage fragments are right, so the values of the recording are used as theirs. */
static void take_recorded(const struct hunt *hunt, struct observation *seen)
{
    for (uint32_t n = 0; n < hunt->probing.events.count; n++) {
        memcpy(seen->value[n], hunt->probing.events.event[n].lane, sizeof *seen->value);
        seen->known[n] = OBSERVED_ALL;
    }
}

static int observe(struct hunt *hunt, int wrong, struct error *error)
{
    for (int i = 0; i < 2; i++)
        if (observation_start(hunt->seen + i, &hunt->probing.events))
            return error_set(error, "out of memory for %u values", hunt->probing.events.count);
    for (int i = 0; i < 2; i++)
        if (probe_reading(hunt->routine[i]) == READING_STAGES) {
            if (wrong == i)
                return hunt_stages(hunt, (unsigned)i, error);
            take_recorded(hunt, hunt->seen + i);
        } else if (probe_observe(&hunt->probing, hunt->routine[i], hunt->seen + i, error)) {
            return -1;
        }
    compare_events(hunt, wrong);
    return 0;
}

int hunt_operation(struct hunt *hunt, struct error *error)
{
    uint8_t *image = replay_image(hunt->replay);
    if (!image)
        return error_set(error, "out of memory for the call of a routine");
    uint32_t lane = hunt->place.element / QUAD_LANES * QUAD_LANES;
    memcpy(image, hunt->replay->before, hunt->replay->output_bytes + hunt->replay->table_bytes);
    interpret(hunt->interpreter, hunt->ir, hunt->replay, image, lane, true);
    free(image);
    hunt->probing = (struct probing){.ir = hunt->ir,
                                     .replay = hunt->replay,
                                     .events = interpreter_events(hunt->interpreter),
                                     .lane = lane,
                                     .arena = hunt->arena,
                                     .interpreter = hunt->interpreter};
    hunt->bisection->outcome = BISECT_NARROWED;
    note_store(hunt);
    int side = wrong_side(hunt);
    int result = observe(hunt, side, error);
    if (side >= 0 && !result)
        result = hunt_passes(hunt, (unsigned)side, error);
    for (int i = 0; i < 2; i++)
        observation_free(hunt->seen + i);
    return result;
}
