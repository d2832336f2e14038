#include "draw/state.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

const uint8_t format_bytes[TRIPTYCH_FORMAT_COUNT] = {0, 4, 8, 12, 16, 4};
const char *const attribute_name[TRIPTYCH_ATTRIBUTE_COUNT] = {"position", "normal", "diffuse", "texcoord"};

enum kind {
#define KIND(name, first, last) KIND_##name,
#include "def/kind.def"
#undef KIND
};

static const struct {
    uint32_t first, last;
} kind_range[] = {
#define KIND(name, first, last) {first, last},
#include "def/kind.def"
#undef KIND
};

static const struct {
    const char *name;
    enum kind kind;
    uint32_t initial;
} state_rows[TRIPTYCH_STATE_COUNT] = {
#define STATE(name, kind, initial, units, meaning) {#name, KIND_##kind, initial},
#include "def/state.def"
#undef STATE
};

static const struct value_row {
    enum kind kind;
    const char *word;
    uint32_t number;
} value_rows[] = {
#define VALUE(kind, word, number) {KIND_##kind, #word, number},
#include "def/value.def"
#undef VALUE
};

enum { VALUE_ROWS = sizeof value_rows / sizeof *value_rows };

static int known_state(enum triptych_state which)
{
    return (unsigned)which < TRIPTYCH_STATE_COUNT;
}

const char *triptych_state_name(enum triptych_state which)
{
    return known_state(which) ? state_rows[which].name : NULL;
}

const char *triptych_state_word(enum triptych_state which, uint32_t value)
{
    if (!known_state(which))
        return NULL;
    for (int i = 0; i < VALUE_ROWS; i++)
        if (value_rows[i].kind == state_rows[which].kind && value_rows[i].number == value)
            return value_rows[i].word;
    return NULL;
}

int triptych_state_value(enum triptych_state which, const char *word, uint32_t *value)
{
    if (!known_state(which) || !word)
        return -1;
    for (int i = 0; i < VALUE_ROWS; i++)
        if (value_rows[i].kind == state_rows[which].kind && !strcmp(value_rows[i].word, word)) {
            *value = value_rows[i].number;
            return 0;
        }
    return -1;
}

/* Numbers without words. */
static int is_numeric(enum kind kind)
{
    return kind == KIND_COLOR || kind == KIND_MASK || kind == KIND_BYTE;
}

static void list_words(enum kind kind, char *text, size_t size)
{
    size_t at = 0;
    for (int i = 0; i < VALUE_ROWS; i++)
        if (value_rows[i].kind == kind && at < size)
            at += (size_t)snprintf(text + at, size - at, "%s%s (%u)", at ? ", " : "", value_rows[i].word,
                                   value_rows[i].number);
}

