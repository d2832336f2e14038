/* Programs of OpenGL ES 2.0, from their sources to their pixels. The first byte chooses an engine, the rest
 * is a vertex shader, a zero, and a fragment shader. Without bytes a source is one that fits most others. A
 * program that links is drawn with the emulator and with the engine, and the pixels are equal. */
#include "shader/shader.h"
#include "tests/command/fuzz/targets/gl/canvas.h"
#include "tests/command/fuzz/targets/target.h"
#include "front/gl/program/program.h"

#include <string.h>

enum { NAME_BYTES = 256, LINES = 600, LINES_WITH_LOOP = 60, BYTES = 4096 };

struct sources {
    const char *text[GLSL_STAGES];
    GLint length[GLSL_STAGES];
};

static const char default_vertex[] =
    "attribute vec4 a; attribute vec2 b; uniform mat4 m; varying vec4 v; varying vec2 w;"
    "void main() { gl_Position = a; gl_PointSize = 3.0; v = a + m[1]; w = b; }";
static const char default_fragment[] = "precision mediump float; void main() { gl_FragColor = vec4(0.5); }";

static struct sources divide(struct choices rest)
{
    const char *text = (const char *)rest.at;
    size_t bytes = (size_t)(rest.end - rest.at), first = strnlen(text, bytes);
    struct sources sources = {{default_vertex, default_fragment}, {-1, -1}};
    if (first)
        sources.text[GLSL_VERTEX] = text, sources.length[GLSL_VERTEX] = (GLint)first;
    if (first + 1 < bytes)
        sources.text[GLSL_FRAGMENT] = text + first + 1,
        sources.length[GLSL_FRAGMENT] = (GLint)(bytes - first - 1);
    return sources;
}

static GLuint compile(struct gl_context *gl, GLenum type, const char *text, GLint length)
{
    GLuint shader = gl_CreateShader(gl, type);
    GLint compiled = 0, room = 0;
    gl_ShaderSource(gl, shader, 1, &text, &length);
    gl_CompileShader(gl, shader);
    gl_GetShaderiv(gl, shader, GL_COMPILE_STATUS, &compiled);
    gl_GetShaderiv(gl, shader, GL_INFO_LOG_LENGTH, &room);
    expect(compiled || room, "a shader without a log");
    return shader;
}

/* Returns the program, or 0 if it does not link. */
static GLuint make_program(struct gl_context *gl, const struct sources *sources)
{
    static const GLenum types[GLSL_STAGES] = {GL_VERTEX_SHADER, GL_FRAGMENT_SHADER};
    GLuint program = gl_CreateProgram(gl);
    GLint linked = 0, room = 0;
    for (int i = 0; i < GLSL_STAGES; i++) {
        GLuint shader = compile(gl, types[i], sources->text[i], sources->length[i]);
        gl_AttachShader(gl, program, shader);
        gl_DeleteShader(gl, shader);
    }
    gl_LinkProgram(gl, program);
    gl_GetProgramiv(gl, program, GL_LINK_STATUS, &linked);
    gl_GetProgramiv(gl, program, GL_INFO_LOG_LENGTH, &room);
    expect(linked || room, "a program without a log");
    return linked ? program : 0;
}

/* --- The shader machine --- */

/* The work of a draw, by the texts of its shaders. */
struct work {
    unsigned lines, loops;
};

/* The text of a stage is one that the assembler reads and the validator accepts. */
static void check_text(const char *text, struct work *work)
{
    struct error error = {{0}};
    struct shader *shader;
    expect(!shader_assemble("fuzz", text, strlen(text), &shader, &error), "%s\n%s", error.text, text);
    expect(!shader_validate(shader, NULL, &error), "%s\n%s", error.text, text);
    shader_free(shader);
    for (const char *line = text; line; line = strchr(line + 1, '\n'))
        work->lines++;
    for (const char *at = text; (at = strstr(at, "endwhile")); at++)
        work->loops++;
}

static struct work check_program(struct gl_context *gl, GLuint name)
{
    const struct gl_program *program = gl_program_find(gl, name);
    struct work work = {0, 0};
    expect(program && program->program, "no program");
    check_text(program->program->text[GLSL_VERTEX], &work);
    check_text(program->program->text[GLSL_FRAGMENT], &work);
    if (program->program->turned)
        check_text(program->program->turned, &work);
    return work;
}

/* A loop ends after 65536 passes, so only one is executed, for one pixel. */
static bool is_short(const struct work *work)
{
    return work->loops ? work->loops == 1 && work->lines < LINES_WITH_LOOP : work->lines < LINES;
}

/* --- The draw --- */

/* Numbers between -2 and 2 that are the same for all engines. */
static void fill(GLfloat *numbers, unsigned count)
{
    for (unsigned i = 0; i < count; i++)
        numbers[i] = (GLfloat)((i * 37 + 11) % 64) / 16 - 2;
}

static void set_uniform(struct gl_context *gl, GLint location, GLsizei size, GLenum type)
{
    GLfloat numbers[64 * 16];
    GLsizei count = size < 64 ? size : 64;
    fill(numbers, 64 * 16);
    switch (type) {
    case GL_FLOAT: gl_Uniform1fv(gl, location, count, numbers); break;
    case GL_FLOAT_VEC2: gl_Uniform2fv(gl, location, count, numbers); break;
    case GL_FLOAT_VEC3: gl_Uniform3fv(gl, location, count, numbers); break;
    case GL_FLOAT_VEC4: gl_Uniform4fv(gl, location, count, numbers); break;
    case GL_FLOAT_MAT2: gl_UniformMatrix2fv(gl, location, count, GL_FALSE, numbers); break;
    case GL_FLOAT_MAT3: gl_UniformMatrix3fv(gl, location, count, GL_FALSE, numbers); break;
    case GL_FLOAT_MAT4: gl_UniformMatrix4fv(gl, location, count, GL_FALSE, numbers); break;
    case GL_INT:
    case GL_BOOL:
    case GL_SAMPLER_2D:
    case GL_SAMPLER_CUBE: gl_Uniform1i(gl, location, type == GL_SAMPLER_CUBE); break;
    default: break;
    }
    expect(!gl_GetError(gl), "an error of uniform %d", location);
}

