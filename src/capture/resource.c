/* Resources as records: the fields of a definition, and the data that follow.
 *
 * Data that the definition implies are not stored, such as texels of generated textures and vertices of
 * shapes. The reader generates them like the reader of text, so a container cannot contradict itself. Data of
 * files are stored in the container, and their path is only a remark. */
#include "capture/codec.h"
#include "capture/layout.h"
#include "render/target/surface.h"

#include <string.h>

enum { NAME_BYTES = 64, PATH_BYTES = 1024, CELL_MOST = 8192 };

static const struct {
    uint8_t usage, index;
} usages[STREAM_ELEMENTS] = {
#define ATTRIBUTE(name, word, usage, index, meaning) {TRIPTYCH_USAGE_##usage, index},
#include "def/state/attribute.def"
#undef ATTRIBUTE
#define ELEMENT(word, usage, index) {TRIPTYCH_USAGE_##usage, index},
#include "capture/element.def"
#undef ELEMENT
};

int resource_find_element(unsigned usage, unsigned usage_index)
{
    for (int e = 0; e < STREAM_ELEMENTS; e++)
        if (usages[e].usage == usage && usages[e].index == usage_index)
            return e;
    return -1;
}

enum triptych_usage resource_element_usage(unsigned element, unsigned *usage_index)
{
    *usage_index = usages[element].index;
    return (enum triptych_usage)usages[element].usage;
}

unsigned layout_order(const struct layout *layout, unsigned order[STREAM_ELEMENTS])
{
    unsigned count = 0;
    for (uint32_t offset = 0; offset < layout->stride; count++) {
        unsigned a = 0;
        while (!layout->format[a] || layout->offset[a] != offset)
            a++;
        order[count] = a;
        offset += key_vertex_types[layout->format[a]].bytes;
    }
    return count;
}

/* --- Definitions ---------------------------------------------------------------------------------------- */

static void code_flag(struct codec *codec, bool *flag, const char *what)
{
    *flag = codec_u8(codec, *flag, 1, what);
}

/* Returns the number of levels with given contents. */
static unsigned given_levels(const struct resource *resource, const struct triptych_texture *shape)
{
    return resource->mips ? 1 : shape->levels;
}

/* Computes the sizes of a texture's data from its source. */
static void size_texture(struct codec *codec, struct resource *resource)
{
    struct triptych_texture shape;
    size_t texels = 0;
    if (texture_describe(&resource->texture, &shape, &codec->error) != TRIPTYCH_OK) {
        codec->failed = true;
        return;
    }
    for (unsigned level = 0; level < given_levels(resource, &shape); level++) {
        resource->texel_bytes += shape.faces * texture_level_bytes(&shape, level);
        texels += texture_level_count(&shape.level[level]);
    }
    if (resource->source == TEXTURE_CHECKER)
        resource->color_count = 2;
    else if (resource->source == TEXTURE_FILL)
        resource->color_count = shape.faces * given_levels(resource, &shape);
    else if (resource->source == TEXTURE_COLORS)
        resource->color_count = (uint32_t)(texels * shape.faces);
    bool made = resource->source >= TEXTURE_COLORS && resource->source <= TEXTURE_FILES;
    if (made && shape.format->coding != CODING_PACKED)
        codec_fail(codec, "found colors for format %s, expected empty or bytes", shape.format->name);
    if (resource->source == TEXTURE_FILES && (given_levels(resource, &shape) > 1 || shape.depth > 1))
        codec_fail(codec,
                   "found files of a texture with more than one level and slice, expected one or mips");
}

/* Images and DDS files determine their descriptions, which must match. */
static void check_source(struct codec *codec, const struct resource *resource)
{
    const struct triptych_texture_description *d = &resource->texture;
    bool image = d->type == TRIPTYCH_TEXTURE_2D && d->format == TRIPTYCH_SURFACE_A8B8G8R8 && d->depth == 1 &&
                 d->levels == 1;
    if (resource->source == TEXTURE_IMAGE && (!image || resource->mips))
        codec_fail(codec, "found an image that is not a 2d A8B8G8R8 texture of one level");
    if (resource->source == TEXTURE_DDS && (!resource->path || resource->mips))
        codec_fail(codec, "found a DDS texture without a path, or with mips, expected a path");
    if (resource->path && resource->source != TEXTURE_IMAGE && resource->source != TEXTURE_DDS)
        codec_fail(codec, "found a path of a texture that is of no file");
}

