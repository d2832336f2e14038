/* Random states from the tables of states, which list the states, their values and the supported ones. */
#include "command/fuzz/case/case_part.h"
#include "command/stream/stream.h"

#include <stdio.h>
#include <string.h>

static unsigned table_rows(enum triptych_state_table table)
{
    unsigned rows = 0;
    while (triptych_state_at(table, rows))
        rows++;
    return rows;
}

/* A supported word, or null if luck will have it otherwise. */
static const char *random_word(struct maker *maker, const struct triptych_kind *kind)
{
    unsigned count = 0;
    while (triptych_value_at(kind, count))
        count++;
    const struct triptych_value *value = triptych_value_at(kind, random_below(&maker->random, count));
    return value->support == TRIPTYCH_SUPPORT_YES ? value->word : NULL;
}

/* Numbers of states that reach far: small ones do more than huge ones, which are tried too. */
static uint32_t random_integer(struct maker *maker, const struct triptych_kind *kind)
{
    double span = kind->last - kind->first;
    if (span < 256)
        return (uint32_t)kind->first + random_below(&maker->random, (uint32_t)span + 1);
    return random_chance(&maker->random, 16) ? (uint32_t)random_u64(&maker->random)
                                             : random_below(&maker->random, 6);
}

static void write_bits(struct maker *maker)
{
    static const uint32_t usual[] = {0xffffffff, 0, 0xff, 0x0f, 0x80, 1};
    uint32_t bits = random_chance(&maker->random, 3)
                        ? (uint32_t)random_u64(&maker->random)
                        : usual[random_below(&maker->random, sizeof usual / sizeof *usual)];
    text_add(maker->text, "0x%08x", bits);
}

/* Sizes of points and lines cost what they cover; they stay small. */
static void write_real(struct maker *maker, const struct triptych_kind *kind)
{
    bool size = kind->first == 0;
    float value = random_float(&maker->random, size ? 0 : -2, size ? 6 : 2);
    if (!size && random_chance(&maker->random, 12))
        value = wild_float(&maker->random);
    text_add(maker->text, "%.9g", (double)value);
}

/* `state NAME VALUE` with `prefix` in front; returns whether there is a line. */
static bool write_state(struct maker *maker, const char *prefix, const struct triptych_state_row *row)
{
    const struct triptych_kind *kind = row->kind;
    const char *word = kind->notation == TRIPTYCH_NOTATION_WORDS ? random_word(maker, kind) : "";
    if (row->support != TRIPTYCH_SUPPORT_YES || !word)
        return false;
    text_add(maker->text, "%s %s %s", prefix, row->name, word);
    if (kind->notation == TRIPTYCH_NOTATION_NUMBER)
        text_add(maker->text, "%u", random_integer(maker, kind));
    else if (kind->notation == TRIPTYCH_NOTATION_HEXADECIMAL)
        write_bits(maker);
    else if (kind->notation == TRIPTYCH_NOTATION_REAL)
        write_real(maker, kind);
    text_add(maker->text, "\n");
    return true;
}

/* With these at random hardly anything would be seen. */
static bool hides(const char *name)
{
    static const char *const hiding[] = {"cullmode",        "fillmode",         "zfunc",
                                         "clipping",        "alphatestenable",  "stencilenable",
                                         "clipplaneenable", "colorwriteenable", "scissortestenable"};
    for (unsigned i = 0; i < sizeof hiding / sizeof *hiding; i++)
        if (!strcmp(name, hiding[i]))
            return true;
    return false;
}

/* Features that are off by default in Direct3D 9 and rarely on by chance, with the states that they read. */
void case_features(struct maker *maker)
{
    static const struct {
        const char *on, *states;
        uint8_t one_in;
    } features[] = {{"alphatestenable", "alpha", 8},
                    {"alphatestenable", "adaptivetess_y", 16},
                    {"stencilenable", "stencil", 6},
                    {"alphablendenable", "blend", 6},
                    {"alphablendenable", "src", 6},
                    {"fogenable", "fog", 8},
                    {"twosidedstencilmode", "ccw_stencil", 12},
                    {"scissortestenable", "scissor", 24},
                    {"antialiasedlineenable", "coveragetarget", 8},
                    {"antialiasedpointenable", "coveragetarget", 8}};
    const struct triptych_state_row *row;
    if (random_below(&maker->random, 8) < 5)
        text_add(maker->text, "state cullmode none\n");
    if (random_chance(&maker->random, 5))
        text_add(maker->text, "state edgeantialias %u\n", 1 + random_below(&maker->random, 15));
    for (unsigned f = 0; f < sizeof features / sizeof *features; f++) {
        if (!random_chance(&maker->random, features[f].one_in))
            continue;
        for (unsigned i = 0; (row = triptych_state_at(TRIPTYCH_RENDER_STATES, i)); i++)
            if (!strncmp(row->name, features[f].states, strlen(features[f].states)) &&
                random_below(&maker->random, 4))
                write_state(maker, "state", row);
        text_add(maker->text, "state %s true\n", features[f].on);
    }
    if (maker->elements >> ELEMENT_indices1 & 1 && random_below(&maker->random, 4))
        text_add(maker->text, "state primitiveblendenable true\n");
}

void case_states(struct maker *maker, unsigned changes)
{
    unsigned rows = table_rows(TRIPTYCH_RENDER_STATES);
    bool hide = random_chance(&maker->random, 2);
    while (changes) {
        const struct triptych_state_row *row =
            triptych_state_at(TRIPTYCH_RENDER_STATES, random_below(&maker->random, rows));
        if (hides(row->name) && !hide && !random_chance(&maker->random, 4))
            continue;
        changes -= write_state(maker, "state", row);
    }
}

/* Sets each row of a table with probability one in `one_in`. */
static void write_rows(struct maker *maker, enum triptych_state_table table, const char *prefix,
                       unsigned one_in)
{
    const struct triptych_state_row *row;
    for (unsigned i = 0; (row = triptych_state_at(table, i)); i++)
        if (random_chance(&maker->random, one_in))
            write_state(maker, prefix, row);
}

/* A texture of the type that a shader needs, or any; -1 if there is none. */
static int find_texture(struct maker *maker, unsigned sampler)
{
    unsigned first = maker->textures ? random_below(&maker->random, maker->textures) : 0;
    for (unsigned i = 0; i < maker->textures; i++) {
        unsigned t = (first + i) % maker->textures;
        if (maker->sampler_type[sampler] == ANY_TEXTURE ||
            maker->sampler_type[sampler] == maker->texture[t].type)
            return (int)t;
    }
    return -1;
}

void case_samplers(struct maker *maker)
{
    char prefix[32];
    for (unsigned i = 0; i < TRIPTYCH_SAMPLERS; i++) {
        if (!(maker->samplers >> i & 1))
            continue;
        int texture = find_texture(maker, i);
        if (texture >= 0 && !random_chance(&maker->random, 16))
            text_add(maker->text, "bind texture %u t%d\n", i, texture);
        snprintf(prefix, sizeof prefix, "sampler %u", i);
        if (!random_chance(&maker->random, 4))
            write_rows(maker, TRIPTYCH_SAMPLER_STATES, prefix, 2);
    }
}

void case_stages(struct maker *maker)
{
    char prefix[32];
    for (unsigned i = 0; i < maker->stages; i++) {
        snprintf(prefix, sizeof prefix, "stage %u", i);
        if (i)
            text_add(maker->text, "%s colorop modulate\n%s alphaop add\n", prefix, prefix);
        write_rows(maker, TRIPTYCH_STAGE_STATES, prefix, 2);
    }
}
