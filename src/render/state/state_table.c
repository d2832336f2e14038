/* The tables of states, of their kinds and of the words of values, as the interface shows them. */
#include "render/state/state.h"
#include "render/state/primitive.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <string.h>

const struct state_primitive state_primitives[TRIPTYCH_PRIMITIVE_COUNT] = {
#define PRIMITIVE(name, word, kind, parts, each, more, meaning)                                              \
    [TRIPTYCH_##name] = {PRIMITIVE_##kind, parts, each, more},
#include "def/state/primitive.def"
#undef PRIMITIVE
};

enum {
#define KIND(name, ...) KIND_##name,
#include "def/state/kind.def"
#undef KIND
    KIND_COUNT
};

static const struct triptych_kind kinds[] = {
#define KIND(name, notation, prefix, first, last) {#name, TRIPTYCH_NOTATION_##notation, first, last, #prefix},
#include "def/state/kind.def"
#undef KIND
};

/* The values of a kind are consecutive. */
static const struct triptych_value values[] = {
#define VALUE(kind, word, number, support) {&kinds[KIND_##kind], #word, number, TRIPTYCH_SUPPORT_##support},
#include "def/state/value.def"
#undef VALUE
};

enum { VALUE_COUNT = sizeof values / sizeof *values };

_Static_assert(STATE_ROWS == (int)TRIPTYCH_STATE_COUNT, "the public header has the rows of state.def");
_Static_assert(SAMPLER_STATE_ROWS == (int)TRIPTYCH_SAMPLER_STATE_COUNT, "and those of sampler_state.def");
_Static_assert(STAGE_STATE_ROWS == (int)TRIPTYCH_STAGE_STATE_COUNT, "and those of stage_state.def");

#define ROW(number, name, kind, initial, units, change, support, test, meaning)                              \
    {number, #name, &kinds[KIND_##kind], units, TRIPTYCH_SUPPORT_##support, test, meaning},

static const struct triptych_state_row render_states[] = {
#define STATE ROW
#include "def/state/state.def"
#undef STATE
};

static const struct triptych_state_row sampler_states[] = {
#define SAMPLER_STATE ROW
#include "def/state/sampler_state.def"
#undef SAMPLER_STATE
};

static const struct triptych_state_row stage_states[] = {
#define STAGE_STATE ROW
#include "def/state/stage_state.def"
#undef STAGE_STATE
};

static const struct {
    const char *name;
    unsigned size, rows;
    const struct triptych_state_row *row;
} tables[TRIPTYCH_STATE_TABLE_COUNT] = {
    [TRIPTYCH_RENDER_STATES] = {"state", 1, TRIPTYCH_STATE_COUNT, render_states},
    [TRIPTYCH_SAMPLER_STATES] = {"sampler", TRIPTYCH_SAMPLERS, TRIPTYCH_SAMPLER_STATE_COUNT, sampler_states},
    [TRIPTYCH_STAGE_STATES] = {"stage", TRIPTYCH_STAGES, TRIPTYCH_STAGE_STATE_COUNT, stage_states},
};

static bool known(enum triptych_state_table table)
{
    return (unsigned)table < TRIPTYCH_STATE_TABLE_COUNT;
}

const char *triptych_table_name(enum triptych_state_table table)
{
    return known(table) ? tables[table].name : NULL;
}

unsigned triptych_table_size(enum triptych_state_table table)
{
    return known(table) ? tables[table].size : 0;
}

const struct triptych_state_row *triptych_state_at(enum triptych_state_table table, unsigned row)
{
    return known(table) && row < tables[table].rows ? &tables[table].row[row] : NULL;
}

static uint32_t render_default(unsigned row)
{
    static const uint32_t initial[] = {
#define STATE(number, name, kind, initial, ...) (uint32_t)(initial),
#include "def/state/state.def"
#undef STATE
    };
    return initial[row];
}

static uint32_t sampler_default(unsigned row, unsigned i)
{
    (void)i;
    switch (row) {
#define SAMPLER_STATE(number, name, kind, initial, ...)                                                      \
    case SAMPLER_##name:                                                                                     \
        return initial;
#include "def/state/sampler_state.def"
#undef SAMPLER_STATE
    default: return 0;
    }
}

static uint32_t stage_default(unsigned row, unsigned i)
{
    switch (row) {
#define STAGE_STATE(number, name, kind, initial, ...)                                                        \
    case STAGE_##name:                                                                                       \
        return initial;
#include "def/state/stage_state.def"
#undef STAGE_STATE
    default: return 0;
    }
}

uint32_t triptych_state_default(enum triptych_state_table table, unsigned row, unsigned i)
{
    if (!triptych_state_at(table, row))
        return 0;
    if (table == TRIPTYCH_SAMPLER_STATES)
        return sampler_default(row, i);
    return table == TRIPTYCH_STAGE_STATES ? stage_default(row, i) : render_default(row);
}

const struct triptych_kind *triptych_kind_at(unsigned i)
{
    return i < KIND_COUNT ? &kinds[i] : NULL;
}

/* The first of a kind's values, which follow one another; VALUE_COUNT if it has none. Searched once. */
static unsigned first_value(const struct triptych_kind *kind)
{
    if (!kind)
        return VALUE_COUNT;
    static _Atomic uint16_t found[KIND_COUNT]; /* and 1 */
    unsigned first = atomic_load_explicit(&found[kind - kinds], memory_order_relaxed);
    if (first)
        return first - 1;
    while (first < VALUE_COUNT && values[first].kind != kind)
        first++;
    atomic_store_explicit(&found[kind - kinds], (uint16_t)(first + 1), memory_order_relaxed);
    return first;
}

const struct triptych_value *triptych_value_at(const struct triptych_kind *kind, unsigned i)
{
    unsigned first = first_value(kind);
    return i < VALUE_COUNT - first && values[first + i].kind == kind ? &values[first + i] : NULL;
}

const struct triptych_value *triptych_value_find(const struct triptych_kind *kind, uint32_t number)
{
    for (unsigned i = first_value(kind); i < VALUE_COUNT && values[i].kind == kind; i++)
        if (values[i].number == number)
            return &values[i];
    return NULL;
}

const char *triptych_value_word(const struct triptych_kind *kind, uint32_t number)
{
    const struct triptych_value *value = triptych_value_find(kind, number);
    return value ? value->word : NULL;
}

int triptych_value_number(const struct triptych_kind *kind, const char *word, uint32_t *number)
{
    for (unsigned i = 0; i < VALUE_COUNT && word && number; i++)
        if (values[i].kind == kind && !strcmp(values[i].word, word)) {
            *number = values[i].number;
            return 0;
        }
    return -1;
}
