// Pages, drawn by swgl as their streams draw them. Included after gl.cc, whose functions it calls.
#ifndef BENCH_PEERS_SWGL_PAGE_H
#define BENCH_PEERS_SWGL_PAGE_H

extern "C" {
#include "gles/page.h"
}

static struct {
    page file;
    bool span;
    GLuint textures[PAGE_TEXTURES], buffers[2 * PAGE_KINDS], programs[2][PAGE_SHADERS], array, stops;
    std::vector<uint8_t> vertices[PAGE_KINDS];
    std::vector<uint16_t> indices[PAGE_KINDS];
} swgl_page;

static size_t swgl_page_stride(unsigned kind)
{
    return kind ? PAGE_ROUND_BYTES : PAGE_FLAT_BYTES;
}

struct swgl_page_vertex {
    float x, y;
    uint8_t ink[4];
};

static swgl_page_vertex swgl_page_vertex_at(unsigned kind, unsigned index)
{
    swgl_page_vertex vertex;
    memcpy(&vertex, swgl_page.vertices[kind].data() + index * swgl_page_stride(kind), sizeof vertex);
    return vertex;
}

// --- Vertices ---

// Two triangles are a rectangle if they are the vertices n to n + 3 as 0, 1, 2 and 2, 1, 3, and a
// parallelogram.
static bool swgl_page_is_rectangle(unsigned kind, const uint16_t *index, unsigned left)
{
    static const int order[6] = {0, 1, 2, 2, 1, 3};
    for (int i = 0; left >= 6 && i < 6; i++)
        if (index[i] != index[0] + order[i])
            return false;
    if (left < 6)
        return false;
    swgl_page_vertex a = swgl_page_vertex_at(kind, index[0]), b = swgl_page_vertex_at(kind, index[1]);
    swgl_page_vertex c = swgl_page_vertex_at(kind, index[2]), d = swgl_page_vertex_at(kind, index[5]);
    return fabsf(a.x + d.x - b.x - c.x) < 0.01f && fabsf(a.y + d.y - b.y - c.y) < 0.01f;
}

// swgl draws rectangles, and triangles whose vertices follow each other. The vertices of other triangles are
// repeated, so that they do. Returns null, or a reason.
static const char *swgl_page_separate(unsigned kind)
{
    const page &file = swgl_page.file;
    size_t stride = swgl_page_stride(kind);
    std::vector<uint8_t> &vertices = swgl_page.vertices[kind];
    std::vector<uint16_t> &indices = swgl_page.indices[kind];
    vertices.assign(file.vertices[kind], file.vertices[kind] + file.vertex_count[kind] * stride);
    indices.assign(file.indices[kind], file.indices[kind] + file.index_count[kind]);
    for (unsigned i = 0; i < indices.size(); i += 3) {
        if (swgl_page_is_rectangle(kind, &indices[i], unsigned(indices.size()) - i)) {
            i += 3;
            continue;
        }
        for (unsigned k = i; k < i + 3; k++) {
            size_t at = indices[k] * stride, made = vertices.size() / stride;
            if (made > 0xffff)
                return "a page has more vertices than 16 bits count";
            vertices.resize(vertices.size() + stride);
            memcpy(&vertices[made * stride], &vertices[at], stride);
            indices[k] = uint16_t(made);
        }
    }
    return nullptr;
}

static void swgl_page_make_buffers(unsigned kind)
{
    BindBuffer(GL_ARRAY_BUFFER, swgl_page.buffers[2 * kind]);
    BufferData(GL_ARRAY_BUFFER, swgl_page.vertices[kind].size(), swgl_page.vertices[kind].data(), 0);
    BindBuffer(GL_ELEMENT_ARRAY_BUFFER, swgl_page.buffers[2 * kind + 1]);
    BufferData(GL_ELEMENT_ARRAY_BUFFER, swgl_page.indices[kind].size() * 2, swgl_page.indices[kind].data(),
               0);
}

