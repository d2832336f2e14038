/* A GLES2 renderer that is measured: NAME [FOLDER]. FOLDER has ANGLE's libraries. */
#include "gles/gles_library.h"
#include "gles/gles_page.h"
#include "gles_shader.h"
#include "gles_texel.h"
#include "peer.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum geometry { QUAD, QUADS, TILTED, TINY, ARITHMETIC, COLORS, GRID_316, GRID_90, CELLS, SMALL, NOTHING };
enum filter { NEAREST, BILINEAR, TRILINEAR, NEAREST_CLAMP, BILINEAR_CLAMP };
enum blend { OPAQUE, ALPHA, PREMULTIPLIED };
enum picture { NONE, ONE, TWO, PICTURE, PATTERN, BYTES };
enum test { ANY, LESS, LESS_EQUAL, BACK, FRONT };
enum {
    TEXTURE_SIDE = 256,
    PATTERN_SIDE = 64,
    LEVELS = 9,
    QUAD_LAYERS = 32,
    CELL_COLUMNS = 16,
    CELL_ROWS = 24
};

struct scene {
    const char *name;
    enum geometry geometry;
    float low, high;
    enum vertex_shader vertex;
    enum pixel_shader pixel;
    enum picture picture;
    enum filter filter;
    enum blend blend;
    enum test test;
    uint32_t color;
};

static const struct scene scenes[] = {
#define SCENE(name, ...) {#name, __VA_ARGS__},
#include "scene.def"
#undef SCENE
};

static const struct workload *workload;
static const struct scene *scene;
static GLuint program, textures[2], buffers[2];
static GLsizei index_count;
static GLint place, row, constant, offset; /* uniforms that change between draws */
static char reason[1024];

/* Attributes of all vertex shaders: the position, then up to two others. */
enum { POSITION, FIRST, SECOND };

const char *renderer_start(int count, char **arguments, char *description)
{
    if (count != 2 && count != 3)
        return "expected NAME [FOLDER]";
    const char *failed = gles_start(count == 3 ? arguments[2] : NULL, SIDE);
    if (failed)
        return failed;
    snprintf(description, 256, "%s (%s)", (const char *)gl.GetString(GL_RENDERER),
             (const char *)gl.GetString(GL_VERSION));
    return NULL;
}

static const char *check(const char *what)
{
    GLenum error = gl.GetError();
    if (!error)
        return NULL;
    snprintf(reason, sizeof reason, "%s: GL error 0x%x", what, error);
    return reason;
}

/* --- Programs ------------------------------------------------------------------------------------------- */

static GLuint compile(GLenum type, const char *text)
{
    GLuint shader = gl.CreateShader(type);
    gl.ShaderSource(shader, 1, &text, NULL);
    gl.CompileShader(shader);
    return shader;
}

static GLint uniform(const char *name)
{
    return gl.GetUniformLocation(program, name);
}

static void set3(const char *name, float x, float y, float z)
{
    gl.Uniform3fv(uniform(name), 1, (const float[]){x, y, z});
}

static void set4(const char *name, float x, float y, float z, float w)
{
    gl.Uniform4f(uniform(name), x, y, z, w);
}

static void set_lit(void)
{
    float size = scene->geometry == GRID_90 ? 0.985f : 0.8728f,
          tilt = scene->geometry == GRID_90 ? 0.004f : 0.05f;
    static const float turn[] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    const float grid[] = {size, 0, 0, 0, 0, 0, size, 0, 0, 0, 0.1f, 0.5f, 0, 0, tilt, 1};
    const float cells[] = {0.005455f,    0, 0, 0, 0, 0, 0.005594872f, 0, 0, 0, 0.000641026f, 0.5f, 0, 0,
                           0.000320513f, 1};
    gl.Uniform4fv(uniform("rows"), 4, scene->geometry == CELLS ? cells : grid);
    gl.Uniform3fv(uniform("turn"), 3, turn);
    float unit = scene->geometry == CELLS ? 160 : 1;
    set3("light", 0.3f * unit, 0.4f * unit, 0.2f * unit);
    set3("diffuse", 0.7f, 0.6f, 0.3f);
    set3("offset", 0, 0, 0);
    set4("ambient", 0.1f, 0.15f, 0.3f, 1);
}

