/* Calls as canonical text. */
#include "base/bits.h"
#include "render/texture/format.h"
#include "capture/layout.h"
#include "capture/word.h"
#include "command/stream/functions.h"
#include "command/text/write_part.h"

#include <inttypes.h>
#include <string.h>

static const char *resource_name(const struct writer *writer, uint32_t number)
{
    return number == NO_RESOURCE ? "none" : writer->stream->resources[number].name;
}

/* Writes a word and its numbers, unless they are the default's. */
static void write_field(struct writer *writer, const char *word, const float *numbers, const float *initial,
                        size_t count)
{
    if (initial && !memcmp(numbers, initial, count * sizeof *numbers))
        return;
    fprintf(writer->out, " %s", word);
    write_numbers(writer, numbers, count);
}

static void write_value(struct writer *writer, const struct triptych_kind *kind, uint32_t value)
{
    const char *word = triptych_value_word(kind, value);

    if (word)
        fprintf(writer->out, " %s", word);
    else if (kind->notation == TRIPTYCH_NOTATION_HEXADECIMAL)
        fprintf(writer->out, " 0x%08" PRIx32, value);
    else if (kind->notation == TRIPTYCH_NOTATION_NUMBER)
        fprintf(writer->out, " %" PRIu32, value);
    else
        write_number(writer, bits_to_float(value));
}

void write_set(struct writer *writer, const struct call *call)
{
    const struct triptych_state_row *state = triptych_state_at(call->set.table, call->set.row);
    fputs(triptych_table_name(call->set.table), writer->out);
    if (call->set.table != TRIPTYCH_RENDER_STATES)
        fprintf(writer->out, " %" PRIu32, call->set.i);
    fprintf(writer->out, " %s", state->name);
    write_value(writer, state->kind, call->set.value);
}

static void write_transform_name(struct writer *writer, unsigned which)
{
    if (which >= TRIPTYCH_TRANSFORM_WORLD1)
        fprintf(writer->out, " world %u", which - TRIPTYCH_TRANSFORM_WORLD1 + 1);
    else if (which >= TRIPTYCH_TRANSFORM_TEXTURE0)
        fprintf(writer->out, " texture %u", which - TRIPTYCH_TRANSFORM_TEXTURE0);
    else
        fprintf(writer->out, " %s", word_text(WORDS_TRANSFORM, which));
}

void write_transform(struct writer *writer, const struct call *call)
{
    fputs("transform", writer->out);
    write_transform_name(writer, call->transform.which);
    write_field(writer, "matrix", &call->transform.matrix[0][0], NULL, 16);
}

void write_material(struct writer *writer, const struct call *call)
{
    const struct triptych_material *material = &call->material, *initial = &call_default_material;
    fputs("material", writer->out);
    write_field(writer, "diffuse", material->diffuse, initial->diffuse, 4);
    write_field(writer, "ambient", material->ambient, initial->ambient, 4);
    write_field(writer, "emissive", material->emissive, initial->emissive, 4);
    write_field(writer, "specular", material->specular, initial->specular, 4);
    write_field(writer, "power", &material->power, &initial->power, 1);
}

void write_enable_light(struct writer *writer, const struct call *call)
{
    fprintf(writer->out, "light %" PRIu32 " %s", call->enable_light.index,
            call->enable_light.on ? "on" : "off");
}

void write_light(struct writer *writer, const struct call *call)
{
    const struct triptych_light *light = &call->light.value, *initial = &call_default_light;
    static const char *const type[] = {"directional", "point", "spot"};
    fprintf(writer->out, "light %" PRIu32 " %s", call->light.index, type[light->type]);
    write_field(writer, "diffuse", light->diffuse, initial->diffuse, 4);
    write_field(writer, "ambient", light->ambient, initial->ambient, 4);
    write_field(writer, "specular", light->specular, initial->specular, 4);
    if (light->type != TRIPTYCH_LIGHT_POINT)
        write_field(writer, "direction", light->direction, initial->direction, 3);
    if (light->type == TRIPTYCH_LIGHT_DIRECTIONAL)
        return;
    write_field(writer, "position", light->position, initial->position, 3);
    write_field(writer, "range", &light->range, &initial->range, 1);
    write_field(writer, "attenuation", light->attenuation, initial->attenuation, 3);
    if (light->type == TRIPTYCH_LIGHT_POINT)
        return;
    write_field(writer, "theta", &light->theta, &initial->theta, 1);
    write_field(writer, "phi", &light->phi, &initial->phi, 1);
    write_field(writer, "falloff", &light->falloff, &initial->falloff, 1);
}

