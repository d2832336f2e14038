/* Lighting and vertex fog on every engine, compared with Direct3D 9's formulas in double: lights of all
 * kinds, highlights, sources of reflectances, and fog by depth and by distance. */
#include "tests/support/picture/canvas.h"
#include "tests/support/picture/shading.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { VERTICES = 48 };

static struct vertex {
    float position[3], normal[3];
    float diffuse[4], specular[4];
} vertex[VERTICES];

void setUp(void)
{
}

void tearDown(void)
{
    shading_close();
}

/* --- Scenes -------------------------------------------------------------------------------------------- */

static float between(double low, double high)
{
    return (float)random_between(low, high);
}

static void randomize(float *values, int count, double low, double high)
{
    for (int i = 0; i < count; i++)
        values[i] = between(low, high);
}

static void bind_vertices(void)
{
    for (int i = 0; i < VERTICES; i++) {
        randomize(vertex[i].position, 3, -2, 2);
        randomize(vertex[i].normal, 3, -1, 1);
        randomize(vertex[i].diffuse, 4, 0, 1);
        randomize(vertex[i].specular, 4, 0, 1);
    }
    shading_bind(TRIPTYCH_POSITION, TRIPTYCH_FORMAT_FLOAT3, vertex[0].position, sizeof *vertex);
    shading_bind(TRIPTYCH_NORMAL, TRIPTYCH_FORMAT_FLOAT3, vertex[0].normal, sizeof *vertex);
    shading_bind(TRIPTYCH_DIFFUSE, TRIPTYCH_FORMAT_FLOAT4, vertex[0].diffuse, sizeof *vertex);
    shading_bind(TRIPTYCH_SPECULAR, TRIPTYCH_FORMAT_FLOAT4, vertex[0].specular, sizeof *vertex);
    shading_varying[VARYING_diffuse] = shading_varying[VARYING_specular] = INTERPOLATION_SMOOTH;
}

static void randomize_light(struct triptych_light *light, enum triptych_light_type type)
{
    *light = (struct triptych_light){.type = type, .range = between(2, 8)};
    randomize(light->diffuse, 4, 0, 0.6);
    randomize(light->ambient, 4, 0, 0.2);
    randomize(light->specular, 4, 0, 0.6);
    randomize(light->position, 3, -3, 3);
    randomize(light->direction, 3, -1, 1);
    randomize(light->attenuation, 3, 0.1, 0.5);
    light->phi = between(1, 3);
    light->theta = random_word() & 1 ? light->phi : between(0, 1);
    light->falloff = random_word() & 1 ? 1 : between(0, 4);
}

static void randomize_scene(void)
{
    static const uint8_t axes[3][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}};
    static const float powers[] = {0, 1, 2.5f, 20, 100};
    struct triptych_material *material = &shading_state.material;
    randomize(material->diffuse, 4, 0, 1);
    randomize(material->ambient, 4, 0, 1);
    randomize(material->emissive, 4, 0, 0.2);
    randomize(material->specular, 4, 0, 1);
    material->power = powers[random_word() % 5];
    SHADING_NUMBER(ambient, random_word() & 0x3f3f3f);
    for (int i = 0; i < TRIPTYCH_LIGHTS; i++) {
        shading_state.light_enabled[i] = random_word() & 1;
        randomize_light(&shading_state.light[i], (enum triptych_light_type)(random_word() % 3));
    }
    for (int t = 0; t < 2; t++) {
        float(*m)[4] = shading_state.transform[t];
        const uint8_t *axis = axes[random_word() % 3];
        memset(m, 0, 16 * sizeof(float));
        for (int i = 0; i < 3; i++) {
            m[i][axis[i]] = random_word() & 1 ? between(0.5, 1.5) : between(-1.5, -0.5);
            m[3][i] = between(-1, 1);
        }
        m[0][axis[1]] += between(-0.4, 0.4);
        m[3][3] = 1;
    }
    SHADING_NUMBER(normalizenormals, random_word() & 1);
    SHADING_NUMBER(localviewer, random_word() & 1);
    SHADING_NUMBER(specularenable, random_word() & 1);
    SHADING_NUMBER(colorvertex, random_word() % 4 != 0);
    SHADING_NUMBER(diffusematerialsource, random_word() % 3);
    SHADING_NUMBER(ambientmaterialsource, random_word() % 3);
    SHADING_NUMBER(specularmaterialsource, random_word() % 3);
    SHADING_NUMBER(emissivematerialsource, random_word() % 3);
}

