/* Bicubic Bézier patches in Geomview's BEZ format (its manual, "Bezier Surfaces"):
 *
 *   [ST]BBP or [C]BEZ333[_ST], then patches of 16 points x y z, u running fastest, then for ST four pairs
 *   of texture coordinates and for C four colours R G B A, at the corners (u, v) = (0,0) (1,0) (0,1) (1,1)
 *
 * # starts a comment.
 *
 * A patch becomes a grid of subdivisions + 1 vertices each way. Positions, derivatives and normals are
 * evaluated in binary64 from Bernstein polynomials. A front is the side from which v runs clockwise to u, as
 * in the teapot: the normal is dP/dv x dP/du.
 *
 * At a degenerate edge, whose control points coincide (the top of the teapot's lid), the derivative along the
 * edge is zero. Close to the edge its direction is that of the mixed derivative, which replaces it. If that
 * is zero too, the normal of a point slightly inside the patch is used. If even that is zero, the normal is
 * averaged from the faces. */
#include "base/file.h"
#include "command/stream/lex.h"
#include "command/assets/mesh.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

struct patch {
    float point[4][4][3]; /* [v][u] */
    float texcoord[4][2]; /* corners */
    float color[4][4];
};

struct bezier {
    struct lexer lex;
    const char *path;
    struct mesh *mesh;
    unsigned subdivisions;
    bool has_texcoord, has_color;
};

/* --- Evaluation --- */

/* The four cubic Bernstein polynomials and their derivatives. */
static void bernstein(double t, double value[4], double derivative[4])
{
    double s = 1 - t;
    value[0] = s * s * s;
    value[1] = 3 * s * s * t;
    value[2] = 3 * s * t * t;
    value[3] = t * t * t;
    derivative[0] = -3 * s * s;
    derivative[1] = 3 * s * s - 6 * s * t;
    derivative[2] = 6 * s * t - 3 * t * t;
    derivative[3] = 3 * t * t;
}

static void combine(const struct patch *patch, const double along_u[4], const double along_v[4],
                    double out[3])
{
    memset(out, 0, 3 * sizeof *out);
    for (int v = 0; v < 4; v++)
        for (int u = 0; u < 4; u++)
            for (int i = 0; i < 3; i++)
                out[i] += along_v[v] * along_u[u] * patch->point[v][u][i];
}

static double length(const double v[3])
{
    return hypot(hypot(v[0], v[1]), v[2]);
}

/* The longest edge of the control net: the scale below which lengths count as zero. */
static double patch_size(const struct patch *patch)
{
    double low[3], high[3], size = 0;
    for (int i = 0; i < 3; i++) {
        low[i] = high[i] = patch->point[0][0][i];
        for (int p = 1; p < 16; p++) {
            low[i] = fmin(low[i], patch->point[p / 4][p % 4][i]);
            high[i] = fmax(high[i], patch->point[p / 4][p % 4][i]);
        }
        size = fmax(size, high[i] - low[i]);
    }
    return size;
}

/* Computes the unit normal at (u, v). Returns false if the derivatives do not span a plane there. */
static bool evaluate_normal(const struct patch *patch, double u, double v, double normal[3])
{
    double bu[4], bv[4], du[4], dv[4], along_u[3], along_v[3], mixed[3];
    double small = 1e-9 * patch_size(patch);
    bernstein(u, bu, du);
    bernstein(v, bv, dv);
    combine(patch, du, bv, along_u);
    combine(patch, bu, dv, along_v);
    combine(patch, du, dv, mixed);
    /* Taken towards the inside of the patch: at the end of the range the derivative shrinks as the parameter
     * grows. */
    if (length(along_u) <= small)
        for (int i = 0; i < 3; i++)
            along_u[i] = v < 0.5 ? mixed[i] : -mixed[i];
    else if (length(along_v) <= small)
        for (int i = 0; i < 3; i++)
            along_v[i] = u < 0.5 ? mixed[i] : -mixed[i];
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        normal[i] = along_v[j] * along_u[k] - along_v[k] * along_u[j];
    }
    double l = length(normal);
    if (!(l > 1e-9 * length(along_u) * length(along_v)) || !(l > 0))
        return false;
    for (int i = 0; i < 3; i++)
        normal[i] /= l;
    return true;
}

static double bilinear(const float *corner, size_t step, double u, double v)
{
    return (1 - v) * ((1 - u) * corner[0] + u * corner[step]) +
           v * ((1 - u) * corner[2 * step] + u * corner[3 * step]);
}

static uint32_t pack_color(const struct patch *patch, double u, double v)
{
    static const int shift[4] = {16, 8, 0, 24};
    uint32_t color = 0;
    for (int c = 0; c < 4; c++)
        color |= (uint32_t)lround(255 * fmin(fmax(bilinear(&patch->color[0][c], 4, u, v), 0), 1)) << shift[c];
    return color;
}