static void code_faces(struct codec *codec, struct resource *resource)
{
    unsigned faces = resource->texture.type == TRIPTYCH_TEXTURE_CUBE ? CUBE_FACES : 1;
    for (unsigned face = 0; face < faces; face++) {
        codec_string(codec, &resource->face_path[face], PATH_BYTES, "path");
        if (codec->reading && !resource->face_path[face])
            codec_fail(codec, "found a face without a path, expected the path of a file");
    }
}

static void code_texture(struct codec *codec, struct resource *resource)
{
    struct triptych_texture_description *d = &resource->texture;
    d->type = codec_u8(codec, d->type, TRIPTYCH_TEXTURE_TYPE_COUNT - 1, "type of texture");
    d->format = codec_u32(codec, d->format, UINT32_MAX, "format");
    d->width = codec_u16(codec, d->width, TRIPTYCH_TEXTURE_MAXIMUM, "texture width");
    d->height = codec_u16(codec, d->height, TRIPTYCH_TEXTURE_MAXIMUM, "texture height");
    d->depth = codec_u16(codec, d->depth, TRIPTYCH_VOLUME_MAXIMUM, "texture depth");
    d->levels = codec_u8(codec, d->levels, TEXTURE_LEVELS, "levels");
    code_flag(codec, &resource->mips, "mips");
    resource->source = codec_u8(codec, resource->source, TEXTURE_FILES, "source of texels");
    codec_string(codec, &resource->path, PATH_BYTES, "path");
    if (resource->source == TEXTURE_CHECKER) {
        resource->cell = codec_u16(codec, resource->cell, CELL_MOST, "side of a square");
        if (codec->reading && !resource->cell)
            codec_fail(codec, "found squares of side 0, expected 1 to %d", CELL_MOST);
    }
    if (resource->source == TEXTURE_FILES)
        code_faces(codec, resource);
    if (codec->reading && !codec->failed)
        size_texture(codec, resource);
    if (codec->reading)
        check_source(codec, resource);
}

static void code_layout(struct codec *codec, struct layout *layout)
{
    unsigned order[STREAM_ELEMENTS] = {0};
    uint32_t count = codec->reading ? 0 : layout_order(layout, order);
    count = codec_u8(codec, count, STREAM_ELEMENTS, "count of elements");
    for (uint32_t i = 0; i < count && !codec->failed; i++) {
        unsigned index, usage = resource_element_usage(order[i], &index);
        usage = codec_u8(codec, usage, TRIPTYCH_USAGE_COUNT - 1, "usage");
        index = codec_u8(codec, index, TRIPTYCH_USAGE_INDICES - 1, "usage index");
        uint32_t format =
            codec_u8(codec, layout->format[order[i]], TRIPTYCH_FORMAT_COUNT - 1, "vertex format");
        int element = resource_find_element(usage, index);
        if (!codec->reading || codec->failed)
            continue;
        if (element < 0 || !format || layout->format[element])
            codec_fail(codec,
                       "found an element of usage %u, index %u, format %u, expected one that is known, once",
                       usage, index, format);
        else
            layout_add(layout, (unsigned)element, (enum triptych_format)format);
    }
    if (codec->reading && !layout->stride)
        codec_fail(codec, "found vertices without elements, expected at least one");
}

static void code_vertices(struct codec *codec, struct resource *resource)
{
    code_layout(codec, &resource->layout);
    resource->vertex_count = codec_u32(codec, resource->vertex_count, UINT32_MAX, "count of vertices");
    resource->vertex_bytes = (size_t)resource->vertex_count * resource->layout.stride;
    if (codec->reading && !resource->vertex_count)
        codec_fail(codec, "found no vertices, expected at least one");
}

static void code_indices(struct codec *codec, struct resource *resource)
{
    resource->index_bits = codec_u8(codec, resource->index_bits, 32, "bits of indices");
    resource->index_count = codec_u32(codec, resource->index_count, UINT32_MAX, "count of indices");
    if (!codec->reading)
        return;
    if (resource->index_bits != 16 && resource->index_bits != 32)
        codec_fail(codec, "found indices of %u bits, expected 16 or 32", resource->index_bits);
    if (!resource->index_count)
        codec_fail(codec, "found no indices, expected at least one");
}

