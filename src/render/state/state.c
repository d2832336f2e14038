#include "render/state/state.h"

#include "base/bits.h"
#include "render/target/depth.h"
#include "render/target/target.h"

#include "shader/program/program.h"

#include <inttypes.h>
#include <math.h>
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

/* Written so that a NaN fails. */
static bool within(double low, double value, double high)
{
    return value >= low && value <= high;
}

static bool exists(const struct triptych_kind *kind, uint32_t value)
{
    if (kind->notation == TRIPTYCH_NOTATION_WORDS)
        return triptych_value_find(kind, value) != NULL;
    bool is_real = kind->notation == TRIPTYCH_NOTATION_REAL;
    return within(kind->first, is_real ? (double)bits_to_float(value) : value, kind->last);
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

static void initialize_values(struct state *state)
{
    struct place place;
    for (place.table = 0; place.table < TRIPTYCH_STATE_TABLE_COUNT; place.table++)
        for (place.i = 0; place.i < triptych_table_size(place.table); place.i++)
            for (place.row = 0; triptych_state_at(place.table, place.row); place.row++)
                *value_at(state, &place) = triptych_state_default(place.table, place.row, place.i);
}

void state_initialize(struct state *state)
{
    static const struct triptych_light light = {
        .type = TRIPTYCH_LIGHT_DIRECTIONAL, .diffuse = {1, 1, 1, 0}, .direction = {0, 0, 1}};
    memset(state, 0, sizeof *state);
    initialize_values(state);
    for (int t = 0; t < TRIPTYCH_TRANSFORM_COUNT; t++)
        for (int i = 0; i < 4; i++)
            state->transform[t][i][i] = 1;
    for (int c = 0; c < 4; c++)
        state->material.diffuse[c] = 1;
    for (int i = 0; i < TRIPTYCH_LIGHTS; i++)
        state->light[i] = light;
    state->target[0] = (struct target_channels){TARGET_8888, 15};
}

static bool all_finite(const float *values, size_t count)
{
    bool finite = true;
    for (size_t i = 0; i < count; i++)
        finite &= isfinite(values[i]) != 0;
    return finite;
}

/* Refuses NaN and infinities; the reason names the value. */
static enum triptych_result check_finite(const float *values, size_t count, const char *what,
                                         struct error *error)
{
    for (size_t i = 0; i < count; i++)
        if (!isfinite(values[i])) {
            error_set(error, "%s: value %zu is %f, expected a finite number", what, i, (double)values[i]);
            return TRIPTYCH_BAD_ARGUMENT;
        }
    return TRIPTYCH_OK;
}

static void name_transform(unsigned which, char *name, size_t size)
{
    static const char *const single[] = {"world matrix", "view matrix", "projection matrix"};
    if (which >= TRIPTYCH_TRANSFORM_WORLD1)
        snprintf(name, size, "world matrix %u", which - TRIPTYCH_TRANSFORM_WORLD1 + 1);
    else if (which >= TRIPTYCH_TRANSFORM_TEXTURE0)
        snprintf(name, size, "texture matrix %u", which - TRIPTYCH_TRANSFORM_TEXTURE0);
    else
        snprintf(name, size, "%s", single[which]);
}

enum triptych_result state_set_transform(struct state *state, enum triptych_transform which,
                                         const float matrix[4][4], struct error *error)
{
    char name[32];
    if ((unsigned)which >= TRIPTYCH_TRANSFORM_COUNT) {
        error_set(error, "transform %u: expected 0 to %u", (unsigned)which, TRIPTYCH_TRANSFORM_COUNT - 1);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    if (!all_finite(&matrix[0][0], 16)) {
        name_transform(which, name, sizeof name);
        return check_finite(&matrix[0][0], 16, name, error);
    }
    memcpy(state->transform[which], matrix, sizeof state->transform[which]);
    return TRIPTYCH_OK;
}

enum triptych_result state_set_viewport(struct state *state, const struct triptych_viewport *viewport,
                                        struct error *error)
{
    const struct triptych_viewport *v = viewport;
    if (!isfinite(v->x) || !isfinite(v->y) || !isfinite(v->width) || !isfinite(v->height) || v->width < 0 ||
        v->height < 0) {
        error_set(error, "viewport %g x %g at %g, %g: expected finite numbers, and sides of 0 or more",
                  (double)v->width, (double)v->height, (double)v->x, (double)v->y);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    if (!within(0, v->depth_near, 1) || !within(0, v->depth_far, 1)) {
        error_set(error, "viewport depth %g to %g: expected values from 0 to 1", (double)v->depth_near,
                  (double)v->depth_far);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    state->viewport = *viewport;
    return TRIPTYCH_OK;
}

void state_set_scissor(struct state *state, struct scissor scissor)
{
    state->scissor = scissor;
}

enum { CLIP_MASK_PLACE = 2 * TRIPTYCH_TARGET_MAXIMUM };

static bool is_place(int place)
{
    return place >= -CLIP_MASK_PLACE && place <= CLIP_MASK_PLACE;
}

static bool is_mask(const struct triptych_texture *texture)
{
    return texture->type == TRIPTYCH_TEXTURE_2D && format_texel_bytes(texture->format) == 1;
}

enum triptych_result state_set_clip_mask(struct state *state, const struct triptych_clip_mask *mask,
                                         struct error *error)
{
    if (mask->texture && !is_mask(mask->texture))
        error_set(error, "clip mask of format %s: expected a 2d texture of A8, L8 or R8",
                  mask->texture->format->name);
    else if (!is_place(mask->x) || !is_place(mask->y))
        error_set(error, "clip mask at %d, %d: expected %d to %d", mask->x, mask->y, -CLIP_MASK_PLACE,
                  CLIP_MASK_PLACE);
    else {
        state->clip_mask = *mask;
        return TRIPTYCH_OK;
    }
    return TRIPTYCH_BAD_ARGUMENT;
}

enum triptych_result state_set_clip_plane(struct state *state, unsigned i, const float plane[4],
                                          struct error *error)
{
    if (i >= TRIPTYCH_CLIP_PLANES) {
        error_set(error, "clip plane %u: expected 0 to %u", i, TRIPTYCH_CLIP_PLANES - 1);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    enum triptych_result result = check_finite(plane, 4, "clip plane", error);
    if (result == TRIPTYCH_OK)
        memcpy(state->clip_plane[i], plane, sizeof state->clip_plane[i]);
    return result;
}

/* The conventions, and the number and names of their values. */
static const struct {
    const char *name, *values;
    unsigned count;
} conventions[TRIPTYCH_CONVENTION_COUNT] = {
    [TRIPTYCH_PIXEL_CENTER] = {"pixel center", "half (0) or integer (1)", 2},
    [TRIPTYCH_DEPTH_RANGE] = {"depth range", "zero (0) or minus (1)", 2},
    [TRIPTYCH_MULTIPLY] = {"multiply", "ieee (0) or legacy (1)", 2},
    [TRIPTYCH_WINDOW_ORIGIN] = {"window origin", "upper (0) or lower (1)", 2},
    [TRIPTYCH_POINT_CLIP] = {"point clip", "viewport (0), depth (1) or center (2)", 3},
    [TRIPTYCH_DEPTH_BIAS_UNIT] = {"depth bias unit", "one (0) or smallest (1)", 2},
    [TRIPTYCH_PROVOKING_VERTEX] = {"provoking vertex", "first (0) or last (1)", 2},
    [TRIPTYCH_CUBE_ADDRESS] = {"cube address", "clamp (0) or sampler (1)", 2},
    [TRIPTYCH_MAGNIFY_LIMIT] = {"magnify limit", "zero (0) or half (1)", 2},
    [TRIPTYCH_SPRITE_ORIGIN] = {"sprite origin", "upper (0) or last (1)", 2}};

static void explain_conventions(unsigned which, struct error *error)
{
    char list[256];
    int length = 0;
    for (unsigned i = 0; i < TRIPTYCH_CONVENTION_COUNT; i++)
        length += snprintf(list + length, sizeof list - (size_t)length, "%s%s (%u)",
                           !i                                   ? ""
                           : i + 1 == TRIPTYCH_CONVENTION_COUNT ? " or "
                                                                : ", ",
                           conventions[i].name, i);
    error_set(error, "convention %u: expected %s", which, list);
}

enum triptych_result state_set_convention(struct state *state, enum triptych_convention which, unsigned value,
                                          struct error *error)
{
    if ((unsigned)which >= TRIPTYCH_CONVENTION_COUNT) {
        explain_conventions((unsigned)which, error);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    if (value >= conventions[which].count) {
        error_set(error, "convention %s: value %u, expected %s", conventions[which].name, value,
                  conventions[which].values);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    state->convention[which] = (uint8_t)value;
    return TRIPTYCH_OK;
}

enum triptych_result state_check_constants(enum constant_file file, enum triptych_shader_stage stage,
                                           unsigned first, unsigned count, struct error *error)
{
    static const struct {
        const char *name;
        unsigned count;
    } files[] = {[CONSTANT_FLOAT] = {"float", TRIPTYCH_SHADER_FLOATS},
                 [CONSTANT_INTEGER] = {"integer", TRIPTYCH_SHADER_INTEGERS},
                 [CONSTANT_BOOLEAN] = {"Boolean", TRIPTYCH_SHADER_BOOLEANS}};
    if ((unsigned)stage >= SHADER_STAGES) {
        error_set(error, "shader stage %u: expected vertex (0) or pixel (1)", (unsigned)stage);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    if (count <= files[file].count && first <= files[file].count - count)
        return TRIPTYCH_OK;
    error_set(error, "%s constants %u to %" PRIu64 ": expected them below %u", files[file].name, first,
              (uint64_t)first + count - 1, files[file].count);
    return TRIPTYCH_BAD_ARGUMENT;
}

enum triptych_result state_check_integers(const struct state *state, struct error *error)
{
    for (int stage = 0; stage < SHADER_STAGES; stage++)
        if (state->program[stage] &&
            program_check_integers(state->program[stage],
                                   (const int32_t(*)[4])state->registers[stage]->integers, error))
            return TRIPTYCH_BAD_CALL;
    return TRIPTYCH_OK;
}

/* Finite, and 0 or more. */
static enum triptych_result check_positive(float value, const char *what, struct error *error)
{
    if (value >= 0 && isfinite(value))
        return TRIPTYCH_OK;
    error_set(error, "%s %g: expected 0 or more", what, (double)value);
    return TRIPTYCH_BAD_ARGUMENT;
}

enum triptych_result state_set_material(struct state *state, const struct triptych_material *material,
                                        struct error *error)
{
    enum triptych_result result = check_finite(material->diffuse, 4, "material diffuse", error);
    if (result == TRIPTYCH_OK)
        result = check_finite(material->ambient, 4, "material ambient", error);
    if (result == TRIPTYCH_OK)
        result = check_finite(material->emissive, 4, "material emissive", error);
    if (result == TRIPTYCH_OK)
        result = check_finite(material->specular, 4, "material specular", error);
    if (result == TRIPTYCH_OK)
        result = check_positive(material->power, "material power", error);
    if (result == TRIPTYCH_OK)
        state->material = *material;
    return result;
}

static enum triptych_result check_direction(const struct triptych_light *light, struct error *error)
{
    const float *d = light->direction;
    if (d[0] == 0 && d[1] == 0 && d[2] == 0) {
        error_set(error, "light direction 0, 0, 0: expected a direction other than zero");
        return TRIPTYCH_BAD_ARGUMENT;
    }
    return check_finite(d, 3, "light direction", error);
}

static enum triptych_result check_place(const struct triptych_light *light, struct error *error)
{
    static const char *const name[] = {"light attenuation 0", "light attenuation 1", "light attenuation 2"};
    enum triptych_result result = check_positive(light->range, "light range", error);
    for (int i = 0; i < 3 && result == TRIPTYCH_OK; i++)
        result = check_positive(light->attenuation[i], name[i], error);
    return result == TRIPTYCH_OK ? check_finite(light->position, 3, "light position", error) : result;
}

static enum triptych_result check_cones(const struct triptych_light *light, struct error *error)
{
    if (!within(0, light->phi, (double)(float)M_PI)) {
        error_set(error, "light phi %g: expected an angle from 0 to pi", (double)light->phi);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    if (!within(0, light->theta, light->phi)) {
        error_set(error, "light theta %g: expected an angle from 0 to phi, %g", (double)light->theta,
                  (double)light->phi);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    return check_positive(light->falloff, "light falloff", error);
}

/* Checks the fields that the light's type uses; the others are kept unchanged. */
static enum triptych_result check_light(const struct triptych_light *light, struct error *error)
{
    enum triptych_result result = check_finite(light->diffuse, 4, "light diffuse", error);
    if (result == TRIPTYCH_OK)
        result = check_finite(light->ambient, 4, "light ambient", error);
    if (result == TRIPTYCH_OK)
        result = check_finite(light->specular, 4, "light specular", error);
    if (result == TRIPTYCH_OK && light->type != TRIPTYCH_LIGHT_POINT)
        result = check_direction(light, error);
    if (result == TRIPTYCH_OK && light->type != TRIPTYCH_LIGHT_DIRECTIONAL)
        result = check_place(light, error);
    if (result == TRIPTYCH_OK && light->type == TRIPTYCH_LIGHT_SPOT)
        result = check_cones(light, error);
    return result;
}

enum triptych_result state_set_light(struct state *state, unsigned index, const struct triptych_light *light,
                                     struct error *error)
{
    if (index >= TRIPTYCH_LIGHTS) {
        error_set(error, "light %u: expected 0 to %u", index, TRIPTYCH_LIGHTS - 1);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    if ((unsigned)light->type > TRIPTYCH_LIGHT_SPOT) {
        error_set(error, "light type %u: expected directional (0), point (1) or spot (2)",
                  (unsigned)light->type);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    enum triptych_result result = check_light(light, error);
    if (result == TRIPTYCH_OK)
        state->light[index] = *light;
    return result;
}

void state_set_target(struct state *state, const struct triptych_target_description *description)
{
    uint32_t width = description->width, height = description->height;
    state->width = width;
    state->height = height;
    state->viewport = (struct triptych_viewport){0, 0, (float)width, (float)height, 0, 1};
    state->scissor = (struct scissor){0, 0, width, height};
    state->depth_format = description->depth_format;
    state->samples = (uint8_t)samples_exponent(description->samples);
    for (unsigned t = 0; t < TARGETS; t++) {
        const struct format *format = target_format(description, t);
        state->target[t] = (struct target_channels){0, 0};
        if (format)
            state->target[t] = (struct target_channels){format->target, color_channels(format)};
    }
}

enum triptych_result state_check_clear(enum triptych_depth_format format,
                                       const struct triptych_clear_values *values, struct error *error)
{
    unsigned flags = values->flags;
    float depth = values->depth;
    unsigned all = TRIPTYCH_CLEAR_COLOR | TRIPTYCH_CLEAR_DEPTH | TRIPTYCH_CLEAR_STENCIL;
    if (flags & ~all) {
        error_set(error, "clear flags 0x%x: expected a sum of 1, 2 and 4", flags);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    for (int c = 0; c < 4 && flags & TRIPTYCH_CLEAR_COLOR; c++)
        if (!isfinite(values->color[c])) {
            error_set(error, "clear colour %d is %f, expected a finite number", c, (double)values->color[c]);
            return TRIPTYCH_BAD_ARGUMENT;
        }
    if (values->color_mask > 15) {
        error_set(error, "colour mask 0x%x of a clear: expected 0 to 15", values->color_mask);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    if (flags & TRIPTYCH_CLEAR_DEPTH && !(depth >= 0 && depth <= 1)) {
        error_set(error, "clear depth %g: expected 0 to 1", (double)depth);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    bool lacks_depth = flags & TRIPTYCH_CLEAR_DEPTH && !depth_mask(format);
    bool lacks_stencil = flags & TRIPTYCH_CLEAR_STENCIL && !stencil_mask(format);
    if (lacks_depth || lacks_stencil) {
        error_set(error, "clear of %s: the target's depth format is %s, expected one with %s",
                  lacks_depth ? "depth" : "stencil", depth_formats[format].name,
                  lacks_depth ? "depth" : "stencil");
        return TRIPTYCH_BAD_CALL;
    }
    return TRIPTYCH_OK;
}