static struct mesh_vertex evaluate(const struct patch *patch, double u, double v)
{
    static const double inside = 1.0 / 1024;
    struct mesh_vertex vertex = {.color = pack_color(patch, u, v)};
    double bu[4], bv[4], unused[4], position[3], normal[3] = {0};
    bernstein(u, bu, unused);
    bernstein(v, bv, unused);
    combine(patch, bu, bv, position);
    if (!evaluate_normal(patch, u, v, normal) &&
        !evaluate_normal(patch, u + (0.5 - u) * inside, v + (0.5 - v) * inside, normal))
        memset(normal, 0, sizeof normal);
    for (int i = 0; i < 3; i++) {
        vertex.position[i] = (float)position[i];
        vertex.normal[i] = (float)normal[i];
    }
    for (int i = 0; i < 2; i++)
        vertex.texcoord[i] = (float)bilinear(&patch->texcoord[0][i], 2, u, v);
    return vertex;
}

/* --- Grid --- */

static bool same_position(const struct mesh *mesh, uint32_t a, uint32_t b)
{
    return !memcmp(mesh->vertices[a].position, mesh->vertices[b].position, sizeof mesh->vertices->position);
}

/* Omits triangles whose corners coincide, at poles. */
static int add_triangle(struct bezier *bezier, uint32_t a, uint32_t b, uint32_t c)
{
    const struct mesh *mesh = bezier->mesh;
    if (same_position(mesh, a, b) || same_position(mesh, b, c) || same_position(mesh, c, a))
        return 0;
    return mesh_add_triangle(bezier->mesh, bezier->path, a, b, c, bezier->lex.error);
}

static int add_patch(struct bezier *bezier, const struct patch *patch)
{
    unsigned n = bezier->subdivisions;
    uint32_t first = bezier->mesh->vertex_count;
    for (unsigned y = 0; y <= n; y++)
        for (unsigned x = 0; x <= n; x++) {
            struct mesh_vertex vertex = evaluate(patch, (double)x / n, (double)y / n);
            if (mesh_add_vertex(bezier->mesh, bezier->path, &vertex, bezier->lex.error))
                return -1;
        }
    for (unsigned y = 0; y < n; y++)
        for (unsigned x = 0; x < n; x++) {
            uint32_t a = first + y * (n + 1) + x, b = a + 1, c = a + n + 1, d = c + 1;
            if (add_triangle(bezier, a, c, d) || add_triangle(bezier, a, d, b))
                return -1;
        }
    return 0;
}

/* --- Reading --- */

static int read_header(struct bezier *bezier)
{
    static const struct {
        const char *word;
        bool has_texcoord, has_color;
    } headers[] = {{"BBP", 0, 0},     {"STBBP", 1, 0},     {"BEZ333", 0, 0},
                   {"CBEZ333", 0, 1}, {"BEZ333_ST", 1, 0}, {"CBEZ333_ST", 1, 1}};
    struct lexer *lex = &bezier->lex;
    if (lex_skip_lines(lex))
        return -1;
    for (size_t i = 0; i < sizeof headers / sizeof headers[0]; i++)
        if (lex_is(lex, headers[i].word)) {
            bezier->has_texcoord = headers[i].has_texcoord;
            bezier->has_color = headers[i].has_color;
            return lex_next(lex);
        }
    return lex_expected(
        lex, "the header of bicubic patches: BBP, STBBP, BEZ333, BEZ333_ST, CBEZ333 or CBEZ333_ST");
}

static int read_numbers(struct lexer *lex, const char *what, float *numbers, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (lex_skip_lines(lex) || lex_number(lex, what, &numbers[i]))
            return -1;
    return 0;
}

static int read_patch(struct bezier *bezier, struct patch *patch)
{
    static const struct patch initial = {
        .texcoord = {{0, 0}, {1, 0}, {0, 1}, {1, 1}},
        .color = {{1, 1, 1, 1}, {1, 1, 1, 1}, {1, 1, 1, 1}, {1, 1, 1, 1}},
    };
    *patch = initial;
    if (read_numbers(&bezier->lex, "a coordinate of a patch's 16 points", &patch->point[0][0][0], 48))
        return -1;
    if (bezier->has_texcoord && read_numbers(&bezier->lex, "a texture coordinate", &patch->texcoord[0][0], 8))
        return -1;
    if (bezier->has_color && read_numbers(&bezier->lex, "part of a colour", &patch->color[0][0], 16))
        return -1;
    return lex_skip_lines(&bezier->lex);
}

static int read_patches(struct bezier *bezier)
{
    struct patch patch;
    unsigned count = 0;
    if (read_header(bezier) || lex_skip_lines(&bezier->lex))
        return -1;
    while (bezier->lex.token.type != TOKEN_END) {
        if (count++ == LIMIT_PATCHES)
            return error_set(bezier->lex.error, "%s: more than %d patches", bezier->path, LIMIT_PATCHES);
        if (read_patch(bezier, &patch) || add_patch(bezier, &patch))
            return -1;
    }
    bezier->mesh->has_texcoord = 1;
    bezier->mesh->has_color = bezier->has_color;
    return 0;
}

int mesh_read_bezier(struct mesh *mesh, const char *path, unsigned subdivisions, struct error *error)
{
    struct bezier bezier = {.path = path, .mesh = mesh, .subdivisions = subdivisions};
    char *text;
    size_t bytes;
    if (file_read(path, LIMIT_FILE_BYTES, &text, &bytes, error))
        return -1;
    int result = lex_start(&bezier.lex, path, text, bytes, error);
    if (!result)
        result = read_patches(&bezier);
    if (!result && store_add_main_file(&mesh->files, path, text, bytes))
        result = error_set(error, "%s: not enough memory", path);
    free(text);
    return result;
}
