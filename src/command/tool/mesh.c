/* `triptych mesh`: describes models and Bézier patches as the streams that use them will read them. */
#include "command/assets/asset.h"
#include "command/assets/mesh.h"
#include "command/support/json.h"
#include "command/support/option.h"
#include "command/support/table.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

struct settings {
    const char *json;
    bool info; /* the only action */
};

/* A material's texture, as `model` finds it. */
struct found_texture {
    char *path; /* null: none, or embedded */
    bool exists;
};

/* --- Reading -------------------------------------------------------------------------------------------- */

enum { PRINTABLE = 4096 }; /* bytes of a name or a path */

static bool is_bezier(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot && !strcasecmp(dot, ".bez");
}

/* Patches have one cell of two triangles each. */
static int read_mesh(const struct command *self, const char *path, struct mesh *mesh)
{
    struct error error = {""};
    int bad = asset_check_path(path, &error) ||
              (is_bezier(path) ? mesh_read_bezier(mesh, path, 1, &error)
                               : mesh_read_model(mesh, path, MODEL_BONES | MODEL_MATERIALS, &error));
    return bad ? tool_fail(self, "%s", error.text) : STATUS_OK;
}

static void find_bounds(const struct mesh *mesh, double low[3], double high[3])
{
    for (int i = 0; i < 3; i++) {
        low[i] = INFINITY;
        high[i] = -INFINITY;
        for (uint32_t v = 0; v < mesh->vertex_count; v++) {
            low[i] = fmin(low[i], mesh->vertices[v].position[i]);
            high[i] = fmax(high[i], mesh->vertices[v].position[i]);
        }
    }
}

static bool has_normals(const struct mesh *mesh)
{
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        for (int i = 0; i < 3; i++)
            if (mesh->vertices[v].normal[i] != 0)
                return true;
    return false;
}

static uint32_t bone_count(const struct mesh *mesh)
{
    return mesh->skeleton ? mesh->skeleton->bone_count : 0;
}

static uint32_t animation_count(const struct mesh *mesh)
{
    return mesh->skeleton ? mesh->skeleton->animation_count : 0;
}

static struct found_texture find_texture(const char *path, const struct material *material)
{
    struct found_texture found = {NULL, material->picture != NULL};
    char *inside = material->texture && !material->picture ? material_path(material->texture) : NULL;
    if (inside)
        found.path = asset_path(path, inside);
    if (found.path)
        found.exists = !access(found.path, R_OK);
    free(inside);
    return found;
}

/* --- The text ------------------------------------------------------------------------------------------- */

/* Names come from files: control characters are not printed. */
static const char *printable(const char *name, char text[PRINTABLE])
{
    snprintf(text, PRINTABLE, "%s", name);
    for (char *c = text; *c; c++)
        if ((unsigned char)*c < ' ' || *c == 0x7f)
            *c = '?';
    return text;
}

static void print_materials(const char *path, const struct materials *materials)
{
    struct table table = {0};
    char text[PRINTABLE];
    table_column(&table, "material", TABLE_LEFT);
    table_column(&table, "triangles", TABLE_RIGHT);
    table_column(&table, "red", TABLE_RIGHT);
    table_column(&table, "green", TABLE_RIGHT);
    table_column(&table, "blue", TABLE_RIGHT);
    table_column(&table, "alpha", TABLE_RIGHT);
    table_column(&table, "texture", TABLE_LEFT);
    for (uint32_t i = 0; i < materials->count; i++) {
        const struct material *material = &materials->of[i];
        struct found_texture found = find_texture(path, material);
        table_cell(&table, "%s", *material->name ? printable(material->name, text) : "-");
        table_cell(&table, "%u", material->count / 3);
        for (int c = 0; c < 4; c++)
            table_cell(&table, "%.3g", (double)material->diffuse[c]);
        if (material->picture)
            table_cell(&table, "embedded, %zu bytes", material->picture_bytes);
        else if (found.path)
            table_cell(&table, "%s%s", printable(found.path, text), found.exists ? "" : " (missing)");
        else
            table_cell(&table, "-");
        free(found.path);
    }
    table_print(&table, 2, stdout);
}

static void print_mesh(const char *path, const struct mesh *mesh)
{
    double low[3], high[3];
    char text[PRINTABLE];
    find_bounds(mesh, low, high);
    printf("%s\n  %u vertices, %u triangles", path, mesh->vertex_count, mesh->index_count / 3);
    if (is_bezier(path))
        printf(", %u patches", mesh->index_count / 6);
    printf("\n  x %.6g to %.6g, y %.6g to %.6g, z %.6g to %.6g\n", low[0], high[0], low[1], high[1], low[2],
           high[2]);
    printf("  normals: %s, colors: %s, texture coordinates: %s, bones: %u\n",
           has_normals(mesh) ? "yes" : "no", mesh->has_color ? "yes" : "no",
           mesh->has_texcoord ? "yes" : "no", bone_count(mesh));
    for (uint32_t i = 0; i < animation_count(mesh); i++)
        printf("  animation \"%s\": %.4g s\n", printable(mesh->skeleton->animations[i].name, text),
               mesh->skeleton->animations[i].seconds);
    if (mesh->materials.count)
        print_materials(path, &mesh->materials);
}

