/* ProcessVertices: transformed and lit vertices, written to a buffer in the format that it declares. */
#include "front/d3d9/call.h"
#include "front/d3d9/draw/buffer.h"
#include "front/d3d9/draw/draw.h"
#include "front/d3d9/state/declaration.h"

#include <string.h>

/* D3DDECLTYPE; D3DRS_FOGENABLE. */
enum { TYPE_FLOAT4 = 3, TYPE_COLOR = 4, FOG_ENABLE = 28 };

/* Where vertices are written. */
struct output {
    const struct d3d9_vertex_element *element;
    unsigned count;
    uint32_t stride;
    bool fog; /* the specular alpha is the fog factor */
    struct d3d9_vertex_element own[TRIPTYCH_DECLARATION_ELEMENTS];
};

static uint32_t bytes_of(uint8_t type)
{
    return type <= TYPE_FLOAT4 ? 4u * (type + 1u) : 4;
}

/* The elements of a declaration, or those of the buffer's vertex format code. */
static void find_output(struct output *output, const struct d3d9_declaration *declaration,
                        const struct d3d9_buffer *buffer)
{
    output->element = declaration ? declaration->element : output->own;
    output->count = declaration ? declaration->count : d3d9_state_fvf_elements(buffer->fvf, output->own);
    for (unsigned i = 0; i < output->count; i++) {
        uint32_t end = output->element[i].offset + bytes_of(output->element[i].type);
        output->stride = end > output->stride ? end : output->stride;
    }
}

static uint32_t packed_color(const float color[4], float alpha)
{
    float channel[4] = {color[2], color[1], color[0], alpha};
    uint32_t word = 0;
    for (int c = 0; c < 4; c++) {
        float unit = channel[c] > 0 ? channel[c] < 1 ? channel[c] : 1 : 0;
        word |= (uint32_t)(unit * 255 + 0.5F) << 8 * c;
    }
    return word;
}

/* Writes an element that the vertex routine computes; others stay as they are. */
static void write_element(const struct output *output, const struct d3d9_vertex_element *element,
                          const struct triptych_processed_vertex *vertex, uint8_t *to)
{
    unsigned index = element->usage_index;
    bool floats = element->type <= TYPE_FLOAT4;
    size_t bytes = bytes_of(element->type);
    to += element->offset;
    if (element->usage == TRIPTYCH_USAGE_POSITIONT && floats)
        memcpy(to, vertex->position, bytes);
    else if (element->usage == TRIPTYCH_USAGE_TEXCOORD && floats && index < 8)
        memcpy(to, vertex->texcoord[index], bytes);
    else if (element->usage == TRIPTYCH_USAGE_PSIZE && floats)
        memcpy(to, &vertex->point_size, sizeof vertex->point_size);
    else if (element->usage == TRIPTYCH_USAGE_COLOR && element->type == TYPE_COLOR && index < 2) {
        float alpha = index && output->fog ? vertex->fog : vertex->color[index][3];
        uint32_t word = packed_color(vertex->color[index], alpha);
        memcpy(to, &word, sizeof word);
    }
}

static int32_t process(struct d3d9_device *device, const struct output *output, uint32_t first,
                       uint32_t count, uint8_t *to)
{
    enum { AT_ONCE = 32 };
    struct triptych_processed_vertex vertex[AT_ONCE];
    for (uint32_t done = 0; done < count; done += AT_ONCE) {
        uint32_t now = count - done < AT_ONCE ? count - done : AT_ONCE;
        if (triptych_process_vertices(device->renderer, first + done, now, vertex) != TRIPTYCH_OK)
            return D3D9_INVALID_CALL;
        for (uint32_t i = 0; i < now; i++)
            for (unsigned e = 0; e < output->count; e++)
                write_element(output, output->element + e, vertex + i,
                              to + (size_t)(done + i) * output->stride);
    }
    return D3D9_OK;
}

int32_t d3d9_device_process_vertices(struct d3d9_device *device, uint32_t source_first,
                                     uint32_t destination_first, uint32_t count,
                                     struct d3d9_vertex_buffer *destination,
                                     struct d3d9_declaration *declaration, uint32_t flags)
{
    struct d3d9_buffer *buffer = (struct d3d9_buffer *)destination;
    struct output output = {.fog = device->state->render[FOG_ENABLE]};
    (void)flags; /* D3DPV_DONOTCOPYDATA: nothing is copied besides what is computed */
    if (!buffer || !device->state->declaration[0])
        return D3D9_INVALID_CALL;
    find_output(&output, declaration, buffer);
    uint64_t begin = (uint64_t)destination_first * output.stride,
             end = begin + (uint64_t)count * output.stride;
    if (!output.count || end > buffer->bytes || !d3d9_draw_prepare(device, D3D9_NEEDS_STREAMS))
        return D3D9_INVALID_CALL;
    int32_t result = process(device, &output, source_first, count, buffer->memory + begin);
    if (count)
        d3d9_buffer_written(buffer, (uint32_t)begin, (uint32_t)end);
    return result;
}
