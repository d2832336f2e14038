/* The program of a draw of version 1.1, and its uniforms. */
#include "front/gl/commands.h"
#include "front/gl/draw/vertex_array.h"
#include "front/gl/fixed.h"
#include "front/gl/program/program.h"
#include "front/gl/state.h"
#include "front/gl/texture/texture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- Keys --- */

static void key_environment(const struct gl_fixed_environment *from, struct gl_fixed_unit_key *to)
{
    to->mode = (uint16_t)from->mode;
    for (unsigned i = 0; i < 2 && to->mode == GL_COMBINE; i++) {
        to->combine[i] = (uint16_t)from->combine[i];
        to->scale[i] = (uint8_t)from->scale[i];
        for (unsigned k = 0; k < 3; k++) {
            to->source[i][k] = (uint16_t)from->source[i][k];
            to->operand[i][k] = (uint16_t)from->operand[i][k];
        }
    }
}

/* A unit with a texture that is not complete is off. */
static void key_unit(struct gl_context *context, unsigned i, bool sprites, struct gl_fixed_unit_key *to)
{
    struct gl_texture *texture = context->texture[i][GL_DIMENSION_2D];
    if (!context->fixed->texture_2d[i] || !gl_texture_use(context, texture))
        return;
    GLenum format = texture->level[0][0].texel->format;
    to->enabled = true;
    to->color = format != GL_ALPHA;
    to->alpha = texture->level[0][0].texel->alpha > 0;
    to->replace = sprites && context->fixed->environment[i].replace != 0;
    key_environment(&context->fixed->environment[i], to);
}

static uint8_t bits_of(const GLboolean *first, unsigned count)
{
    unsigned bits = 0;
    for (unsigned i = 0; i < count; i++)
        bits |= first[i] ? 1u << i : 0;
    return (uint8_t)bits;
}

static void key_lighting(const struct gl_context *context, GLenum mode, struct gl_fixed_key *key)
{
    const struct gl_values *v = &context->values;
    const GLboolean lights[] = {v->light0[0], v->light1[0], v->light2[0], v->light3[0],
                                v->light4[0], v->light5[0], v->light6[0], v->light7[0]};
    key->lighting = v->lighting[0];
    if (!key->lighting)
        return;
    key->lights = bits_of(lights, GL_FIXED_LIGHTS);
    key->two_side = context->fixed->two_side[0] != 0 && mode >= GL_TRIANGLES;
    key->color_material = v->color_material[0];
    key->normalize = v->normalize[0];
    key->rescale = v->rescale_normal[0] && !v->normalize[0];
}

static void make_key(struct gl_context *context, GLenum mode, struct gl_fixed_key *key)
{
    const struct gl_values *v = &context->values;
    const GLboolean planes[] = {v->plane0[0], v->plane1[0], v->plane2[0],
                                v->plane3[0], v->plane4[0], v->plane5[0]};
    memset(key, 0, sizeof *key);
    key->points = mode == GL_POINTS;
    for (unsigned i = 0; i < GL_FIXED_UNITS; i++)
        key_unit(context, i, key->points && v->point_sprite[0], &key->unit[i]);
    key->fog = v->fog[0] ? (uint16_t)context->fixed->fog_mode[0] : 0;
    key_lighting(context, mode, key);
    key->planes = bits_of(planes, GL_FIXED_PLANES);
    key->size_array = key->points && context->vertex_array->array[GL_FIXED_SIZE].enabled;
    key->flat = !key->points && context->fixed->shade_model[0] == GL_FLAT;
    key->alpha_to_one = v->alpha_to_one[0] && v->multisample[0];
}

/* --- Programs --- */

static GLuint compile(struct gl_context *context, GLenum type, char *text)
{
    GLuint shader = text ? gl_CreateShader(context, type) : 0;
    const GLchar *source = text;
    if (shader) {
        gl_ShaderSource(context, shader, 1, &source, NULL);
        gl_CompileShader(context, shader);
    }
    free(text);
    return shader;
}

static void bind_locations(struct gl_context *context, GLuint program)
{
    char name[] = "a_coordinates0";
    gl_BindAttribLocation(context, program, GL_FIXED_POSITION, "a_position");
    gl_BindAttribLocation(context, program, GL_FIXED_NORMAL, "a_normal");
    gl_BindAttribLocation(context, program, GL_FIXED_COLOR, "a_color");
    gl_BindAttribLocation(context, program, GL_FIXED_SIZE, "a_size");
    for (unsigned i = 0; i < GL_FIXED_UNITS; i++) {
        name[sizeof name - 2] = (char)('0' + i);
        gl_BindAttribLocation(context, program, GL_FIXED_COORDINATES + i, name);
    }
}

