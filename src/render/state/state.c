/* State outside of the tables: transforms, the viewport, clip masks and planes, conventions, the material,
 * lights, the target; and the checks of constants and of clears. */
#include "render/state/state_part.h"

#include "render/target/depth.h"
#include "render/target/target.h"

#include "shader/program/program.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

void state_initialize(struct state *state)
{
    static const struct triptych_light light = {
        .type = TRIPTYCH_LIGHT_DIRECTIONAL, .diffuse = {1, 1, 1, 0}, .direction = {0, 0, 1}};
    memset(state, 0, sizeof *state);
    state_initialize_values(state);
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
    if (!state_within(0, v->depth_near, 1) || !state_within(0, v->depth_far, 1)) {
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
    if (!state_within(0, light->phi, (double)(float)M_PI)) {
        error_set(error, "light phi %g: expected an angle from 0 to pi", (double)light->phi);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    if (!state_within(0, light->theta, light->phi)) {
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