void write_convention(struct writer *writer, const struct call *call)
{
    fprintf(writer->out, "convention %s %s", word_text(WORDS_CONVENTION, call->convention.which),
            word_text(WORDS_PIXEL_CENTER + call->convention.which, call->convention.value));
}

void write_bind_texture(struct writer *writer, const struct call *call)
{
    fputs("bind texture ", writer->out);
    if (call->bind_texture.sampler)
        fprintf(writer->out, "%" PRIu32 " ", call->bind_texture.sampler);
    fputs(resource_name(writer, call->resource), writer->out);
}

void write_bind_indices(struct writer *writer, const struct call *call)
{
    fprintf(writer->out, "bind indices %s", resource_name(writer, call->resource));
    if (call->bind_indices.bits)
        fprintf(writer->out, " %" PRIu32, call->bind_indices.bits);
}

void write_bind_element(struct writer *writer, const struct call *call)
{
    const char *name = resource_name(writer, call->resource);
    fprintf(writer->out, "bind element %s", word_text(WORDS_ATTRIBUTE, call->element.attribute));
    if (call->element.format == TRIPTYCH_FORMAT_NONE)
        fputs(" none", writer->out);
    else
        fprintf(writer->out, " %s %s %" PRIu32 " %" PRIu32, word_text(WORDS_FORMAT, call->element.format),
                name, call->element.offset, call->element.stride);
}

void write_bind_stream(struct writer *writer, const struct call *call)
{
    const char *name = resource_name(writer, call->resource);
    fprintf(writer->out, "bind stream %" PRIu32 " %s", call->bind_stream.number, name);
    if (call->resource != NO_RESOURCE)
        fprintf(writer->out, " %" PRIu32 " %" PRIu32, call->bind_stream.offset, call->bind_stream.stride);
}

void write_declare(struct writer *writer, const struct call *call)
{
    fputs("declare", writer->out);
    for (uint32_t i = 0; i < call->declare.count; i++) {
        const struct call_declared *element = &call->declare.element[i];
        if (!i || element->stream != element[-1].stream)
            fprintf(writer->out, " %u", element->stream);
        fprintf(writer->out, " %s:%s@%u", stream_element_word(element->usage, element->usage_index),
                word_text(WORDS_FORMAT, element->format), (unsigned)element->offset);
    }
}

void write_fvf(struct writer *writer, const struct call *call)
{
    static const struct {
        const char *word;
        uint32_t mask, value;
    } rows[] = {
#define FVF(word, mask, value, meaning) {#word, mask, value},
#include "def/state/fvf.def"
#undef FVF
    };
    fputs("fvf", writer->out);
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        if ((call->fvf.code & rows[i].mask) == rows[i].value)
            fprintf(writer->out, " %s", rows[i].word);
}

static const char *stage_word(enum triptych_shader_stage stage)
{
    return stage == TRIPTYCH_SHADER_PIXEL ? "pixel" : "vertex";
}

void write_set_shader(struct writer *writer, const struct call *call)
{
    fprintf(writer->out, "%sshader %s", stage_word(call->shader.stage),
            resource_name(writer, call->resource));
}

void write_constants(struct writer *writer, const struct call *call)
{
    static const char *const word[] = {
        [CONSTANTS_FLOAT] = "constant", [CONSTANTS_INTEGER] = "integer", [CONSTANTS_BOOLEAN] = "boolean"};
    const int32_t *integers = call->constants.integers[0];
    fprintf(writer->out, "%s%s %" PRIu32, stage_word(call->constants.stage), word[call->constants.type],
            call->constants.first);
    if (call->constants.type == CONSTANTS_FLOAT)
        write_numbers(writer, call->constants.floats[0], 4 * (size_t)call->constants.count);
    else if (call->constants.type == CONSTANTS_INTEGER)
        for (int i = 0; i < (integers[3] ? 4 : 3); i++)
            fprintf(writer->out, " %" PRId32, integers[i]);
    else
        for (uint32_t i = 0; i < call->constants.count; i++)
            fputs(call->constants.booleans[i] ? " true" : " false", writer->out);
}

