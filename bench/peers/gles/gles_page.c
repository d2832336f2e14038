#include "gles_page.h"
#include "gles_library.h"
#include "page.h"

#include <GLES2/gl2ext.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static struct page page;
static GLuint textures[PAGE_TEXTURES], buffers[2 * PAGE_KINDS], programs[PAGE_SHADERS];
static unsigned opened; /* counts, so that each text of a program is new to the library */

/* --- Programs --- */

enum { POSITION, COLOR, TEXCOORD, PLACE, RADIUS };
static const char *const attributes[] = {"position", "color", "texcoord", "place", "radius"};

/* From pixels to clip space. */
#define VERTEX                                                                                               \
    "attribute vec2 position; attribute vec4 color; attribute vec2 texcoord; varying vec4 ink; varying "     \
    "vec2 "                                                                                                  \
    "uv;\n"
#define PASS                                                                                                 \
    "gl_Position = vec4(position * vec2(0.001953125, -0.001953125) + vec2(-1.0, 1.0), 0.0, 1.0); ink = "     \
    "color; uv = texcoord;"
static const char flat_vertex[] = VERTEX "void main() { " PASS " }\n";
static const char round_vertex[] =
    VERTEX "attribute vec4 place; attribute float radius; varying vec4 at; varying float edge;\n"
           "void main() { " PASS " at = place; edge = radius; }\n";

#define ROUND                                                                                                \
    "varying vec4 at; varying float edge;\n"                                                                 \
    "float coverage() { vec2 d = max(abs(at.xy) - at.zw, 0.0); return clamp(edge - length(d), 0.0, 1.0); "   \
    "}\n"
static const char *const pixels[PAGE_SHADERS] = {
    [SOLID] = "void main() { gl_FragColor = ink; }\n",
    [IMAGE] = "void main() { gl_FragColor = texture2D(texels, uv) * ink; }\n",
    [MASK] = "void main() { gl_FragColor = ink * texture2D(texels, uv).a; }\n",
    [SUBPIXEL] = "void main() { vec4 part = texture2D(texels, uv); gl_FragColor = ink * part; "
                 "gl_SecondaryFragColorEXT = part * ink.a; }\n",
    [LINE] = "void main() { gl_FragColor = ink * clamp(uv.y - abs(uv.x), 0.0, 1.0); }\n",
    [ROUNDED] = ROUND "void main() { gl_FragColor = ink * coverage(); }\n",
    [ROUNDED_IMAGE] = ROUND "void main() { gl_FragColor = texture2D(texels, uv) * ink * coverage(); }\n",
};

static GLuint compile(GLenum type, const char *head, const char *text)
{
    GLuint shader = gl.CreateShader(type);
    gl.ShaderSource(shader, 2, (const char *const[]){head, text}, NULL);
    gl.CompileShader(shader);
    return shader;
}

static const char *make_program(enum page_shader shader)
{
    char head[192];
    GLint linked = 0;
    snprintf(head, sizeof head,
             "%s// %u\nprecision highp float; varying vec4 ink; varying vec2 uv; uniform sampler2D texels;\n",
             shader == SUBPIXEL ? "#extension GL_EXT_blend_func_extended : require\n" : "", opened);
    GLuint program = programs[shader] = gl.CreateProgram();
    GLuint vertex = compile(GL_VERTEX_SHADER, "", shader >= ROUNDED ? round_vertex : flat_vertex);
    GLuint pixel = compile(GL_FRAGMENT_SHADER, head, pixels[shader]);
    gl.AttachShader(program, vertex);
    gl.AttachShader(program, pixel);
    for (GLuint i = 0; i < sizeof attributes / sizeof *attributes; i++)
        gl.BindAttribLocation(program, i, attributes[i]);
    gl.LinkProgram(program);
    gl.DeleteShader(vertex);
    gl.DeleteShader(pixel);
    gl.GetProgramiv(program, GL_LINK_STATUS, &linked);
    return linked ? NULL : "a program of a page does not link";
}

/* --- Textures and buffers --- */

static void make_texture(unsigned i)
{
    const struct page_texture *texture = page.textures + i;
    GLenum format = texture->alpha ? GL_ALPHA : GL_RGBA;
    gl.BindTexture(GL_TEXTURE_2D, textures[i]);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    gl.TexImage2D(GL_TEXTURE_2D, 0, (GLint)format, (GLsizei)texture->width, (GLsizei)texture->height, 0,
                  format, GL_UNSIGNED_BYTE, texture->texels);
}

static void make_buffers(enum page_kind kind)
{
    size_t stride = kind == ROUND_VERTICES ? PAGE_ROUND_BYTES : PAGE_FLAT_BYTES;
    gl.BindBuffer(GL_ARRAY_BUFFER, buffers[2 * kind]);
    gl.BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(page.vertex_count[kind] * stride), page.vertices[kind],
                  GL_STATIC_DRAW);
    gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[2 * kind + 1]);
    gl.BufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)(page.index_count[kind] * sizeof(uint16_t)),
                  page.indices[kind], GL_STATIC_DRAW);
}

