/* Draws a lit, textured cube with a vertex shader and a pixel shader, reads the picture and writes it as PNG.
 *
 *   cc cube.c -o cube $(pkg-config --cflags --libs triptych libpng)
 *   ./cube specialize cube.png
 *
 * docs/library.md explains the calls. */
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <triptych.h>

enum { SIDE = 256, TEXTURE_SIDE = 64, FACES = 6, CORNERS = 4 };

struct vertex {
    float position[3], normal[3], texcoord[2];
};

/* Constants c0 to c3 transform to clip space, c4 to c6 turn the normal: one column of a matrix each. */
static const char vertex_shader[] = "vs_2_0\n"
                                    "dcl_position v0\n"
                                    "dcl_normal v1\n"
                                    "dcl_texcoord v2\n"
                                    "dp4 oPos.x, v0, c0\n"
                                    "dp4 oPos.y, v0, c1\n"
                                    "dp4 oPos.z, v0, c2\n"
                                    "dp4 oPos.w, v0, c3\n"
                                    "dp3 oT1.x, v1, c4\n"
                                    "dp3 oT1.y, v1, c5\n"
                                    "dp3 oT1.z, v1, c6\n"
                                    "mov oT0.xy, v2\n";

/* Constant c0 is the direction to the light. A part of the light is ambient. */
static const char pixel_shader[] = "ps_2_0\n"
                                   "def c1, 0.25, 0.75, 0, 0\n"
                                   "dcl t0.xy\n"
                                   "dcl t1.xyz\n"
                                   "dcl_2d s0\n"
                                   "nrm r1.xyz, t1\n"
                                   "dp3_sat r1.x, r1, c0\n"
                                   "mad r1.x, r1.x, c1.y, c1.x\n"
                                   "texld r0, t0, s0\n"
                                   "mul r0.xyz, r0, r1.x\n"
                                   "mov oC0, r0\n";

/* --- Errors --------------------------------------------------------------------------------------------- */

/* Every failed call ends here with its reason, so the calls below need no checks of their own. */
static void report(void *user, enum triptych_log_level level, const char *text)
{
    (void)user;
    fprintf(stderr, "cube: %s\n", text);
    if (level == TRIPTYCH_LOG_ERROR)
        exit(2);
}

static triptych_device *create_device(const char *engine)
{
    const struct triptych_options options = {.engine = engine, .log = report};
    triptych_device *device;
    char reason[512];
    if (triptych_device_create(&options, &device, reason, sizeof reason) == TRIPTYCH_OK)
        return device;
    fprintf(stderr, "cube: %s\n", reason);
    exit(2);
}

/* --- The cube ------------------------------------------------------------------------------------------- */

/* Axis of the normal, its sign, and the axes of the texture coordinates. The order of the corners makes the
 * outer side clockwise, which is the side that is not culled. */
static void set_face(struct vertex corner[CORNERS], int face)
{
    int axis = face / 2, u_axis = (axis + 1) % 3, v_axis = (axis + 2) % 3;
    float sign = face % 2 ? -1 : 1;
    for (int i = 0; i < CORNERS; i++) {
        float u = (float)(i % 2), v = (float)(i / 2);
        memset(&corner[i], 0, sizeof corner[i]);
        corner[i].position[axis] = corner[i].normal[axis] = sign;
        corner[i].position[u_axis] = sign * (2 * u - 1);
        corner[i].position[v_axis] = 2 * v - 1;
        corner[i].texcoord[0] = u;
        corner[i].texcoord[1] = v;
    }
}

static void set_geometry(triptych_device *device)
{
    static const uint16_t order[] = {0, 1, 2, 2, 1, 3};
    static const struct triptych_declaration_element elements[] = {
        {0, offsetof(struct vertex, position), TRIPTYCH_FORMAT_FLOAT3, TRIPTYCH_USAGE_POSITION, 0},
        {0, offsetof(struct vertex, normal), TRIPTYCH_FORMAT_FLOAT3, TRIPTYCH_USAGE_NORMAL, 0},
        {0, offsetof(struct vertex, texcoord), TRIPTYCH_FORMAT_FLOAT2, TRIPTYCH_USAGE_TEXCOORD, 0},
    };
    struct vertex corner[FACES][CORNERS];
    uint16_t index[FACES][6];
    triptych_buffer *vertices, *indices;
    for (int face = 0; face < FACES; face++) {
        set_face(corner[face], face);
        for (int i = 0; i < 6; i++)
            index[face][i] = (uint16_t)(CORNERS * face + order[i]);
    }
    triptych_buffer_create(device, corner, sizeof corner, &vertices);
    triptych_buffer_create(device, index, sizeof index, &indices);
    triptych_set_declaration(device, elements, 3);
    triptych_set_stream(device, 0, vertices, 0, sizeof(struct vertex));
    triptych_set_indices(device, indices, 16);
}