/* --- JSON ----------------------------------------------------------------------------------------------- */

static cJSON *json_material(const char *path, const struct material *material)
{
    const double diffuse[4] = {material->diffuse[0], material->diffuse[1], material->diffuse[2],
                               material->diffuse[3]};
    struct found_texture found = find_texture(path, material);
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "name", material->name);
    cJSON_AddNumberToObject(json, "triangles", material->count / 3);
    cJSON_AddItemToObject(json, "diffuse", cJSON_CreateDoubleArray(diffuse, 4));
    if (material->texture)
        cJSON_AddStringToObject(json, "texture", material->texture);
    if (material->picture)
        cJSON_AddNumberToObject(json, "embedded_bytes", (double)material->picture_bytes);
    if (found.path) {
        cJSON_AddStringToObject(json, "file", found.path);
        cJSON_AddBoolToObject(json, "exists", found.exists);
    }
    free(found.path);
    return json;
}

static cJSON *json_mesh(const char *path, const struct mesh *mesh)
{
    double low[3], high[3];
    find_bounds(mesh, low, high);
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "file", path);
    cJSON_AddNumberToObject(json, "vertices", mesh->vertex_count);
    cJSON_AddNumberToObject(json, "triangles", mesh->index_count / 3);
    cJSON_AddItemToObject(json, "low", cJSON_CreateDoubleArray(low, 3));
    cJSON_AddItemToObject(json, "high", cJSON_CreateDoubleArray(high, 3));
    cJSON_AddBoolToObject(json, "normals", has_normals(mesh));
    cJSON_AddBoolToObject(json, "colors", mesh->has_color);
    cJSON_AddBoolToObject(json, "texcoords", mesh->has_texcoord);
    cJSON_AddNumberToObject(json, "bones", bone_count(mesh));
    cJSON *animations = cJSON_AddArrayToObject(json, "animations");
    for (uint32_t i = 0; i < animation_count(mesh); i++) {
        cJSON *animation = cJSON_CreateObject();
        cJSON_AddStringToObject(animation, "name", mesh->skeleton->animations[i].name);
        cJSON_AddNumberToObject(animation, "seconds", mesh->skeleton->animations[i].seconds);
        cJSON_AddItemToArray(animations, animation);
    }
    cJSON *materials = cJSON_AddArrayToObject(json, "materials");
    for (uint32_t i = 0; i < mesh->materials.count; i++)
        cJSON_AddItemToArray(materials, json_material(path, &mesh->materials.of[i]));
    return json;
}

/* --- The command ---------------------------------------------------------------------------------------- */

static int run(const struct command *self, void *data, const struct operands *operands)
{
    const struct settings *settings = data;
    int status = tool_check_output(self, settings->json);
    cJSON *report = cJSON_CreateObject(), *meshes = cJSON_AddArrayToObject(report, "meshes");
    for (int i = 0; i < operands->count && !status; i++) {
        struct mesh mesh = {0};
        status = read_mesh(self, operands->value[i], &mesh);
        if (!status && settings->json)
            cJSON_AddItemToArray(meshes, json_mesh(operands->value[i], &mesh));
        if (!status)
            print_mesh(operands->value[i], &mesh);
        mesh_free(&mesh);
    }
    if (!status && settings->json)
        status = json_write(self, report, settings->json);
    cJSON_Delete(report);
    return status;
}

static const char notes[] =
    "Bounds are those of the file, before center and fit. Textures are those that "
    "`model` loads: files beside\n"
    "the model, PNG or DDS. A node that shows a part without bones counts as a bone. Bézier patches are\n"
    "counted as two triangles each.";

static const struct option options[] = {
    {"info", NULL, "counts, bounds, materials and textures, as without it",
     OPTION_IS_FLAG(struct settings, info)},
    {"json", "FILE", "write the same as JSON", OPTION_IS_FILE(struct settings, json), .extension = "json"},
    {0},
};

static const struct operand operands[] = {
    {"FILE", "a model (OBJ, PLY, glTF and others), or patches (.bez)", .kind = OPERAND_INPUT,
     .extension = "obj ply 3ds gltf glb bez", .repeated = true},
    {0},
};

const struct command command_mesh = {
    .name = "mesh",
    .summary = "describe models: counts, bounds, materials, textures",
    .options = options,
    .operands = operands,
    .notes = notes,
    .settings_bytes = sizeof(struct settings),
    .run = run,
};
