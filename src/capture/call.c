/* The table of calls at run time, and what follows from it for all calls alike. */
#include "capture/call.h"
#include "capture/codec.h"

#include <string.h>

const struct triptych_material call_default_material = {.diffuse = {1, 1, 1, 1}};
const struct triptych_light call_default_light = {
    .theta = 0.5f,
    .phi = 1,
    .falloff = 1,
    .type = TRIPTYCH_LIGHT_DIRECTIONAL,
    .diffuse = {1, 1, 1, 1},
    .direction = {0, 0, 1},
    .range = 0x1.fffffep+63f, /* the square root of FLT_MAX, rounded down */
    .attenuation = {1, 0, 0},
};

#define INTEGER(field_kind, path, width, maximum, list, name)                                                \
    {.kind = (field_kind),                                                                                   \
     .offset = offsetof(struct call, path),                                                                  \
     .size = sizeof((struct call *)0)->path,                                                                 \
     .bytes = (width),                                                                                       \
     .words = (list),                                                                                        \
     .most = (maximum),                                                                                      \
     .what = (name)},
#define U8(member, name, most, what)         INTEGER(FIELD_INTEGER, member.name, 1, most, 0, what)
#define U16(member, name, most, what)        INTEGER(FIELD_INTEGER, member.name, 2, most, 0, what)
#define U32(member, name, most, what)        INTEGER(FIELD_INTEGER, member.name, 4, most, 0, what)
#define S32(member, name, what)              INTEGER(FIELD_SIGNED, member.name, 4, 0, 0, what)
#define BOOL(member, name, what)             INTEGER(FIELD_INTEGER, member.name, 1, 1, 0, what)
#define WORD(member, name, list, most, what) INTEGER(FIELD_WORD, member.name, 1, most, WORDS_##list, what)
#define FLOATS(member, name, numbers, description)                                                           \
    {.kind = FIELD_FLOATS,                                                                                   \
     .offset = offsetof(struct call, member.name),                                                           \
     .count = (numbers),                                                                                     \
     .what = (description)},
#define RESOURCE(path, mask, optional, device_kind, description)                                             \
    {.kind = FIELD_RESOURCE,                                                                                 \
     .offset = offsetof(struct call, path),                                                                  \
     .types = (mask),                                                                                        \
     .or_none = (optional),                                                                                  \
     .what = (description)},
#define CALL(name, number, word, traits, member, function, fields)                                           \
    [number] = {word, traits, (const struct call_field[]){fields{.kind = FIELD_END}}},
#define CALL_OF(name, number, word, traits, type, member, fields)                                            \
    [number] = {word, traits, (const struct call_field[]){fields{.kind = FIELD_END}}},
#define CALL_BARE(name, number, word, traits, fields)                                                        \
    [number] = {word, traits, (const struct call_field[]){fields{.kind = FIELD_END}}},

static const struct call_row rows[CALL_TYPES] = {
#include "capture/call.def"
};

#include "capture/call_undefine.h"

const struct call_row *call_row(unsigned type)
{
    return type < CALL_TYPES && rows[type].word ? &rows[type] : NULL;
}

/* --- Fields --------------------------------------------------------------------------------------------- */

static void *field_at(struct call *call, const struct call_field *field)
{
    return (uint8_t *)call + field->offset;
}

uint32_t call_get(const struct call *call, const struct call_field *field)
{
    const uint8_t *at = (const uint8_t *)call + field->offset;
    uint32_t value;
    if (field->size == 1)
        return *at;
    memcpy(&value, at, sizeof value);
    return value;
}

void call_put(struct call *call, const struct call_field *field, uint32_t value)
{
    if (field->size == 1)
        *(uint8_t *)field_at(call, field) = (uint8_t)value;
    else
        memcpy(field_at(call, field), &value, sizeof value);
}

float *call_floats(struct call *call, const struct call_field *field)
{
    return field_at(call, field);
}

int32_t *call_signed(struct call *call, const struct call_field *field)
{
    return field_at(call, field);
}

uint32_t *call_resource(struct call *call, const struct call_field *field)
{
    return field_at(call, field);
}

const struct call_field *call_next_resource(const struct call_field *field)
{
    while (field->kind != FIELD_END && field->kind != FIELD_RESOURCE)
        field++;
    return field->kind == FIELD_END ? NULL : field;
}

/* --- Binary form ---------------------------------------------------------------------------------------- */

static void code_integer(struct codec *codec, struct call *call, const struct call_field *field)
{
    uint32_t value = call_get(call, field);
    if (field->bytes == 1)
        value = codec_u8(codec, value, field->most, field->what);
    else if (field->bytes == 2)
        value = codec_u16(codec, value, field->most, field->what);
    else
        value = codec_u32(codec, value, field->most, field->what);
    call_put(call, field, value);
}

void call_code_fields(struct codec *codec, struct call *call)
{
    for (const struct call_field *field = rows[call->type].fields; field->kind != FIELD_END; field++)
        switch (field->kind) {
        case FIELD_FLOATS: codec_floats(codec, call_floats(call, field), field->count); break;
        case FIELD_SIGNED: codec_integers(codec, call_signed(call, field), 1); break;
        case FIELD_RESOURCE: codec_resource(codec, call_resource(call, field)); break;
        default: code_integer(codec, call, field); break;
        }
}