/* --- The definition ------------------------------------------------------------------------------------ */

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void unit(double v[3])
{
    double length = sqrt(dot(v, v));
    for (int c = 0; c < 3 && length > 0; c++)
        v[c] /= length;
}

/* Multiplies a point (w = 1) or a direction (w = 0) by a matrix. */
static void transformed(const double p[3], double w, enum triptych_transform which, double out[3])
{
    float(*m)[4] = shading_state.transform[which];
    for (int c = 0; c < 3; c++)
        out[c] =
            p[0] * (double)m[0][c] + p[1] * (double)m[1][c] + p[2] * (double)m[2][c] + w * (double)m[3][c];
}

static void widened(const float v[3], double out[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = (double)v[c];
}

static void to_camera(const float position[3], double out[3])
{
    double p[3], world[3];
    widened(position, p);
    transformed(p, 1, TRIPTYCH_TRANSFORM_WORLD, world);
    transformed(world, 1, TRIPTYCH_TRANSFORM_VIEW, out);
}

/* Transforms a normal. If a vector is orthogonal to the normal, the transformed vector is orthogonal to the
 * transformed normal. This gives three equations, which Cramer's rule solves; it is the inverse transpose. */
static void normal_to_camera(const float normal[3], double out[3])
{
    double column[3][3], n[3], cross[3];
    widened(normal, n);
    for (int i = 0; i < 3; i++) {
        double axis[3] = {i == 0, i == 1, i == 2}, world[3];
        transformed(axis, 0, TRIPTYCH_TRANSFORM_WORLD, world);
        transformed(world, 0, TRIPTYCH_TRANSFORM_VIEW, column[i]);
    }
    double determinant = 0;
    for (int c = 0; c < 3; c++)
        out[c] = 0;
    for (int i = 0; i < 3; i++) {
        const double *a = column[(i + 1) % 3], *b = column[(i + 2) % 3];
        for (int c = 0; c < 3; c++)
            cross[c] = a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3];
        determinant = dot(cross, column[i]);
        for (int c = 0; c < 3; c++)
            out[c] += n[i] * cross[c] / determinant;
    }
    if (shading_state.value[TRIPTYCH_STATE_NORMALIZENORMALS])
        unit(out);
}

/* Returns the product of attenuation and cone, and in `to_light` the unit vector to the light. */
static double strength(const struct triptych_light *light, const double position[3], double to_light[3])
{
    double direction[3], at[3], wide[3];
    widened(light->direction, wide);
    transformed(wide, 0, TRIPTYCH_TRANSFORM_VIEW, direction);
    unit(direction);
    for (int c = 0; c < 3; c++)
        to_light[c] = -direction[c];
    if (light->type == TRIPTYCH_LIGHT_DIRECTIONAL)
        return 1;
    widened(light->position, wide);
    transformed(wide, 1, TRIPTYCH_TRANSFORM_VIEW, at);
    for (int c = 0; c < 3; c++)
        to_light[c] = at[c] - position[c];
    double distance = sqrt(dot(to_light, to_light));
    unit(to_light);
    const float *a = light->attenuation;
    double result = distance > (double)light->range
                        ? 0
                        : 1 / ((double)a[0] + (double)a[1] * distance + (double)a[2] * distance * distance);
    if (light->type == TRIPTYCH_LIGHT_POINT)
        return result;
    double cosine = -dot(direction, to_light), inner = cos((double)light->theta / 2);
    double outer = cos((double)light->phi / 2);
    if (cosine > inner)
        return result;
    return cosine <= outer ? 0 : result * pow((cosine - outer) / (inner - outer), (double)light->falloff);
}

static double shine(const double normal[3], const double to_light[3], const double position[3])
{
    double half[3], view[3] = {0, 0, -1};
    if (shading_state.value[TRIPTYCH_STATE_LOCALVIEWER]) {
        for (int c = 0; c < 3; c++)
            view[c] = -position[c];
        unit(view);
    }
    for (int c = 0; c < 3; c++)
        half[c] = view[c] + to_light[c];
    unit(half);
    double cosine = dot(normal, half);
    return dot(normal, to_light) > 0 && cosine > 0 ? pow(cosine, (double)shading_state.material.power) : 0;
}

