/* Vertex declarations, of elements or of vertex format codes. */
#include "front/d3d9/state/declaration.h"
#include "front/d3d9/call.h"
#include "front/d3d9/device.h"

#include <string.h>

enum { END_STREAM = 0xff, TYPE_UNUSED = 17 };

/* --- Making --- */

static int32_t check_element(const struct d3d9_vertex_element *element)
{
    bool valid = element->stream < TRIPTYCH_STREAMS && element->offset % 4 == 0 &&
                 element->type < TYPE_UNUSED && element->usage < TRIPTYCH_USAGE_COUNT &&
                 element->usage_index < TRIPTYCH_USAGE_INDICES;
    return valid ? D3D9_OK : D3D9_FAIL;
}

/* The renderer reads the first of the elements with one usage and index. */
static void translate(struct d3d9_declaration *declaration)
{
    uint16_t used[TRIPTYCH_USAGE_COUNT] = {0};
    for (unsigned i = 0; i < declaration->count; i++) {
        const struct d3d9_vertex_element *from = declaration->element + i;
        if (used[from->usage] >> from->usage_index & 1)
            continue;
        used[from->usage] |= (uint16_t)(1u << from->usage_index);
        declaration->streams |= (uint16_t)(1u << from->stream);
        declaration->translation[declaration->translated++] = (struct triptych_declaration_element){
            .stream = from->stream,
            .offset = from->offset,
            .format = (enum triptych_format)(TRIPTYCH_FORMAT_FLOAT1 + from->type),
            .usage = (enum triptych_usage)from->usage,
            .usage_index = from->usage_index};
    }
}

/* Windows' conversion to a vertex format code finds positions only. */
static uint32_t code_of(const struct d3d9_vertex_element *elements, unsigned count)
{
    enum { FVF_XYZ = 2, FVF_XYZRHW = 4, FLOAT3 = 2, FLOAT4 = 3 };
    if (count != 1 || elements->stream || elements->offset || elements->usage_index)
        return 0;
    if (elements->usage == TRIPTYCH_USAGE_POSITION && elements->type == FLOAT3)
        return FVF_XYZ;
    return elements->usage == TRIPTYCH_USAGE_POSITIONT && elements->type == FLOAT4 ? FVF_XYZRHW : 0;
}

/* Makes a declaration of `count` elements, which ends are not part of, with one reference. D3D9_FAIL for
 * elements that no device accepts. */
static int32_t make(struct d3d9_device *device, const struct d3d9_vertex_element *elements, unsigned count,
                    struct d3d9_declaration **out)
{
    for (unsigned i = 0; i < count; i++)
        if (check_element(elements + i) != D3D9_OK)
            return D3D9_FAIL;
    struct d3d9_declaration *declaration =
        d3d9_object_make(sizeof *declaration, D3D9_INTERFACE_DECLARATION, &device->object, NULL);
    if (!declaration)
        return D3D9_OUT_OF_MEMORY;
    declaration->device = device;
    declaration->count = count;
    if (count)
        memcpy(declaration->element, elements, count * sizeof *elements);
    declaration->element[count] = (struct d3d9_vertex_element){.stream = END_STREAM, .type = TYPE_UNUSED};
    declaration->fvf = code_of(elements, count);
    translate(declaration);
    *out = declaration;
    return D3D9_OK;
}

int32_t d3d9_device_create_vertex_declaration(struct d3d9_device *device,
                                              const struct d3d9_vertex_element *elements,
                                              struct d3d9_declaration **out)
{
    unsigned count = 0;
    if (!elements || !out)
        return D3D9_INVALID_CALL;
    while (elements[count].stream != END_STREAM)
        if (++count > TRIPTYCH_DECLARATION_ELEMENTS)
            return D3D9_FAIL;
    return make(device, elements, count, out);
}

int32_t d3d9_declaration_get_declaration(struct d3d9_declaration *declaration,
                                         struct d3d9_vertex_element *elements, uint32_t *count)
{
    if (!count || (elements && *count <= declaration->count))
        return D3D9_INVALID_CALL;
    *count = declaration->count + 1;
    if (elements)
        memcpy(elements, declaration->element, *count * sizeof *elements);
    return D3D9_OK;
}

/* --- Setting --- */

int32_t d3d9_device_set_vertex_declaration(struct d3d9_device *device, struct d3d9_declaration *declaration)
{
    d3d9_state_set(device, D3D9_GROUP_DECLARATION, 0, &declaration);
    return D3D9_OK;
}

int32_t d3d9_device_get_vertex_declaration(struct d3d9_device *device, struct d3d9_declaration **out)
{
    if (!out)
        return D3D9_INVALID_CALL;
    *out = device->state->declaration[0];
    if (*out)
        d3d9_object_add_ref(&(*out)->object);
    return D3D9_OK;
}

/* The device's declaration for a code, which it keeps. */
static struct d3d9_declaration *declaration_of(struct d3d9_device *device, uint32_t fvf)
{
    struct d3d9_vertex_element elements[TRIPTYCH_DECLARATION_ELEMENTS];
    struct d3d9_declaration *made = device->declarations;
    while (made && made->fvf != fvf)
        made = made->next;
    if (made)
        return made;
    unsigned count = d3d9_state_fvf_elements(fvf, elements);
    if (make(device, elements, count, &made) != D3D9_OK)
        return NULL;
    made->fvf = fvf;
    made->next = device->declarations;
    device->declarations = made;
    d3d9_object_hold(&made->object);
    d3d9_object_release(&made->object);
    return made;
}

/* Code 0 keeps the declaration. */
int32_t d3d9_device_set_fvf(struct d3d9_device *device, uint32_t fvf)
{
    if (!fvf)
        return D3D9_OK;
    struct d3d9_declaration *declaration = declaration_of(device, fvf);
    return declaration ? d3d9_device_set_vertex_declaration(device, declaration) : D3D9_OUT_OF_MEMORY;
}

int32_t d3d9_device_get_fvf(struct d3d9_device *device, uint32_t *fvf)
{
    if (!fvf)
        return D3D9_INVALID_CALL;
    *fvf = device->state->declaration[0] ? device->state->declaration[0]->fvf : 0;
    return D3D9_OK;
}