static void set_arithmetic(void)
{
    if (scene->pixel >= MULTIPLY_ADD && scene->pixel <= MIX_64) {
        set4("factor", 0.99f, 0.985f, 0.99f, 1);
        set4("term", 0.002f, 0.003f, 0.004f, 0);
    }
    if (scene->pixel != PHONG)
        return;
    set3("light", 0.5f, 0.8f, 1.5f);
    set3("eye", 0, 0, 2);
    set4("diffuse", 0.2f, 0.4f, 0.7f, 0);
    set4("ambient", 0.05f, 0.05f, 0.1f, 1);
    set4("specular", 0.8f, 0.8f, 0.6f, 0);
}

static void set_uniforms(void)
{
    uint32_t c = scene->color;
    constant = uniform("constant");
    place = uniform("place");
    row = uniform("row");
    offset = uniform("offset");
    if (constant >= 0)
        gl.Uniform4f(constant, (float)(c >> 16 & 255) / 255, (float)(c >> 8 & 255) / 255,
                     (float)(c & 255) / 255, (float)(c >> 24) / 255);
    if (scene->picture != NONE)
        gl.Uniform1i(uniform("checker"), 0);
    if (scene->picture == TWO)
        gl.Uniform1i(uniform("gradient"), 1);
    if (scene->vertex == LIT)
        set_lit();
    set_arithmetic();
}

/* Makes a program that the library has not compiled before, and uses it. */
static const char *make_program(unsigned number)
{
    GLint linked = 0;
    if (program)
        gl.DeleteProgram(program);
    program = gl.CreateProgram();
    GLuint vertex = compile(GL_VERTEX_SHADER, vertex_text(scene->vertex));
    GLuint pixel = compile(GL_FRAGMENT_SHADER, pixel_text(scene->pixel, number));
    gl.AttachShader(program, vertex);
    gl.AttachShader(program, pixel);
    gl.BindAttribLocation(program, POSITION, "position");
    gl.BindAttribLocation(program, FIRST,
                          scene->vertex == PASS  ? "texcoord"
                          : scene->vertex == LIT ? "normal"
                                                 : "first");
    if (scene->vertex == VECTORS)
        gl.BindAttribLocation(program, SECOND, "second");
    gl.LinkProgram(program);
    gl.DeleteShader(vertex);
    gl.DeleteShader(pixel);
    gl.GetProgramiv(program, GL_LINK_STATUS, &linked);
    if (!linked) {
        char log[900] = "";
        gl.GetProgramInfoLog(program, sizeof log, NULL, log);
        snprintf(reason, sizeof reason, "a program does not link: %.900s", log);
        for (char *end = reason; (end = strchr(end, '\n'));)
            *end = ' ';
        return reason;
    }
    gl.UseProgram(program);
    set_uniforms();
    return NULL;
}

/* --- Textures ------------------------------------------------------------------------------------------ */

static void make_sampler(unsigned unit)
{
    enum filter filter = scene->filter;
    GLint wrap = filter == NEAREST_CLAMP || filter == BILINEAR_CLAMP ? GL_CLAMP_TO_EDGE : GL_REPEAT;
    GLint near = filter == NEAREST || filter == NEAREST_CLAMP ? GL_NEAREST : GL_LINEAR;
    gl.ActiveTexture(GL_TEXTURE0 + unit);
    gl.BindTexture(GL_TEXTURE_2D, textures[unit]);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrap);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrap);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, near);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER,
                     filter == TRILINEAR ? GL_LINEAR_MIPMAP_LINEAR : near);
}

static void make_texture(unsigned unit, unsigned full, uint32_t (*at)(unsigned, unsigned, unsigned))
{
    static uint32_t texels[2][SIDE * SIDE];
    make_sampler(unit);
    for (unsigned i = 0; i < full * full; i++)
        texels[0][i] = at(i % full, i / full, full);
    for (int level = 0; level < (scene->filter == TRILINEAR ? LEVELS : 1); level++) {
        GLsizei side = (GLsizei)(full >> level);
        gl.TexImage2D(GL_TEXTURE_2D, level, GL_RGBA, side, side, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                      texels[level % 2]);
        gles_halve(texels[level % 2], texels[(level + 1) % 2], (unsigned)side / 2);
    }
}

