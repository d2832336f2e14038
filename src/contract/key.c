#include "contract/key_query.h"
#include "contract/layout.h"
#include "shader/program/program.h"

#include <assert.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

const char *const unit_name[UNIT_ALL] = {"vertex", "setup", "pixel", "kernel", "blit"};

const uint8_t stage_arguments[STAGE_COUNT] = {
#define STAGE_OPERATION(name, arguments, meaning) arguments,
#include "def/stage.def"
#undef STAGE_OPERATION
};

const struct program *key_shader(enum unit unit, const union key *key)
{
    uint32_t number = unit == UNIT_VERTEX  ? key_program(key->vertex.shader)
                      : unit == UNIT_PIXEL ? key_program(key->pixel.shader)
                                           : 0;
    return number ? program_find(number) : NULL;
}

/* For alpha, a source and the same source with its alpha replicated are equal. */
static bool same_argument(unsigned color, unsigned alpha)
{
    bool replicated = alpha / ARGUMENT_REPLICATE & 1;
    return color == alpha || (!replicated && color == alpha + ARGUMENT_REPLICATE);
}

bool stage_is_joint(const struct pixel_key *key, int stage)
{
    if (key->color_stage[stage] == STAGE_DOT)
        return true;
    if (key->color_stage[stage] != key->alpha_stage[stage])
        return false;
    for (int i = 0; i < stage_arguments[key->color_stage[stage]]; i++)
        if (!same_argument(color_arguments(key, stage)[i], alpha_arguments(key, stage)[i]))
            return false;
    return true;
}

bool stage_reads(const struct pixel_key *key, int stage, enum source source)
{
    for (int i = 0; i < stage_arguments[key->color_stage[stage]]; i++)
        if (color_arguments(key, stage)[i] % SOURCE_COUNT == source)
            return true;
    for (int i = 0; i < stage_arguments[key->alpha_stage[stage]] && !stage_is_joint(key, stage); i++)
        if (alpha_arguments(key, stage)[i] % SOURCE_COUNT == source)
            return true;
    return false;
}

const struct vertex_type key_vertex_types[ATTRIBUTE_FORMAT_COUNT] = {
    {NULL, 0, ENCODING_NONE, 0, 0, 0},
#define VERTEX_TYPE(name, word, components, encoding, bits, divisor, meaning)                                \
    {#word, components, ENCODING_##encoding, bits, ((components) * (bits) + 7) / 8, 1.0f / (float)(divisor)},
#include "def/state/vertex_type.def"
#undef VERTEX_TYPE
};

const uint8_t storage_planes[TARGET_COUNT] = {
#define TARGET(name, planes, red, green, blue, alpha, meaning) planes,
#include "def/state/target.def"
#undef TARGET
};

const uint8_t storage_bits[TARGET_COUNT][4] = {
#define TARGET(name, planes, red, green, blue, alpha, meaning) {red, green, blue, alpha},
#include "def/state/target.def"
#undef TARGET
};

const struct compact_form storage_compact[COMPACT_COUNT] = {
    {0, 0, 0, 0},
#define COMPACT(name, bytes, first, second, constant) {bytes, first, second, constant},
#include "def/state/compact.def"
#undef COMPACT
};

#define FIELD(unit, field, radix, meaning) {#field, meaning, offsetof(struct unit##_key, field), 1, radix},
#define FIELDS(unit, field, count, radix, meaning)                                                           \
    {#field, meaning, offsetof(struct unit##_key, field), count, radix},

static const struct key_field vertex_fields[] = {VERTEX_KEY(FIELD, FIELDS)};
static const struct key_field setup_fields[] = {SETUP_KEY(FIELD, FIELDS)};
static const struct key_field pixel_fields[] = {PIXEL_KEY(FIELD, FIELDS)};
static const struct key_field blit_fields[] = {BLIT_KEY(FIELD, FIELDS)};

#define COUNT(array) (sizeof(array) / sizeof *(array))

static const struct {
    const struct key_field *field;
    size_t count;
} fields[UNIT_ALL] = {
    [UNIT_VERTEX] = {vertex_fields, COUNT(vertex_fields)},
    [UNIT_SETUP] = {setup_fields, COUNT(setup_fields)},
    [UNIT_PIXEL] = {pixel_fields, COUNT(pixel_fields)},
    [UNIT_BLIT] = {blit_fields, COUNT(blit_fields)},
};

const struct key_field *key_fields(enum unit unit, size_t *count)
{
    *count = fields[unit].count;
    return fields[unit].field;
}

/* The bits of a digit. A word holds at least 56 bits of digits, since no digit has more than eight and none
 * straddles. */
#define DIGIT_BITS(radix) ((radix) > 1 ? 32 - __builtin_clz((radix)-1u) : 1)
enum { LEAST_BITS_A_WORD = 56 };

#define FIELD_BITS(unit, field, radix, meaning)         +DIGIT_BITS(radix)
#define FIELDS_BITS(unit, field, count, radix, meaning) +(count)*DIGIT_BITS(radix)
#define FIELD_TEXT(unit, field, radix, meaning)         +sizeof #field + 1 + sizeof "255"
#define FIELDS_TEXT(unit, field, count, radix, meaning) +sizeof #field + 1 + (count) * sizeof "255"

#define PACKS(KEY)  ((0 KEY(FIELD_BITS, FIELDS_BITS)) / LEAST_BITS_A_WORD < KEY_PACKED_WORDS)
#define PRINTS(KEY) ((0 KEY(FIELD_TEXT, FIELDS_TEXT)) < KEY_TEXT_CAPACITY)

static_assert(PACKS(VERTEX_KEY) && PACKS(SETUP_KEY) && PACKS(PIXEL_KEY) && PACKS(BLIT_KEY),
              "the words of a packed key hold every digit");
static_assert(PRINTS(VERTEX_KEY) && PRINTS(SETUP_KEY) && PRINTS(PIXEL_KEY) && PRINTS(BLIT_KEY),
              "the text of a key holds every field");

/* The position of a digit: its place value grows until the next digit would no longer fit the word. */
struct digit {
    uint64_t place;
    uint16_t word;
    uint16_t radix;
};

/* The digits of each unit by their offset in its key; every byte of a key is a digit. */
static struct digit digits[UNIT_ALL][sizeof(union key)];
static uint16_t digit_count[UNIT_ALL];
static pthread_once_t digits_once = PTHREAD_ONCE_INIT;

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
    for (int unit = 0; unit < UNIT_ALL; unit++)
        place_unit(unit);
}

static const struct digit *digits_of(enum unit unit)
{
    pthread_once(&digits_once, place_digits);
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

bool key_equal(const struct packed_key *a, const struct packed_key *b)
{
    return a->words == b->words && !memcmp(a->word, b->word, a->words * sizeof a->word[0]);
}

/* The number of values up to the last that is not zero. */
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

/* Reads `v,v,v`, at most the field's count; leaves *at after the last digit, or at the offending one. */
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
