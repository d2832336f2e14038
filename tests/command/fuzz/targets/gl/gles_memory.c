/* Memory for the pointers of a call: exactly as large as the command may read or write, by the specification
 * and not by the front end, so that the sanitizer finds every access beyond it. */
#include "front/gl/draw/vertex_array.h"
#include "tests/command/fuzz/targets/gl/gles_call.h"
#include "tests/command/fuzz/targets/target.h"

#include <string.h>

/* --- Sizes --- */

enum { SIDE = 8192 };

static unsigned components(GLenum format)
{
    switch (format) {
    case GL_ALPHA:
    case GL_LUMINANCE:
    case GL_DEPTH_COMPONENT: return 1;
    case GL_LUMINANCE_ALPHA: return 2;
    case GL_RGB: return 3;
    case GL_RGBA:
    case GL_BGRA_EXT: return 4;
    default: return 0;
    }
}

/* The bytes of a pixel; 0 if the type does not exist, which is an error. */
static unsigned pixel_bytes(GLenum format, GLenum type)
{
    switch (type) {
    case GL_UNSIGNED_BYTE: return components(format);
    case GL_UNSIGNED_SHORT:
    case GL_HALF_FLOAT_OES: return 2 * components(format);
    case GL_UNSIGNED_INT:
    case GL_FLOAT: return 4 * components(format);
    case GL_UNSIGNED_SHORT_5_6_5:
    case GL_UNSIGNED_SHORT_4_4_4_4:
    case GL_UNSIGNED_SHORT_5_5_5_1:
    case GL_UNSIGNED_SHORT_4_4_4_4_REV_EXT:
    case GL_UNSIGNED_SHORT_1_5_5_5_REV_EXT: return 2;
    case GL_UNSIGNED_INT_2_10_10_10_REV_EXT:
    case GL_UNSIGNED_INT_24_8_OES: return 4;
    default: return 0;
    }
}

/* Sizes of more bytes than memory has are all equal. */
static int64_t times(int64_t rows, int64_t pitch)
{
    int64_t bytes;
    return __builtin_mul_overflow(rows, pitch, &bytes) || bytes > INT64_MAX / 4 ? INT64_MAX / 4 : bytes;
}

/* The last row has no padding. */
static int64_t rows_bytes(GLint width, GLint height, unsigned pixel, GLint alignment)
{
    int64_t row = (int64_t)width * pixel, pitch = (row + alignment - 1) / alignment * alignment;
    return width <= 0 || height <= 0 ? 0 : times(height - 1, pitch) + row;
}

/* A size that no image has is an error before anything is read. */
static int64_t texels(const struct gl_values *values, GLint width, GLint height, GLenum format, GLenum type)
{
    int64_t pixel = pixel_bytes(format, type), alignment = values->unpack_alignment[0];
    int64_t length = values->unpack_row_length[0] ? values->unpack_row_length[0] : width;
    int64_t pitch = (length * pixel + alignment - 1) / alignment * alignment;
    if (width <= 0 || height <= 0 || width > SIDE || height > SIDE)
        return 0;
    return times(values->unpack_skip_rows[0] + (int64_t)height - 1, pitch) +
           pixel * (values->unpack_skip_pixels[0] + (int64_t)width);
}

/* How many values a parameter of version 1.1 has. */
static int64_t values(GLenum name)
{
    switch (name) {
    case GL_AMBIENT:
    case GL_DIFFUSE:
    case GL_SPECULAR:
    case GL_EMISSION:
    case GL_AMBIENT_AND_DIFFUSE:
    case GL_POSITION:
    case GL_FOG_COLOR:
    case GL_LIGHT_MODEL_AMBIENT:
    case GL_TEXTURE_ENV_COLOR: return 4;
    case GL_SPOT_DIRECTION:
    case GL_POINT_DISTANCE_ATTENUATION: return 3;
    default: return 1;
    }
}

static unsigned index_bits(GLenum type)
{
    return type == GL_UNSIGNED_BYTE ? 8 : type == GL_UNSIGNED_SHORT ? 16 : type == GL_UNSIGNED_INT ? 32 : 0;
}

/* --- Kinds --- */

static uint8_t *take(struct gles_input *input, int64_t bytes)
{
    uint8_t *memory = malloc(bytes > 0 ? (size_t)bytes : 0);
    expect(memory && input->takings < sizeof input->taken / sizeof *input->taken, "memory");
    return input->taken[input->takings++] = memory;
}

void gles_forget(struct gles_input *input)
{
    while (input->takings)
        free(input->taken[--input->takings]);
}

/* Eight bytes of the input, and numbers that follow from them. */
static void fill(struct gles_input *input, uint8_t *memory, int64_t bytes)
{
    uint32_t state = gles_word(input);
    for (int64_t i = 0; i < bytes; i++) {
        memory[i] = (uint8_t)(state >> 8);
        state = i % 4 == 3 ? state * 1664525u + 1013904223u : state >> 8 | state << 24;
    }
}