void write_constant_matrix(struct writer *writer, const struct call *call)
{
    fprintf(writer->out, "%sconstant %" PRIu32 " transform", stage_word(call->constant_matrix.stage),
            call->constant_matrix.first);
    for (uint32_t i = 0; i < call->constant_matrix.factors; i++)
        write_transform_name(writer, call->constant_matrix.factor[i]);
    fprintf(writer->out, "%s%s", call->constant_matrix.inverse ? " inverse" : "",
            call->constant_matrix.transposed ? " transposed" : "");
    if (call->constant_matrix.count < CONSTANTS_PER_CALL)
        fprintf(writer->out, " count %" PRIu32, call->constant_matrix.count);
}

void write_update(struct writer *writer, const struct call *call)
{
    const struct triptych_box *box = &call->update.box;
    fprintf(writer->out, "update %s", resource_name(writer, call->resource));
    if (call->update.face)
        fprintf(writer->out, " face %" PRIu32, call->update.face);
    if (call->update.level)
        fprintf(writer->out, " level %" PRIu32, call->update.level);
    if (box->width)
        fprintf(writer->out, " box %u %u %u %u %u %u", box->x, box->y, box->z, box->width, box->height,
                box->depth);
    fprintf(writer->out, " %s", resource_name(writer, call->update.source));
}

static void write_clear_values(struct writer *writer, const struct call_clear *clear)
{
    fputs("clear", writer->out);
    if (clear->flags & TRIPTYCH_CLEAR_COLOR)
        write_field(writer, "color", clear->color, NULL, 4);
    if (clear->flags & TRIPTYCH_CLEAR_DEPTH)
        write_field(writer, "depth", &clear->depth, NULL, 1);
    if (clear->flags & TRIPTYCH_CLEAR_STENCIL)
        fprintf(writer->out, " stencil %" PRIu32, clear->stencil);
}

void write_clear(struct writer *writer, const struct call *call)
{
    write_clear_values(writer, &call->clear);
}

/* The mask of the stencil is always written: without any other word the line would be a plain clear. */
void write_clear_parts(struct writer *writer, const struct call *call)
{
    const struct call_clear_parts *parts = &call->clear_parts;
    write_clear_values(writer, &parts->clear);
    if (parts->color_mask != 15)
        fprintf(writer->out, " colormask %" PRIu32, parts->color_mask);
    fprintf(writer->out, " stencilmask %" PRIu32, parts->stencil_mask);
    if (parts->everywhere)
        fputs(" everywhere", writer->out);
    for (uint32_t i = 0; i < parts->count; i++)
        fprintf(writer->out, " part %u %u %u %u", parts->part[i].x, parts->part[i].y, parts->part[i].width,
                parts->part[i].height);
}

static void write_color_formats(struct writer *writer, const struct triptych_target_description *target)
{
    for (unsigned t = 0; t < TRIPTYCH_TARGETS && target->color_format[t]; t++)
        fprintf(writer->out, "%s %s", t ? "" : " color", format_find(target->color_format[t])->name);
}

void write_target(struct writer *writer, const struct call *call)
{
    const struct triptych_target_description *target = &call->target;
    fprintf(writer->out, "target %u %u", target->width, target->height);
    if (target->depth_format)
        fprintf(writer->out, " depth %s", word_text(WORDS_DEPTH, target->depth_format));
    if (target->samples)
        fprintf(writer->out, " samples %u", target->samples);
    write_color_formats(writer, target);
}

