/* Models: meshes with the materials of their files. A model does not become a resource or a call of its own:
 * it is a mesh and textures, and drawing it is the calls that set each material and draw its triangles. */
#include "command/assets/asset.h"
#include "command/import/material.h"
#include "command/text/parse.h"
#include "render/texture/texture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- Definitions ---------------------------------------------------------------------------------------- */

/* The path of a texture in the stream: it begins at the folder of the model. Null if memory is short. */
static char *path_of(const char *model, const char *texture)
{
    char *inside = material_path(texture), *path = inside ? asset_path(model, inside) : NULL;
    free(inside);
    return path;
}

/* Takes the file from the model. */
static int load_embedded(struct parser *parser, struct resource *resource, struct material *material,
                         const struct token *place)
{
    struct error reason = {{0}};
    struct triptych_texture shape;
    char *data = (char *)material->picture;
    material->picture = NULL;
    if (asset_decode_texture(resource, material->name, data, material->picture_bytes, &reason))
        return lex_fail(&parser->lex, place, "texture of material %s", reason.text);
    texture_describe(&resource->texture, &shape, NULL);
    return parse_account(parser, place, texture_storage_bytes(&shape));
}

static int add_texture(struct parser *parser, uint32_t model, unsigned number, struct material *material,
                       const struct token *place)
{
    char name[2 * LIMIT_NAME_BYTES];
    struct error reason = {{0}};
    struct resource *resource;
    int length = snprintf(name, sizeof name, "%s.texture%u", parser->stream->resources[model].name, number);
    if (length > LIMIT_NAME_BYTES)
        return lex_fail(&parser->lex, place, "found the name %s of a texture, expected at most %d bytes",
                        name, LIMIT_NAME_BYTES);
    if (stream_build_resource(&parser->build, name, (size_t)length, RESOURCE_TEXTURE, &resource, &reason))
        return lex_fail(&parser->lex, place, "%s", reason.text);
    material->resource = parser->stream->resource_count - 1;
    if (material->picture)
        return load_embedded(parser, resource, material, place);
    resource->path = path_of(parser->stream->resources[model].path, material->texture);
    return resource->path ? parse_texture_file(parser, resource, place)
                          : lex_fail(&parser->lex, place, "not enough memory");
}

/* Materials with the same texture share it. */
static int add_textures(struct parser *parser, uint32_t model, bool untextured, const struct token *place)
{
    struct materials *materials = parser->stream->resources[model].materials;
    unsigned textures = 0;
    for (uint32_t i = 0; materials && i < materials->count; i++) {
        struct material *material = &materials->of[i];
        uint32_t same = 0;
        material->resource = NO_RESOURCE;
        if (untextured || !material->texture)
            continue;
        while (same < i &&
               (!materials->of[same].texture || strcmp(materials->of[same].texture, material->texture)))
            same++;
        if (same < i)
            material->resource = materials->of[same].resource;
        else if (add_texture(parser, model, textures++, material, place))
            return -1;
    }
    return 0;
}

/* NAME [untextured] "PATH" OPTIONS */
int parse_model(struct parser *parser)
{
    struct resource *resource;
    if (parse_new_name(parser, RESOURCE_MESH, &resource))
        return -1;
    uint32_t number = parser->stream->resource_count - 1;
    bool untextured = lex_is(&parser->lex, "untextured");
    if (untextured && lex_next(&parser->lex))
        return -1;
    struct token place = parser->lex.token;
    resource->options.source = MESH_MODEL;
    if (parse_mesh_source(parser, resource))
        return -1;
    return add_textures(parser, number, untextured, &place);
}

/* --- Drawing -------------------------------------------------------------------------------------------- */

static int add_call(struct parser *parser, const struct call *call, enum call_type type, uint32_t resource,
                    const struct token *place)
{
    struct call next = {.type = type, .resource = resource, .position = call->position};
    return parse_add_call(parser, &next, place);
}

static int add_material(struct parser *parser, const struct call *call, const struct material *material,
                        const struct token *place)
{
    struct call next = {.type = CALL_MATERIAL, .resource = NO_RESOURCE, .position = call->position};
    memcpy(next.material.diffuse, material->diffuse, sizeof next.material.diffuse);
    memcpy(next.material.ambient, material->diffuse, sizeof next.material.ambient);
    return parse_add_call(parser, &next, place) ||
                   add_call(parser, call, CALL_BIND_TEXTURE, material->resource, place)
               ? -1
               : 0;
}

int parse_draw_model(struct parser *parser, struct call *call)
{
    const struct token place = parser->lex.token;
    uint32_t number;
    if (parse_name(parser, 1 << RESOURCE_MESH, "a model", &number))
        return -1;
    const struct materials *materials = parser->stream->resources[number].materials;
    if (!materials)
        return lex_fail(&parser->lex, &place, "found a mesh without materials, expected the name of a model");
    if (add_call(parser, call, CALL_BIND_VERTICES, number, &place) ||
        add_call(parser, call, CALL_BIND_INDICES, number, &place))
        return -1;
    for (uint32_t i = 0; i < materials->count; i++) {
        const struct material *material = &materials->of[i];
        if (add_material(parser, call, material, &place))
            return -1;
        call->type = CALL_DRAW_INDEXED;
        call->draw_indexed.primitive = TRIPTYCH_TRIANGLE_LIST;
        call->draw_indexed.first = material->first;
        call->draw_indexed.count = material->count / 3;
        if (i + 1 < materials->count && parse_add_call(parser, call, &place))
            return -1;
    }
    return 0;
}