/* Each sampler reads the unit of its number. */
static void set_units(struct gl_program *program)
{
    for (unsigned i = 0; i < program->program->uniforms; i++) {
        const struct glsl_uniform *uniform = &program->program->uniform[i];
        if (glsl_is_sampler(uniform->type))
            program->unit[GLSL_FRAGMENT][uniform->stage[GLSL_FRAGMENT].first] =
                (uint8_t)(uniform->name[strlen(uniform->name) - 1] - '0');
    }
}

/* Declares a varying of a stage's text as a colour, over texcoord<i>. Outputs follow position and size. */
static void declare_color(char *text, unsigned stage, unsigned i)
{
    char from[32], to[32];
    unsigned number = stage == GLSL_VERTEX ? i + 2 : i;
    char file = stage == GLSL_VERTEX ? 'o' : 'v';
    int bytes = snprintf(from, sizeof from, "dcl_texcoord%u %c%u\n", i, file, number);
    snprintf(to, sizeof to, "dcl_color%u    %c%u\n", i, file, number);
    char *found = strstr(text, from);
    if (found)
        memcpy(found, to, (size_t)bytes);
}

/* The first varyings are the colours of vertices. As colours of the machine, flat shading concerns them. */
static bool make_flat(struct gl_context *context, struct gl_program *program, unsigned colors)
{
    for (unsigned s = 0; s < GLSL_STAGES; s++) {
        char *text = strdup(program->program->text[s]);
        triptych_shader *stage = NULL;
        enum triptych_result result = TRIPTYCH_NO_MEMORY;
        for (unsigned i = 0; text && i < colors; i++)
            declare_color(text, s, i);
        if (text)
            result = triptych_shader_assemble(context->renderer, s == GLSL_VERTEX ? "vertex" : "fragment",
                                              text, strlen(text), &stage);
        free(text);
        if (result != TRIPTYCH_OK)
            return false;
        triptych_shader_destroy(context->renderer, program->stage[s]);
        program->stage[s] = stage;
    }
    return true;
}

static struct gl_program *make_program(struct gl_context *context, const struct gl_fixed_key *key)
{
    GLuint name = gl_CreateProgram(context);
    GLuint shaders[] = {compile(context, GL_VERTEX_SHADER, gl_fixed_vertex_text(key)),
                        compile(context, GL_FRAGMENT_SHADER, gl_fixed_fragment_text(key))};
    struct gl_program *program = name ? gl_program_find(context, name) : NULL;
    struct gl_program *made = NULL;
    for (unsigned i = 0; i < 2; i++)
        if (program && shaders[i])
            gl_AttachShader(context, name, shaders[i]);
    if (program) {
        bind_locations(context, name);
        gl_LinkProgram(context, name);
        if (program->linked && (!key->flat || make_flat(context, program, 1 + key->two_side)))
            GL_HOLD(&made, program);
    }
    gl_DeleteShader(context, shaders[0]);
    gl_DeleteShader(context, shaders[1]);
    gl_DeleteProgram(context, name);
    if (made)
        set_units(made);
    return made;
}

/* The place of a key: that which has it, or the one that was not used for the longest time. */
static struct gl_fixed_program *find_place(struct gl_fixed *fixed, const struct gl_fixed_key *key)
{
    struct gl_fixed_program *oldest = &fixed->kept[0];
    for (unsigned i = 0; i < GL_FIXED_KEPT; i++) {
        struct gl_fixed_program *place = &fixed->kept[i];
        if (place->program && !memcmp(&place->key, key, sizeof *key))
            return place;
        if (place->used < oldest->used)
            oldest = place;
    }
    GL_HOLD(&oldest->program, NULL);
    return oldest;
}

static bool find_program(struct gl_context *context, const struct gl_fixed_key *key)
{
    struct gl_fixed_program *place = find_place(context->fixed, key);
    if (!place->program) {
        place->program = make_program(context, key);
        place->key = *key;
    }
    place->used = ++context->fixed->draws;
    if (!place->program) {
        gl_error(context, GL_OUT_OF_MEMORY, "no memory for the program of a draw");
        return false;
    }
    if (context->program != place->program) {
        GL_HOLD(&context->program, place->program);
        context->late |= GL_LATE_SHADERS | GL_LATE_PROGRAM | GL_LATE_TEXTURES | GL_LATE_FIXED;
    }
    return true;
}

/* --- Uniforms --- */

static void set_matrices(struct gl_context *context)
{
    const struct gl_fixed *fixed = context->fixed;
    struct gl_program *program = context->program;
    const GLfloat *modelview = gl_fixed_modelview(fixed);
    GLfloat inverse[16], normal[9];
    char name[] = "u_texture0";
    gl_matrix_invert(modelview, inverse);
    for (unsigned i = 0; i < 9; i++)
        normal[i] = inverse[i % 3 * 4 + i / 3];
    GLfloat length = sqrtf(inverse[2] * inverse[2] + inverse[6] * inverse[6] + inverse[10] * inverse[10]);
    GLfloat rescale = length > 0 ? 1 / length : 1;
    gl_uniforms_set(program, "u_modelview", 0, modelview);
    gl_uniforms_set(program, "u_projection", 0, fixed->projection.matrix[fixed->projection.depth]);
    gl_uniforms_set(program, "u_normal", 0, normal);
    gl_uniforms_set(program, "u_rescale", 0, &rescale);
    for (unsigned i = 0; i < GL_FIXED_UNITS; i++) {
        name[sizeof name - 2] = (char)('0' + i);
        gl_uniforms_set(program, name, 0, fixed->texture[i].matrix[fixed->texture[i].depth]);
    }
}

