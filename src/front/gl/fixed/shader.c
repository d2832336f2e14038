/* The texts of a key's program. Steps are in the order of chapters 2 and 3 of version 1.1. */
#include "front/gl/fixed.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- Vertices --- */

/* A light: the sum of its parts for a normal, without that of alpha (2.12.1). */
static const char lighting[] =
    "uniform vec3 u_light_ambient[8], u_light_diffuse[8], u_light_specular[8];\n"
    "uniform vec4 u_light_position[8], u_light_spot[8], u_light_fade[8];\n"
    "uniform vec4 u_ambient, u_diffuse, u_specular, u_emission, u_scene;\n"
    "uniform float u_shininess;\n"
    "vec4 ambient, diffuse;\n"
    "vec3 light(vec3 normal, vec3 eye, vec4 position, vec4 spot, vec4 fade, vec3 a, vec3 d, vec3 s)\n"
    "{\n"
    "    vec3 to = position.w == 0.0 ? position.xyz : position.xyz / position.w - eye;\n"
    "    float far = length(to), part = 1.0;\n"
    "    to = far > 0.0 ? to / far : vec3(0.0);\n"
    "    if (position.w != 0.0) {\n"
    "        part = 1.0 / (fade.x + fade.y * far + fade.z * far * far);\n"
    "        if (fade.w >= 0.0) {\n"
    "            float along = -dot(to, spot.xyz);\n"
    "            float power = spot.w == 0.0 ? 1.0 : pow(max(along, 0.0), spot.w);\n"
    "            part = along < fade.w ? 0.0 : part * power;\n"
    "        }\n"
    "    }\n"
    "    float facing = dot(normal, to), shine = 0.0;\n"
    "    if (facing > 0.0) {\n"
    "        float near = max(dot(normal, normalize(to + vec3(0.0, 0.0, 1.0))), 0.0);\n"
    "        shine = u_shininess == 0.0 ? 1.0 : pow(near, u_shininess);\n"
    "    }\n"
    "    return part * (a * ambient.rgb + max(facing, 0.0) * d * diffuse.rgb + shine * s * u_specular.rgb);\n"
    "}\n";

static void put_lights(FILE *out, const struct gl_fixed_key *key)
{
    fprintf(out, "%svec4 lit(vec3 n, vec3 eye)\n{\n", lighting);
    fprintf(out, "    vec3 sum = u_emission.rgb + ambient.rgb * u_scene.rgb;\n");
    for (unsigned i = 0; i < GL_FIXED_LIGHTS; i++)
        if (key->lights >> i & 1)
            fprintf(out,
                    "    sum += light(n, eye, u_light_position[%u], u_light_spot[%u], u_light_fade[%u],\n"
                    "                 u_light_ambient[%u], u_light_diffuse[%u], u_light_specular[%u]);\n",
                    i, i, i, i, i, i);
    fprintf(out, "    return clamp(vec4(sum, diffuse.a), 0.0, 1.0);\n}\n");
}

static void put_color(FILE *out, const struct gl_fixed_key *key)
{
    if (!key->lighting) {
        fprintf(out, "    v_front = clamp(a_color, 0.0, 1.0);\n");
        return;
    }
    fprintf(out, "    vec3 normal = u_normal * a_normal%s;\n", key->rescale ? " * u_rescale" : "");
    if (key->normalize)
        fprintf(out, "    normal = dot(normal, normal) > 0.0 ? normalize(normal) : normal;\n");
    fprintf(out, "    ambient = %s;\n    diffuse = %s;\n", key->color_material ? "a_color" : "u_ambient",
            key->color_material ? "a_color" : "u_diffuse");
    fprintf(out, "    v_front = lit(normal, eye.xyz);\n");
    if (key->two_side)
        fprintf(out, "    v_back = lit(-normal, eye.xyz);\n");
}

static void put_size(FILE *out, const struct gl_fixed_key *key)
{
    fprintf(out,
            "    float far = length(eye.xyz);\n"
            "    float fall = u_distance.x + u_distance.y * far + u_distance.z * far * far;\n"
            "    float size = clamp(%s * inversesqrt(max(fall, 1e-30)), u_sizes.y, u_sizes.z);\n"
            "    gl_PointSize = max(size, 1.0);\n",
            key->size_array ? "a_size" : "u_sizes.x");
}

static bool units_of(const struct gl_fixed_key *key, unsigned unit)
{
    return key->unit[unit].enabled;
}