/* Returns the reflectance from its source: the material or a colour of the vertex. */
static const float *reflectance(enum triptych_state source, const float *material, const struct vertex *v)
{
    if (!shading_state.value[TRIPTYCH_STATE_COLORVERTEX])
        return material;
    const float *const from[3] = {material, v->diffuse, v->specular};
    return from[shading_state.value[source]];
}

static void expected_colors(const struct vertex *v, double diffuse[4], double specular[4])
{
    const struct triptych_material *m = &shading_state.material;
    const float *kd = reflectance(TRIPTYCH_STATE_DIFFUSEMATERIALSOURCE, m->diffuse, v);
    const float *ka = reflectance(TRIPTYCH_STATE_AMBIENTMATERIALSOURCE, m->ambient, v);
    const float *ks = reflectance(TRIPTYCH_STATE_SPECULARMATERIALSOURCE, m->specular, v);
    const float *ke = reflectance(TRIPTYCH_STATE_EMISSIVEMATERIALSOURCE, m->emissive, v);
    double position[3], normal[3];
    to_camera(v->position, position);
    normal_to_camera(v->normal, normal);
    uint32_t scene = shading_state.value[TRIPTYCH_STATE_AMBIENT];
    for (int c = 0; c < 3; c++) {
        diffuse[c] = (double)ke[c] + (double)ka[c] * (scene >> (16 - 8 * c) & 255) / 255;
        specular[c] = 0;
    }
    int lit = 0;
    for (int i = 0; i < TRIPTYCH_LIGHTS; i++) {
        const struct triptych_light *light = &shading_state.light[i];
        double to_light[3], share;
        if (!shading_state.light_enabled[i])
            continue;
        lit = 1;
        share = strength(light, position, to_light);
        double facing = fmax(0, dot(normal, to_light)), glint = shine(normal, to_light, position);
        for (int c = 0; c < 3; c++) {
            diffuse[c] += share * ((double)ka[c] * (double)light->ambient[c] +
                                   (double)kd[c] * (double)light->diffuse[c] * facing);
            specular[c] += share * (double)ks[c] * (double)light->specular[c] * glint;
        }
    }
    int shown = lit && shading_state.value[TRIPTYCH_STATE_SPECULARENABLE];
    diffuse[3] = (double)kd[3];
    specular[3] = shown ? (double)ks[3] : 0;
    for (int c = 0; c < 3 && !shown; c++)
        specular[c] = 0;
}

static double clamped(double value)
{
    return fmin(fmax(value, 0), 1);
}

/* Returns 1 if a cosine of the vertex is near the edge of a highlight or a cone, where rounding decides. */
static int near_an_edge(const struct vertex *v)
{
    double position[3], normal[3], to_light[3], wide[3], direction[3], at[3];
    to_camera(v->position, position);
    normal_to_camera(v->normal, normal);
    for (int i = 0; i < TRIPTYCH_LIGHTS; i++) {
        const struct triptych_light *light = &shading_state.light[i];
        strength(light, position, to_light);
        widened(light->direction, wide);
        transformed(wide, 0, TRIPTYCH_TRANSFORM_VIEW, direction);
        unit(direction);
        widened(light->position, wide);
        transformed(wide, 1, TRIPTYCH_TRANSFORM_VIEW, at);
        double distance =
            sqrt(pow(at[0] - position[0], 2) + pow(at[1] - position[1], 2) + pow(at[2] - position[2], 2));
        double cosine = -dot(direction, to_light);
        if (fabs(cosine - cos((double)light->phi / 2)) < 1e-4 || fabs(dot(normal, to_light)) < 1e-4 ||
            fabs(distance - (double)light->range) < 1e-4)
            return 1;
    }
    return 0;
}

