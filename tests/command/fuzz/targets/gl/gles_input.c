/* Arguments that are not pointers, from the bytes of an input. Most are likely ones; some are any number. */
#include "tests/command/fuzz/targets/gl/gles_call.h"

#include <string.h>

unsigned gles_byte(struct gles_input *input)
{
    return input->at < input->end ? *input->at++ : 0;
}

uint32_t gles_word(struct gles_input *input)
{
    uint32_t word = gles_byte(input);
    for (int shift = 8; shift < 32; shift += 8)
        word |= (uint32_t)gles_byte(input) << shift;
    return word;
}

/* --- Enumerations --- */

static const struct {
    const char *parameter;
    GLenum word[72]; /* ends with 0 */
    unsigned count;
} lists[] = {
#define GLES_WORDS(parameter, ...)                                                                           \
    {#parameter, {__VA_ARGS__}, sizeof((const GLenum[]){__VA_ARGS__}) / sizeof(GLenum)},
#include "tests/command/fuzz/targets/gl/gles_word.def"
#undef GLES_WORDS
};

/* One of them has the name of the rows. */
#undef GL_CONSTANT
static const GLenum constants[] = {
#define GL_CONSTANT(value, name) value,
#include "front/gl/calls/constant.def"
#undef GL_CONSTANT
};

/* A byte below 192 is one of the likely values. */
GLenum gles_enumeration(struct gles_input *input, const char *parameter)
{
    unsigned byte = gles_byte(input);
    for (unsigned i = 0; i < sizeof lists / sizeof *lists && byte < 192; i++)
        if (!strcmp(lists[i].parameter, parameter))
            return lists[i].word[byte % lists[i].count];
    if (byte < 240)
        return constants[(byte % 16 << 8 | gles_byte(input)) % (sizeof constants / sizeof *constants)];
    return gles_word(input);
}

/* --- Numbers --- */

GLuint gles_name(struct gles_input *input)
{
    unsigned byte = gles_byte(input);
    return byte < 240 ? byte % 6 : gles_word(input);
}

GLint gles_integer(struct gles_input *input)
{
    static const GLint edges[] = {-1,      -2,      -8,     20,        32,        64,
                                  100,     255,     256,    1000,      4096,      8191,
                                  8192,    8193,    16384,  65535,     65536,     1 << 24,
                                  1 << 28, 1 << 30, -65536, INT32_MAX, INT32_MIN, INT32_MAX - 3};
    unsigned byte = gles_byte(input);
    if (byte < 176)
        return (GLint)(byte % 16);
    return byte < 248 ? edges[byte % (sizeof edges / sizeof *edges)] : (GLint)gles_word(input);
}

GLfloat gles_number(struct gles_input *input)
{
    static const GLfloat edges[] = {1e30F, -1e30F, 1e-30F, 3.4e38F, -3.4e38F, 1024, 8192, -128};
    unsigned byte = gles_byte(input);
    GLfloat number;
    if (byte < 224)
        return (GLfloat)((int)byte % 64 - 24) / 8;
    if (byte < 248)
        return edges[byte % 8];
    uint32_t word = gles_word(input);
    memcpy(&number, &word, sizeof number);
    return number;
}

static GLfixed fixed(struct gles_input *input)
{
    unsigned byte = gles_byte(input);
    return byte < 224 ? ((GLfixed)(byte % 64) - 24) * 8192 : (GLfixed)gles_word(input);
}

/* A size or an offset with as many bits as an address. */
static int64_t size(struct gles_input *input)
{
    unsigned byte = gles_byte(input);
    return byte < 200   ? byte
           : byte < 240 ? gles_integer(input)
                        : (int64_t)((uint64_t)gles_word(input) << (byte % 33));
}

const char *gles_text(struct gles_input *input)
{
    static const char *const texts[] = {
        "a",      "b", "m",        "m[1]", "m[0]", "c",    "s",           "s[0]",
        "l[1].d", "",  "position", "[1]",  "m[",   "m[9]", "gl_Position", "m[99999999999]"};
    return texts[gles_byte(input) % (sizeof texts / sizeof *texts)];
}

/* --- Arguments --- */

static bool is_of(const char *declaration, const char *type)
{
    size_t length = strlen(type);
    return !strncmp(declaration, type, length) && declaration[length] == ' ';
}

/* Sizes of 32 bits and smaller are stored by the bytes of their type. */
void gles_scalar(struct gles_input *input, const char *declaration, void *to)
{
    const char *parameter = strrchr(declaration, ' ') + 1;
    if (is_of(declaration, "GLenum") || is_of(declaration, "GLbitfield"))
        *(GLenum *)to = gles_enumeration(input, parameter);
    else if (is_of(declaration, "GLuint"))
        *(GLuint *)to = gles_name(input);
    else if (is_of(declaration, "GLfloat") || is_of(declaration, "GLclampf"))
        *(GLfloat *)to =
            strcmp(parameter, "param") ? gles_number(input) : (GLfloat)gles_enumeration(input, parameter);
    else if (is_of(declaration, "GLfixed") || is_of(declaration, "GLclampx"))
        *(GLfixed *)to =
            strcmp(parameter, "param") ? fixed(input) : (GLfixed)gles_enumeration(input, parameter);
    else if (is_of(declaration, "GLboolean") || is_of(declaration, "GLubyte"))
        *(GLubyte *)to = (GLubyte)gles_byte(input);
    else if (is_of(declaration, "GLintptr") || is_of(declaration, "GLsizeiptr"))
        *(GLintptr *)to = (GLintptr)size(input);
    else if (!strcmp(parameter, "param") || !strcmp(parameter, "internalformat"))
        *(GLint *)to = (GLint)gles_enumeration(input, parameter);
    else
        *(GLint *)to = gles_integer(input);
}