static void make_bytes(void)
{
    static uint8_t texels[SIDE * SIDE];
    make_sampler(0);
    for (unsigned i = 0; i < SIDE * SIDE; i++)
        texels[i] = gles_mask(i % SIDE, i / SIDE);
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_ALPHA, SIDE, SIDE, 0, GL_ALPHA, GL_UNSIGNED_BYTE, texels);
}

static void make_textures(void)
{
    gl.GenTextures(2, textures);
    switch (scene->picture) {
    case NONE: break;
    case ONE: make_texture(0, TEXTURE_SIDE, gles_checker); break;
    case TWO:
        make_texture(0, TEXTURE_SIDE, gles_checker);
        make_texture(1, TEXTURE_SIDE, gles_gradient);
        break;
    case PICTURE: make_texture(0, SIDE, gles_gradient); break;
    case PATTERN: make_texture(0, PATTERN_SIDE, gles_gradient); break;
    case BYTES: make_bytes(); break;
    }
}

/* --- Geometry ------------------------------------------------------------------------------------------- */

static void attribute(GLuint i, GLint components, unsigned offset_floats, unsigned stride_floats)
{
    gl.EnableVertexAttribArray(i);
    gl.VertexAttribPointer(i, components, GL_FLOAT, GL_FALSE, (GLsizei)(stride_floats * sizeof(float)),
                           (const void *)(offset_floats * sizeof(float)));
}

static void upload(GLenum target, const void *data, size_t bytes)
{
    gl.BindBuffer(target, buffers[target == GL_ELEMENT_ARRAY_BUFFER]);
    gl.BufferData(target, (GLsizeiptr)bytes, data, GL_STATIC_DRAW);
}

/* Corners from the upper left: x, y, z, w, u, v. */
static void make_corners(float size, float right)
{
    float l = scene->low, h = scene->high, r = right * size;
    const float corners[] = {-size, size,  0, 1, l, l, r, r,  0, right, h, l,
                             -size, -size, 0, 1, l, h, r, -r, 0, right, h, h};
    upload(GL_ARRAY_BUFFER, corners, sizeof corners);
    attribute(POSITION, 4, 0, 6);
    attribute(FIRST, 2, 4, 6);
}

static void make_quads(void)
{
    float quads[QUAD_LAYERS][4][4];
    for (int i = 0; i < QUAD_LAYERS; i++)
        for (int corner = 0; corner < 4; corner++) {
            const float vertex[] = {corner % 2 ? 1 : -1, corner < 2 ? 1 : -1, 0.9f - (float)i * 0.03125f, 1};
            memcpy(quads[i][corner], vertex, sizeof vertex);
        }
    upload(GL_ARRAY_BUFFER, quads, sizeof quads);
    attribute(POSITION, 4, 0, 4);
}

static void make_vectors(void)
{
    static const float arithmetic[4][4] = {
        {-0.6f, 0.7f, 1, 1}, {0.8f, 0.5f, 1, 1}, {-0.5f, -0.6f, 1, 1}, {0.9f, -0.8f, 1, 1}};
    static const float colors[4][4] = {
        {0.1f, 0.9f, 0.3f, 1}, {0.7f, 0.7f, 0.2f, 1}, {0.3f, 0.2f, 0.9f, 1}, {0.9f, 0, 0.8f, 1}};
    float vertices[4][11];
    for (int i = 0; i < 4; i++) {
        const float x = i % 2 ? 1 : -1, y = i < 2 ? 1 : -1, place_of[] = {x, y, 0, 1}, second[] = {x, y, 0};
        static const float none[3];
        memcpy(vertices[i], place_of, sizeof place_of);
        memcpy(vertices[i] + 4, scene->geometry == COLORS ? colors[i] : arithmetic[i], 4 * sizeof(float));
        memcpy(vertices[i] + 8, scene->geometry == COLORS ? none : second, 3 * sizeof(float));
    }
    upload(GL_ARRAY_BUFFER, vertices, sizeof vertices);
    attribute(POSITION, 4, 0, 11);
    attribute(FIRST, 4, 4, 11);
    attribute(SECOND, 3, 8, 11);
}