static void swgl_page_bind_buffers(unsigned kind)
{
    static const struct {
        GLint components;
        GLenum type;
        GLuint offset;
    } rows[] = {
        {2, GL_FLOAT, 0}, {4, GL_UNSIGNED_BYTE, 8}, {2, GL_FLOAT, 12}, {4, GL_FLOAT, 20}, {1, GL_FLOAT, 36}};
    BindVertexArray(swgl_page.array);
    BindBuffer(GL_ARRAY_BUFFER, swgl_page.buffers[2 * kind]);
    BindBuffer(GL_ELEMENT_ARRAY_BUFFER, swgl_page.buffers[2 * kind + 1]);
    for (GLuint i = 0; i < 5; i++) {
        if (i >= 3 && !kind) {
            DisableVertexAttribArray(i);
            continue;
        }
        EnableVertexAttribArray(i);
        VertexAttribPointer(i, rows[i].components, rows[i].type, rows[i].type == GL_UNSIGNED_BYTE,
                            GLsizei(swgl_page_stride(kind)), rows[i].offset);
    }
}

// --- Textures ---

static void swgl_page_set_filter(bool linear)
{
    TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, linear ? GL_LINEAR : GL_NEAREST);
    TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, linear ? GL_LINEAR : GL_NEAREST);
}

static void swgl_page_make_textures()
{
    PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    GenTextures(PAGE_TEXTURES, swgl_page.textures);
    for (unsigned i = 0; i < swgl_page.file.texture_count; i++) {
        const page_texture &texture = swgl_page.file.textures[i];
        BindTexture(GL_TEXTURE_2D, swgl_page.textures[i]);
        TexImage2D(GL_TEXTURE_2D, 0, texture.alpha ? GL_R8 : GL_RGBA8, texture.width, texture.height, 0,
                   texture.alpha ? GL_RED : GL_RGBA, GL_UNSIGNED_BYTE, (void *)texture.texels);
    }
}

// A rectangle whose colours are a plane, as swgl's span path of gradients has it: a table of three entries,
// the start's and the step's colours, the two outer ones without a step, and the direction in u and v.
struct swgl_page_gradient {
    float entries[3][2][4], direction[4];
};

static swgl_page_gradient swgl_page_gradient_at(unsigned kind, const uint16_t *index)
{
    swgl_page_gradient gradient = {};
    swgl_page_vertex corners[] = {swgl_page_vertex_at(kind, index[0]), swgl_page_vertex_at(kind, index[1]),
                                  swgl_page_vertex_at(kind, index[5])};
    int widest = 0;
    float steps[4];
    for (int i = 0; i < 4; i++) {
        float first = corners[0].ink[i] / 255.0f, last = corners[2].ink[i] / 255.0f;
        steps[i] = last - first;
        gradient.entries[0][0][i] = gradient.entries[1][0][i] = first;
        gradient.entries[1][1][i] = steps[i];
        gradient.entries[2][0][i] = last;
        if (fabsf(steps[i]) > fabsf(steps[widest]))
            widest = i;
    }
    float across = (corners[1].ink[widest] - corners[0].ink[widest]) / 255.0f / steps[widest];
    gradient.direction[1] = across;
    gradient.direction[2] = 1 - across;
    return gradient;
}

// --- Programs and frames ---

static const char *swgl_page_program_name(const page_draw &draw, char (&name)[64])
{
    static const char *const names[] = {"solid", "image",   "mask",         "subpixel",
                                        "line",  "rounded", "rounded_image"};
    bool has_span = draw.shader != LINE && !(draw.shader == ROUNDED && draw.shaded);
    snprintf(name, sizeof name, "page_%s%s%s", names[draw.shader], draw.shaded ? "_shaded" : "",
             swgl_page.span && has_span ? "_span" : "");
    return name;
}

static void swgl_page_set_sampler(GLuint program, const char *name, GLint unit)
{
    GLint at = GetUniformLocation(program, (char *)name);
    if (at >= 0)
        Uniform1i(at, unit);
}

