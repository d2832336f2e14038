#include "command/inspect/inspection_part.h"

#include "capture/record.h"
#include "command/support/session.h"
#include "shader/program/program.h"

#include <stdlib.h>
#include <string.h>

static cJSON *add_object(cJSON *array)
{
    cJSON *object = cJSON_CreateObject();
    cJSON_AddItemToArray(array, object);
    return object;
}

static void add_text(cJSON *object, const char *name, const char *text)
{
    cJSON_AddStringToObject(object, name, text);
}

static void add_number(cJSON *object, const char *name, double number)
{
    cJSON_AddNumberToObject(object, name, number);
}

/* --- The trail ------------------------------------------------------------------------------------------ */

const struct trail_canvas *inspection_canvas(const struct trail *trail)
{
    return trail->canvas + trail->draw[trail->draws - 1].canvas;
}

struct trail *inspection_open(const struct stream *stream, const struct trail_options *options,
                              struct error *error)
{
    struct trail *trail = malloc(sizeof *trail);
    if (!trail) {
        error_set(error, "out of memory");
        return NULL;
    }
    if (!trail_open(trail, stream, options, error))
        return trail;
    inspection_close(trail);
    return NULL;
}

void inspection_close(struct trail *trail)
{
    trail_close(trail);
    free(trail);
}

const struct watch_owner *inspection_owners(const struct trail *trail)
{
    return inspection_canvas(trail)->owner;
}

bool inspection_is_starved(const struct trail *trail)
{
    return trail->starved;
}

bool inspection_is_lower(const struct trail *trail)
{
    return session_is_lower(trail->device);
}

const uint32_t *inspection_counts(const struct trail *trail, unsigned *width, unsigned *height)
{
    const struct trail_canvas *canvas = inspection_canvas(trail);
    *width = canvas->width;
    *height = canvas->height;
    return canvas->count;
}

/* --- Calls ---------------------------------------------------------------------------------------------- */

/* Adds the canonical line of a call. */
static void add_line(struct trail *trail, cJSON *object, const char *name, const struct call *call)
{
    char *line = stream_write_call(trail->stream, call);
    if (line)
        add_text(object, name, line);
    else
        trail->starved = true;
    free(line);
}

void inspection_call(struct trail *trail, uint32_t position, cJSON *object)
{
    const struct call *call = &trail->stream->calls[trail->stream->executed[position]];
    add_line(trail, object, "call", call);
    if (call->position.kind == POSITION_TEXT) {
        add_number(object, "line", call->position.text.line);
        return;
    }
    add_number(object, "offset", (double)call->position.container.offset);
    add_number(object, "byte", call->position.container.byte);
}

static void add_counts(cJSON *object, const struct watch_counts *counts)
{
    add_number(object, "primitives", (double)counts->primitives);
    add_number(object, "covered", (double)counts->covered);
    add_number(object, "shaded", (double)counts->shaded);
    add_number(object, "passed", (double)counts->passed);
}

cJSON *inspection_draws(struct trail *trail)
{
    cJSON *draws = cJSON_CreateArray();
    for (uint32_t i = 0; i < trail->draws; i++) {
        cJSON *draw = add_object(draws);
        add_number(draw, "draw", i);
        add_counts(draw, &trail->draw[i].counts);
        inspection_call(trail, trail->draw[i].position, draw);
    }
    return draws;
}

/* --- Targets -------------------------------------------------------------------------------------------- */

static const char *resource_name(struct trail *trail, const void *object)
{
    uint32_t number = player_resource(trail->player, object);
    return number == NO_RESOURCE ? "unnamed" : trail->stream->resources[number].name;
}

static void add_surface(struct trail *trail, cJSON *object, const struct triptych_surface *surface)
{
    if (surface->image)
        add_text(object, "image", resource_name(trail, surface->image));
    if (!surface->texture)
        return;
    add_text(object, "texture", resource_name(trail, surface->texture));
    add_number(object, "level", surface->level);
    add_number(object, "slice", surface->slice);
}