enum triptych_result state_set_value(struct state *state, enum triptych_state which, uint32_t value,
                                     struct error *error)
{
    if (!known_state(which)) {
        error_set(error, "state %u: expected 0 to %u", (unsigned)which, TRIPTYCH_STATE_COUNT - 1);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    enum kind kind = state_rows[which].kind;
    int in_range = value >= kind_range[kind].first && value <= kind_range[kind].last;
    if (is_numeric(kind) && !in_range) {
        error_set(error, "state %s: value %u, expected %u to %u", state_rows[which].name, value,
                  kind_range[kind].first, kind_range[kind].last);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    if (!is_numeric(kind) && !triptych_state_word(which, value)) {
        char words[512] = "";
        list_words(kind, words, sizeof words);
        error_set(error, "state %s: value %u %s, expected %s", state_rows[which].name, value,
                  in_range ? "is not supported yet" : "does not exist", words);
        return in_range ? TRIPTYCH_UNSUPPORTED : TRIPTYCH_BAD_ARGUMENT;
    }
    state->value[which] = value;
    return TRIPTYCH_OK;
}

void state_initialize(struct state *state)
{
    static const struct triptych_light light = {
        .type = TRIPTYCH_LIGHT_DIRECTIONAL, .diffuse = {1, 1, 1, 0}, .direction = {0, 0, 1}};
    memset(state, 0, sizeof *state);
    for (int i = 0; i < TRIPTYCH_STATE_COUNT; i++)
        state->value[i] = state_rows[i].initial;
    for (int t = 0; t < TRIPTYCH_TRANSFORM_COUNT; t++)
        for (int i = 0; i < 4; i++)
            state->transform[t][i][i] = 1;
    for (int c = 0; c < 4; c++)
        state->material.diffuse[c] = 1;
    for (int i = 0; i < TRIPTYCH_LIGHTS; i++)
        state->light[i] = light;
}

/* Refuses what is not a number or infinite; says which of the values. */
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

enum triptych_result state_set_transform(struct state *state, enum triptych_transform which,
                                         const float matrix[4][4], struct error *error)
{
    static const char *const name[] = {"world matrix", "view matrix", "projection matrix"};
    if ((unsigned)which >= TRIPTYCH_TRANSFORM_COUNT) {
        error_set(error, "transform %u: expected 0 to %u", (unsigned)which, TRIPTYCH_TRANSFORM_COUNT - 1);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    enum triptych_result result = check_finite(&matrix[0][0], 16, name[which], error);
    if (result == TRIPTYCH_OK)
        memcpy(state->transform[which], matrix, sizeof state->transform[which]);
    return result;
}

/* Written so that a NaN fails. */
static int within(double low, double value, double high)
{
    return value >= low && value <= high;
}

enum triptych_result state_set_viewport(struct state *state, const struct triptych_viewport *viewport,
                                        uint32_t target_width, uint32_t target_height, struct error *error)
{
    const struct triptych_viewport *v = viewport;
    if (!(v->width > 0 && within(0, v->x, target_width) && (double)v->x + v->width <= target_width) ||
        !(v->height > 0 && within(0, v->y, target_height) && (double)v->y + v->height <= target_height)) {
        error_set(error, "viewport %gx%g at %g, %g: expected a part of the target of %ux%u pixels",
                  (double)v->width, (double)v->height, (double)v->x, (double)v->y, target_width,
                  target_height);
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

enum triptych_result state_set_scissor(struct state *state, struct scissor scissor, uint32_t target_width,
                                       uint32_t target_height, struct error *error)
{
    const struct scissor *s = &scissor;
    if ((uint64_t)s->x + s->width > target_width || (uint64_t)s->y + s->height > target_height) {
        error_set(error, "scissor rectangle %ux%u at %u, %u: expected a part of the target of %ux%u pixels",
                  s->width, s->height, s->x, s->y, target_width, target_height);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    state->scissor = scissor;
    return TRIPTYCH_OK;
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
        state->material = *material;
    return result;
}

/* What the light's type uses is checked; the rest is kept as it is. */
static enum triptych_result check_light(const struct triptych_light *light, struct error *error)
{
    enum triptych_result result = check_finite(light->diffuse, 4, "light diffuse", error);
    if (result == TRIPTYCH_OK)
        result = check_finite(light->ambient, 4, "light ambient", error);
    if (result != TRIPTYCH_OK)
        return result;
    if (light->type == TRIPTYCH_LIGHT_DIRECTIONAL) {
        const float *d = light->direction;
        if (d[0] == 0 && d[1] == 0 && d[2] == 0) {
            error_set(error, "light direction 0, 0, 0: expected a direction other than zero");
            return TRIPTYCH_BAD_ARGUMENT;
        }
        return check_finite(d, 3, "light direction", error);
    }
    for (int i = 0; i < 3; i++)
        if (!(light->attenuation[i] >= 0)) {
            error_set(error, "light attenuation %d is %g: expected 0 or more", i,
                      (double)light->attenuation[i]);
            return TRIPTYCH_BAD_ARGUMENT;
        }
    if (!(light->range >= 0)) {
        error_set(error, "light range %g: expected 0 or more", (double)light->range);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    result = check_finite(light->attenuation, 3, "light attenuation", error);
    if (result == TRIPTYCH_OK)
        result = check_finite(&light->range, 1, "light range", error);
    return result == TRIPTYCH_OK ? check_finite(light->position, 3, "light position", error) : result;
}

enum triptych_result state_set_light(struct state *state, unsigned index, const struct triptych_light *light,
                                     struct error *error)
{
    if (index >= TRIPTYCH_LIGHTS) {
        error_set(error, "light %u: expected 0 to %u", index, TRIPTYCH_LIGHTS - 1);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    if (light->type != TRIPTYCH_LIGHT_DIRECTIONAL && light->type != TRIPTYCH_LIGHT_POINT) {
        error_set(error, "light type %u: expected directional (0) or point (1)", (unsigned)light->type);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    enum triptych_result result = check_light(light, error);
    if (result == TRIPTYCH_OK)
        state->light[index] = *light;
    return result;
}

static enum triptych_result bind_element(struct state *state, enum triptych_attribute attribute,
                                         const struct triptych_element *element, struct error *error)
{
    const char *name = attribute_name[attribute];
    if (element->format == TRIPTYCH_FORMAT_COLOR && attribute != TRIPTYCH_DIFFUSE) {
        error_set(error, "element %s: format color, expected float1 to float4", name);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    if (!element->buffer) {
        error_set(error, "element %s: no buffer, expected one with this format", name);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    if (element->stride > 65536) {
        error_set(error, "element %s: stride %zu, expected 0 to 65536", name, element->stride);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    size_t bytes = format_bytes[element->format];
    if (element->buffer->bytes < bytes || element->offset > element->buffer->bytes - bytes) {
        error_set(error, "element %s: %zu bytes at offset %zu, expected them inside the buffer of %zu bytes",
                  name, bytes, element->offset, element->buffer->bytes);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    state->element[attribute] = *element;
    return TRIPTYCH_OK;
}

enum triptych_result state_set_element(struct state *state, enum triptych_attribute attribute,
                                       const struct triptych_element *element, struct error *error)
{
    if ((unsigned)attribute >= TRIPTYCH_ATTRIBUTE_COUNT) {
        error_set(error, "attribute %u: expected 0 to %u", (unsigned)attribute, TRIPTYCH_ATTRIBUTE_COUNT - 1);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    if ((unsigned)element->format >= TRIPTYCH_FORMAT_COUNT) {
        error_set(error, "element %s: format %u, expected 0 to %u", attribute_name[attribute],
                  (unsigned)element->format, TRIPTYCH_FORMAT_COUNT - 1);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    if (element->format != TRIPTYCH_FORMAT_NONE)
        return bind_element(state, attribute, element, error);
    state->element[attribute] = (struct triptych_element){.format = TRIPTYCH_FORMAT_NONE};
    return TRIPTYCH_OK;
}