static void swgl_page_use_program(const page_draw &draw)
{
    static const char *const attributes[] = {"position", "paint", "texcoord", "place", "radius"};
    GLuint &program = swgl_page.programs[draw.shaded][draw.shader];
    char name[64];
    if (program) {
        UseProgram(program);
        return;
    }
    GLuint vs = CreateShader(GL_VERTEX_SHADER), fs = CreateShader(GL_FRAGMENT_SHADER);
    ShaderSourceByName(vs, (char *)swgl_page_program_name(draw, name));
    ShaderSourceByName(fs, name);
    program = CreateProgram();
    AttachShader(program, vs);
    AttachShader(program, fs);
    for (GLuint i = 0; i < 5; i++)
        BindAttribLocation(program, i, (char *)attributes[i]);
    LinkProgram(program);
    UseProgram(program);
    swgl_page_set_sampler(program, "texels", 0);
    swgl_page_set_sampler(program, "stops", 1);
}

static void swgl_page_draw_gradients(const page_draw &draw)
{
    GLint at = GetUniformLocation(swgl_page.programs[1][SOLID], (char *)"gradient");
    for (unsigned i = draw.first; i < draw.first + draw.count; i += 6) {
        swgl_page_gradient gradient = swgl_page_gradient_at(draw.kind, &swgl_page.indices[draw.kind][i]);
        ActiveTexture(GL_TEXTURE0 + 1);
        BindTexture(GL_TEXTURE_2D, swgl_page.stops);
        TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, 6, 1, 0, GL_RGBA, GL_FLOAT, gradient.entries);
        ActiveTexture(GL_TEXTURE0);
        Uniform4fv(at, 1, gradient.direction);
        DrawElementsInstanced(GL_TRIANGLES, 6, GL_UNSIGNED_SHORT, i * 2, 1);
    }
}

// Null, or a reason; the reason "none" if swgl cannot draw the page.
static const char *swgl_page_open(const char *name, bool span)
{
    const char *failed = workload_page_read(&swgl_page.file, name);
    for (unsigned kind = 0; !failed && kind < PAGE_KINDS; kind++)
        failed = swgl_page_separate(kind);
    if (failed) {
        workload_page_free(&swgl_page.file);
        return failed;
    }
    swgl_page.span = span;
    ActiveTexture(GL_TEXTURE0);
    swgl_page_make_textures();
    GenTextures(1, &swgl_page.stops);
    GenVertexArrays(1, &swgl_page.array);
    BindVertexArray(swgl_page.array);
    GenBuffers(2 * PAGE_KINDS, swgl_page.buffers);
    for (unsigned kind = 0; kind < PAGE_KINDS; kind++)
        swgl_page_make_buffers(kind);
    const float *clear = swgl_page.file.clear;
    Disable(GL_DEPTH_TEST);
    Disable(GL_SCISSOR_TEST);
    BlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    ClearColor(clear[0], clear[1], clear[2], clear[3]);
    SetViewport(0, 0, SIDE, SIDE);
    return nullptr;
}

static void swgl_page_draw()
{
    unsigned bound = PAGE_KINDS;
    Clear(GL_COLOR_BUFFER_BIT);
    for (unsigned i = 0; i < swgl_page.file.draw_count; i++) {
        const page_draw &draw = swgl_page.file.draws[i];
        swgl_page_use_program(draw);
        if (bound != draw.kind)
            swgl_page_bind_buffers(bound = draw.kind);
        if (draw.texture != PAGE_NO_TEXTURE) {
            BindTexture(GL_TEXTURE_2D, swgl_page.textures[draw.texture]);
            swgl_page_set_filter(draw.linear);
        }
        (draw.blend ? Enable : Disable)(GL_BLEND);
        if (swgl_page.span && draw.shaded && draw.shader == SOLID)
            swgl_page_draw_gradients(draw);
        else
            DrawElementsInstanced(GL_TRIANGLES, draw.count, GL_UNSIGNED_SHORT, draw.first * 2, 1);
    }
    GetColorBuffer(0, true, nullptr, nullptr, nullptr);
    Finish();
}

static void swgl_page_close()
{
    for (GLuint(&programs)[PAGE_SHADERS] : swgl_page.programs)
        for (GLuint &program : programs) {
            if (program)
                DeleteProgram(program);
            program = 0;
        }
    for (GLuint texture : swgl_page.textures)
        DeleteTexture(texture);
    for (GLuint buffer : swgl_page.buffers)
        DeleteBuffer(buffer);
    DeleteTexture(swgl_page.stops);
    DeleteVertexArray(swgl_page.array);
    workload_page_free(&swgl_page.file);
}

#endif
