/* Meshes without a file: grids of cells on simple surfaces, in a right-handed system with y up and fronts
 * outside. u runs to the right and v down as seen from the front.
 *
 *   grid       -1 to 1 in x and z, facing +y; v runs from -z to +z
 *   box        -1 to 1 in x, y and z; the whole texture on each side
 *   sphere     radius 1; u around y, v from the north pole down
 *   cylinder   radius 1, y from -1 to 1, open; u around, v from the top down
 *   torus      around y; the tube's centre runs at radius 1; u around y, v around the tube from outside
 *              over the top */
#include "command/assets/mesh.h"

#include <math.h>
#include <stdbool.h>

static const double pi = 3.14159265358979323846;

/* The position and normal of a surface at (u, v), both from 0 to 1. */
typedef void surface(const struct mesh_options *options, double u, double v, double position[3],
                     double normal[3]);

/* Exactly closed: the last vertices around have the position of the first. */
static double turn(double part)
{
    return part == 1 ? 0 : 2 * pi * part;
}

static void set(double out[3], double x, double y, double z)
{
    out[0] = x;
    out[1] = y;
    out[2] = z;
}

static void grid(const struct mesh_options *options, double u, double v, double position[3], double normal[3])
{
    (void)options;
    set(position, 2 * u - 1, 0, 2 * v - 1);
    set(normal, 0, 1, 0);
}

static void sphere(const struct mesh_options *options, double u, double v, double position[3],
                   double normal[3])
{
    double around = turn(u), down = pi * v, radius = v == 1 ? 0 : sin(down);
    (void)options;
    set(position, radius * sin(around), cos(down), radius * cos(around));
    set(normal, position[0], position[1], position[2]);
}

static void cylinder(const struct mesh_options *options, double u, double v, double position[3],
                     double normal[3])
{
    double around = turn(u);
    (void)options;
    set(position, sin(around), 1 - 2 * v, cos(around));
    set(normal, sin(around), 0, cos(around));
}

static void torus(const struct mesh_options *options, double u, double v, double position[3],
                  double normal[3])
{
    double around = turn(u), tilt = -turn(v);
    double radius = 1 + (double)options->tube * cos(tilt);
    set(position, radius * sin(around), (double)options->tube * sin(tilt), radius * cos(around));
    set(normal, cos(tilt) * sin(around), sin(tilt), cos(tilt) * cos(around));
}

static bool same_position(const struct mesh_vertex *a, const struct mesh_vertex *b)
{
    return a->position[0] == b->position[0] && a->position[1] == b->position[1] &&
           a->position[2] == b->position[2];
}

/* At poles one side of a cell has length 0. */
static int add_triangle(struct mesh *mesh, const char *name, uint32_t a, uint32_t b, uint32_t c,
                        struct error *error)
{
    const struct mesh_vertex *v = mesh->vertices;
    if (same_position(&v[a], &v[b]) || same_position(&v[b], &v[c]) || same_position(&v[c], &v[a]))
        return 0;
    return mesh_add_triangle(mesh, name, a, b, c, error);
}

static int add_surface(struct mesh *mesh, const char *name, const struct mesh_options *options, surface *at,
                       struct error *error)
{
    uint32_t columns = options->cells[0], rows = options->cells[1], first = mesh->vertex_count;
    for (uint32_t row = 0; row <= rows; row++)
        for (uint32_t column = 0; column <= columns; column++) {
            double u = (double)column / columns, v = (double)row / rows, position[3], normal[3];
            struct mesh_vertex vertex = {.texcoord = {(float)u, (float)v}, .color = 0xffffffff};
            at(options, u, v, position, normal);
            for (int i = 0; i < 3; i++) {
                vertex.position[i] = (float)position[i];
                vertex.normal[i] = (float)normal[i];
            }
            if (mesh_add_vertex(mesh, name, &vertex, error))
                return -1;
        }
    for (uint32_t row = 0; row < rows; row++)
        for (uint32_t column = 0; column < columns; column++) {
            uint32_t a = first + row * (columns + 1) + column, c = a + columns + 1;
            if (add_triangle(mesh, name, a, c, c + 1, error) ||
                add_triangle(mesh, name, a, c + 1, a + 1, error))
                return -1;
        }
    return 0;
}

/* Axis n points outward; x to the right and y up as seen from outside. */
static int add_side(struct mesh *mesh, const char *name, const float n[3], const float y[3],
                    struct error *error)
{
    const float x[3] = {y[1] * n[2] - y[2] * n[1], y[2] * n[0] - y[0] * n[2], y[0] * n[1] - y[1] * n[0]};
    uint32_t first = mesh->vertex_count;
    for (int corner = 0; corner < 4; corner++) {
        int right = corner & 1, down = corner >> 1;
        struct mesh_vertex vertex = {.texcoord = {(float)right, (float)down}, .color = 0xffffffff};
        for (int i = 0; i < 3; i++) {
            vertex.normal[i] = n[i];
            vertex.position[i] = n[i] + (right ? x[i] : -x[i]) + (down ? -y[i] : y[i]);
        }
        if (mesh_add_vertex(mesh, name, &vertex, error))
            return -1;
    }
    return mesh_add_triangle(mesh, name, first, first + 2, first + 3, error) ||
                   mesh_add_triangle(mesh, name, first, first + 3, first + 1, error)
               ? -1
               : 0;
}

static int add_box(struct mesh *mesh, const char *name, struct error *error)
{
    static const float sides[6][2][3] = {{{1, 0, 0}, {0, 1, 0}},  {{-1, 0, 0}, {0, 1, 0}},
                                         {{0, 1, 0}, {0, 0, -1}}, {{0, -1, 0}, {0, 0, 1}},
                                         {{0, 0, 1}, {0, 1, 0}},  {{0, 0, -1}, {0, 1, 0}}};
    for (int i = 0; i < 6; i++)
        if (add_side(mesh, name, sides[i][0], sides[i][1], error))
            return -1;
    return 0;
}

int mesh_make_shape(struct mesh *mesh, const char *name, const struct mesh_options *options,
                    struct error *error)
{
    mesh->has_texcoord = 1;
    switch (options->source) {
    case MESH_BOX: return add_box(mesh, name, error);
    case MESH_GRID: return add_surface(mesh, name, options, grid, error);
    case MESH_SPHERE: return add_surface(mesh, name, options, sphere, error);
    case MESH_CYLINDER: return add_surface(mesh, name, options, cylinder, error);
    default: return add_surface(mesh, name, options, torus, error);
    }
}