static void put_varyings(FILE *out, const struct gl_fixed_key *key)
{
    fprintf(out, "varying vec4 v_front;\n");
    if (key->two_side)
        fprintf(out, "varying vec4 v_back;\n");
    fprintf(out, "varying vec3 v_eye;\n");
    for (unsigned i = 0; i < GL_FIXED_UNITS; i++)
        if (units_of(key, i))
            fprintf(out, "varying vec4 v_coordinates%u;\n", i);
}

static char *close_text(FILE *out, char **text)
{
    bool failed = ferror(out);
    if (!fclose(out) && !failed)
        return *text;
    free(*text);
    return NULL;
}

char *gl_fixed_vertex_text(const struct gl_fixed_key *key)
{
    size_t bytes;
    char *text = NULL;
    FILE *out = open_memstream(&text, &bytes);
    if (!out)
        return NULL;
    fprintf(out, "attribute vec4 a_position, a_color;\nattribute vec3 a_normal;\nattribute float a_size;\n"
                 "uniform mat4 u_modelview, u_projection;\nuniform mat3 u_normal;\n"
                 "uniform float u_rescale;\nuniform vec3 u_sizes, u_distance;\n");
    for (unsigned i = 0; i < GL_FIXED_UNITS; i++)
        fprintf(out, "attribute vec4 a_coordinates%u;\nuniform mat4 u_texture%u;\n", i, i);
    put_varyings(out, key);
    if (key->lighting)
        put_lights(out, key);
    fprintf(out, "void main()\n{\n    vec4 eye = u_modelview * a_position;\n"
                 "    gl_Position = u_projection * eye;\n    v_eye = eye.xyz;\n");
    put_color(out, key);
    for (unsigned i = 0; i < GL_FIXED_UNITS; i++)
        if (units_of(key, i))
            fprintf(out, "    v_coordinates%u = u_texture%u * a_coordinates%u;\n", i, i, i);
    if (key->points)
        put_size(out, key);
    fprintf(out, "}\n");
    return close_text(out, &text);
}

/* --- Texture environments (3.7.12) --- */

static void put_texture(FILE *out, const struct gl_fixed_key *key, unsigned i)
{
    if (key->points && key->unit[i].replace)
        fprintf(out, "    vec4 texel%u = texture2D(u_unit%u, gl_PointCoord);\n", i, i);
    else
        fprintf(out, "    vec4 texel%u = texture2DProj(u_unit%u, v_coordinates%u);\n", i, i, i);
}

/* Modes but GL_COMBINE. `f` is the colour so far. A texture without colours leaves them; one
 * without alpha has 1. */
static void put_mode(FILE *out, const struct gl_fixed_unit_key *unit, unsigned i)
{
    static const struct {
        uint16_t mode;
        const char *color, *alpha;
    } modes[] = {
        {GL_REPLACE, "t.rgb", "t.a"},
        {GL_MODULATE, "f.rgb * t.rgb", "f.a * t.a"},
        {GL_DECAL, "mix(f.rgb, t.rgb, t.a)", "f.a"},
        {GL_BLEND, "mix(f.rgb, c.rgb, t.rgb)", "f.a * t.a"},
        {GL_ADD, "min(f.rgb + t.rgb, 1.0)", "f.a * t.a"},
    };
    fprintf(out, "    t = texel%u;\n    c = u_constant%u;\n", i, i);
    for (unsigned m = 0; m < sizeof modes / sizeof *modes; m++)
        if (modes[m].mode == unit->mode)
            fprintf(out, "    f = vec4(%s, %s);\n", unit->color ? modes[m].color : "f.rgb",
                    unit->alpha ? modes[m].alpha : "f.a");
}

static void put_source(FILE *out, const struct gl_fixed_key *key, unsigned i, uint16_t source)
{
    unsigned other = source == GL_TEXTURE ? i : (unsigned)source - GL_TEXTURE0;
    if (source == GL_CONSTANT)
        fprintf(out, "u_constant%u", i);
    else if (source == GL_PRIMARY_COLOR)
        fprintf(out, "primary");
    else if (source == GL_PREVIOUS)
        fprintf(out, "f");
    else if (key->unit[other].enabled)
        fprintf(out, "texel%u", other);
    else
        fprintf(out, "vec4(0.0, 0.0, 0.0, 1.0)");
}

/* The arguments a0 to a2 of a function, as vec3 of colours or float of alpha. */
static void put_arguments(FILE *out, const struct gl_fixed_key *key, unsigned i, unsigned alpha)
{
    const struct gl_fixed_unit_key *unit = &key->unit[i];
    for (unsigned k = 0; k < 3; k++) {
        uint16_t operand = unit->operand[alpha][k];
        bool inverse = operand == GL_ONE_MINUS_SRC_COLOR || operand == GL_ONE_MINUS_SRC_ALPHA;
        bool channel = operand == GL_SRC_ALPHA || operand == GL_ONE_MINUS_SRC_ALPHA;
        fprintf(out, "    %s%u = %s", alpha ? "b" : "a", k, inverse ? "1.0 - " : "");
        put_source(out, key, i, unit->source[alpha][k]);
        fprintf(out, "%s;\n", alpha ? ".a" : channel ? ".aaa" : ".rgb");
    }
}