/* The shape `grid` of streams. */
static const char *make_grid(unsigned cells)
{
    unsigned side = cells + 1;
    float(*vertices)[6] = malloc((size_t)side * side * sizeof *vertices);
    uint32_t *indices = malloc((size_t)cells * cells * 6 * sizeof *indices), *index = indices;
    if (!vertices || !indices) {
        free(vertices);
        free(indices);
        return "no memory for a grid";
    }
    for (unsigned i = 0; i < side * side; i++) {
        const float vertex[] = {
            (float)(2.0 * (i % side) / cells - 1), 0, (float)(2.0 * (i / side) / cells - 1), 0, 1, 0};
        memcpy(vertices[i], vertex, sizeof vertex);
    }
    for (unsigned cell = 0; cell < cells * cells; cell++) {
        uint32_t a = cell / cells * side + cell % cells, c = a + side;
        const uint32_t corners[] = {a, c, c + 1, a, c + 1, a + 1};
        memcpy(index, corners, sizeof corners);
        index += 6;
    }
    index_count = (GLsizei)(index - indices);
    upload(GL_ARRAY_BUFFER, vertices, (size_t)side * side * sizeof *vertices);
    upload(GL_ELEMENT_ARRAY_BUFFER, indices, (size_t)index_count * sizeof *indices);
    attribute(POSITION, 3, 0, 6);
    attribute(FIRST, 3, 3, 6);
    free(vertices);
    free(indices);
    return NULL;
}

static void make_cells(void)
{
    static const int corners[6][2] = {{0, 0}, {0, 1}, {1, 1}, {0, 0}, {1, 1}, {1, 0}};
    static float vertices[CELL_COLUMNS * CELL_ROWS * 6][6];
    for (int i = 0; i < CELL_COLUMNS * CELL_ROWS * 6; i++) {
        int x = i / 6 % CELL_COLUMNS + corners[i % 6][0], z = i / 6 / CELL_COLUMNS + corners[i % 6][1];
        const float vertex[] = {(float)x, 0, (float)z, 0, 1, 0};
        memcpy(vertices[i], vertex, sizeof vertex);
    }
    upload(GL_ARRAY_BUFFER, vertices, sizeof vertices);
    attribute(POSITION, 3, 0, 6);
    attribute(FIRST, 3, 3, 6);
}

static void make_small(void)
{
    static const float corners[] = {-0.0035f, 0.0035f, 0, 0.0045f, 0.0035f, 0, -0.0035f, -0.0045f, 0};
    upload(GL_ARRAY_BUFFER, corners, sizeof corners);
    attribute(POSITION, 3, 0, 3);
}

static const char *make_geometry(void)
{
    gl.GenBuffers(2, buffers);
    for (GLuint i = POSITION; i <= SECOND; i++)
        gl.DisableVertexAttribArray(i);
    switch (scene->geometry) {
    case QUAD: make_corners(1, 1); break;
    case TILTED: make_corners(1, 2); break;
    case TINY: make_corners(0.01f, 1); break;
    case QUADS: make_quads(); break;
    case ARITHMETIC:
    case COLORS: make_vectors(); break;
    case GRID_316: return make_grid(316);
    case GRID_90: return make_grid(90);
    case CELLS: make_cells(); break;
    case SMALL: make_small(); break;
    case NOTHING: break;
    }
    return NULL;
}

/* --- Frames --------------------------------------------------------------------------------------------- */

