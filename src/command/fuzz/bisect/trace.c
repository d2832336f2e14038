#include "command/fuzz/bisect/trace.h"

#include "machine/mxcsr.h"

#include <stdlib.h>
#include <string.h>

struct env;

/* Of the trace that is being made, by one thread at a time. */
static _Thread_local struct trace *current;
static _Thread_local int current_line;

static bool reserve(struct trace *trace)
{
    if (trace->count < trace->capacity)
        return true;
    uint32_t capacity = trace->capacity ? 2 * trace->capacity : 4096;
    struct traced *larger =
        capacity <= TRACE_CAPACITY ? realloc(trace->value, capacity * sizeof *larger) : NULL;
    if (!larger) {
        trace->full = true;
        return false;
    }
    trace->value = larger;
    trace->capacity = capacity;
    return true;
}

static void write_down(const void *lanes)
{
    struct traced *value = current->value + current->count;
    if (current->full || !reserve(current))
        return;
    value = current->value + current->count++;
    value->line = (uint16_t)current_line;
    memcpy(value->lane, lanes, sizeof value->lane);
}

static inline struct env *trace_at(struct env *e, int line)
{
    current_line = line;
    return e;
}

#define E           trace_at(e, __LINE__)
#define GIVE(value) (write_down(&(value)), (value))

#include "emu/emulate/bind.h"
#include "spec/spec.h"

void trace_emulate(struct trace *trace, enum unit unit, const union key *key,
                   const uint8_t *const base[BASE_COUNT])
{
    static _Thread_local struct env e;
    struct triangle_layout layout = layout_of_unit(unit, key);
    unsigned saved = mxcsr_enter();
    current = trace;
    trace->count = 0;
    trace->full = false;
    e.program = key_shader(unit, key);
    memcpy(e.base, base, sizeof e.base);
    switch (unit) {
    case UNIT_VERTEX: spec_vertex(&e, &key->vertex); break;
    case UNIT_SETUP: spec_setup(&e, &key->setup, &layout); break;
    case UNIT_BLIT: spec_blit(&e, &key->blit); break;
    default: spec_pixel(&e, &key->pixel, &layout); break;
    }
    mxcsr_leave(saved);
}

void trace_free(struct trace *trace)
{
    free(trace->value);
    *trace = (struct trace){0};
}
