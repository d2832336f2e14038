#include "draw/key.h"
#include "draw/call.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

const char *const unit_name[UNIT_COUNT] = {"vertex", "setup", "pixel"};

const uint8_t stage_arguments[STAGE_COUNT] = {
    [STAGE_SELECT] = 1,        [STAGE_MODULATE] = 2, [STAGE_MODULATE_2X] = 2,
    [STAGE_MODULATE_4X] = 2,   [STAGE_ADD] = 2,      [STAGE_ADD_SIGNED] = 2,
    [STAGE_ADD_SIGNED_2X] = 2, [STAGE_SUBTRACT] = 2, [STAGE_MULTIPLY_ADD] = 3,
    [STAGE_LERP] = 3,          [STAGE_DOT] = 2};

/* Alpha's own argument is the same with its alpha replicated. */
static int same_argument(unsigned color, unsigned alpha)
{
    int replicated = alpha / ARGUMENT_REPLICATE & 1;
    return color == alpha || (!replicated && color == alpha + ARGUMENT_REPLICATE);
}

int stage_is_joint(const struct pixel_key *key)
{
    if (key->color_stage == STAGE_DOT)
        return 1;
    if (key->color_stage != key->alpha_stage)
        return 0;
    for (int i = 0; i < stage_arguments[key->color_stage]; i++)
        if (!same_argument(key->color_argument[i], key->alpha_argument[i]))
            return 0;
    return 1;
}

int stage_reads(const struct pixel_key *key, enum source source)
{
    for (int i = 0; i < stage_arguments[key->color_stage]; i++)
        if (key->color_argument[i] % SOURCE_COUNT == source)
            return 1;
    for (int i = 0; i < stage_arguments[key->alpha_stage] && !stage_is_joint(key); i++)
        if (key->alpha_argument[i] % SOURCE_COUNT == source)
            return 1;
    return 0;
}

