#include "command/explore/record.h"

#include "machine/mxcsr.h"

#include <stdlib.h>

struct env;

static struct env *note_place(struct env *e, const char *file, int line, const char *function,
                              const void *frame);

#define E note_place(e, __FILE__, __LINE__, __func__, __builtin_frame_address(0))

#include "ir/bind.h"
#include "spec/spec.h"

enum { DEPTH_MAXIMUM = 1024, FIRST_PLACES = 256 };

/* Of the recording that is being made, by one thread at a time. */
static _Thread_local struct noting {
    struct explore_recording *recording;
    uint32_t noted;   /* the instructions below this have places */
    uint32_t current; /* the place of the next ones */
    unsigned depth;
    struct {
        uintptr_t frame;
        uint32_t place;
    } stack[DEPTH_MAXIMUM];
    bool failed;
} noting;

static uint32_t add_place(struct explore_recording *r, struct explore_place place)
{
    if (r->place_count == r->place_capacity) {
        uint32_t capacity = r->place_capacity ? 2 * r->place_capacity : FIRST_PLACES;
        struct explore_place *larger = realloc(r->places, capacity * sizeof *larger);
        if (!larger) {
            noting.failed = true;
            return EXPLORE_NO_PLACE;
        }
        r->places = larger;
        r->place_capacity = capacity;
    }
    r->places[r->place_count] = place;
    return r->place_count++;
}

/* Place 0 is the root, whose children have no caller. */
static uint32_t find_place(uint32_t caller, const char *file, int line, const char *function)
{
    struct explore_recording *r = noting.recording;
    uint32_t parent = caller == EXPLORE_NO_PLACE ? 0 : caller;
    for (uint32_t at = r->places[parent].child; at; at = r->places[at].sibling)
        if (r->places[at].line == (uint32_t)line && r->places[at].function == function)
            return at;
    uint32_t added = add_place(r, (struct explore_place){.file = spec_path(file),
                                                         .function = function,
                                                         .line = (uint32_t)line,
                                                         .caller = caller,
                                                         .sibling = r->places[parent].child});
    if (added == EXPLORE_NO_PLACE)
        return caller;
    r->places[parent].child = added;
    return added;
}

static void note_instructions(const struct ir *ir)
{
    while (noting.noted < ir->count)
        noting.recording->place[noting.noted++] = noting.current;
}

/* The stack grows down: frames below that of the caller belong to functions that have returned. */
static struct env *note_place(struct env *e, const char *file, int line, const char *function,
                              const void *frame)
{
    uintptr_t here = (uintptr_t)frame;
    note_instructions(e->ir);
    while (noting.depth && noting.stack[noting.depth - 1].frame <= here)
        noting.depth--;
    uint32_t caller = noting.depth ? noting.stack[noting.depth - 1].place : EXPLORE_NO_PLACE;
    noting.current = find_place(caller, file, line, function);
    if (noting.depth < DEPTH_MAXIMUM) {
        noting.stack[noting.depth].frame = here;
        noting.stack[noting.depth++].place = noting.current;
    }
    return record_at(e, file, line);
}

static void record_spec(struct ir *ir, enum unit unit, const union key *key)
{
    struct env e = {.ir = ir, .program = key_shader(unit, key)};
    struct triangle_layout layout = layout_of_unit(unit, key);
    unsigned saved = mxcsr_enter();
    ir_start(ir);
    ir_note_records(ir, unit, key);
    switch (unit) {
    case UNIT_VERTEX: spec_vertex(&e, &key->vertex); break;
    case UNIT_SETUP: spec_setup(&e, &key->setup, &layout); break;
    default: spec_pixel(&e, &key->pixel, &layout); break;
    }
    mxcsr_leave(saved);
    note_instructions(ir);
}

int explore_record(struct explore_recording *recording, enum unit unit, const union key *key,
                   struct error *error)
{
    *recording = (struct explore_recording){.ir = malloc(sizeof *recording->ir),
                                            .place = malloc(IR_CAPACITY * sizeof *recording->place)};
    if (recording->ir)
        recording->ir->overflow = false;
    noting = (struct noting){.recording = recording, .current = EXPLORE_NO_PLACE};
    add_place(recording, (struct explore_place){.file = "", .function = "", .caller = EXPLORE_NO_PLACE});
    if (!recording->ir || !recording->place || noting.failed)
        return error_set(error, "out of memory for a recording (%zu bytes)", sizeof *recording->ir);
    record_spec(recording->ir, unit, key);
    if (noting.failed)
        return error_set(error, "out of memory for the places of a recording");
    if (recording->ir->overflow)
        return error_set(error, "the %s routine takes more than %d operations", unit_name[unit],
                         IR_CAPACITY - 1);
    return 0;
}

void explore_record_free(struct explore_recording *recording)
{
    free(recording->ir);
    free(recording->place);
    free(recording->places);
    *recording = (struct explore_recording){0};
}
