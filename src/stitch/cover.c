/* The table def/cover.def, asked of keys. Values that are 0 cost no more than looking at them: most fields of
 * most keys are. */
#include "stitch/cover.h"

static int source_has_fragments(unsigned source)
{
    return source != SOURCE_SPECULAR && source != SOURCE_TEMPORARY;
}

/* Its registers hold the current colour then. */
static int later_stage_reads_diffuse(const struct pixel_key *key)
{
    for (int i = 1; i < key->stages; i++)
        if (stage_reads(key, i, SOURCE_DIFFUSE))
            return 1;
    return 0;
}

typedef int covers_function(const union key *keys, unsigned element, unsigned value);

#define COVER(unit, field, condition, reason)                                                                \
    static int covers_##unit##_##field(const union key *keys, unsigned element, unsigned value)              \
    {                                                                                                        \
        const struct unit##_key *key = &keys->unit;                                                          \
        (void)key, (void)element, (void)value;                                                               \
        return condition;                                                                                    \
    }
#include "def/cover.def"
#undef COVER

struct cover {
    covers_function *covers;
    const char *reason;
    uint16_t offset; /* bytes from the start of the unit's key */
};

enum {
#define COVER(unit, field, condition, reason) ROW_##unit##_##field,
#include "def/cover.def"
#undef COVER
    ROWS
};

static const struct cover table[ROWS] = {
#define COVER(unit, field, condition, reason)                                                                \
    {covers_##unit##_##field, reason, offsetof(struct unit##_key, field)},
#include "def/cover.def"
#undef COVER
};

#define UNIT_vertex        UNIT_VERTEX
#define UNIT_setup         UNIT_SETUP
#define UNIT_pixel         UNIT_PIXEL
#define FIRST(unit, field) offsetof(struct unit##_key, field)
#define LAST(unit, field)  FIRST(unit, field) + sizeof((struct unit##_key *)0)->field - 1

/* By a byte of a unit's key: 1 and the row of the field it belongs to, 0 when there is none. */
static const uint8_t row_of[UNIT_COUNT][sizeof(union key)] = {
#define COVER(unit, field, condition, reason)                                                                \
    [UNIT_##unit][FIRST(unit, field)... LAST(unit, field)] = ROW_##unit##_##field + 1,
#include "def/cover.def"
#undef COVER
};

static const uint16_t key_bytes[UNIT_COUNT] = {sizeof(struct vertex_key), sizeof(struct setup_key),
                                               sizeof(struct pixel_key)};

/* Whether the byte's value is covered. */
static int is_covered(enum unit unit, const union key *key, unsigned byte)
{
    unsigned number = row_of[unit][byte];
    const struct cover *row = number ? table + number - 1 : NULL;
    return !row || row->covers(key, byte - row->offset, ((const uint8_t *)key)[byte]);
}

const char *stages_lack(enum unit unit, const union key *key)
{
    const uint8_t *value = (const uint8_t *)key;
    unsigned first = ROWS + 1, count = key_bytes[unit];
    for (unsigned i = key_next(value, 0, count); i < count; i = key_next(value, i + 1, count))
        if (row_of[unit][i] < first && !is_covered(unit, key, i))
            first = row_of[unit][i];
    return first > ROWS ? NULL : table[first - 1].reason;
}

/* Again until nothing is left, since a condition may look at fields that have changed since. */
void stages_reduce(enum unit unit, union key *key)
{
    uint8_t *value = (uint8_t *)key;
    while (stages_lack(unit, key))
        for (unsigned i = 0; i < key_bytes[unit]; i++)
            if (value[i] && !is_covered(unit, key, i))
                value[i] = 0;
}