static bool is_integers(enum value_type type)
{
    return type == VALUE_U16 || type == VALUE_U32;
}

static void code_buffer(struct codec *codec, struct resource *resource)
{
    resource->value_type = codec_u8(codec, resource->value_type, VALUE_BYTES, "type of values");
    size_t size = value_bytes(resource->value_type);
    uint64_t bytes = resource->indices ? (uint64_t)resource->index_count * size : resource->vertex_bytes;
    bytes = codec_u64(codec, bytes, UINT32_MAX, "bytes of a buffer");
    if (!codec->reading)
        return;
    if (!bytes || bytes % size)
        codec_fail(codec, "found a buffer of %zu bytes, expected values of %zu each", (size_t)bytes, size);
    if (is_integers(resource->value_type)) {
        resource->index_bits = 8 * (uint32_t)size;
        resource->index_count = (uint32_t)(bytes / size);
    } else {
        resource->vertex_bytes = (size_t)bytes;
    }
}

static bool has_data(const struct resource *resource)
{
    enum mesh_source source = resource->options.source;
    return source == MESH_FILE || source == MESH_BEZIER || source == MESH_DATA || source == MESH_MODEL;
}

static void code_shadow(struct codec *codec, struct mesh_options *options)
{
    options->caster = codec_u32(codec, options->caster, NO_RESOURCE - 1, "mesh");
    code_flag(codec, &options->light_is_point, "kind of light");
    codec_floats(codec, options->light, 3);
    codec_floats(codec, &options->length, 1);
}

static void code_mesh(struct codec *codec, struct resource *resource)
{
    struct mesh_options *options = &resource->options;
    options->source = codec_u8(codec, options->source, MESH_SOURCES - 1, "source of a mesh");
    options->normals = codec_u8(codec, options->normals, NORMALS_FLAT, "normals");
    options->texcoords = codec_u8(codec, options->texcoords, TEXCOORDS_CYLINDRICAL, "projection");
    options->subdivisions = codec_u8(codec, options->subdivisions, 255, "subdivisions");
    code_flag(codec, &options->center, "center");
    codec_floats(codec, &options->fit, 1);
    codec_floats(codec, options->repeat, 2);
    for (int i = 0; i < 2; i++)
        options->cells[i] = codec_u16(codec, options->cells[i], UINT16_MAX, "cells");
    codec_floats(codec, &options->tube, 1);
    code_flag(codec, &options->bones, "bones");
    if (options->source == MESH_SHADOW)
        code_shadow(codec, options);
    codec_string(codec, &resource->path, PATH_BYTES, "path");
    if (!has_data(resource))
        return;
    code_vertices(codec, resource);
    code_indices(codec, resource);
    if (codec->reading && resource->index_count % 3)
        codec_fail(codec, "found a mesh of %u indices, expected three a triangle", resource->index_count);
}

static void code_shader(struct codec *codec, struct resource *resource)
{
    codec_string(codec, &resource->path, PATH_BYTES, "path");
    resource->code_bytes = codec_u32(codec, (uint32_t)resource->code_bytes, UINT32_MAX, "bytes of a shader");
    if (codec->reading && !resource->code_bytes)
        codec_fail(codec, "found a shader without text, expected some");
}

static void code_image(struct codec *codec, struct resource *resource)
{
    struct triptych_image_description *image = &resource->image;
    image->format = codec_u32(codec, image->format, UINT32_MAX, "format");
    image->depth_format = codec_u8(codec, image->depth_format, TRIPTYCH_DEPTH_COUNT - 1, "depth format");
    image->width = codec_u16(codec, image->width, TRIPTYCH_TARGET_MAXIMUM, "width");
    image->height = codec_u16(codec, image->height, TRIPTYCH_TARGET_MAXIMUM, "height");
    image->samples = codec_u8(codec, image->samples, 8, "samples per pixel");
    if (codec->reading && !codec->failed && image_check(image, &codec->error) != TRIPTYCH_OK)
        codec->failed = true;
}