static void check_colors(void)
{
    for (uint32_t i = 0; i < VERTICES; i++) {
        double diffuse[4], specular[4];
        if (near_an_edge(&vertex[i]))
            continue;
        expected_colors(&vertex[i], diffuse, specular);
        for (int c = 0; c < 4; c++) {
            TEST_ASSERT_DOUBLE_WITHIN(2e-5, clamped(diffuse[c]), (double)shaded_slot(SLOT_diffuse + c, i));
            TEST_ASSERT_DOUBLE_WITHIN(2e-5, clamped(specular[c]), (double)shaded_slot(SLOT_specular + c, i));
        }
    }
}

/* --- Tests --------------------------------------------------------------------------------------------- */

static void check_random_scenes(void)
{
    enum { SCENES = 150 };
    bind_vertices();
    for (int i = 0; i < SCENES; i++) {
        randomize_scene();
        shade(VERTICES);
        check_colors();
    }
}

static void test_scenes_are_lit_by_the_formulas(void)
{
    shading_on_every_engine(check_random_scenes);
}

/* Without lighting, a vertex has its own colours. With lighting and without vertex colours, it has those of
 * the material, whatever the sources are. */
static void check_sources_that_are_missing(void)
{
    bind_vertices();
    randomize_scene();
    SHADING_SET(lighting, "false");
    shade(VERTICES);
    for (uint32_t i = 0; i < VERTICES; i++)
        for (int c = 0; c < 4; c++) {
            TEST_ASSERT_EQUAL_FLOAT(vertex[i].diffuse[c], shaded_slot(SLOT_diffuse + c, i));
            TEST_ASSERT_EQUAL_FLOAT(vertex[i].specular[c], shaded_slot(SLOT_specular + c, i));
        }
    SHADING_SET(lighting, "true");
    SHADING_SET(colorvertex, "true");
    SHADING_SET(diffusematerialsource, "color1");
    SHADING_SET(ambientmaterialsource, "color2");
    shading_bind(TRIPTYCH_DIFFUSE, TRIPTYCH_FORMAT_NONE, NULL, 0);
    shading_bind(TRIPTYCH_SPECULAR, TRIPTYCH_FORMAT_NONE, NULL, 0);
    shade(VERTICES);
    TEST_ASSERT_EQUAL_INT(REFLECTANCE_MATERIAL, shading_key[UNIT_VERTEX].vertex.reflectance[0]);
    TEST_ASSERT_EQUAL_INT(REFLECTANCE_MATERIAL, shading_key[UNIT_VERTEX].vertex.reflectance[1]);
    TEST_ASSERT_EQUAL_FLOAT(shading_state.material.diffuse[3], shaded_slot(SLOT_diffuse + 3, 0));
}

static void test_a_colour_that_is_missing_is_the_materials(void)
{
    shading_on_every_engine(check_sources_that_are_missing);
}

static double fog_distance(const struct vertex *v)
{
    double p[3];
    to_camera(v->position, p);
    return shading_state.value[TRIPTYCH_STATE_RANGEFOGENABLE] ? sqrt(dot(p, p)) : fabs(p[2]);
}

static void check_fog_mode(const char *mode, double start, double end, double density)
{
    SHADING_SET(fogvertexmode, mode);
    shading_state.value[TRIPTYCH_STATE_FOGSTART] = bits_of_float((float)start);
    shading_state.value[TRIPTYCH_STATE_FOGEND] = bits_of_float((float)end);
    shading_state.value[TRIPTYCH_STATE_FOGDENSITY] = bits_of_float((float)density);
    shade(VERTICES);
    for (uint32_t i = 0; i < VERTICES; i++) {
        double d = fog_distance(&vertex[i]), expected = (double)vertex[i].specular[3];
        if (!strcmp(mode, "linear"))
            expected = start != end ? (end - d) / (end - start) : 0;
        else if (!strcmp(mode, "exp"))
            expected = exp(-d * density);
        else if (!strcmp(mode, "exp2"))
            expected = exp(-d * density * d * density);
        TEST_ASSERT_DOUBLE_WITHIN(4e-6, clamped(expected), (double)shaded_slot(SLOT_fog, i));
    }
}

