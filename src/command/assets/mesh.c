#include "command/assets/mesh.h"

#include "capture/layout.h"
#include "command/assets/asset.h"
#include "command/assets/kept.h"
#include "command/stream/build.h"
#include "command/assets/weld.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

static int no_memory(const char *path, struct error *error)
{
    return error_set(error, "%s: not enough memory", path);
}

/* --- Growing -------------------------------------------------------------------------------------------- */

void mesh_free(struct mesh *mesh)
{
    free(mesh->vertices);
    free(mesh->indices);
    skeleton_free(mesh->skeleton);
    material_free_all(&mesh->materials);
    store_free_files(&mesh->files);
    *mesh = (struct mesh){0};
}

/* Makes room for `more` elements. The capacity doubles up to the limit, which the caller has checked. */
static int reserve(void **array, uint32_t count, uint32_t *capacity, uint32_t more, size_t size)
{
    if (count + more <= *capacity)
        return 0;
    uint32_t larger = 2 * *capacity > count + more ? 2 * *capacity : count + more + 255;
    void *moved = realloc(*array, larger * size);
    if (!moved)
        return -1;
    *array = moved;
    *capacity = larger;
    return 0;
}

int mesh_add_vertex(struct mesh *mesh, const char *path, const struct mesh_vertex *vertex,
                    struct error *error)
{
    if (mesh->vertex_count == LIMIT_VERTICES)
        return error_set(error, "%s: more than %d vertices", path, LIMIT_VERTICES);
    for (int i = 0; i < 3; i++)
        if (!isfinite(vertex->position[i]) || !isfinite(vertex->normal[i]))
            return error_set(error, "%s: vertex %u is not finite", path, mesh->vertex_count);
    if (!isfinite(vertex->texcoord[0]) || !isfinite(vertex->texcoord[1]))
        return error_set(error, "%s: the texture coordinates of vertex %u are not finite", path,
                         mesh->vertex_count);
    if (reserve((void **)&mesh->vertices, mesh->vertex_count, &mesh->vertex_capacity, 1, sizeof *vertex))
        return no_memory(path, error);
    mesh->vertices[mesh->vertex_count++] = *vertex;
    return 0;
}

int mesh_add_triangle(struct mesh *mesh, const char *path, uint32_t a, uint32_t b, uint32_t c,
                      struct error *error)
{
    if (mesh->index_count + 3 > LIMIT_VALUES)
        return error_set(error, "%s: more than %d indices", path, LIMIT_VALUES);
    if (reserve((void **)&mesh->indices, mesh->index_count, &mesh->index_capacity, 3, sizeof a))
        return no_memory(path, error);
    uint32_t *at = mesh->indices + mesh->index_count;
    at[0] = a;
    at[1] = b;
    at[2] = c;
    mesh->index_count += 3;
    return 0;
}

/* --- Normals -------------------------------------------------------------------------------------------- */

static bool lacks_normal(const struct mesh_vertex *vertex)
{
    return vertex->normal[0] == 0 && vertex->normal[1] == 0 && vertex->normal[2] == 0;
}

/* Its length is twice the triangle's area. */
static void face_normal(const struct mesh *mesh, const uint32_t corner[3], double normal[3])
{
    double edge[2][3];
    for (int e = 0; e < 2; e++)
        for (int i = 0; i < 3; i++)
            edge[e][i] =
                (double)mesh->vertices[corner[e + 1]].position[i] - mesh->vertices[corner[0]].position[i];
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        normal[i] = edge[0][j] * edge[1][k] - edge[0][k] * edge[1][j];
    }
}

/* A normal without any face points along z. */
static void set_normal(struct mesh_vertex *vertex, const double normal[3])
{
    double length = hypot(hypot(normal[0], normal[1]), normal[2]);
    for (int i = 0; i < 3; i++)
        vertex->normal[i] = length > 0 ? (float)(normal[i] / length) : (float)(i == 2);
}

/* Collects the vertices without a normal. Returns their number. */
static uint32_t collect_places(const struct mesh *mesh, struct weld_vertex *places)
{
    uint32_t count = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        if (lacks_normal(&mesh->vertices[v])) {
            memcpy(places[count].position, mesh->vertices[v].position, sizeof places->position);
            places[count++].vertex = v;
        }
    return count;
}

/* group[v] becomes the first vertex at the position of v if v has no normal, else v. */
static void group_vertices(const struct mesh *mesh, struct weld_vertex *places, uint32_t count,
                           uint32_t *group)
{
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        group[v] = v;
    weld_positions(places, count, group);
}

