/* Calls of OpenGL ES. The first byte chooses the versions of two contexts, and if they share objects. The
 * rest is calls: two bytes that select a command, and its arguments (gles_input.c). Two bytes from 0xff00
 * on change the context. Contexts begin with a program, a texture, a buffer and an array, so that one call is
 * enough for a draw.
 *
 * No call crashes, each error is one of OpenGL's, and a negative size is one. */
#include "front/gl/dispatch/dispatch.h"
#include "front/gl/draw/vertex_array.h"
#include "tests/command/fuzz/targets/gl/canvas.h"
#include "tests/command/fuzz/targets/gl/gles_call.h"
#include "tests/command/fuzz/targets/target.h"

#include <string.h>

enum { CALLS = 120 };

/* --- Commands --- */

#define FIRST(first, ...)  __VA_ARGS__
#define WITHOUT_COMMA(...) FIRST(__VA_ARGS__)
#define ARGUMENT(name)     , a->name
#define DESCRIBE(name)                                                                                       \
    command->offset[command->count] = (uint16_t)((const char *)&a->name - (const char *)a);                  \
    command->bytes[command->count++] = sizeof a->name;
#define MAKE_none(result, name, parameters, arguments)
#define MAKE_own(result, name, parameters, arguments)                                                        \
    static void call_##name(void (*function)(void), const void *structure)                                   \
    {                                                                                                        \
        const struct gles_##name *a = structure;                                                             \
        (void)a;                                                                                             \
        ((result(*) parameters)function)(WITHOUT_COMMA(GLES_EACH(ARGUMENT, GLES_PLAIN arguments)));          \
    }                                                                                                        \
    static void describe_##name(struct gles_command *command)                                                \
    {                                                                                                        \
        static const struct gles_##name none[1];                                                             \
        const struct gles_##name *a = none;                                                                  \
        (void)a, (void)command;                                                                              \
        GLES_EACH(DESCRIBE, GLES_PLAIN arguments)                                                            \
    }
#define GL_COMMAND(state, interfaces, result, name, maker, parameters, arguments)                            \
    MAKE_##state(result, name, parameters, arguments)
#include "front/gl/calls/core.def"
#include "front/gl/calls/extension.def"
#undef GL_COMMAND