static cJSON *targets(struct trail *trail)
{
    const struct target *target = device_target(trail->device);
    const struct triptych_target_surfaces *surfaces = &inspection_canvas(trail)->surfaces;
    cJSON *object = cJSON_CreateObject();
    add_number(object, "width", target->width);
    add_number(object, "height", target->height);
    add_number(object, "samples", target->samples);
    cJSON *colors = cJSON_AddArrayToObject(object, "colors");
    for (unsigned t = 0; t < TARGETS; t++) {
        if (!target->colors[t].format)
            continue;
        cJSON *color = add_object(colors);
        add_number(color, "target", t);
        add_text(color, "format", target->colors[t].format->name);
        add_surface(trail, color, &surfaces->color[t]);
    }
    if (!target->depth)
        return object;
    cJSON *depth = cJSON_AddObjectToObject(object, "depth");
    add_text(depth, "format", depth_formats[target->depth_format].name);
    add_surface(trail, depth, &surfaces->depth);
    return object;
}

/* --- States --------------------------------------------------------------------------------------------- */

struct listing {
    struct trail *trail;
    cJSON *array;
};

/* The default of a state by its number: the last word of the line that would set it. */
static void add_default(const struct listing *listing, cJSON *object, const struct call *call)
{
    struct call initial = *call;
    initial.set.value = triptych_state_default(call->set.table, call->set.row, call->set.i);
    char *line = stream_write_call(listing->trail->stream, &initial);
    const char *word = line ? strrchr(line, ' ') : NULL;
    if (word)
        add_text(object, "default", word + 1);
    else
        listing->trail->starved = true;
    free(line);
}

static void add_difference(void *user, const struct call *call)
{
    const struct listing *listing = user;
    cJSON *object = add_object(listing->array);
    add_line(listing->trail, object, "call", call);
    if (call->type == CALL_SET)
        add_default(listing, object, call);
}

static cJSON *states(struct trail *trail)
{
    const struct state *state = &trail->device->state;
    struct call viewport = {.type = CALL_VIEWPORT, .viewport = state->viewport};
    struct call scissor = {.type = CALL_SCISSOR};
    struct listing listing = {trail, cJSON_CreateArray()};
    scissor.scissor.x = state->scissor.x;
    scissor.scissor.y = state->scissor.y;
    scissor.scissor.width = state->scissor.width;
    scissor.scissor.height = state->scissor.height;
    add_difference(&listing, &viewport);
    add_difference(&listing, &scissor);
    record_differences(trail->device, add_difference, &listing);
    return listing.array;
}

/* --- Bindings ------------------------------------------------------------------------------------------- */

static void add_texture(struct trail *trail, cJSON *object, const struct triptych_texture *texture)
{
    add_text(object, "texture", resource_name(trail, texture));
    add_text(object, "type", word_text(WORDS_TEXTURETYPE, texture->type));
    add_text(object, "format", texture->format->name);
    add_number(object, "width", texture->width);
    add_number(object, "height", texture->height);
    add_number(object, "depth", texture->depth);
    add_number(object, "levels", texture->levels);
    add_number(object, "bytes", (double)texture_texel_bytes(texture));
}

static cJSON *textures(struct trail *trail)
{
    cJSON *array = cJSON_CreateArray();
    for (unsigned i = 0; i < TRIPTYCH_SAMPLERS; i++) {
        const struct triptych_texture *texture = trail->device->state.texture[i];
        if (!texture)
            continue;
        cJSON *object = add_object(array);
        add_number(object, "sampler", i);
        add_texture(trail, object, texture);
        cJSON_AddBoolToObject(object, "sampled", device_derived_samples(&trail->device->derived, (int)i));
    }
    return array;
}

/* Attributes that are set by themselves have a stream each, after those of declarations. Streams of one
 * buffer are reported together. */
static bool together(const struct state *state, unsigned a, unsigned b)
{
    const struct state_stream *first = &state->stream[a], *second = &state->stream[b];
    return a == b || (a >= TRIPTYCH_STREAMS && b >= TRIPTYCH_STREAMS && first->buffer == second->buffer &&
                      first->stride == second->stride);
}