static int make_smooth_normals(struct mesh *mesh)
{
    struct weld_vertex *places = malloc(mesh->vertex_count * sizeof *places);
    uint32_t *group = malloc(mesh->vertex_count * sizeof *group);
    double(*sum)[3] = calloc(mesh->vertex_count, sizeof *sum);
    bool good = places && group && sum;
    uint32_t count = good ? collect_places(mesh, places) : 0;
    if (count)
        group_vertices(mesh, places, count, group);
    for (uint32_t i = 0; count && i < mesh->index_count; i += 3) {
        double normal[3];
        face_normal(mesh, mesh->indices + i, normal);
        for (int c = 0; c < 3; c++)
            for (int j = 0; j < 3; j++)
                sum[group[mesh->indices[i + c]]][j] += normal[j];
    }
    for (uint32_t i = 0; i < count; i++)
        set_normal(&mesh->vertices[places[i].vertex], sum[group[places[i].vertex]]);
    free(places);
    free(group);
    free(sum);
    return good ? 0 : -1;
}

/* The vertex of a corner in the new mesh. A corner without a normal gets its own vertex; other corners share
 * theirs. moved[v] is 1 + the new number of a vertex that keeps its normal. */
static int move_corner(struct mesh *made, const struct mesh *mesh, const char *path, uint32_t v,
                       const double normal[3], uint32_t *moved, uint32_t *corner, struct error *error)
{
    struct mesh_vertex vertex = mesh->vertices[v];
    if (moved[v]) {
        *corner = moved[v] - 1;
        return 0;
    }
    *corner = made->vertex_count;
    if (lacks_normal(&vertex))
        set_normal(&vertex, normal);
    else
        moved[v] = made->vertex_count + 1;
    return mesh_add_vertex(made, path, &vertex, error);
}

/* Also drops vertices that no triangle uses. */
static int make_flat_normals(struct mesh *mesh, const char *path, struct error *error)
{
    struct mesh made = {.has_color = mesh->has_color, .has_texcoord = mesh->has_texcoord};
    uint32_t *moved = calloc(mesh->vertex_count, sizeof *moved);
    int result = moved ? 0 : no_memory(path, error);
    for (uint32_t i = 0; !result && i < mesh->index_count; i += 3) {
        uint32_t corner[3];
        double normal[3];
        face_normal(mesh, mesh->indices + i, normal);
        for (int c = 0; !result && c < 3; c++)
            result = move_corner(&made, mesh, path, mesh->indices[i + c], normal, moved, &corner[c], error);
        if (!result)
            result = mesh_add_triangle(&made, path, corner[0], corner[1], corner[2], error);
    }
    free(moved);
    made.skeleton = mesh->skeleton;
    made.files = mesh->files;
    made.materials = mesh->materials;
    mesh->materials = (struct materials){0};
    mesh->skeleton = NULL;
    mesh->files = (struct store_files){0};
    mesh_free(mesh);
    *mesh = made;
    return result;
}

/* --- Texture coordinates, centre, size ------------------------------------------------------------------ */

static void bounds(const struct mesh *mesh, double low[3], double high[3])
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

static double fraction(double part, double whole)
{
    return whole > 0 ? part / whole : 0;
}

static void project_texcoord(struct mesh_vertex *vertex, enum texcoords kind, const double low[3],
                             const double high[3])
{
    double from_center[3];
    for (int i = 0; i < 3; i++)
        from_center[i] = vertex->position[i] - (low[i] + high[i]) / 2;
    double around = atan2(from_center[0], from_center[2]) / (2 * pi) + 0.5;
    double down = fraction(high[1] - vertex->position[1], high[1] - low[1]);
    double length = hypot(hypot(from_center[0], from_center[1]), from_center[2]);
    if (kind == TEXCOORDS_PLANAR)
        around = fraction(vertex->position[0] - low[0], high[0] - low[0]);
    if (kind == TEXCOORDS_SPHERICAL)
        down = acos(fraction(from_center[1], length)) / pi;
    vertex->texcoord[0] = (float)around;
    vertex->texcoord[1] = (float)down;
}

static bool crosses_seam(const struct mesh *mesh, const uint32_t corner[3])
{
    float least = 1, most = 0;
    for (int c = 0; c < 3; c++) {
        float u = mesh->vertices[corner[c]].texcoord[0];
        least = u < least ? u : least;
        most = u > most ? u : most;
    }
    return most - least > 0.5f;
}

