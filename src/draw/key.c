#include "draw/key.h"
#include "draw/call.h"
#include "shader/program.h"

#include <assert.h>
#include <pthread.h>
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

const struct program *key_shader(enum unit unit, const union key *key)
{
    uint32_t number = unit == UNIT_VERTEX  ? key_program(key->vertex.shader)
                      : unit == UNIT_PIXEL ? key_program(key->pixel.shader)
                                           : 0;
    return number ? program_find(number) : NULL;
}

/* Alpha's own argument is the same with its alpha replicated. */
static int same_argument(unsigned color, unsigned alpha)
{
    int replicated = alpha / ARGUMENT_REPLICATE & 1;
    return color == alpha || (!replicated && color == alpha + ARGUMENT_REPLICATE);
}

int stage_is_joint(const struct pixel_key *key, int stage)
{
    if (key->color_stage[stage] == STAGE_DOT)
        return 1;
    if (key->color_stage[stage] != key->alpha_stage[stage])
        return 0;
    for (int i = 0; i < stage_arguments[key->color_stage[stage]]; i++)
        if (!same_argument(color_arguments(key, stage)[i], alpha_arguments(key, stage)[i]))
            return 0;
    return 1;
}

int stage_reads(const struct pixel_key *key, int stage, enum source source)
{
    for (int i = 0; i < stage_arguments[key->color_stage[stage]]; i++)
        if (color_arguments(key, stage)[i] % SOURCE_COUNT == source)
            return 1;
    for (int i = 0; i < stage_arguments[key->alpha_stage[stage]] && !stage_is_joint(key, stage); i++)
        if (alpha_arguments(key, stage)[i] % SOURCE_COUNT == source)
            return 1;
    return 0;
}