/* A checkerboard with a level for each size, down to one texel. */
static void set_texture(triptych_device *device)
{
    const struct triptych_texture_description description = {
        .type = TRIPTYCH_TEXTURE_2D,
        .format = TRIPTYCH_SURFACE_A8B8G8R8,
        .width = TEXTURE_SIDE,
        .height = TEXTURE_SIDE,
        .depth = 1,
    };
    static uint32_t texel[TEXTURE_SIDE][TEXTURE_SIDE];
    triptych_texture *texture;
    for (int y = 0; y < TEXTURE_SIDE; y++)
        for (int x = 0; x < TEXTURE_SIDE; x++)
            texel[y][x] = (x / 8 + y / 8) % 2 ? 0xff3060e0 : 0xfff0f0f0; /* red is the lowest byte */
    triptych_texture_define(device, &description, &texture);
    triptych_texture_update(device, texture, 0, 0, NULL, texel, sizeof texel[0], 0);
    triptych_texture_generate_mips(device, texture);
    triptych_set_texture(device, 0, texture);
    triptych_set_sampler_state(device, 0, TRIPTYCH_SAMPLER_MINFILTER, TRIPTYCH_FILTER_LINEAR);
    triptych_set_sampler_state(device, 0, TRIPTYCH_SAMPLER_MAGFILTER, TRIPTYCH_FILTER_LINEAR);
    triptych_set_sampler_state(device, 0, TRIPTYCH_SAMPLER_MIPFILTER, TRIPTYCH_FILTER_LINEAR);
}

static void set_shaders(triptych_device *device)
{
    triptych_shader *vertex, *pixel;
    triptych_shader_assemble(device, "vertex", vertex_shader, strlen(vertex_shader), &vertex);
    triptych_shader_assemble(device, "pixel", pixel_shader, strlen(pixel_shader), &pixel);
    triptych_set_vertex_shader(device, vertex);
    triptych_set_pixel_shader(device, pixel);
}

/* --- The camera ----------------------------------------------------------------------------------------- */

static void multiply(double a[4][4], double b[4][4], double product[4][4])
{
    for (int row = 0; row < 4; row++)
        for (int column = 0; column < 4; column++) {
            product[row][column] = 0;
            for (int i = 0; i < 4; i++)
                product[row][column] += a[row][i] * b[i][column];
        }
}

/* A point is a row vector, so a shader multiplies it by the columns of a matrix. */
static void set_columns(triptych_device *device, unsigned first, unsigned count, double matrix[4][4])
{
    float column[4][4];
    for (int i = 0; i < 4; i++)
        for (int row = 0; row < 4; row++)
            column[i][row] = (float)matrix[row][i];
    triptych_set_shader_floats(device, TRIPTYCH_SHADER_VERTEX, first, column[0], count);
}

/* The cube turns about y and x, and lies 5 units in front of the camera. Sines and cosines are 0.6 and 0.8.
 * The near plane is at 1, the far plane at 9. */
static void set_camera(triptych_device *device)
{
    static double about_y[4][4] = {{0.8, 0, -0.6, 0}, {0, 1, 0, 0}, {0.6, 0, 0.8, 0}, {0, 0, 0, 1}};
    static double about_x[4][4] = {{1, 0, 0, 0}, {0, 0.8, -0.6, 0}, {0, 0.6, 0.8, 0}, {0, 0, 0, 1}};
    static double projection[4][4] = {
        {2.6, 0, 0, 0}, {0, 2.6, 0, 0}, {0, 0, 1.125, 1}, {0, 0, 5 * 1.125 - 1.125, 5}};
    static const float to_light[4] = {0.36f, 0.48f, -0.8f, 0};
    double world[4][4], all[4][4];
    multiply(about_y, about_x, world);
    multiply(world, projection, all);
    set_columns(device, 0, 4, all);
    set_columns(device, 4, 3, world);
    triptych_set_shader_floats(device, TRIPTYCH_SHADER_PIXEL, 0, to_light, 1);
}

/* --- The program ---------------------------------------------------------------------------------------- */

static int write_png(const char *path, const uint32_t *pixels)
{
    png_image image = {
        .version = PNG_IMAGE_VERSION, .width = SIDE, .height = SIDE, .format = PNG_FORMAT_RGBA};
    if (png_image_write_to_file(&image, path, 0, pixels, 0, NULL))
        return 0;
    fprintf(stderr, "cube: %s: %s\n", path, image.message);
    return 2;
}

int main(int count, char **arguments)
{
    static const float background[4] = {0.1f, 0.1f, 0.15f, 1};
    static uint32_t pixels[SIDE * SIDE];
    const char *engine = count > 1 ? arguments[1] : "specialize",
               *path = count > 2 ? arguments[2] : "cube.png";
    triptych_device *device = create_device(engine);
    triptych_set_target(device, SIDE, SIDE);
    set_geometry(device);
    set_texture(device);
    set_shaders(device);
    set_camera(device);
    triptych_clear(device, background, 1);
    triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_LIST, 0, 0, 2 * FACES);
    triptych_read_color(device, pixels, sizeof pixels);
    triptych_end_frame(device);
    triptych_device_destroy(device);
    return write_png(path, pixels);
}