static void check_fog(void)
{
    static const char *const modes[] = {"none", "linear", "exp", "exp2"};
    bind_vertices();
    shading_varying[VARYING_fog] = INTERPOLATION_SMOOTH;
    for (int i = 0; i < 40; i++) {
        randomize_scene();
        SHADING_NUMBER(rangefogenable, i & 1);
        check_fog_mode(modes[i / 2 % 4], 0.5 + i % 5, i % 3 + 2, 0.125 * (i % 7));
    }
    check_fog_mode("linear", 1.5, 1.5, 1);
    check_fog_mode("linear", 3, 0.5, 1);
}

static void test_fog_follows_its_formulas(void)
{
    shading_on_every_engine(check_fog);
}

/* A vertex in window coordinates has its fog factor in its specular alpha. Its colours are not changed. */
static void check_window_fog(void)
{
    bind_vertices();
    shading_varying[VARYING_fog] = INTERPOLATION_SMOOTH;
    randomize_scene();
    SHADING_SET(fogvertexmode, "exp");
    shading_bind(TRIPTYCH_POSITIONT, TRIPTYCH_FORMAT_FLOAT4, vertex, sizeof *vertex);
    shade(VERTICES);
    for (uint32_t i = 0; i < VERTICES; i++) {
        TEST_ASSERT_EQUAL_FLOAT(vertex[i].specular[3], shaded_slot(SLOT_fog, i));
        for (int c = 0; c < 4; c++)
            TEST_ASSERT_EQUAL_FLOAT(vertex[i].diffuse[c], shaded_slot(SLOT_diffuse + c, i));
    }
}

static void test_vertices_in_window_coordinates_have_their_own_fog(void)
{
    shading_on_every_engine(check_window_fog);
}

/* If 1 / (a0 + d (a1 + d a2)) divides by zero, a light has the largest brightness. It saturates surfaces that
 * face it, and does not change the effect of other lights. */
static void check_lights_without_attenuation(float a1, float x, float y, float z)
{
    struct triptych_light *sun = &shading_state.light[0], *lamp = &shading_state.light[1];
    bind_vertices();
    *sun = (struct triptych_light){.type = TRIPTYCH_LIGHT_DIRECTIONAL, .diffuse = {0.5f, 0.25f, 0.125f, 0}};
    *lamp = (struct triptych_light){
        .type = TRIPTYCH_LIGHT_POINT, .diffuse = {1, 0, 0, 0}, .specular = {1, 0, 0, 0}, .range = 100};
    sun->direction[2] = 1;
    lamp->attenuation[1] = a1;
    shading_state.light_enabled[0] = shading_state.light_enabled[1] = 1;
    vertex[0] = (struct vertex){{0, 0, 4}, {0, 0, -1}, {1, 1, 1, 1}, {1, 1, 1, 1}};
    lamp->position[0] = x;
    lamp->position[1] = y;
    lamp->position[2] = z;
    SHADING_SET(specularenable, "true");
    shade(1);
    float red = z < 4 ? 1 : 0.5f, glint = z < 4 ? 1 : 0;
    TEST_ASSERT_EQUAL_FLOAT(red, shaded_slot(SLOT_diffuse, 0));
    TEST_ASSERT_EQUAL_FLOAT(0.25f, shaded_slot(SLOT_diffuse + 1, 0));
    TEST_ASSERT_EQUAL_FLOAT(0.125f, shaded_slot(SLOT_diffuse + 2, 0));
    TEST_ASSERT_EQUAL_FLOAT(glint, shaded_slot(SLOT_specular, 0));
    TEST_ASSERT_EQUAL_FLOAT(0, shaded_slot(SLOT_specular + 1, 0));
}

static void check_attenuation_of_zero(void)
{
    check_lights_without_attenuation(0, 1, 2, 0); /* in front of the vertex */
    check_lights_without_attenuation(0, 1, 2, 8); /* behind the surface */
    check_lights_without_attenuation(1, 0, 0, 4); /* where it is */
}

static void test_lights_without_attenuation_leave_others_alone(void)
{
    shading_on_every_engine(check_attenuation_of_zero);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_scenes_are_lit_by_the_formulas);
    RUN_TEST(test_a_colour_that_is_missing_is_the_materials);
    RUN_TEST(test_lights_without_attenuation_leave_others_alone);
    RUN_TEST(test_fog_follows_its_formulas);
    RUN_TEST(test_vertices_in_window_coordinates_have_their_own_fog);
    return UNITY_END();
}