static void set_uniforms(struct gl_context *gl, GLuint program)
{
    GLint count = 0;
    gl_GetProgramiv(gl, program, GL_ACTIVE_UNIFORMS, &count);
    for (GLint i = 0; i < count; i++) {
        char name[NAME_BYTES];
        GLsizei length = 0;
        GLint size = 0;
        GLenum type = 0;
        gl_GetActiveUniform(gl, program, (GLuint)i, NAME_BYTES, &length, &size, &type, name);
        GLint location = gl_GetUniformLocation(gl, program, name);
        bool whole = length < NAME_BYTES - 1 && strncmp(name, "gl_", 3);
        expect(location >= 0 || !whole, "the active uniform %s has no location", name);
        if (location >= 0 && whole)
            set_uniform(gl, location, size, type);
    }
}

static void set_textures(struct gl_context *gl)
{
    static const uint32_t texels[4] = {0xff0000ff, 0xff00ff00, 0x80ff0000, 0x40ffffff};
    GLuint names[2];
    gl_GenTextures(gl, 2, names);
    for (unsigned i = 0; i < 2; i++) {
        GLenum target = i ? GL_TEXTURE_CUBE_MAP : GL_TEXTURE_2D;
        gl_ActiveTexture(gl, GL_TEXTURE0 + i);
        gl_BindTexture(gl, target, names[i]);
        gl_TexParameteri(gl, target, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
        for (unsigned face = 0; face < (i ? 6 : 1); face++)
            gl_TexImage2D(gl, i ? GL_TEXTURE_CUBE_MAP_POSITIVE_X + face : GL_TEXTURE_2D, 0, GL_RGBA, 2, 2, 0,
                          GL_RGBA, GL_UNSIGNED_BYTE, texels);
    }
}

/* Two triangles over the whole canvas, and a point. All attributes have the same numbers. */
static void draw(struct gl_context *gl)
{
    static const GLfloat corners[5][4] = {
        {-1, -1, 0.5F, 1}, {1, -1, -0.5F, 1}, {-1, 1, 0.25F, 1}, {1, 1, 0, 2}, {0.25F, 0.25F, 0, 1}};
    for (GLuint i = 0; i < GL_ATTRIBUTES; i++) {
        gl_VertexAttribPointer(gl, i, 4, GL_FLOAT, GL_FALSE, 0, corners);
        gl_EnableVertexAttribArray(gl, i);
    }
    gl_Clear(gl, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    gl_DrawArrays(gl, GL_TRIANGLE_STRIP, 0, 4);
    gl_FrontFace(gl, GL_CW);
    gl_DrawArrays(gl, GL_TRIANGLES, 1, 3);
    gl_DrawArrays(gl, GL_POINTS, 4, 1);
}

/* Fills in the pixels; returns false if the program does not link or is too long. */
static bool render(const char *engine, const struct sources *sources, uint32_t *pixels, bool *linked)
{
    struct canvas canvas;
    canvas_begin(&canvas, canvas_device(engine), GL_ES2, NULL);
    struct gl_context *gl = canvas.context;
    gl_context_enter(gl);
    GLuint program = make_program(gl, sources);
    struct work work = {UINT32_MAX, 0};
    *linked = program;
    if (program)
        work = check_program(gl, program);
    bool drawn = is_short(&work);
    if (drawn) {
        if (work.loops) {
            gl_Enable(gl, GL_SCISSOR_TEST);
            gl_Scissor(gl, 9, 4, 1, 1);
        }
        gl_UseProgram(gl, program);
        set_textures(gl);
        set_uniforms(gl, program);
        draw(gl);
        gl_ReadPixels(gl, 0, 0, CANVAS_WIDTH, CANVAS_HEIGHT, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
    }
    GLenum error = gl_GetError(gl);
    expect(!error, "error 0x%x: %s", error, triptych_error(canvas.surface.device->renderer));
    gl_context_leave(gl);
    canvas_end(&canvas);
    return drawn;
}

static void run(const uint8_t *data, size_t bytes)
{
    static const char *const engines[] = {"batch", "stitch", "specialize"};
    static uint32_t pixels[2][CANVAS_HEIGHT * CANVAS_WIDTH];
    bool linked[2];
    struct choices choices = {data, data + bytes};
    const char *engine = engines[choose(&choices, 3)];
    const struct sources sources = divide(choices);
    canvas_next();
    if (bytes > BYTES || !render("emulate", &sources, pixels[0], &linked[0]))
        return;
    render(engine, &sources, pixels[1], &linked[1]);
    expect(linked[0] == linked[1], "linked with one of the engines");
    for (unsigned i = 0; i < CANVAS_WIDTH * CANVAS_HEIGHT; i++)
        expect(pixels[0][i] == pixels[1][i], "pixel %u is %08x with emulate, %08x with %s", i, pixels[0][i],
               pixels[1][i], engine);
}

const struct fuzz_target fuzz_program = {"program", run};