const struct vertex_type vertex_types[ATTRIBUTE_FORMAT_COUNT] = {
    {NULL, 0, ENCODING_NONE, 0, 0, 0},
#define VERTEX_TYPE(name, word, components, encoding, bits, divisor, meaning)                                \
    {#word, components, ENCODING_##encoding, bits, ((components) * (bits) + 31) / 32 * 4, 1.0f / (divisor)},
#include "def/vertex_type.def"
#undef VERTEX_TYPE
};

const uint8_t target_planes[TARGET_COUNT] = {
#define TARGET(name, planes, red, green, blue, alpha, meaning) planes,
#include "def/target.def"
#undef TARGET
};

const uint8_t target_bits[TARGET_COUNT][4] = {
#define TARGET(name, planes, red, green, blue, alpha, meaning) {red, green, blue, alpha},
#include "def/target.def"
#undef TARGET
};

static const struct key_field all_fields[] = {
#define KEY(unit, field, radix, meaning) {#field, meaning, offsetof(struct unit##_key, field), 1, radix},
#define KEYS(unit, field, count, radix, meaning)                                                             \
    {#field, meaning, offsetof(struct unit##_key, field), count, radix},
#include "def/key.def"
#undef KEY
#undef KEYS
};

/* How many rows of the table each unit has; its rows stand together, in the order of enum unit. */
static const uint16_t field_count[UNIT_COUNT] = {
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

/* The bits of a digit when it has them to itself; a word holds at least 56 of them, since no digit has more
 * than eight and none straddles. */
#define DIGIT_BITS(radix)  ((radix) > 1 ? 32 - __builtin_clz((radix)-1u) : 1)
#define BITS(count, radix) (count) * DIGIT_BITS(radix)
#define TEXT(field, count) sizeof #field + 1 + (count) * sizeof "255"

enum {
    LEAST_BITS_A_WORD = 56,
#define KEY(unit, field, radix, meaning)         unit##_##field##_bits = BITS(1, radix),
#define KEYS(unit, field, count, radix, meaning) unit##_##field##_bits = BITS(count, radix),
#include "def/key.def"
#undef KEY
#undef KEYS
};

/* All units together: no unit has more. */
#define KEY(unit, field, radix, meaning)         +unit##_##field##_bits
#define KEYS(unit, field, count, radix, meaning) +unit##_##field##_bits
static_assert((0
#include "def/key.def"
               ) / LEAST_BITS_A_WORD <
                  KEY_PACKED_WORDS,
              "the words of a packed key hold every digit");
#undef KEY
#undef KEYS
#define KEY(unit, field, radix, meaning)         +TEXT(field, 1)
#define KEYS(unit, field, count, radix, meaning) +TEXT(field, count)
static_assert(0
#include "def/key.def"
                  < KEY_TEXT_CAPACITY,
              "the text of a key holds every field");
#undef KEY
#undef KEYS

/* Where a digit stands: the place value grows until the next digit would no longer fit the word. */
struct digit {
    uint64_t place;
    uint16_t word;
    uint16_t radix;
};

/* The digits of each unit, by their offset in its key: every byte of a key is one. */
static struct digit digits[UNIT_COUNT][sizeof(union key)];
static uint16_t digit_count[UNIT_COUNT];
static pthread_once_t digits_are_placed = PTHREAD_ONCE_INIT;

static void place_unit(enum unit unit)
{
    struct digit next = {.place = 1};
    size_t count;
    const struct key_field *field = key_fields(unit, &count);
    for (size_t i = 0; i < count; i++)
        for (unsigned j = 0; j < field[i].count; j++) {
            next.radix = field[i].radix;
            if (next.place > UINT64_MAX / next.radix) {
                next.word++;
                next.place = 1;
            }
            digits[unit][digit_count[unit]++] = next;
            next.place *= next.radix;
        }
}

static void place_digits(void)
{
    for (int unit = 0; unit < UNIT_COUNT; unit++)
        place_unit(unit);
}

static const struct digit *digits_of(enum unit unit)
{
    pthread_once(&digits_are_placed, place_digits);
    return digits[unit];
}

struct packed_key key_pack(enum unit unit, const union key *key)
{
    const struct digit *digit = digits_of(unit);
    const uint8_t *value = (const uint8_t *)key;
    struct packed_key packed;
    packed.words = digit[digit_count[unit] - 1].word + 1u;
    memset(packed.word, 0, packed.words * sizeof packed.word[0]);
    unsigned count = digit_count[unit];
    for (unsigned i = key_next(value, 0, count); i < count; i = key_next(value, i + 1, count))
        packed.word[digit[i].word] += digit[i].place * value[i];
    return packed;
}

void key_unpack(enum unit unit, const struct packed_key *packed, union key *key)
{
    const struct digit *digit = digits_of(unit);
    memset(key, 0, sizeof *key);
    for (unsigned i = 0; i < digit_count[unit]; i++)
        ((uint8_t *)key)[i] = (uint8_t)(packed->word[digit[i].word] / digit[i].place % digit[i].radix);
}

uint64_t key_hash(enum unit unit, const struct packed_key *packed)
{
    return XXH3_64bits_withSeed(packed->word, packed->words * sizeof packed->word[0], unit);
}

int key_equal(const struct packed_key *a, const struct packed_key *b)
{
    return a->words == b->words && !memcmp(a->word, b->word, a->words * sizeof a->word[0]);
}

/* How many values there are up to the last that is not zero. */
static unsigned significant(const uint8_t *values, unsigned count)
{
    while (count && !values[count - 1])
        count--;
    return count;
}

char *key_print(enum unit unit, const union key *key, char text[KEY_TEXT_CAPACITY])
{
    size_t count, at = 0;
    const struct key_field *field = key_fields(unit, &count);
    for (size_t i = 0; i < count; i++) {
        const uint8_t *values = (const uint8_t *)key + field[i].offset;
        if (!significant(values, field[i].count))
            continue;
        at += (size_t)snprintf(text + at, KEY_TEXT_CAPACITY - at, "%s%s=", at ? " " : "", field[i].name);
        for (unsigned j = 0; j < significant(values, field[i].count); j++)
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

/* Reads `v,v,v`, as many as there are; leaves *at behind the last digit, or at the offending one. */
static int parse_values(const struct key_field *field, const char **at, uint8_t *values)
{
    for (unsigned j = 0; j < field->count; j++) {
        if (j && **at != ',')
            return 0;
        if (j)
            ++*at;
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
