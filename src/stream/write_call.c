/* Calls as canonical text. */
#include "draw/format.h"
#include "container/layout.h"
#include "stream/words.h"
#include "stream/write_part.h"

#include <inttypes.h>
#include <string.h>

/* A word and its numbers, unless they are the default's. */
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
    float number;
    if (word)
        fprintf(writer->out, " %s", word);
    else if (kind->notation == TRIPTYCH_NOTATION_HEXADECIMAL)
        fprintf(writer->out, " 0x%08" PRIx32, value);
    else if (kind->notation == TRIPTYCH_NOTATION_NUMBER)
        fprintf(writer->out, " %" PRIu32, value);
    else {
        memcpy(&number, &value, sizeof number);
        write_number(writer, number);
    }
}

static void write_set(struct writer *writer, const struct call *call)
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

static void write_material(struct writer *writer, const struct triptych_material *material)
{
    const struct triptych_material *initial = &stream_default_material;
    fputs("material", writer->out);
    write_field(writer, "diffuse", material->diffuse, initial->diffuse, 4);
    write_field(writer, "ambient", material->ambient, initial->ambient, 4);
    write_field(writer, "emissive", material->emissive, initial->emissive, 4);
    write_field(writer, "specular", material->specular, initial->specular, 4);
    write_field(writer, "power", &material->power, &initial->power, 1);
}