static void write_surface(struct writer *writer, const char *word, const struct call_surface *surface)
{
    fprintf(writer->out, " %s%s", word,
            surface->resource == NO_RESOURCE ? "target" : writer->stream->resources[surface->resource].name);
    if (surface->level)
        fprintf(writer->out, " level %" PRIu32, surface->level);
    if (surface->slice)
        fprintf(writer->out, " slice %" PRIu32, surface->slice);
}

void write_attach(struct writer *writer, const struct call *call)
{
    int last = TRIPTYCH_TARGETS - 1;
    fputs(call->attach.some ? "attach" : "attach none", writer->out);
    while (last >= 0 && call->attach.color[last].resource == NO_RESOURCE)
        last--;
    for (int t = 0; t <= last && call->attach.some; t++)
        if (call->attach.color[t].resource != NO_RESOURCE)
            write_surface(writer, "color ", &call->attach.color[t]);
        else
            fputs(" color none", writer->out);
    if (call->attach.depth.resource != NO_RESOURCE)
        write_surface(writer, "depth ", &call->attach.depth);
    if (call->attach.depth_format)
        fprintf(writer->out, " depthformat %s", word_text(WORDS_DEPTH, call->attach.depth_format));
}

static void write_part(struct writer *writer, const struct triptych_rectangle *part)
{
    if (part->width)
        fprintf(writer->out, " part %u %u %u %u", part->x, part->y, part->width, part->height);
}

void write_copy(struct writer *writer, const struct call *call)
{
    fputs("copy", writer->out);
    for (int i = 0; i < 2; i++) {
        write_surface(writer, i ? "to " : "", &call->copy.surface[i]);
        write_part(writer, &call->copy.part[i]);
    }
    fputs(call->copy.filter == TRIPTYCH_COPY_LINEAR ? " linear" : "", writer->out);
}

void write_set_pixels(struct writer *writer, const struct call *call)
{
    fputs("pixels", writer->out);
    write_surface(writer, "", &call->set_pixels.surface);
    write_part(writer, &call->set_pixels.part);
    if (call->set_pixels.format)
        fprintf(writer->out, " format %s", format_find(call->set_pixels.format)->name);
    fprintf(writer->out, " %s", resource_name(writer, call->set_pixels.source));
}

void write_fill(struct writer *writer, const struct call *call)
{
    fputs("fill", writer->out);
    write_surface(writer, "", &call->fill.surface);
    write_part(writer, &call->fill.part);
    write_field(writer, "color", call->fill.color, NULL, 4);
}

/* --- Lines ---------------------------------------------------------------------------------------------- */

static void write_regular(struct writer *writer, const struct call *call)
{
    struct call copy = *call;
    const struct call_row *row = call_row(call->type);
    fputs(row->word, writer->out);
    for (const struct call_field *field = row->fields; field->kind != FIELD_END; field++)
        switch (field->kind) {
        case FIELD_FLOATS: write_numbers(writer, call_floats(&copy, field), field->count); break;
        case FIELD_SIGNED: fprintf(writer->out, " %" PRId32, *call_signed(&copy, field)); break;
        case FIELD_WORD: fprintf(writer->out, " %s", word_text(field->words, call_get(call, field))); break;
        case FIELD_RESOURCE:
            fprintf(writer->out, " %s", resource_name(writer, *call_resource(&copy, field)));
            break;
        default: fprintf(writer->out, " %" PRIu32, call_get(call, field)); break;
        }
}

void write_call(struct writer *writer, const struct call *call)
{
    if (calls_functions[call->type].print)
        calls_functions[call->type].print(writer, call);
    else
        write_regular(writer, call);
}

void write_calls(struct writer *writer)
{
    const struct stream *stream = writer->stream;
    uint32_t end = UINT32_MAX; /* of the sequence that is open */
    for (uint32_t i = 0; i <= stream->call_count; i++) {
        if (i == end) {
            fputs("end\n", writer->out);
            end = UINT32_MAX;
        }
        if (i == stream->call_count)
            break;
        const struct call *call = &stream->calls[i];
        if (end != UINT32_MAX)
            fputs("    ", writer->out);
        write_call(writer, call);
        fputc('\n', writer->out);
        if (call->type == CALL_SEQUENCE)
            end = i + 1 + call->sequence.count;
    }
}