/* Some libraries have no second colour. softpipe of Mesa 22.3 has the extension, and crashes. */
static bool has_second_color(void)
{
    const char *extensions = (const char *)gl.GetString(GL_EXTENSIONS);
    const char *renderer = (const char *)gl.GetString(GL_RENDERER);
    return extensions && strstr(extensions, "GL_EXT_blend_func_extended") && renderer &&
           !strstr(renderer, "softpipe");
}

static bool is_supported(void)
{
    bool second = false;
    for (unsigned i = 0; i < page.draw_count; i++)
        second |= page.draws[i].shader == SUBPIXEL;
    return !second || has_second_color();
}

const char *gles_page_open(const char *name)
{
    const char *failed = workload_page_read(&page, name);
    if (failed)
        return failed;
    if (!is_supported()) {
        workload_page_free(&page);
        return "none";
    }
    opened++;
    gl.ActiveTexture(GL_TEXTURE0);
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl.GenTextures(PAGE_TEXTURES, textures);
    for (unsigned i = 0; i < page.texture_count; i++)
        make_texture(i);
    gl.GenBuffers(2 * PAGE_KINDS, buffers);
    for (enum page_kind kind = FLAT_VERTICES; kind < PAGE_KINDS; kind++)
        make_buffers(kind);
    gl.Disable(GL_DEPTH_TEST);
    gl.Disable(GL_CULL_FACE);
    gl.Disable(GL_SCISSOR_TEST);
    gl.ClearColor(page.clear[0], page.clear[1], page.clear[2], page.clear[3]);
    return NULL;
}

/* --- Frames --- */

static void attribute(GLuint i, GLint components, GLenum type, GLsizei stride, size_t offset)
{
    gl.EnableVertexAttribArray(i);
    gl.VertexAttribPointer(i, components, type, type == GL_UNSIGNED_BYTE, stride, (const void *)offset);
}

static void bind_buffers(enum page_kind kind)
{
    GLsizei stride = kind == ROUND_VERTICES ? PAGE_ROUND_BYTES : PAGE_FLAT_BYTES;
    gl.BindBuffer(GL_ARRAY_BUFFER, buffers[2 * kind]);
    gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[2 * kind + 1]);
    attribute(POSITION, 2, GL_FLOAT, stride, 0);
    attribute(COLOR, 4, GL_UNSIGNED_BYTE, stride, 8);
    attribute(TEXCOORD, 2, GL_FLOAT, stride, 12);
    gl.DisableVertexAttribArray(PLACE);
    gl.DisableVertexAttribArray(RADIUS);
    if (kind == ROUND_VERTICES) {
        attribute(PLACE, 4, GL_FLOAT, stride, 20);
        attribute(RADIUS, 1, GL_FLOAT, stride, 36);
    }
}

static void bind_texture(const struct page_draw *draw)
{
    GLint filter = draw->linear ? GL_LINEAR : GL_NEAREST;
    if (draw->texture == PAGE_NO_TEXTURE)
        return;
    gl.BindTexture(GL_TEXTURE_2D, textures[draw->texture]);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
}

const char *gles_page_frame(void)
{
    gl.Clear(GL_COLOR_BUFFER_BIT);
    enum page_kind bound = PAGE_KINDS;
    for (unsigned i = 0; i < page.draw_count; i++) {
        const struct page_draw *draw = page.draws + i;
        const char *failed = programs[draw->shader] ? NULL : make_program(draw->shader);
        if (failed)
            return failed;
        gl.UseProgram(programs[draw->shader]);
        if (bound != draw->kind)
            bind_buffers(bound = draw->kind);
        bind_texture(draw);
        (draw->blend ? gl.Enable : gl.Disable)(GL_BLEND);
        gl.BlendFunc(GL_ONE, draw->shader == SUBPIXEL ? GL_ONE_MINUS_SRC1_COLOR_EXT : GL_ONE_MINUS_SRC_ALPHA);
        gl.DrawElements(GL_TRIANGLES, (GLsizei)draw->count, GL_UNSIGNED_SHORT,
                        (const void *)((size_t)draw->first * sizeof(uint16_t)));
    }
    gl.Finish();
    return NULL;
}

void gles_page_close(void)
{
    gl.UseProgram(0);
    for (unsigned i = 0; i < PAGE_SHADERS; i++)
        if (programs[i])
            gl.DeleteProgram(programs[i]);
    for (unsigned i = 0; i < PAGE_SHADERS; i++)
        programs[i] = 0;
    gl.DeleteTextures(PAGE_TEXTURES, textures);
    gl.DeleteBuffers(2 * PAGE_KINDS, buffers);
    gl.Finish();
    workload_page_free(&page);
}