/* A triangle across the seam would span the whole texture. Its corners on the low side move up by one turn.
 */
static int cut_seam(struct mesh *mesh, const char *path, struct error *error)
{
    uint32_t count = mesh->vertex_count;
    uint32_t *copy = calloc(count, sizeof *copy); /* 1 + the copy of a vertex beyond the seam; 0: none */
    int result = copy ? 0 : no_memory(path, error);
    for (uint32_t i = 0; !result && i < mesh->index_count; i += 3) {
        if (!crosses_seam(mesh, mesh->indices + i))
            continue;
        for (uint32_t c = i; !result && c < i + 3; c++) {
            uint32_t old = mesh->indices[c];
            struct mesh_vertex vertex = mesh->vertices[old];
            if (vertex.texcoord[0] >= 0.5f)
                continue;
            vertex.texcoord[0] += 1;
            if (!copy[old]) {
                copy[old] = mesh->vertex_count;
                result = mesh_add_vertex(mesh, path, &vertex, error);
            }
            mesh->indices[c] = copy[old];
        }
    }
    free(copy);
    return result;
}

static int make_texcoords(struct mesh *mesh, const char *path, enum texcoords kind, struct error *error)
{
    double low[3], high[3];
    bounds(mesh, low, high);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        project_texcoord(&mesh->vertices[v], kind, low, high);
    mesh->has_texcoord = 1;
    return kind == TEXCOORDS_PLANAR ? 0 : cut_seam(mesh, path, error);
}

static void repeat_texcoords(struct mesh *mesh, const float repeat[2])
{
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        for (int i = 0; i < 2; i++)
            mesh->vertices[v].texcoord[i] *= repeat[i];
}

