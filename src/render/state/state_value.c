/* The values of the tables of states: which exist, which are supported, and the reasons of refusals. */
#include "render/state/state_part.h"

#include "base/bits.h"

#include <stdio.h>
#include <string.h>

/* Where a value is in its table; the row exists. */
struct place {
    enum triptych_state_table table;
    unsigned i, row;
    const struct triptych_state_row *state;
};

static void print_place(const struct place *place, char *text, size_t size)
{
    const char *table = triptych_table_name(place->table);
    if (place->table == TRIPTYCH_RENDER_STATES)
        snprintf(text, size, "%s %s", table, place->state->name);
    else
        snprintf(text, size, "%s %u %s", table, place->i, place->state->name);
}

static void print_value(const struct triptych_kind *kind, uint32_t value, char *text, size_t size)
{
    const char *word = triptych_value_word(kind, value);
    if (word)
        snprintf(text, size, "%s (%u)", word, value);
    else if (kind->notation == TRIPTYCH_NOTATION_REAL)
        snprintf(text, size, "%g", (double)bits_to_float(value));
    else
        snprintf(text, size, kind->notation == TRIPTYCH_NOTATION_HEXADECIMAL ? "0x%08x" : "%u", value);
}

static bool exists(const struct triptych_kind *kind, uint32_t value)
{
    if (kind->notation == TRIPTYCH_NOTATION_WORDS)
        return triptych_value_find(kind, value) != NULL;
    bool is_real = kind->notation == TRIPTYCH_NOTATION_REAL;
    return state_within(kind->first, is_real ? (double)bits_to_float(value) : value, kind->last);
}

/* Of values that exist; the default needs nothing to work. */
static bool is_supported(const struct place *place, uint32_t value)
{
    if (value == triptych_state_default(place->table, place->row, place->i))
        return true;
    if (place->state->support != TRIPTYCH_SUPPORT_YES)
        return false;
    const struct triptych_value *row = triptych_value_find(place->state->kind, value);
    return !row || row->support == TRIPTYCH_SUPPORT_YES;
}

/* Returns true if the value will never be supported. */
static bool is_never(const struct place *place, uint32_t value)
{
    const struct triptych_value *row = triptych_value_find(place->state->kind, value);
    return place->state->support == TRIPTYCH_SUPPORT_NEVER || (row && row->support == TRIPTYCH_SUPPORT_NEVER);
}

/* The values that the state can be set to: "none (1), cw (2)", "0 to 15"; cut after the words that fit. */
static void print_expected(const struct place *place, char *text, size_t size)
{
    const struct triptych_kind *kind = place->state->kind;
    const struct triptych_value *v;
    char value[64];
    size_t at = 0;
    for (unsigned i = 0; (v = triptych_value_at(kind, i)); i++) {
        if (!is_supported(place, v->number))
            continue;
        print_value(kind, v->number, value, sizeof value);
        if (at + strlen(value) + 8 > size) {
            snprintf(text + at, size - at, ", ...");
            return;
        }
        at += (size_t)snprintf(text + at, size - at, "%s%s", at ? ", " : "", value);
    }
    if (at)
        return;
    if (place->state->support != TRIPTYCH_SUPPORT_YES)
        print_value(kind, triptych_state_default(place->table, place->row, place->i), text, size);
    else if (kind->first < -0x1p64)
        snprintf(text, size, "a finite number");
    else if (kind->last > 0x1p64)
        snprintf(text, size, "a finite number from %g up", kind->first);
    else
        snprintf(text, size, "%.0f to %.0f", kind->first, kind->last);
}

static enum triptych_result refuse_value(const struct place *place, uint32_t value, struct error *error)
{
    const struct triptych_kind *kind = place->state->kind;
    char name[96], text[64], expected[320];
    print_place(place, name, sizeof name);
    print_expected(place, expected, sizeof expected);
    if (exists(kind, value)) {
        print_value(kind, value, text, sizeof text);
        error_set(error, "%s: value %s is not supported%s, expected %s", name, text,
                  is_never(place, value) ? "" : " yet", expected);
        return TRIPTYCH_UNSUPPORTED;
    }
    if (kind->notation == TRIPTYCH_NOTATION_WORDS)
        error_set(error, "%s: value %u does not exist, expected %s", name, value, expected);
    else {
        print_value(kind, value, text, sizeof text);
        error_set(error, "%s: value %s, expected %s", name, text, expected);
    }
    return TRIPTYCH_BAD_ARGUMENT;
}

static uint32_t *value_at(struct state *state, const struct place *place)
{
    if (place->table == TRIPTYCH_SAMPLER_STATES)
        return &state->sampler[place->i][place->row];
    return place->table == TRIPTYCH_STAGE_STATES ? &state->stage[place->i][place->row]
                                                 : &state->value[place->row];
}

enum triptych_result state_set_value(struct state *state, enum triptych_state_table table, unsigned i,
                                     unsigned row, uint32_t value, struct error *error)
{
    struct place place = {table, i, row, triptych_state_at(table, row)};
    const char *name = triptych_table_name(table);
    if (i >= triptych_table_size(table)) {
        error_set(error, "%s %u: expected 0 to %u", name, i, triptych_table_size(table) - 1);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    if (!place.state) {
        unsigned rows = 0;
        while (triptych_state_at(table, rows))
            rows++;
        error_set(error, "%s%s %u: expected 0 to %u", table == TRIPTYCH_RENDER_STATES ? "" : name,
                  table == TRIPTYCH_RENDER_STATES ? "state" : " state", row, rows - 1);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    if (!exists(place.state->kind, value) || !is_supported(&place, value))
        return refuse_value(&place, value, error);
    *value_at(state, &place) = value;
    return TRIPTYCH_OK;
}

bool state_has_value(const struct state *state, enum triptych_state_table table, unsigned i, unsigned row,
                     uint32_t value)
{
    switch (table) {
    case TRIPTYCH_RENDER_STATES: return row < TRIPTYCH_STATE_COUNT && state->value[row] == value;
    case TRIPTYCH_SAMPLER_STATES:
        return i < TRIPTYCH_SAMPLERS && row < TRIPTYCH_SAMPLER_STATE_COUNT && state->sampler[i][row] == value;
    case TRIPTYCH_STAGE_STATES:
        return i < TRIPTYCH_STAGES && row < TRIPTYCH_STAGE_STATE_COUNT && state->stage[i][row] == value;
    default: return false;
    }
}

void state_initialize_values(struct state *state)
{
    struct place place;
    for (place.table = 0; place.table < TRIPTYCH_STATE_TABLE_COUNT; place.table++)
        for (place.i = 0; place.i < triptych_table_size(place.table); place.i++)
            for (place.row = 0; triptych_state_at(place.table, place.row); place.row++)
                *value_at(state, &place) = triptych_state_default(place.table, place.row, place.i);
}