static void set_light(struct gl_program *program, unsigned i, const struct gl_fixed_light *light)
{
    const GLfloat *d = light->direction;
    GLfloat length = sqrtf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), scale = length > 0 ? 1 / length : 0;
    const GLfloat spot[] = {d[0] * scale, d[1] * scale, d[2] * scale, light->exponent};
    const GLfloat cosine = light->cutoff == 90 ? 0 : cosf(light->cutoff * 0.017453292519943295F);
    const GLfloat fade[] = {light->constant, light->linear, light->quadratic,
                            light->cutoff == 180 ? -1 : cosine};
    gl_uniforms_set(program, "u_light_ambient", i, light->ambient);
    gl_uniforms_set(program, "u_light_diffuse", i, light->diffuse);
    gl_uniforms_set(program, "u_light_specular", i, light->specular);
    gl_uniforms_set(program, "u_light_position", i, light->position);
    gl_uniforms_set(program, "u_light_spot", i, spot);
    gl_uniforms_set(program, "u_light_fade", i, fade);
}

static void set_material(struct gl_program *program, const struct gl_fixed *fixed)
{
    gl_uniforms_set(program, "u_ambient", 0, fixed->material.ambient);
    gl_uniforms_set(program, "u_diffuse", 0, fixed->material.diffuse);
    gl_uniforms_set(program, "u_specular", 0, fixed->material.specular);
    gl_uniforms_set(program, "u_emission", 0, fixed->material.emission);
    gl_uniforms_set(program, "u_shininess", 0, &fixed->material.shininess);
    gl_uniforms_set(program, "u_scene", 0, fixed->scene_ambient);
}

static void set_fragments(struct gl_program *program, const struct gl_fixed *fixed)
{
    GLfloat range = fixed->fog_end[0] - fixed->fog_start[0];
    const GLfloat fog[] = {fixed->fog_density[0], fixed->fog_start[0], fixed->fog_end[0],
                           range != 0 ? 1 / range : 0};
    char name[] = "u_constant0";
    gl_uniforms_set(program, "u_fog", 0, fog);
    gl_uniforms_set(program, "u_fog_color", 0, fixed->fog_color);
    for (unsigned i = 0; i < GL_FIXED_PLANES; i++)
        gl_uniforms_set(program, "u_plane", i, fixed->plane[i]);
    for (unsigned i = 0; i < GL_FIXED_UNITS; i++) {
        name[sizeof name - 2] = (char)('0' + i);
        gl_uniforms_set(program, name, 0, fixed->environment[i].color);
    }
}

static void set_uniforms(struct gl_context *context, const struct gl_fixed_key *key)
{
    const struct gl_fixed *fixed = context->fixed;
    struct gl_program *program = context->program;
    const GLfloat most = fixed->point_most[0] < GL_POINT_MOST ? fixed->point_most[0] : GL_POINT_MOST;
    const GLfloat sizes[] = {fixed->point_size[0], fixed->point_least[0], most};
    set_matrices(context);
    for (unsigned i = 0; i < GL_FIXED_LIGHTS; i++)
        if (key->lights >> i & 1)
            set_light(program, i, &fixed->light[i]);
    set_material(program, fixed);
    set_fragments(program, fixed);
    gl_uniforms_set(program, "u_sizes", 0, sizes);
    gl_uniforms_set(program, "u_distance", 0, fixed->point_distance);
    context->late = (context->late & ~(unsigned)GL_LATE_FIXED) | GL_LATE_PROGRAM;
}

/* Sprites are squares, whatever POINT_SMOOTH is. */
static void pass_points(struct gl_context *context)
{
    const struct gl_values *v = &context->values;
    triptych_set_state(context->renderer, TRIPTYCH_STATE_ANTIALIASEDPOINTENABLE,
                       v->point_smooth[0] && !v->point_sprite[0]);
}

bool gl_fixed_prepare(struct gl_context *context, GLenum mode)
{
    struct gl_fixed_key key;
    if (!context->vertex_array->array[GL_FIXED_POSITION].enabled)
        return false;
    make_key(context, mode, &key);
    if (!find_program(context, &key))
        return false;
    if (context->late & GL_LATE_FIXED) {
        set_uniforms(context, &key);
        pass_points(context);
    }
    return true;
}