static void place(struct mesh *mesh, const struct mesh_options *options)
{
    double low[3], high[3], center[3] = {0}, scale = 1;
    bounds(mesh, low, high);
    double side = fmax(fmax(high[0] - low[0], high[1] - low[1]), high[2] - low[2]);
    if (options->fit > 0 && side > 0)
        scale = options->fit / side;
    for (int i = 0; options->center && i < 3; i++)
        center[i] = (low[i] + high[i]) / 2;
    if (mesh->skeleton) {
        memcpy(mesh->skeleton->center, center, sizeof center);
        mesh->skeleton->scale = scale;
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        for (int i = 0; i < 3; i++)
            mesh->vertices[v].position[i] = (float)((mesh->vertices[v].position[i] - center[i]) * scale);
}

int mesh_finish(struct mesh *mesh, const char *path, const struct mesh_options *options, struct error *error)
{
    if (!mesh->index_count)
        return error_set(error, "%s: no triangles", path);
    if (options->normals == NORMALS_FLAT) {
        if (make_flat_normals(mesh, path, error))
            return -1;
    } else if (make_smooth_normals(mesh)) {
        return no_memory(path, error);
    }
    if (options->texcoords != TEXCOORDS_KEEP && make_texcoords(mesh, path, options->texcoords, error))
        return -1;
    if (options->repeat[0] != 0)
        repeat_texcoords(mesh, options->repeat);
    place(mesh, options);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        for (int i = 0; i < 3; i++)
            if (!isfinite(mesh->vertices[v].position[i]))
                return error_set(error, "%s: too large to be centred or scaled", path);
    return 0;
}

/* --- Packing -------------------------------------------------------------------------------------------- */

static void pack_vertex(uint8_t *out, const struct layout *layout, const struct mesh_vertex *vertex)
{
    memcpy(out + layout->offset[TRIPTYCH_POSITION], vertex->position, sizeof vertex->position);
    memcpy(out + layout->offset[TRIPTYCH_NORMAL], vertex->normal, sizeof vertex->normal);
    if (layout->format[TRIPTYCH_DIFFUSE])
        memcpy(out + layout->offset[TRIPTYCH_DIFFUSE], &vertex->color, sizeof vertex->color);
    if (layout->format[TRIPTYCH_TEXCOORD])
        memcpy(out + layout->offset[TRIPTYCH_TEXCOORD], vertex->texcoord, sizeof vertex->texcoord);
    if (layout->format[TRIPTYCH_WEIGHTS]) { /* the last weight is 1 minus the others */
        memcpy(out + layout->offset[TRIPTYCH_WEIGHTS], vertex->weight, 3 * sizeof *vertex->weight);
        memcpy(out + layout->offset[TRIPTYCH_INDICES], vertex->bone, sizeof vertex->bone);
    }
}

static void pack_indices(struct resource *resource, const struct mesh *mesh)
{
    uint16_t *narrow = resource->indices;
    uint32_t *wide = resource->indices;
    for (uint32_t i = 0; i < mesh->index_count; i++)
        if (resource->index_bits == 16)
            narrow[i] = (uint16_t)mesh->indices[i];
        else
            wide[i] = mesh->indices[i];
}

static int pack(struct resource *resource, const struct mesh *mesh)
{
    struct layout *layout = &resource->layout;
    layout_add(layout, TRIPTYCH_POSITION, TRIPTYCH_FORMAT_FLOAT3);
    layout_add(layout, TRIPTYCH_NORMAL, TRIPTYCH_FORMAT_FLOAT3);
    if (mesh->has_color)
        layout_add(layout, TRIPTYCH_DIFFUSE, TRIPTYCH_FORMAT_COLOR);
    if (mesh->has_texcoord)
        layout_add(layout, TRIPTYCH_TEXCOORD, TRIPTYCH_FORMAT_FLOAT2);
    if (mesh->skeleton) {
        layout_add(layout, TRIPTYCH_WEIGHTS, TRIPTYCH_FORMAT_FLOAT3);
        layout_add(layout, TRIPTYCH_INDICES, TRIPTYCH_FORMAT_UBYTE4);
    }
    resource->vertex_count = mesh->vertex_count;
    resource->vertex_bytes = (size_t)mesh->vertex_count * layout->stride;
    resource->index_bits = mesh->vertex_count <= 65536 ? 16 : 32;
    resource->index_count = mesh->index_count;
    resource->vertices = malloc(resource->vertex_bytes);
    resource->indices = malloc((size_t)mesh->index_count * resource->index_bits / 8);
    if (!resource->vertices || !resource->indices)
        return -1;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        pack_vertex(resource->vertices + (size_t)v * layout->stride, layout, &mesh->vertices[v]);
    pack_indices(resource, mesh);
    if (mesh->materials.count) {
        resource->materials = malloc(sizeof *resource->materials);
        if (!resource->materials)
            return -1;
        *resource->materials = mesh->materials;
    }
    resource->skeleton = mesh->skeleton;
    return 0;
}

/* Packs a finished mesh and frees it, also after a failure. */
static int take(struct resource *resource, struct mesh *mesh, const char *path, int result,
                struct error *error)
{
    if (!result && pack(resource, mesh))
        result = no_memory(path, error);
    if (resource->skeleton)
        mesh->skeleton = NULL;
    if (resource->materials)
        mesh->materials = (struct materials){0};
    mesh_free(mesh);
    return result;
}

static int read_and_finish(struct mesh *mesh, const char *path, const struct mesh_options *options,
                           struct error *error)
{
    unsigned parts =
        (options->bones ? MODEL_BONES : 0) | (options->source == MESH_MODEL ? MODEL_MATERIALS : 0);
    int result = options->source == MESH_BEZIER ? mesh_read_bezier(mesh, path, options->subdivisions, error)
                                                : mesh_read_model(mesh, path, parts, error);
    return result ? result : mesh_finish(mesh, path, options, error);
}

int mesh_load(struct resource *resource, const char *path, struct error *error)
{
    const struct mesh_options *options = &resource->options;
    struct mesh mesh = {0};
    if (asset_check_path(path, error))
        return -1;
    int result = 0;
    if (!kept_find(path, options, &mesh)) {
        result = read_and_finish(&mesh, path, options, error);
        if (!result)
            kept_add(path, options, &mesh);
    }
    return take(resource, &mesh, path, result, error);
}

int mesh_make(struct resource *resource, const struct resource *caster, struct error *error)
{
    const struct mesh_options *options = &resource->options;
    const char *name = resource->name;
    struct mesh mesh = {0};
    int result = options->source == MESH_SHADOW ? mesh_make_shadow(&mesh, name, options, caster, error)
                                                : mesh_make_shape(&mesh, name, options, error);
    if (!result)
        result = mesh_finish(&mesh, name, options, error);
    return take(resource, &mesh, name, result, error);
}

int mesh_check_indices(struct resource *resource, struct error *error)
{
    stream_build_extremes(resource);
    if (resource->index_most < resource->vertex_count)
        return 0;
    return error_set(error, "found index %u in a mesh, expected at most %u, its last vertex",
                     resource->index_most, resource->vertex_count - 1);
}