static void add_element(cJSON *array, const struct state *state, const char *word,
                        const struct state_element *element)
{
    bool alone = element->stream >= TRIPTYCH_STREAMS;
    cJSON *object = add_object(array);
    add_text(object, "element", word);
    add_text(object, "format", word_text(WORDS_FORMAT, element->format));
    add_number(object, "offset",
               (double)(element->offset + (alone ? state->stream[element->stream].offset : 0)));
}

static cJSON *elements(const struct state *state, unsigned stream)
{
    cJSON *array = cJSON_CreateArray();
    for (unsigned a = 0; a < TRIPTYCH_ATTRIBUTE_COUNT; a++)
        if (state->element[a].format && together(state, state->element[a].stream, stream))
            add_element(array, state, word_text(WORDS_ATTRIBUTE, a), &state->element[a]);
    for (unsigned i = 0; i < state->others; i++)
        if (state->other[i].element.stream == stream)
            add_element(array, state, stream_element_word(state->other[i].usage, state->other[i].usage_index),
                        &state->other[i].element);
    return array;
}

/* Returns true if an earlier stream is reported together with this one. */
static bool is_reported(const struct state *state, unsigned stream)
{
    for (unsigned i = 0; i < stream; i++)
        if (state->stream[i].buffer && together(state, i, stream))
            return true;
    return false;
}

static cJSON *buffers(struct trail *trail)
{
    const struct state *state = &trail->device->state;
    cJSON *array = cJSON_CreateArray();
    for (unsigned i = 0; i < STREAM_COUNT; i++) {
        const struct state_stream *stream = &state->stream[i];
        bool alone = i >= TRIPTYCH_STREAMS;
        cJSON *described = stream->buffer && !is_reported(state, i) ? elements(state, i) : NULL;
        if (!cJSON_GetArraySize(described) && (alone || !described)) {
            cJSON_Delete(described);
            continue;
        }
        cJSON *object = add_object(array);
        if (!alone)
            add_number(object, "stream", i);
        add_text(object, "buffer", resource_name(trail, stream->buffer));
        add_number(object, "bytes", (double)stream->buffer->bytes);
        add_number(object, "offset", alone ? 0 : (double)stream->offset);
        add_number(object, "stride", (double)stream->stride);
        cJSON_AddItemToObject(object, "elements", described);
    }
    return array;
}

static cJSON *indices(struct trail *trail)
{
    const struct state *state = &trail->device->state;
    cJSON *object = cJSON_CreateObject();
    add_text(object, "buffer", resource_name(trail, state->indices));
    add_number(object, "bits", state->index_bits);
    add_number(object, "bytes", (double)state->indices->bytes);
    return object;
}

static cJSON *shaders(struct trail *trail)
{
    static const char *const stage_name[SHADER_STAGES] = {[STAGE_VERTEX] = "vertex", [STAGE_PIXEL] = "pixel"};
    cJSON *array = cJSON_CreateArray();
    for (int stage = 0; stage < SHADER_STAGES; stage++) {
        const struct triptych_shader *shader = trail->device->shader[stage];
        cJSON *object = add_object(array);
        add_text(object, "stage", stage_name[stage]);
        if (!shader)
            continue;
        add_text(object, "shader", resource_name(trail, shader));
        add_text(object, "model", shader->program->model->name);
        add_number(object, "slots", shader->program->slots);
    }
    return array;
}

cJSON *inspection_state(struct trail *trail)
{
    const struct trail_draw *draw = &trail->draw[trail->draws - 1];
    cJSON *object = cJSON_CreateObject();
    add_text(object, "stream", trail->stream->path);
    add_number(object, "frame", trail->options.frame);
    add_number(object, "draw", trail->options.draw);
    add_number(object, "draws", trail->frame_draws);
    inspection_call(trail, draw->position, object);
    add_counts(object, &draw->counts);
    cJSON_AddItemToObject(object, "targets", targets(trail));
    cJSON_AddItemToObject(object, "shaders", shaders(trail));
    cJSON_AddItemToObject(object, "textures", textures(trail));
    cJSON_AddItemToObject(object, "buffers", buffers(trail));
    if (trail->device->state.indices)
        cJSON_AddItemToObject(object, "indices", indices(trail));
    cJSON_AddItemToObject(object, "states", states(trail));
    return object;
}