static const struct key_field all_fields[] = {
#define KEY(unit, field, radix, meaning) {#field, meaning, offsetof(struct unit##_key, field), 1, radix},
#define KEYS(unit, field, count, radix, meaning)                                                             \
    {#field, meaning, offsetof(struct unit##_key, field), count, radix},
#include "def/key.def"
#undef KEY
#undef KEYS
};

/* How many rows of the table each unit has; its rows stand together, in the order of enum unit. */
static const uint8_t field_count[UNIT_COUNT] = {
#define KEY(unit, field, radix, meaning)         +KEY_##unit
#define KEYS(unit, field, count, radix, meaning) +KEY_##unit
#define KEY_vertex                               1
#define KEY_setup                                0
#define KEY_pixel                                0
    [UNIT_VERTEX] = 0
#include "def/key.def"
#undef KEY_vertex
#undef KEY_setup
#define KEY_vertex 0
#define KEY_setup  1
    ,
    [UNIT_SETUP] = 0
#include "def/key.def"
#undef KEY_setup
#undef KEY_pixel
#define KEY_setup 0
#define KEY_pixel 1
    ,
    [UNIT_PIXEL] = 0
#include "def/key.def"
#undef KEY_vertex
#undef KEY_setup
#undef KEY_pixel
#undef KEY
#undef KEYS
};

const struct key_field *key_fields(enum unit unit, size_t *count)
{
    size_t first = 0;
    for (int u = 0; u < (int)unit; u++)
        first += field_count[u];
    *count = field_count[unit];
    return all_fields + first;
}

/* Walks the digits of a unit's key; the place value grows until a digit would no longer fit the 64-bit word.
 */
struct digits {
    unsigned word;
    uint64_t place;
};

static void next_digit(struct digits *digits, unsigned radix)
{
    if (digits->place > UINT64_MAX / radix) {
        digits->word++;
        digits->place = 1;
    }
}

struct packed_key key_pack(enum unit unit, const union key *key)
{
    struct packed_key packed = {{0}};
    struct digits digits = {0, 1};
    size_t count;
    const struct key_field *field = key_fields(unit, &count);
    for (size_t i = 0; i < count; i++)
        for (unsigned j = 0; j < field[i].count; j++) {
            next_digit(&digits, field[i].radix);
            packed.word[digits.word] += digits.place * ((const uint8_t *)key)[field[i].offset + j];
            digits.place *= field[i].radix;
        }
    return packed;
}

void key_unpack(enum unit unit, const struct packed_key *packed, union key *key)
{
    memset(key, 0, sizeof *key);
    struct digits digits = {0, 1};
    size_t count;
    const struct key_field *field = key_fields(unit, &count);
    for (size_t i = 0; i < count; i++)
        for (unsigned j = 0; j < field[i].count; j++) {
            next_digit(&digits, field[i].radix);
            ((uint8_t *)key)[field[i].offset + j] = packed->word[digits.word] / digits.place % field[i].radix;
            digits.place *= field[i].radix;
        }
}

uint64_t key_hash(enum unit unit, const struct packed_key *packed)
{
    return XXH3_64bits_withSeed(packed, sizeof *packed, unit);
}

static int is_zero(const uint8_t *values, unsigned count)
{
    for (unsigned i = 0; i < count; i++)
        if (values[i])
            return 0;
    return 1;
}

char *key_print(enum unit unit, const union key *key, char text[KEY_TEXT_CAPACITY])
{
    size_t count, at = 0;
    const struct key_field *field = key_fields(unit, &count);
    for (size_t i = 0; i < count; i++) {
        const uint8_t *values = (const uint8_t *)key + field[i].offset;
        if (is_zero(values, field[i].count))
            continue;
        at += (size_t)snprintf(text + at, KEY_TEXT_CAPACITY - at, "%s%s=", at ? " " : "", field[i].name);
        for (unsigned j = 0; j < field[i].count; j++)
            at += (size_t)snprintf(text + at, KEY_TEXT_CAPACITY - at, "%s%u", j ? "," : "", values[j]);
    }
    if (!at)
        snprintf(text, KEY_TEXT_CAPACITY, "default");
    return text;
}

static const struct key_field *find_field(enum unit unit, const char *name, size_t length)
{
    size_t count;
    const struct key_field *field = key_fields(unit, &count);
    for (size_t i = 0; i < count; i++)
        if (strlen(field[i].name) == length && !memcmp(field[i].name, name, length))
            return field + i;
    return NULL;
}

/* Reads `v,v,v`; leaves *at behind the last digit, or at the offending one. */
static int parse_values(const struct key_field *field, const char **at, uint8_t *values)
{
    for (unsigned j = 0; j < field->count; j++) {
        if (j && *(*at)++ != ',')
            return -1;
        char *end;
        if (**at < '0' || **at > '9')
            return -1;
        unsigned long value = strtoul(*at, &end, 10);
        if (value >= field->radix)
            return -1;
        values[j] = (uint8_t)value;
        *at = end;
    }
    return 0;
}

int key_parse(enum unit unit, const char *text, union key *key, const char **where)
{
    memset(key, 0, sizeof *key);
    *where = text;
    if (!strcmp(text, "default"))
        return 0;
    while (**where) {
        size_t length = strcspn(*where, "=");
        const struct key_field *field = find_field(unit, *where, length);
        if (!field || !(*where)[length])
            return -1;
        *where += length + 1;
        if (parse_values(field, where, (uint8_t *)key + field->offset))
            return -1;
        if (**where == ' ')
            (*where)++;
        else if (**where)
            return -1;
    }
    return 0;
}

static uint64_t next_random(uint64_t *seed)
{
    *seed ^= *seed >> 12;
    *seed ^= *seed << 25;
    *seed ^= *seed >> 27;
    return *seed * 0x2545f4914f6cdd1dull;
}

void key_random(enum unit unit, uint64_t *seed, union key *key)
{
    memset(key, 0, sizeof *key);
    size_t count;
    const struct key_field *field = key_fields(unit, &count);
    for (size_t i = 0; i < count; i++)
        for (unsigned j = 0; j < field[i].count; j++)
            ((uint8_t *)key)[field[i].offset + j] = (next_random(seed) >> 33) % field[i].radix;
}