#define DECLARATION(declaration) #declaration,
#define ROW_none(interfaces, name, parameters)
#define ROW_own(interfaces, name, parameters)                                                                \
    {{#name,                                                                                                 \
      "gl" #name,                                                                                            \
      interfaces,                                                                                            \
      0,                                                                                                     \
      0,                                                                                                     \
      {GLES_EACH(DECLARATION, GLES_PLAIN parameters)},                                                       \
      {0},                                                                                                   \
      {0},                                                                                                   \
      call_##name},                                                                                          \
     describe_##name},
#define GL_COMMAND(state, interfaces, result, name, maker, parameters, arguments)                            \
    ROW_##state((interfaces), name, parameters)

static struct row {
    struct gles_command command;
    void (*describe)(struct gles_command *);
} rows[] = {
#include "front/gl/calls/core.def"
#include "front/gl/calls/extension.def"
};
#undef GL_COMMAND

enum { ROWS = sizeof rows / sizeof *rows };

static int compare(const void *a, const void *b)
{
    return (int)((const struct row *)a)->command.hash - (int)((const struct row *)b)->command.hash;
}

/* A command is selected by a hash of its name, so that inputs keep their meaning when the tables grow. */
static void prepare_rows(void)
{
    static bool prepared;
    for (unsigned i = 0; i < ROWS && !prepared; i++) {
        uint32_t hash = 0x811c9dc5;
        for (const char *at = rows[i].command.name; *at; at++)
            hash = (hash ^ (uint8_t)*at) * 0x01000193;
        rows[i].command.hash = (uint16_t)((hash ^ hash >> 16) % 0xff00);
        rows[i].describe(&rows[i].command);
        expect(gles_memory_is_known(&rows[i].command), "%s: a pointer without a row of gles_memory.def",
               rows[i].command.symbol);
    }
    if (!prepared)
        qsort(rows, ROWS, sizeof *rows, compare);
    prepared = true;
}

/* The first command whose hash is not less. */
static const struct gles_command *select_command(unsigned hash)
{
    unsigned first = 0, last = ROWS;
    while (first < last) {
        unsigned middle = (first + last) / 2;
        if (rows[middle].command.hash < hash)
            first = middle + 1;
        else
            last = middle;
    }
    return &rows[first % ROWS].command;
}

/* --- Calls --- */

enum { CONTEXTS = 2 };

struct scene {
    struct gles_input input;
    struct canvas canvas[CONTEXTS];
    enum gl_interface interface[CONTEXTS];
    unsigned current;
    bool shared;
};

static GLenum take_error(struct gl_context *gl)
{
    gl_context_enter(gl);
    GLenum error = gl_GetError(gl);
    gl_context_leave(gl);
    expect(error == GL_NO_ERROR || (error >= GL_INVALID_ENUM && error <= GL_INVALID_FRAMEBUFFER_OPERATION),
           "error 0x%x", error);
    return error;
}

/* A negative length of a text is one that ends with a zero. Location -1 has no errors. */
static bool must_fail(const struct gles_command *command, const uint8_t *arguments)
{
    static const char *const exempt[] = {"Label", "Debug", "Marker", "Uniform"};
    for (unsigned i = 0; i < sizeof exempt / sizeof *exempt; i++)
        if (strstr(command->name, exempt[i]))
            return false;
    for (unsigned i = 0; i < command->count; i++) {
        GLsizei size;
        if (strncmp(command->declaration[i], "GLsizei ", 8) || gles_is_pointer(command->declaration[i]))
            continue;
        memcpy(&size, arguments + command->offset[i], sizeof size);
        if (size < 0)
            return true;
    }
    return false;
}

/* Writes to mapped buffers. */
static void write_mapped(struct gles_input *input)
{
    struct gl_context *gl = input->context;
    struct gl_buffer *buffers[2] = {gl->array_buffer, gl->vertex_array->elements};
    for (int i = 0; i < 2; i++)
        if (buffers[i] && buffers[i]->mapped && buffers[i]->access & GL_MAP_WRITE_BIT_EXT)
            memset(buffers[i]->memory + buffers[i]->map_offset, (int)gles_byte(input), buffers[i]->map_bytes);
}

static void count_vertices(struct gles_input *input, const struct gles_command *command,
                           const uint8_t *arguments)
{
    GLsizei count;
    if (strncmp(command->name, "Draw", 4) || !strncmp(command->name, "DrawBuffers", 11))
        return;
    bool arrays = !strcmp(command->name, "DrawArrays");
    memcpy(&count,
           arguments +
               (arrays ? offsetof(struct gles_DrawArrays, count) : offsetof(struct gles_DrawElements, count)),
           sizeof count);
    input->vertices += count > 0 ? (unsigned)count : 0;
}

static void call(struct scene *scene, const struct gles_command *command)
{
    _Alignas(16) uint8_t arguments[GLES_BYTES] = {0};
    struct gles_input *input = &scene->input;
    for (unsigned i = 0; i < command->count; i++)
        if (!gles_is_pointer(command->declaration[i]))
            gles_scalar(input, command->declaration[i], arguments + command->offset[i]);
    if (gles_limit(input, command, arguments) && gles_memory(input, command, arguments)) {
        take_error(input->context);
        command->call((void (*)(void))gl_dispatch_find(command->symbol), arguments);
        GLenum error = take_error(input->context);
        bool exists = command->interfaces & scene->interface[scene->current];
        expect(error || !exists || !must_fail(command, arguments), "%s with a negative size",
               command->symbol);
        count_vertices(input, command, arguments);
    }
    gles_forget(input);
    if (!strncmp(command->name, "Map", 3))
        write_mapped(input);
}

/* --- Contexts --- */

static GLuint compile(struct gl_context *gl, GLenum type, const char *source)
{
    GLuint shader = gl_CreateShader(gl, type);
    gl_ShaderSource(gl, shader, 1, &source, NULL);
    gl_CompileShader(gl, shader);
    return shader;
}

static void make_program(struct gl_context *gl)
{
    GLuint vertex =
        compile(gl, GL_VERTEX_SHADER,
                "attribute vec4 a; attribute vec2 b; varying vec2 t; uniform mat4 m[2];"
                "void main() { t = b; gl_PointSize = 2.0; gl_Position = a + m[1] * vec4(b, 0, 0); }");
    GLuint fragment = compile(gl, GL_FRAGMENT_SHADER,
                              "precision mediump float; varying vec2 t; uniform sampler2D s; uniform vec4 c;"
                              "void main() { gl_FragColor = texture2D(s, t) + c; }");
    GLuint program = gl_CreateProgram(gl);
    gl_AttachShader(gl, program, vertex);
    gl_AttachShader(gl, program, fragment);
    gl_LinkProgram(gl, program);
    gl_UseProgram(gl, program);
}

static void make_objects(const struct scene *scene, struct gl_context *gl, enum gl_interface interface)
{
    static const uint32_t texels[4] = {0xff0000ff, 0xff00ff00, 0x80ff0000, 0x40ffffff};
    gl_context_enter(gl);
    if (interface == GL_ES2)
        make_program(gl);
    gl_BindTexture(gl, GL_TEXTURE_2D, 1);
    gl_TexImage2D(gl, GL_TEXTURE_2D, 0, GL_RGBA, 2, 2, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels);
    gl_TexParameteri(gl, GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    gl_VertexAttribPointer(gl, 0, 4, GL_FLOAT, GL_FALSE, 0, scene->input.client);
    gl_EnableVertexAttribArray(gl, 0);
    gl_BindBuffer(gl, GL_ARRAY_BUFFER, 1);
    gl_BufferData(gl, GL_ARRAY_BUFFER, 256, scene->input.client, GL_STATIC_DRAW);
    gl_context_leave(gl);
}

static void make_context(struct scene *scene, unsigned i, bool share)
{
    canvas_begin(&scene->canvas[i], canvas_device("emulate"), scene->interface[i],
                 share ? &scene->canvas[!i] : NULL);
    make_objects(scene, scene->canvas[i].context, scene->interface[i]);
}

static void use_context(struct scene *scene, unsigned i)
{
    scene->current = i;
    scene->input.context = scene->canvas[i].context;
    gl_dispatch_set(scene->input.context, scene->interface[i]);
}

/* Between calls: another context, a new context, or one without a framebuffer. */
static void change_context(struct scene *scene, unsigned how)
{
    struct canvas *canvas = &scene->canvas[scene->current];
    if (how % 4 < 2) {
        use_context(scene, !scene->current);
    } else if (how % 4 == 2) {
        canvas_end(&scene->canvas[!scene->current]);
        make_context(scene, !scene->current, scene->shared);
    } else {
        struct gl_surface *surface = how & 4 ? &canvas->surface : NULL;
        gl_context_bind(canvas->context, surface, surface);
    }
}

/* Numbers that make triangles. */
static void fill_client(uint8_t *client)
{
    for (unsigned i = 0; i < GLES_CLIENT / sizeof(GLfloat); i++) {
        const GLfloat number = (GLfloat)((int)(i * 7 % 16) - 8) / 8;
        memcpy(client + i * sizeof number, &number, sizeof number);
    }
}

static void run(const uint8_t *data, size_t bytes)
{
    struct scene scene = {.input = {.at = data, .end = data + bytes, .client = malloc(GLES_CLIENT)}};
    unsigned choice = gles_byte(&scene.input);
    prepare_rows();
    expect(scene.input.client, "memory");
    fill_client(scene.input.client);
    scene.interface[0] = choice & 1 ? GL_ES1 : GL_ES2;
    scene.interface[1] = choice & 2 ? GL_ES1 : GL_ES2;
    scene.shared = choice & 4;
    canvas_next();
    make_context(&scene, 0, false);
    make_context(&scene, 1, scene.shared);
    use_context(&scene, 0);
    for (unsigned i = 0; i < CALLS && scene.input.at < scene.input.end; i++) {
        unsigned word = gles_byte(&scene.input);
        word = word << 8 | gles_byte(&scene.input);
        if (word >= 0xff00)
            change_context(&scene, word);
        else
            call(&scene, select_command(word));
    }
    gl_dispatch_set(NULL, 0);
    canvas_end(&scene.canvas[0]);
    canvas_end(&scene.canvas[1]);
    free(scene.input.client);
}

const struct fuzz_target fuzz_gles = {"gles", run};