#define TAKE(kind)                                                                                           \
    static bool take_##kind(struct gles_input *input, int64_t bytes, const void *arguments, void *to)
#define PUT(pointer)                                                                                         \
    do {                                                                                                     \
        const void *put = (pointer);                                                                         \
        (void)arguments, (void)bytes;                                                                        \
        memcpy(to, &put, sizeof put);                                                                        \
        return true;                                                                                         \
    } while (0)

TAKE(OUT)
{
    PUT(take(input, bytes));
}

TAKE(NOTHING)
{
    PUT(gles_byte(input) % 4 ? take(input, bytes) : NULL);
}

TAKE(BYTES)
{
    uint8_t *memory = take(input, bytes);
    fill(input, memory, bytes);
    PUT(memory);
}

TAKE(SOME)
{
    if (gles_byte(input) % 4)
        return take_BYTES(input, bytes, arguments, to);
    PUT(NULL);
}

/* 32-bit values: the first sixteen of the input, which then repeat. */
#define VALUES(kind, type, next)                                                                             \
    TAKE(kind)                                                                                               \
    {                                                                                                        \
        type *memory = (type *)take(input, bytes);                                                           \
        for (int64_t i = 0; i < bytes / 4; i++)                                                              \
            memory[i] = i < 16 ? (type)(next) : memory[i - 16];                                              \
        PUT(memory);                                                                                         \
    }
VALUES(NAMES, GLuint, gles_name(input))
VALUES(NUMBERS, GLfloat, gles_number(input))
VALUES(ENUMERATIONS, GLenum, gles_enumeration(input, gles_byte(input) % 2 ? "param" : "bufs"))

TAKE(TEXT)
{
    PUT(gles_text(input));
}

/* A text of that length, or one that ends with a zero; long ones are cut or refused. */
TAKE(LABEL)
{
    if (bytes < 0)
        return take_TEXT(input, bytes, arguments, to);
    uint8_t *memory = take(input, bytes);
    memset(memory, 'a' + (int)(gles_byte(input) % 26), (size_t)bytes);
    PUT(memory);
}

TAKE(OPAQUE)
{
    PUT((const void *)(uintptr_t)gles_byte(input));
}

/* An array: in the memory of the program, or an offset for a buffer. Draws check it. */
TAKE(ARRAY)
{
    unsigned byte = gles_byte(input);
    if (byte < 128)
        PUT(input->client + byte % 32 * 8);
    if (byte < 192)
        PUT(input->client + GLES_CLIENT - byte);
    PUT((const void *)(intptr_t)(byte < 240 ? gles_integer(input) : 0));
}

/* --- Sources of shaders --- */

static const char *const sources[] = {
    "attribute vec4 a; void main() { gl_Position = a; gl_PointSize = 5.0; }",
    "attribute vec4 a; attribute vec2 b; uniform mat4 m[2]; varying vec2 t;"
    "void main() { t = b; gl_Position = m[1] * a; gl_PointSize = a.z; }",
    "precision mediump float; uniform vec4 c; void main() { gl_FragColor = c; }",
    "precision mediump float; varying vec2 t; uniform sampler2D s[2]; uniform struct { vec3 d; float e; } "
    "l[2];"
    "void main() { gl_FragColor = texture2D(s[1], t) + vec4(l[1].d, l[0].e); }",
    "#extension GL_EXT_draw_buffers : enable\nprecision mediump float; uniform samplerCube s; varying vec2 t;"
    "void main() { gl_FragData[0] = textureCube(s, vec3(t, 1)); gl_FragData[1] = gl_FragCoord; }",
    "precision mediump float; void main() { gl_FragColor = vec4(gl_FrontFacing, gl_PointCoord, 1); }",
    "void main() { gl_Position = vec4(0.5); }",
    "attribute mat4 a; uniform int i; uniform bvec2 b; void main() { gl_Position = a[i] * float(b.x); }",
    "void main() { error }",
    "",
};

enum { SOURCES = sizeof sources / sizeof *sources, STRINGS = 8 };

static const char *chosen[STRINGS];

TAKE(SOURCES)
{
    const char **memory = (const char **)(void *)take(input, bytes);
    if (bytes > STRINGS * (int64_t)sizeof *chosen)
        return false;
    for (int64_t i = 0; i < bytes / (int64_t)sizeof *chosen; i++)
        memory[i] = chosen[i] = sources[gles_byte(input) % SOURCES];
    PUT(memory);
}