static void write_light(struct writer *writer, uint32_t index, const struct triptych_light *light)
{
    const struct triptych_light *initial = &stream_default_light;
    static const char *const type[] = {"directional", "point", "spot"};
    fprintf(writer->out, "light %" PRIu32 " %s", index, type[light->type]);
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

static void write_bind_element(struct writer *writer, const struct call *call, const char *name)
{
    fprintf(writer->out, "bind element %s", word_text(WORDS_ATTRIBUTE, call->element.attribute));
    if (call->element.format == TRIPTYCH_FORMAT_NONE)
        fputs(" none", writer->out);
    else
        fprintf(writer->out, " %s %s %" PRIu32 " %" PRIu32, word_text(WORDS_FORMAT, call->element.format),
                name, call->element.offset, call->element.stride);
}

static void write_bind_stream(struct writer *writer, const struct call *call, const char *name)
{
    fprintf(writer->out, "bind stream %" PRIu32 " %s", call->bind_stream.number, name);
    if (call->resource != NO_RESOURCE)
        fprintf(writer->out, " %" PRIu32 " %" PRIu32, call->bind_stream.offset, call->bind_stream.stride);
}

static void write_declare(struct writer *writer, const struct call *call)
{
    fputs("declare", writer->out);
    for (uint32_t i = 0; i < call->declare.count; i++) {
        const struct declared *element = &call->declare.element[i];
        if (!i || element->stream != element[-1].stream)
            fprintf(writer->out, " %u", element->stream);
        fprintf(writer->out, " %s:%s@%u", stream_element_word(element->usage, element->usage_index),
                word_text(WORDS_FORMAT, element->format), 4u * element->words);
    }
}

static void write_fvf(struct writer *writer, uint32_t fvf)
{
    static const struct {
        const char *word;
        uint32_t mask, value;
    } rows[] = {
#define FVF(word, mask, value, meaning) {#word, mask, value},
#include "def/fvf.def"
#undef FVF
    };
    fputs("fvf", writer->out);
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        if ((fvf & rows[i].mask) == rows[i].value)
            fprintf(writer->out, " %s", rows[i].word);
}

static const char *stage_word(enum triptych_shader_stage stage)
{
    return stage == TRIPTYCH_SHADER_PIXEL ? "pixel" : "vertex";
}

static void write_constants(struct writer *writer, const struct call *call)
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

static void write_constant_matrix(struct writer *writer, const struct call *call)
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

static void write_update(struct writer *writer, const struct call *call, const char *name)
{
    const struct triptych_box *box = &call->update.box;
    fprintf(writer->out, "update %s", name);
    if (call->update.face)
        fprintf(writer->out, " face %" PRIu32, call->update.face);
    if (call->update.level)
        fprintf(writer->out, " level %" PRIu32, call->update.level);
    if (box->width)
        fprintf(writer->out, " box %u %u %u %u %u %u", box->x, box->y, box->z, box->width, box->height,
                box->depth);
    fprintf(writer->out, " %s", writer->stream->resources[call->update.source].name);
}

static void write_clear(struct writer *writer, const struct call *call)
{
    fputs("clear", writer->out);
    if (call->clear.flags & TRIPTYCH_CLEAR_COLOR)
        write_field(writer, "color", call->clear.color, NULL, 4);
    if (call->clear.flags & TRIPTYCH_CLEAR_DEPTH)
        write_field(writer, "depth", &call->clear.depth, NULL, 1);
    if (call->clear.flags & TRIPTYCH_CLEAR_STENCIL)
        fprintf(writer->out, " stencil %" PRIu32, call->clear.stencil);
}

static void write_draw(struct writer *writer, const struct call *call)
{
    const char *primitive = word_text(WORDS_PRIMITIVE, call->draw.primitive);
    if (call->type == CALL_DRAW_INDEXED)
        fprintf(writer->out, "draw-indexed %s %" PRId32, primitive, call->draw.base);
    else
        fprintf(writer->out, "draw %s", primitive);
    fprintf(writer->out, " %" PRIu32 " %" PRIu32, call->draw.first, call->draw.count);
}

static void write_color_formats(struct writer *writer, const struct triptych_target_description *target)
{
    for (unsigned t = 0; t < TRIPTYCH_TARGETS && target->color_format[t]; t++)
        fprintf(writer->out, "%s %s", t ? "" : " color", format_find(target->color_format[t])->name);
}

static void write_surface(struct writer *writer, const char *word, const struct stream_surface *surface)
{
    fprintf(writer->out, " %s%s", word,
            surface->resource == NO_RESOURCE ? "target" : writer->stream->resources[surface->resource].name);
    if (surface->level)
        fprintf(writer->out, " level %" PRIu32, surface->level);
    if (surface->slice)
        fprintf(writer->out, " slice %" PRIu32, surface->slice);
}

static void write_attach(struct writer *writer, const struct call *call)
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

static void write_copy(struct writer *writer, const struct call *call)
{
    fputs("copy", writer->out);
    for (int i = 0; i < 2; i++) {
        const struct triptych_rectangle *part = &call->copy.part[i];
        write_surface(writer, i ? "to " : "", &call->copy.surface[i]);
        if (part->width)
            fprintf(writer->out, " part %u %u %u %u", part->x, part->y, part->width, part->height);
    }
    fputs(call->copy.filter == TRIPTYCH_COPY_LINEAR ? " linear" : "", writer->out);
}

static void write_call(struct writer *writer, const struct call *call)
{
    FILE *out = writer->out;
    const char *name =
        call->resource == NO_RESOURCE ? "none" : writer->stream->resources[call->resource].name;
    switch (call->type) {
    case CALL_TARGET:
        fprintf(out, "target %u %u", call->target.width, call->target.height);
        if (call->target.depth_format)
            fprintf(out, " depth %s", word_text(WORDS_DEPTH, call->target.depth_format));
        if (call->target.samples)
            fprintf(out, " samples %u", call->target.samples);
        write_color_formats(writer, &call->target);
        break;
    case CALL_ATTACH: write_attach(writer, call); break;
    case CALL_COPY: write_copy(writer, call); break;
    case CALL_VIEWPORT: {
        const struct triptych_viewport *v = &call->viewport;
        const float numbers[6] = {v->x, v->y, v->width, v->height, v->depth_near, v->depth_far};
        fputs("viewport", out);
        write_numbers(writer, numbers, 6);
        break;
    }
    case CALL_SCISSOR:
        fprintf(out, "scissor %" PRIu32 " %" PRIu32 " %" PRIu32 " %" PRIu32, call->scissor.x, call->scissor.y,
                call->scissor.width, call->scissor.height);
        break;
    case CALL_SET: write_set(writer, call); break;
    case CALL_CONVENTION:
        fprintf(out, "convention %s %s", word_text(WORDS_CONVENTION, call->convention.which),
                word_text(WORDS_PIXEL_CENTER + call->convention.which, call->convention.value));
        break;
    case CALL_CLIP_PLANE:
        fprintf(out, "clipplane %" PRIu32, call->clip_plane.index);
        write_numbers(writer, call->clip_plane.plane, 4);
        break;
    case CALL_TRANSFORM:
        fputs("transform", out);
        write_transform_name(writer, call->transform.which);
        write_field(writer, "matrix", &call->transform.matrix[0][0], NULL, 16);
        break;
    case CALL_MATERIAL: write_material(writer, &call->material); break;
    case CALL_LIGHT: write_light(writer, call->light.index, &call->light.value); break;
    case CALL_ENABLE_LIGHT:
        fprintf(out, "light %" PRIu32 " %s", call->light.index, call->light.on ? "on" : "off");
        break;
    case CALL_BIND_TEXTURE:
        fprintf(out, "bind texture ");
        if (call->sampler)
            fprintf(out, "%" PRIu32 " ", call->sampler);
        fprintf(out, "%s", name);
        break;
    case CALL_BIND_VERTICES: fprintf(out, "bind vertices %s", name); break;
    case CALL_BIND_INDICES:
        fprintf(out, "bind indices %s", name);
        if (call->index_bits)
            fprintf(out, " %" PRIu32, call->index_bits);
        break;
    case CALL_BIND_ELEMENT: write_bind_element(writer, call, name); break;
    case CALL_BIND_STREAM: write_bind_stream(writer, call, name); break;
    case CALL_DECLARE: write_declare(writer, call); break;
    case CALL_FVF: write_fvf(writer, call->fvf); break;
    case CALL_FREQUENCY:
        fprintf(out, "frequency %" PRIu32 " %s %" PRIu32, call->frequency.stream,
                word_text(WORDS_FREQUENCY, call->frequency.frequency), call->frequency.count);
        break;
    case CALL_SHADER: fprintf(out, "%sshader %s", stage_word(call->shader), name); break;
    case CALL_CONSTANTS: write_constants(writer, call); break;
    case CALL_CONSTANT_MATRIX: write_constant_matrix(writer, call); break;
    case CALL_UPDATE: write_update(writer, call, name); break;
    case CALL_MIPS: fprintf(out, "mips %s", name); break;
    case CALL_TEXELS:
        fprintf(out, "texels %s %s", name, writer->stream->resources[call->texels.source].name);
        break;
    case CALL_CONTENTS: fprintf(out, "contents %s", name); break;
    case CALL_RELEASE: fprintf(out, "release %s", name); break;
    case CALL_CLEAR: write_clear(writer, call); break;
    case CALL_DRAW:
    case CALL_DRAW_INDEXED: write_draw(writer, call); break;
    case CALL_DRAW_MESH: fprintf(out, "draw mesh %s", name); break;
    case CALL_BEGIN_QUERY: fprintf(out, "begin-query %s", name); break;
    case CALL_END_QUERY: fprintf(out, "end-query %s", name); break;
    case CALL_FRAME: fputs("frame", out); break;
    case CALL_PLAY: fprintf(out, "play %s", name); break;
    case CALL_SEQUENCE: fprintf(out, "sequence %s", name); break;
    }
    fputc('\n', out);
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
        if (call->type == CALL_SEQUENCE)
            end = i + 1 + call->sequence.count;
    }
}