static const char *function_of(uint16_t combine, bool alpha)
{
    switch (combine) {
    case GL_REPLACE: return alpha ? "b0" : "a0";
    case GL_ADD: return alpha ? "b0 + b1" : "a0 + a1";
    case GL_ADD_SIGNED: return alpha ? "b0 + b1 - 0.5" : "a0 + a1 - 0.5";
    case GL_INTERPOLATE: return alpha ? "mix(b1, b0, b2)" : "mix(a1, a0, a2)";
    case GL_SUBTRACT: return alpha ? "b0 - b1" : "a0 - a1";
    case GL_DOT3_RGB:
    case GL_DOT3_RGBA: return "vec3(4.0 * dot(a0 - 0.5, a1 - 0.5))";
    default: return alpha ? "b0 * b1" : "a0 * a1";
    }
}

static void put_combine(FILE *out, const struct gl_fixed_key *key, unsigned i)
{
    const struct gl_fixed_unit_key *unit = &key->unit[i];
    put_arguments(out, key, i, 0);
    put_arguments(out, key, i, 1);
    fprintf(out, "    a0 = clamp((%s) * %u.0, 0.0, 1.0);\n", function_of(unit->combine[0], false),
            unit->scale[0]);
    fprintf(out, "    b0 = clamp((%s) * %u.0, 0.0, 1.0);\n", function_of(unit->combine[1], true),
            unit->scale[1]);
    fprintf(out, "    f = vec4(a0, %s);\n", unit->combine[0] == GL_DOT3_RGBA ? "a0.r" : "b0");
}

/* --- Fragments --- */

static void put_fog(FILE *out, const struct gl_fixed_key *key)
{
    const char *part = key->fog == GL_LINEAR ? "(u_fog.z - far) * u_fog.w"
                       : key->fog == GL_EXP  ? "exp(-u_fog.x * far)"
                                             : "exp(-u_fog.x * far * u_fog.x * far)";
    fprintf(out,
            "    float far = abs(v_eye.z);\n    f.rgb = mix(u_fog_color.rgb, f.rgb, clamp(%s, 0.0, 1.0));\n",
            part);
}

static void put_declarations(FILE *out, const struct gl_fixed_key *key)
{
    fprintf(out, "precision highp float;\nuniform vec4 u_plane[6], u_fog, u_fog_color;\n");
    put_varyings(out, key);
    for (unsigned i = 0; i < GL_FIXED_UNITS; i++)
        if (units_of(key, i))
            fprintf(out, "uniform sampler2D u_unit%u;\nuniform vec4 u_constant%u;\n", i, i);
}

static void put_units(FILE *out, const struct gl_fixed_key *key)
{
    for (unsigned i = 0; i < GL_FIXED_UNITS; i++)
        if (units_of(key, i))
            put_texture(out, key, i);
    for (unsigned i = 0; i < GL_FIXED_UNITS; i++) {
        if (!units_of(key, i))
            continue;
        if (key->unit[i].mode == GL_COMBINE)
            put_combine(out, key, i);
        else
            put_mode(out, &key->unit[i], i);
    }
}

static const char *primary_of(const struct gl_fixed_key *key)
{
    return key->two_side ? "gl_FrontFacing ? v_front : v_back" : "v_front";
}

char *gl_fixed_fragment_text(const struct gl_fixed_key *key)
{
    size_t bytes;
    char *text = NULL;
    FILE *out = open_memstream(&text, &bytes);
    if (!out)
        return NULL;
    put_declarations(out, key);
    fprintf(out, "void main()\n{\n    vec4 primary = %s, f = primary, t, c;\n", primary_of(key));
    fprintf(out, "    vec3 a0, a1, a2;\n    float b0, b1, b2;\n");
    for (unsigned i = 0; i < GL_FIXED_PLANES; i++)
        if (key->planes >> i & 1)
            fprintf(out, "    if (dot(u_plane[%u], vec4(v_eye, 1.0)) < 0.0)\n        discard;\n", i);
    put_units(out, key);
    if (key->fog)
        put_fog(out, key);
    if (key->alpha_to_one)
        fprintf(out, "    f.a = 1.0;\n");
    fprintf(out, "    gl_FragColor = f%s;\n}\n", key->flat ? " + 0.0 * primary" : "");
    return close_text(out, &text);
}