void resource_code(struct codec *codec, struct resource *resource)
{
    codec_string(codec, &resource->name, NAME_BYTES, "name");
    switch (resource->type) {
    case RESOURCE_TEXTURE: code_texture(codec, resource); break;
    case RESOURCE_VERTICES: code_vertices(codec, resource); break;
    case RESOURCE_INDICES: code_indices(codec, resource); break;
    case RESOURCE_BUFFER: code_buffer(codec, resource); break;
    case RESOURCE_MESH: code_mesh(codec, resource); break;
    case RESOURCE_SHADER: code_shader(codec, resource); break;
    case RESOURCE_IMAGE: code_image(codec, resource); break;
    case RESOURCE_QUERY:
    case RESOURCE_SEQUENCE: break;
    }
}

/* --- Data ----------------------------------------------------------------------------------------------- */

static unsigned texture_parts(const struct resource *resource, struct resource_part *parts)
{
    switch (resource->source) {
    case TEXTURE_EMPTY:
    case TEXTURE_GRADIENT: return 0;
    case TEXTURE_COLORS:
    case TEXTURE_FILL:
    case TEXTURE_CHECKER:
        parts[0] = (struct resource_part){resource->colors, 4 * (size_t)resource->color_count};
        return 1;
    default: parts[0] = (struct resource_part){resource->texels, resource->texel_bytes}; return 1;
    }
}

unsigned resource_parts(const struct resource *resource, struct resource_part parts[RESOURCE_PARTS])
{
    struct resource_part vertices = {NULL, 0}, indices = {NULL, 0};
    if (resource_has_geometry(resource)) {
        vertices = (struct resource_part){resource->vertices, resource->vertex_bytes};
        indices = (struct resource_part){resource->indices,
                                         (size_t)resource->index_count * resource->index_bits / 8};
    }
    switch (resource->type) {
    case RESOURCE_TEXTURE: return texture_parts(resource, parts);
    case RESOURCE_VERTICES: parts[0] = vertices; return 1;
    case RESOURCE_INDICES: parts[0] = indices; return 1;
    case RESOURCE_BUFFER: parts[0] = is_integers(resource->value_type) ? indices : vertices; return 1;
    case RESOURCE_MESH:
        parts[0] = vertices;
        parts[1] = indices;
        return has_data(resource) ? 2 : 0;
    case RESOURCE_SHADER: parts[0] = (struct resource_part){resource->code, resource->code_bytes}; return 1;
    case RESOURCE_QUERY:
    case RESOURCE_SEQUENCE:
    case RESOURCE_IMAGE: return 0;
    }
    return 0;
}

void resource_set_part(struct resource *resource, unsigned part, void *data)
{
    if (resource->type == RESOURCE_SHADER)
        resource->code = data;
    else if (resource->type == RESOURCE_TEXTURE && resource->source >= TEXTURE_COLORS &&
             resource->source <= TEXTURE_CHECKER)
        resource->colors = data;
    else if (resource->type == RESOURCE_TEXTURE)
        resource->texels = data;
    else if (resource->type == RESOURCE_INDICES || part ||
             (resource->type == RESOURCE_BUFFER && is_integers(resource->value_type)))
        resource->indices = data;
    else
        resource->vertices = data;
}

const void *resource_data(const struct resource *resource, size_t *bytes)
{
    if (resource->vertex_bytes) {
        *bytes = resource->vertex_bytes;
        return resource->vertices;
    }
    *bytes = (size_t)resource->index_count * resource->index_bits / 8;
    return resource->indices;
}

size_t resource_texels(const struct resource *resource)
{
    struct triptych_texture shape;
    enum triptych_result result = texture_describe(&resource->texture, &shape, NULL);
    return result == TRIPTYCH_OK ? texture_texel_bytes(&shape) : 0;
}

size_t resource_cost(const struct resource *resource)
{
    struct triptych_texture shape;
    if (resource->type == RESOURCE_TEXTURE) {
        if (texture_describe(&resource->texture, &shape, NULL) != TRIPTYCH_OK)
            return 0;
        return texture_storage_bytes(&shape);
    }
    if (resource->type == RESOURCE_IMAGE)
        return image_bytes(&resource->image);
    if (resource_has_geometry(resource))
        return resource->vertex_bytes + (size_t)resource->index_count * resource->index_bits / 8;
    return resource->type == RESOURCE_SHADER ? resource->code_bytes : 0;
}