TAKE(LENGTHS)
{
    GLint *memory = (GLint *)(void *)take(input, bytes);
    unsigned byte = gles_byte(input);
    for (int64_t i = 0; i < bytes / 4; i++)
        memory[i] = byte % 2 ? -1 : (GLint)(strlen(chosen[i]) >> byte % 4);
    PUT(byte % 4 ? NULL : memory);
}

/* --- Messages --- */

static void GL_APIENTRY receive(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length,
                                const GLchar *message, const void *user)
{
    (void)source, (void)type, (void)id, (void)severity, (void)user;
    expect(length >= 0 && strlen(message) == (size_t)length, "%s", message);
}

TAKE(CALLBACK)
{
    void (*callback)(void) = gles_byte(input) % 4 ? (void (*)(void))receive : NULL;
    (void)bytes, (void)arguments;
    memcpy(to, &callback, sizeof callback);
    return true;
}

/* --- Indices --- */

static uint32_t greatest(const uint8_t *memory, unsigned bits, GLsizei count)
{
    uint32_t most = 0;
    for (GLsizei i = 0; i < count; i++) {
        uint32_t index = 0;
        memcpy(&index, memory + (size_t)i * (bits / 8), bits / 8);
        most = index > most ? index : most;
    }
    return most;
}

static bool may_draw(const struct gles_input *input, const uint8_t *memory, unsigned bits, GLsizei count)
{
    return count + input->vertices <= GLES_VERTICES &&
           gles_arrays_exist(input, greatest(memory, bits, count));
}

/* An offset in the buffer of indices, if there is one; outside of the buffer nothing is drawn. */
static bool take_offset(struct gles_input *input, const struct gl_buffer *elements, int64_t bytes,
                        const struct gles_DrawElements *a, void *to)
{
    size_t offset = (size_t)gles_integer(input);
    const void *put = (const void *)offset;
    bool inside = offset <= elements->bytes && (size_t)bytes <= elements->bytes - offset;
    memcpy(to, &put, sizeof put);
    return !inside || !elements->memory ||
           may_draw(input, elements->memory + offset, index_bits(a->type), a->count);
}

TAKE(INDICES)
{
    const struct gles_DrawElements *a = arguments;
    const struct gl_buffer *elements = input->context->vertex_array->elements;
    if (bytes > 0 && elements)
        return take_offset(input, elements, bytes, a, to);
    uint8_t *memory = take(input, bytes);
    fill(input, memory, bytes);
    for (int64_t i = 0; i < bytes && gles_byte(input) % 4; i++) /* small ones */
        memory[i] = i % (index_bits(a->type) / 8) ? 0 : memory[i] % 32;
    if (bytes > 0 && !may_draw(input, memory, index_bits(a->type), a->count))
        return false;
    PUT(bytes > 0 && !(gles_byte(input) % 16) ? NULL : memory);
}

/* --- Rows --- */

#define VALUES_OF_PIXELS         &input->context->values
#define index_bytes(type, count) (int64_t) index_bits(type) / 8 * (count)
#define pixels(width, height, format, type)                                                                  \
    rows_bytes(width, height, pixel_bytes(format, type), input->context->values.pack_alignment[0])

#define GLES_MEMORY(command, parameter, kind, size)                                                          \
    static bool memory_##command##_##parameter(struct gles_input *input, void *arguments)                    \
    {                                                                                                        \
        struct gles_##command *a = arguments;                                                                \
        int64_t bytes = (size);                                                                              \
        return bytes <= GLES_PATIENCE && take_##kind(input, bytes, a, &a->parameter);                        \
    }
#include "tests/command/fuzz/targets/gl/gles_memory.def"
#undef GLES_MEMORY

static const struct {
    const char *command;
    bool (*take)(struct gles_input *, void *arguments);
} rows[] = {
#define GLES_MEMORY(command, parameter, kind, size) {#command, memory_##command##_##parameter},
#include "tests/command/fuzz/targets/gl/gles_memory.def"
#undef GLES_MEMORY
};

bool gles_is_pointer(const char *declaration)
{
    return strchr(declaration, '*') || !strncmp(declaration, "GLDEBUGPROC", 11) ||
           !strncmp(declaration, "GLeglImage", 10);
}

bool gles_memory_is_known(const struct gles_command *command)
{
    unsigned pointers = 0, known = 0;
    for (unsigned i = 0; i < command->count; i++)
        pointers += gles_is_pointer(command->declaration[i]);
    for (unsigned i = 0; i < sizeof rows / sizeof *rows; i++)
        known += !strcmp(rows[i].command, command->name);
    return known == pointers;
}

bool gles_memory(struct gles_input *input, const struct gles_command *command, void *arguments)
{
    for (unsigned i = 0; i < sizeof rows / sizeof *rows; i++)
        if (!strcmp(rows[i].command, command->name) && !rows[i].take(input, arguments))
            return false;
    return true;
}
