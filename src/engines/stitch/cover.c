/* The rows of def/engine/cover.def as a table by bytes of keys. Zero values are always covered, so a key
 * costs only as many checks as it has bytes that are not zero, which are few. */
#include "engines/stitch/cover.h"
#include "contract/key_query.h"

static bool source_has_fragments(unsigned source)
{
    return source != SOURCE_SPECULAR && source != SOURCE_TEMPORARY;
}

static bool factor_has_fragments(unsigned factor)
{
    return (factor | 1) != FACTOR_INVERSE_CONSTANT_ALPHA && !factor_is_second((int)factor);
}

/* Returns true if a stage after the first reads diffuse. Its registers hold the current colour there. */
static bool later_stage_reads_diffuse(const struct pixel_key *key)
{
    for (int i = 1; i < key->stages; i++)
        if (stage_reads(key, i, SOURCE_DIFFUSE))
            return true;
    return false;
}

typedef bool covers_function(const union key *keys, unsigned element, unsigned value);

#define COVER(unit, field, condition, reason)                                                                \
    static bool covers_##unit##_##field(const union key *keys, unsigned element, unsigned value)             \
    {                                                                                                        \
        const struct unit##_key *key = &keys->unit;                                                          \
        (void)key, (void)element, (void)value;                                                               \
        return condition;                                                                                    \
    }
#include "def/engine/cover.def"
#undef COVER

struct cover {
    covers_function *covers;
    const char *reason;
    uint16_t offset; /* bytes from the start of the unit's key */
};

enum {
#define COVER(unit, field, condition, reason) ROW_##unit##_##field,
#include "def/engine/cover.def"
#undef COVER
    ROWS
};

static const struct cover table[ROWS] = {
#define COVER(unit, field, condition, reason)                                                                \
    {covers_##unit##_##field, reason, offsetof(struct unit##_key, field)},
#include "def/engine/cover.def"
#undef COVER
};

#define UNIT_vertex        UNIT_VERTEX
#define UNIT_setup         UNIT_SETUP
#define UNIT_pixel         UNIT_PIXEL
#define FIRST(unit, field) offsetof(struct unit##_key, field)
#define LAST(unit, field)  FIRST(unit, field) + sizeof((struct unit##_key *)0)->field - 1

/* For each byte of a unit's key: 1 and the row of its field, or 0 for a field without a row. */
static const uint8_t row_of[UNIT_COUNT][sizeof(union key)] = {
#define COVER(unit, field, condition, reason)                                                                \
    [UNIT_##unit][FIRST(unit, field)... LAST(unit, field)] = ROW_##unit##_##field + 1,
#include "def/engine/cover.def"
#undef COVER
};

static const uint16_t key_bytes[UNIT_COUNT] = {sizeof(struct vertex_key), sizeof(struct setup_key),
                                               sizeof(struct pixel_key)};

/* Returns true if the value of the byte is covered. */
static bool is_covered(enum unit unit, const union key *key, unsigned byte)
{
    unsigned number = row_of[unit][byte];
    const struct cover *row = number ? table + number - 1 : NULL;
    return !row || row->covers(key, byte - row->offset, ((const uint8_t *)key)[byte]);
}

const char *stages_lack(enum unit unit, const union key *key)
{
    if (unit == UNIT_BLIT)
        return "blits";
    const uint8_t *value = (const uint8_t *)key;
    unsigned first = ROWS + 1, count = key_bytes[unit];
    for (unsigned i = key_next(value, 0, count); i < count; i = key_next(value, i + 1, count))
        if (row_of[unit][i] < first && !is_covered(unit, key, i))
            first = row_of[unit][i];
    return first > ROWS ? NULL : table[first - 1].reason;
}

/* Repeats, since a condition may depend on fields that have changed. */
void stages_reduce(enum unit unit, union key *key)
{
    uint8_t *value = (uint8_t *)key;
    while (stages_lack(unit, key))
        for (unsigned i = 0; i < key_bytes[unit]; i++)
            if (value[i] && !is_covered(unit, key, i))
                value[i] = 0;
}