static void set_states(void)
{
    enum test test = scene->test;
    (scene->blend == OPAQUE ? gl.Disable : gl.Enable)(GL_BLEND);
    gl.BlendFunc(scene->blend == ALPHA ? GL_SRC_ALPHA : GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    (test == ANY ? gl.Disable : gl.Enable)(GL_DEPTH_TEST);
    gl.DepthFunc(test == LESS ? GL_LESS : GL_LEQUAL);
    gl.DepthMask(GL_TRUE);
    (test == BACK || test == FRONT ? gl.Enable : gl.Disable)(GL_CULL_FACE);
    gl.FrontFace(GL_CW);
    gl.CullFace(test == FRONT ? GL_FRONT : GL_BACK);
    gl.Disable(GL_SCISSOR_TEST);
    gl.Viewport(0, 0, SIDE, SIDE);
    if (scene->geometry == NOTHING || scene->test == LESS_EQUAL)
        gl.ClearColor(0.2f, 0.4f, 0.6f, 1);
    else
        gl.ClearColor(0, 0, 0, 1);
    gl.ClearDepthf(scene->test == LESS_EQUAL ? 0.25f : 1);
}

const char *renderer_open(const struct workload *wanted)
{
    workload = wanted;
    if (wanted->group == PAGE)
        return gles_page_open(wanted->name);
    scene = NULL;
    for (unsigned i = 0; i < sizeof scenes / sizeof *scenes; i++)
        if (!strcmp(scenes[i].name, wanted->name))
            scene = scenes + i;
    if (!scene)
        return "no scene of that name";
    make_textures();
    const char *failed = make_geometry();
    set_states();
    gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    gl.Finish();
    return failed ? failed : check("opening");
}

/* Pages are not limited. */
const char *renderer_limit(bool limited)
{
    if (workload->group == PAGE)
        return NULL;
    (limited ? gl.Enable : gl.Disable)(GL_SCISSOR_TEST);
    gl.Scissor(508, 508, 8, 8);
    return NULL;
}

static void draw_cells(void)
{
    for (int z = -156; z < 156; z += CELL_ROWS)
        for (int x = -160; x < 160; x += CELL_COLUMNS) {
            gl.Uniform3fv(offset, 1, (const float[]){(float)x, 0, (float)z});
            gl.DrawArrays(GL_TRIANGLES, 0, CELL_COLUMNS * CELL_ROWS * 6);
        }
}

static void draw_small(void)
{
    bool colors = !strcmp(workload->name, "draws");
    for (int y = 0; y < 100; y++) {
        gl.Uniform4f(row, 0, (float)(y * 10 + 12 - 512) / 512, 0, 0);
        for (int x = 0; x < 100; x++) {
            gl.Uniform4f(place, (float)(x * 10 + 12 - 512) / 512, 0, 0, 0);
            if (colors)
                gl.Uniform4f(constant, (float)x / 99, 1 - (float)x / 99, (float)(x % 10) / 9, 1);
            gl.DrawArrays(GL_TRIANGLES, 0, 3);
        }
    }
}

static void draw_layer(unsigned layer)
{
    switch (scene->geometry) {
    case NOTHING: break;
    case CELLS: draw_cells(); break;
    case SMALL: draw_small(); break;
    case GRID_316:
    case GRID_90: gl.DrawElements(GL_TRIANGLES, index_count, GL_UNSIGNED_INT, NULL); break;
    default: gl.DrawArrays(GL_TRIANGLE_STRIP, scene->geometry == QUADS ? (GLint)layer * 4 : 0, 4);
    }
}

const char *renderer_frame(bool less)
{
    if (workload->group == PAGE) {
        const char *failed = gles_page_frame();
        return failed ? failed : check("drawing");
    }
    if (!program) {
        const char *failed = make_program(0);
        if (failed)
            return failed;
    }
    if (workload->kind != LAYER)
        gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    for (unsigned i = 0; i < (less ? workload->less : workload->full); i++)
        draw_layer(i);
    gl.Finish();
    return check("drawing");
}

const char *renderer_read(uint32_t *rgba_out, bool *upward)
{
    *upward = true;
    gl.PixelStorei(GL_PACK_ALIGNMENT, 4);
    gl.ReadPixels(0, 0, SIDE, SIDE, GL_RGBA, GL_UNSIGNED_BYTE, rgba_out);
    return check("reading");
}

const char *renderer_build(unsigned number)
{
    const char *failed = make_program(number);
    if (failed)
        return failed;
    draw_layer(0);
    gl.Finish();
    return check("drawing");
}

double renderer_build_us(void)
{
    return -1;
}

void renderer_close(void)
{
    if (workload && workload->group == PAGE) {
        gles_page_close();
        workload = NULL;
    }
    if (!workload)
        return;
    gl.UseProgram(0);
    if (program)
        gl.DeleteProgram(program);
    program = 0;
    gl.DeleteTextures(2, textures);
    gl.DeleteBuffers(2, buffers);
    gl.Finish();
    workload = NULL;
}
