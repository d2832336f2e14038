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
    covers_function *covers; /* null ends the table */
    const char *reason;
    uint8_t unit;
    uint8_t count;   /* of elements */
    uint16_t offset; /* bytes from the start of the unit's key */
};

#define UNIT_vertex UNIT_VERTEX
#define UNIT_setup  UNIT_SETUP
#define UNIT_pixel  UNIT_PIXEL

static const struct cover table[] = {
#define COVER(unit, field, condition, reason)                                                                \
    {covers_##unit##_##field, reason, UNIT_##unit, sizeof((struct unit##_key *)0)->field,                    \
     offsetof(struct unit##_key, field)},
#include "def/cover.def"
#undef COVER
    {0}};

/* The first value of a row that is not covered, by its element number; the row's count when all are. */
static unsigned find_uncovered(const struct cover *row, const union key *key)
{
    const uint8_t *value = (const uint8_t *)key + row->offset;
    unsigned element = 0;
    while (element < row->count && (!value[element] || row->covers(key, element, value[element])))
        element++;
    return element;
}

const char *stages_lack(enum unit unit, const union key *key)
{
    for (const struct cover *row = table; row->covers; row++)
        if (row->unit == unit && find_uncovered(row, key) < row->count)
            return row->reason;
    return NULL;
}

/* Again until nothing is left, since a condition may look at fields that a later row has changed. */
void stages_reduce(enum unit unit, union key *key)
{
    while (stages_lack(unit, key))
        for (const struct cover *row = table; row->covers; row++)
            for (unsigned element; row->unit == unit && (element = find_uncovered(row, key)) < row->count;)
                ((uint8_t *)key)[row->offset + element] = 0;
}
