/* Shadow volumes: the closed volume that a mesh keeps from a light, fronts outside.
 *
 * The triangles that face the light are the near cap. The same triangles, moved away from the light and
 * reversed, are the far cap. An edge is part of the outline if no other lit triangle has it in the opposite
 * direction; a side joins its two positions. So the volume is closed for every mesh, open meshes included.
 * Corners at equal positions count as one, because texture seams and creases split them. */
#include "command/assets/mesh.h"
#include "command/assets/weld.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

struct caster {
    const struct resource *mesh;
    uint32_t *corner; /* of each vertex: the first vertex at its position */
    uint8_t *lit;     /* of each triangle */
};

/* A side of a lit triangle; `way` is +1 from low to high, -1 from high to low. */
struct edge {
    uint32_t low, high;
    int way;
};

/* A position, which can begin at any byte of the vertices. */
static void get_position(const struct caster *caster, uint32_t vertex, float position[3])
{
    const struct layout *layout = &caster->mesh->layout;
    memcpy(position,
           caster->mesh->vertices + (size_t)vertex * layout->stride + layout->offset[TRIPTYCH_POSITION],
           3 * sizeof *position);
}

static uint32_t index_of(const struct caster *caster, uint32_t i)
{
    const struct resource *mesh = caster->mesh;
    return caster->corner[mesh->index_bits == 16 ? ((const uint16_t *)mesh->indices)[i]
                                                 : ((const uint32_t *)mesh->indices)[i]];
}

static int join_corners(struct caster *caster)
{
    uint32_t count = caster->mesh->vertex_count;
    struct weld_vertex *places = malloc(count * sizeof *places);
    if (!places)
        return -1;
    for (uint32_t v = 0; v < count; v++) {
        get_position(caster, v, places[v].position);
        places[v].vertex = v;
    }
    weld_positions(places, count, caster->corner);
    free(places);
    return 0;
}

/* The direction from the light to a point of the mesh: of length 1, or 0 at the light itself. */
static void away(const struct mesh_options *options, const float position[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = options->light_is_point ? (double)position[i] - (double)options->light[i]
                                         : (double)options->light[i];
    double length = hypot(hypot(out[0], out[1]), out[2]);
    for (int i = 0; i < 3; i++)
        out[i] = length > 0 ? out[i] / length : 0;
}

static bool is_lit(const struct caster *caster, const struct mesh_options *options, uint32_t triangle)
{
    float a[3], corner[3];
    double edge[2][3], from_light[3], sum = 0;
    get_position(caster, index_of(caster, 3 * triangle), a);
    away(options, a, from_light);
    for (int e = 0; e < 2; e++) {
        get_position(caster, index_of(caster, 3 * triangle + 1 + (uint32_t)e), corner);
        for (int i = 0; i < 3; i++)
            edge[e][i] = (double)corner[i] - (double)a[i];
    }
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        sum += from_light[i] * (edge[0][j] * edge[1][k] - edge[0][k] * edge[1][j]);
    }
    return sum < 0;
}

static int compare_edges(const void *left, const void *right)
{
    const struct edge *a = left, *b = right;
    if (a->low != b->low)
        return a->low < b->low ? -1 : 1;
    return (a->high > b->high) - (a->high < b->high);
}

/* Vertex v of the mesh becomes 2 v, at its position, and 2 v + 1, at the end of the shadow. */
static int add_vertices(struct mesh *mesh, const struct caster *caster, const char *name,
                        const struct mesh_options *options, struct error *error)
{
    for (uint32_t v = 0; v < caster->mesh->vertex_count; v++) {
        struct mesh_vertex vertex = {.color = 0xffffffff};
        float from[3];
        double direction[3];
        get_position(caster, v, from);
        away(options, from, direction);
        memcpy(vertex.position, from, sizeof vertex.position);
        if (mesh_add_vertex(mesh, name, &vertex, error))
            return -1;
        for (int i = 0; i < 3; i++)
            vertex.position[i] = (float)((double)from[i] + (double)options->length * direction[i]);
        if (mesh_add_vertex(mesh, name, &vertex, error))
            return -1;
    }
    return 0;
}

/* Adds both caps and fills `edges` with the sides of the lit triangles. Returns their number, or -1. */
static int64_t add_caps(struct mesh *mesh, const struct caster *caster, const char *name, struct edge *edges,
                        struct error *error)
{
    int64_t count = 0;
    for (uint32_t t = 0; t < caster->mesh->index_count / 3; t++) {
        uint32_t at[3];
        if (!caster->lit[t])
            continue;
        for (uint32_t c = 0; c < 3; c++)
            at[c] = index_of(caster, 3 * t + c);
        if (mesh_add_triangle(mesh, name, 2 * at[0], 2 * at[1], 2 * at[2], error) ||
            mesh_add_triangle(mesh, name, 2 * at[0] + 1, 2 * at[2] + 1, 2 * at[1] + 1, error))
            return -1;
        for (int c = 0; c < 3; c++) {
            uint32_t a = at[c], b = at[(c + 1) % 3];
            edges[count++] = a < b ? (struct edge){a, b, 1} : (struct edge){b, a, -1};
        }
    }
    return count;
}

static int add_sides(struct mesh *mesh, const char *name, struct edge *edges, size_t count,
                     struct error *error)
{
    qsort(edges, count, sizeof *edges, compare_edges);
    for (size_t i = 0, next; i < count; i = next) {
        int ways = 0;
        for (next = i; next < count && !compare_edges(&edges[i], &edges[next]); next++)
            ways += edges[next].way;
        uint32_t a = 2 * (ways > 0 ? edges[i].low : edges[i].high);
        uint32_t b = 2 * (ways > 0 ? edges[i].high : edges[i].low);
        for (int side = 0; side < abs(ways); side++)
            if (mesh_add_triangle(mesh, name, b, a, a + 1, error) ||
                mesh_add_triangle(mesh, name, b, a + 1, b + 1, error))
                return -1;
    }
    return 0;
}

static int make_volume(struct mesh *mesh, const struct caster *caster, const char *name,
                       const struct mesh_options *options, struct edge *edges, struct error *error)
{
    for (uint32_t t = 0; t < caster->mesh->index_count / 3; t++)
        caster->lit[t] = (uint8_t)is_lit(caster, options, t);
    if (add_vertices(mesh, caster, name, options, error))
        return -1;
    int64_t count = add_caps(mesh, caster, name, edges, error);
    return count < 0 ? -1 : add_sides(mesh, name, edges, (size_t)count, error);
}

int mesh_make_shadow(struct mesh *mesh, const char *name, const struct mesh_options *options,
                     const struct resource *of, struct error *error)
{
    struct caster caster = {
        .mesh = of,
        .corner = malloc(of->vertex_count * sizeof *caster.corner),
        .lit = malloc(of->index_count / 3),
    };
    struct edge *edges = malloc(of->index_count * sizeof *edges);
    int result = caster.corner && caster.lit && edges && !join_corners(&caster)
                     ? make_volume(mesh, &caster, name, options, edges, error)
                     : error_set(error, "%s: not enough memory", name);
    free(caster.corner);
    free(caster.lit);
    free(edges);
    return result;
}
