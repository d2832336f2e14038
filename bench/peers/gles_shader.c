#include "gles_shader.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static char text[16384];

static void begin(void)
{
    text[0] = 0;
}

static void add(const char *format, ...) __attribute__((format(printf, 1, 2)));

static void add(const char *format, ...)
{
    size_t used = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text + used, sizeof text - used, format, arguments);
    va_end(arguments);
}

static const char *const vertex_texts[] = {
    [PASS] = "attribute vec4 position; attribute vec2 texcoord; varying vec2 uv;\n"
             "void main() { gl_Position = position; uv = texcoord; }\n",
    [VECTORS] = "attribute vec4 position; attribute vec4 first; attribute vec3 second;\n"
                "varying vec4 a; varying vec3 b;\n"
                "void main() { gl_Position = position; a = first; b = second; }\n",
    [LIT] =
        "attribute vec3 position; attribute vec3 normal;\n"
        "uniform vec4 rows[4]; uniform vec3 turn[3]; uniform vec3 light, diffuse, offset; uniform vec4 "
        "ambient;\n"
        "varying vec4 color;\n"
        "void main() {\n"
        "    vec4 p = vec4(position + offset, 1.0);\n"
        "    gl_Position = vec4(dot(p, rows[0]), dot(p, rows[1]), dot(p, rows[2]), dot(p, rows[3]));\n"
        "    vec3 n = normalize(vec3(dot(normal, turn[0]), dot(normal, turn[1]), dot(normal, turn[2])));\n"
        "    vec3 l = normalize(light - p.xyz);\n"
        "    color = clamp(vec4(diffuse, 0.0) * max(dot(n, l), 0.0) + ambient, 0.0, 1.0);\n"
        "}\n",
    [PLACE] = "attribute vec3 position; uniform vec4 place, row;\n"
              "void main() { gl_Position = vec4(position, 1.0) + place + row; }\n",
};

const char *vertex_text(enum vertex_shader shader)
{
    begin();
    add("%s", vertex_texts[shader]);
    return text;
}

/* `count` dependent multiply-adds of a varying, or of a texel. */
static void add_multiply_add(const char *inputs, const char *first, int count)
{
    add("varying %s; uniform vec4 factor, term;\nvoid main() {\n    vec4 r = %s;\n", inputs, first);
    for (int i = 0; i < count; i++)
        add("    r = r * factor + term;\n");
    add("    gl_FragColor = r;\n}\n");
}

static void add_mix(int count)
{
    add_multiply_add("vec2 uv; uniform sampler2D checker", "texture2D(checker, uv)", count);
}

static void add_normalize(void)
{
    add("varying vec4 a;\nvoid main() {\n    vec3 n = a.xyz;\n");
    for (int i = 0; i < 16; i++)
        add("    n = normalize(vec3(exp2(n.y), sin(n.x), pow(abs(n.z), 1.5)) + a.xyz);\n");
    add("    gl_FragColor = vec4(n * 0.5 + 0.5, 1.0);\n}\n");
}

static const char phong[] =
    "varying vec4 a; varying vec3 b; uniform vec3 light, eye; uniform vec4 diffuse, ambient, specular;\n"
    "void main() {\n"
    "    vec3 n = normalize(a.xyz), l = normalize(light - b), v = normalize(eye - b);\n"
    "    float d = dot(n, l);\n"
    "    float s = pow(max(dot(-reflect(l, n), v), 0.0), 32.0);\n"
    "    gl_FragColor = specular * s + (diffuse * max(d, 0.0) + ambient);\n"
    "}\n";

/* A constant colour times something of a texel. */
static void add_product(const char *factor)
{
    add("varying vec2 uv; uniform sampler2D checker; uniform vec4 constant;\n"
        "void main() { gl_FragColor = constant * %s; }\n",
        factor);
}

static void add_pixel(enum pixel_shader shader, unsigned number)
{
    switch (shader) {
    case CONSTANT: add("uniform vec4 constant;\nvoid main() { gl_FragColor = constant; }\n"); return;
    case TEXTURE:
        add("varying vec2 uv; uniform sampler2D checker;\nvoid main() { gl_FragColor = texture2D(checker, "
            "uv); }\n");
        return;
    case TWO_TEXTURES:
        add("varying vec2 uv; uniform sampler2D checker, gradient;\n"
            "void main() { gl_FragColor = texture2D(checker, uv) * texture2D(gradient, uv); }\n");
        return;
    case MODULATE: add_product("texture2D(checker, uv)"); return;
    case COVERAGE: add_product("texture2D(checker, uv).a"); return;
    case INVERSE: add_product("(1.0 - texture2D(checker, uv).a)"); return;
    case MULTIPLY_ADD: add_multiply_add("vec4 a", "a", 64); return;
    case MIX_4: add_mix(4); return;
    case MIX_16: add_mix(16); return;
    case MIX_64: add_mix(64); return;
    case NORMALIZE: add_normalize(); return;
    case PHONG: add("%s", phong); return;
    case COLOR: add("varying vec4 color;\nvoid main() { gl_FragColor = color; }\n"); return;
    case NEW:
        add("varying vec2 uv; uniform sampler2D checker;\nvoid main() {\n"
            "    vec4 t = texture2D(checker, uv);\n    vec3 c = t.xyz * vec3(%.7f, 0.5, 0.75);\n"
            "    c = t.xyz * dot(c, c) + 1.0;\n    gl_FragColor = vec4(c * 0.5, 1.0);\n}\n",
            0.25 + number * 1e-6);
    }
}

const char *pixel_text(enum pixel_shader shader, unsigned number)
{
    static unsigned count;
    begin();
    add("// %u\nprecision highp float;\n", count++);
    add_pixel(shader, number);
    return text;
}
