/* A program of OpenGL ES 1.1 for `make programs-gles`: a ring of lit columns on a textured ground in fog, a
 * mirrored ring below a clip plane, a globe with two textures, and blended point sprites. Each frame turns
 * the camera by a fixed angle, so frames do not depend on the time. It ends with its window.
 *
 *   fixed [WIDTH HEIGHT]    the size of the window, 800 x 600 */
#include <EGL/egl.h>
#include <GLES/gl.h>
#include <GLES/glext.h>
#include <X11/Xlib.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIDES = 24, RINGS = 12, COLUMNS = 9, SPRITES = 40, TEXELS = 64 };

struct vertex {
    GLfloat position[3], normal[3], coordinates[2];
};

struct mesh {
    GLuint vertices, indices;
    GLsizei count;
};

static int width = 800, height = 600;
static struct mesh column, globe, ground;
static GLuint checker, stripes, spark;

/* --- Meshes --- */

/* A grid of (SIDES + 1) x (RINGS + 1) vertices that `place` puts somewhere. */
static struct mesh make_mesh(void (*place)(struct vertex *, float u, float v))
{
    static struct vertex vertices[(SIDES + 1) * (RINGS + 1)];
    static GLushort indices[SIDES * RINGS * 6];
    struct mesh mesh = {.count = 0};
    for (int j = 0; j <= RINGS; j++)
        for (int i = 0; i <= SIDES; i++) {
            struct vertex *vertex = &vertices[j * (SIDES + 1) + i];
            vertex->coordinates[0] = (float)i / SIDES;
            vertex->coordinates[1] = (float)j / RINGS;
            place(vertex, vertex->coordinates[0], vertex->coordinates[1]);
        }
    for (int j = 0; j < RINGS; j++)
        for (int i = 0; i < SIDES; i++) {
            const int a = j * (SIDES + 1) + i, b = a + SIDES + 1, corners[6] = {a, a + 1, b, b, a + 1, b + 1};
            for (int k = 0; k < 6; k++)
                indices[mesh.count++] = (GLushort)corners[k];
        }
    glGenBuffers(1, &mesh.vertices);
    glBindBuffer(GL_ARRAY_BUFFER, mesh.vertices);
    glBufferData(GL_ARRAY_BUFFER, sizeof vertices, vertices, GL_STATIC_DRAW);
    glGenBuffers(1, &mesh.indices);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh.indices);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, sizeof indices, indices, GL_STATIC_DRAW);
    return mesh;
}

static void set(GLfloat to[3], float x, float y, float z)
{
    to[0] = x, to[1] = y, to[2] = z;
}

static void place_column(struct vertex *vertex, float u, float v)
{
    const float angle = u * 6.2831853F, radius = 0.3F - 0.08F * sinf(v * 3.1415927F);
    set(vertex->normal, cosf(angle), 0, -sinf(angle));
    set(vertex->position, radius * cosf(angle), 2 * v, -radius * sinf(angle));
}

static void place_globe(struct vertex *vertex, float u, float v)
{
    const float angle = u * 6.2831853F, height = (v - 0.5F) * 3.1415927F;
    set(vertex->normal, cosf(angle) * cosf(height), sinf(height), -sinf(angle) * cosf(height));
    set(vertex->position, 0.7F * vertex->normal[0], 0.7F * vertex->normal[1], 0.7F * vertex->normal[2]);
}

static void place_ground(struct vertex *vertex, float u, float v)
{
    set(vertex->normal, 0, 1, 0);
    set(vertex->position, (u - 0.5F) * 16, 0, (0.5F - v) * 16);
    vertex->coordinates[0] = u * 12;
    vertex->coordinates[1] = v * 12;
}

static void draw_mesh(const struct mesh *mesh)
{
    glBindBuffer(GL_ARRAY_BUFFER, mesh->vertices);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh->indices);
    glVertexPointer(3, GL_FLOAT, sizeof(struct vertex), NULL);
    glNormalPointer(GL_FLOAT, sizeof(struct vertex), (void *)offsetof(struct vertex, normal));
    for (int unit = 1; unit >= 0; unit--) {
        glClientActiveTexture(GL_TEXTURE0 + (GLenum)unit);
        glTexCoordPointer(2, GL_FLOAT, sizeof(struct vertex), (void *)offsetof(struct vertex, coordinates));
    }
    glDrawElements(GL_TRIANGLES, mesh->count, GL_UNSIGNED_SHORT, NULL);
}

/* --- Textures --- */

static GLuint make_texture(GLenum format, int bytes, void (*paint)(unsigned char *, int x, int y))
{
    static unsigned char texels[TEXELS * TEXELS * 4];
    GLuint texture;
    for (int y = 0; y < TEXELS; y++)
        for (int x = 0; x < TEXELS; x++)
            paint(texels + (y * TEXELS + x) * bytes, x, y);
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexParameteri(GL_TEXTURE_2D, GL_GENERATE_MIPMAP, GL_TRUE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTexImage2D(GL_TEXTURE_2D, 0, (GLint)format, TEXELS, TEXELS, 0, format, GL_UNSIGNED_BYTE, texels);
    return texture;
}

static void paint_checker(unsigned char *texel, int x, int y)
{
    const int light = (x / (TEXELS / 2) + y / (TEXELS / 2)) % 2;
    texel[0] = light ? 200 : 90;
    texel[1] = light ? 190 : 70;
    texel[2] = light ? 170 : 60;
}

static void paint_stripes(unsigned char *texel, int x, int y)
{
    texel[0] = (unsigned char)(128 + 127 * ((x + y) / 8 % 2));
    texel[1] = (unsigned char)(255 - y * 2);
    texel[2] = (unsigned char)(x * 4);
}

static void paint_spark(unsigned char *texel, int x, int y)
{
    const float dx = (float)x - TEXELS / 2 + 0.5F, dy = (float)y - TEXELS / 2 + 0.5F;
    const float light = 1 - sqrtf(dx * dx + dy * dy) / (TEXELS / 2);
    *texel = (unsigned char)(255 * (light > 0 ? light : 0));
}

/* --- The scene --- */

static void set_lights(void)
{
    static const GLfloat lamp[] = {0, 3, 0, 1}, sun[] = {0.4F, 0.6F, 0.7F, 0}, down[] = {0, -1, 0},
                         warm[] = {1, 0.8F, 0.5F, 1}, cold[] = {0.3F, 0.35F, 0.5F, 1}, white[] = {1, 1, 1, 1};
    glLightfv(GL_LIGHT0, GL_POSITION, lamp);
    glLightfv(GL_LIGHT0, GL_SPOT_DIRECTION, down);
    glLightf(GL_LIGHT0, GL_SPOT_CUTOFF, 70);
    glLightf(GL_LIGHT0, GL_SPOT_EXPONENT, 2);
    glLightf(GL_LIGHT0, GL_LINEAR_ATTENUATION, 0.1F);
    glLightfv(GL_LIGHT0, GL_DIFFUSE, warm);
    glLightfv(GL_LIGHT0, GL_SPECULAR, white);
    glLightfv(GL_LIGHT1, GL_POSITION, sun);
    glLightfv(GL_LIGHT1, GL_DIFFUSE, cold);
}

static void set_material(float red, float green, float blue)
{
    const GLfloat color[] = {red, green, blue, 1}, shine[] = {0.5F, 0.5F, 0.5F, 1};
    glMaterialfv(GL_FRONT_AND_BACK, GL_AMBIENT_AND_DIFFUSE, color);
    glMaterialfv(GL_FRONT_AND_BACK, GL_SPECULAR, shine);
    glMaterialf(GL_FRONT_AND_BACK, GL_SHININESS, 24);
}

static void draw_columns(void)
{
    glDisable(GL_TEXTURE_2D);
    for (int i = 0; i < COLUMNS; i++) {
        const float hue = (float)i / COLUMNS;
        set_material(0.4F + 0.6F * hue, 0.7F, 1 - 0.6F * hue);
        glPushMatrix();
        glRotatef(360 * hue, 0, 1, 0);
        glTranslatef(3, 0, 0);
        draw_mesh(&column);
        glPopMatrix();
    }
}

/* The second unit adds its texture's colours to those of the first one. */
static void draw_globe(float turn)
{
    set_material(1, 1, 1);
    glActiveTexture(GL_TEXTURE1);
    glEnable(GL_TEXTURE_2D);
    glBindTexture(GL_TEXTURE_2D, checker);
    glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_COMBINE);
    glTexEnvi(GL_TEXTURE_ENV, GL_COMBINE_RGB, GL_ADD_SIGNED);
    glActiveTexture(GL_TEXTURE0);
    glEnable(GL_TEXTURE_2D);
    glBindTexture(GL_TEXTURE_2D, stripes);
    glPushMatrix();
    glTranslatef(0, 1.2F, 0);
    glRotatef(turn, 0.2F, 1, 0);
    draw_mesh(&globe);
    glPopMatrix();
    glActiveTexture(GL_TEXTURE1);
    glDisable(GL_TEXTURE_2D);
    glActiveTexture(GL_TEXTURE0);
}

static void draw_ground(void)
{
    set_material(1, 1, 1);
    glEnable(GL_TEXTURE_2D);
    glBindTexture(GL_TEXTURE_2D, checker);
    glColor4f(1, 1, 1, 1);
    draw_mesh(&ground);
}

/* A fountain of points from memory, each of them a texture. */
static void draw_sprites(int frame)
{
    static const GLfloat attenuation[] = {0, 0, 0.02F};
    GLfloat places[SPRITES][3];
    for (int i = 0; i < SPRITES; i++) {
        const float age = (float)((frame * 2 + i * 7) % 120) / 120, angle = (float)i * 2.4F;
        set(places[i], age * cosf(angle) * 2, 2 + 2 * age - 3.5F * age * age, age * sinf(angle) * 2);
    }
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glDisable(GL_LIGHTING);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE);
    glDepthMask(GL_FALSE);
    glEnable(GL_POINT_SPRITE_OES);
    glTexEnvi(GL_POINT_SPRITE_OES, GL_COORD_REPLACE_OES, GL_TRUE);
    glPointParameterfv(GL_POINT_DISTANCE_ATTENUATION, attenuation);
    glPointSize(30);
    glBindTexture(GL_TEXTURE_2D, spark);
    glColor4f(1, 0.9F, 0.6F, 1);
    glDisableClientState(GL_NORMAL_ARRAY);
    glVertexPointer(3, GL_FLOAT, 0, places);
    glDisableClientState(GL_TEXTURE_COORD_ARRAY);
    glDrawArrays(GL_POINTS, 0, SPRITES);
    glEnableClientState(GL_TEXTURE_COORD_ARRAY);
    glEnableClientState(GL_NORMAL_ARRAY);
    glTexEnvi(GL_POINT_SPRITE_OES, GL_COORD_REPLACE_OES, GL_FALSE);
    glDisable(GL_POINT_SPRITE_OES);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
    glEnable(GL_LIGHTING);
}

/* The objects above the ground, upside down below it. */
static void draw_mirrored(float turn)
{
    static const GLfloat below[] = {0, 1, 0, 0};
    glPushMatrix();
    glScalef(1, -1, 1);
    glClipPlanef(GL_CLIP_PLANE0, below);
    glEnable(GL_CLIP_PLANE0);
    glFrontFace(GL_CW);
    draw_columns();
    draw_globe(turn);
    glFrontFace(GL_CCW);
    glDisable(GL_CLIP_PLANE0);
    glPopMatrix();
}

static void draw(int frame)
{
    const float turn = 40 + 1.5F * (float)frame;
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glLoadIdentity();
    glTranslatef(0, -1, -7);
    glRotatef(20, 1, 0, 0);
    glRotatef(turn, 0, 1, 0);
    set_lights();
    draw_mirrored(turn * 2);
    glEnable(GL_BLEND);
    glBlendFunc(GL_DST_COLOR, GL_SRC_COLOR);
    draw_ground();
    glDisable(GL_BLEND);
    draw_columns();
    draw_globe(turn * 2);
    draw_sprites(frame);
}

static void set_state(void)
{
    static const GLfloat haze[] = {0.16F, 0.18F, 0.24F, 1}, dim[] = {0.2F, 0.2F, 0.25F, 1};
    glViewport(0, 0, width, height);
    glMatrixMode(GL_PROJECTION);
    glFrustumf(-0.8F, 0.8F, -0.6F, 0.6F, 1, 40);
    glMatrixMode(GL_MODELVIEW);
    glClearColor(haze[0], haze[1], haze[2], 1);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_CULL_FACE);
    glEnable(GL_LIGHTING);
    glEnable(GL_LIGHT0);
    glEnable(GL_LIGHT1);
    glEnable(GL_NORMALIZE);
    glLightModelfv(GL_LIGHT_MODEL_AMBIENT, dim);
    glEnable(GL_FOG);
    glFogf(GL_FOG_MODE, GL_EXP2);
    glFogf(GL_FOG_DENSITY, 0.09F);
    glFogfv(GL_FOG_COLOR, haze);
    glEnableClientState(GL_VERTEX_ARRAY);
    glEnableClientState(GL_NORMAL_ARRAY);
    glEnableClientState(GL_TEXTURE_COORD_ARRAY);
    glClientActiveTexture(GL_TEXTURE1);
    glEnableClientState(GL_TEXTURE_COORD_ARRAY);
    column = make_mesh(place_column);
    globe = make_mesh(place_globe);
    ground = make_mesh(place_ground);
    checker = make_texture(GL_RGB, 3, paint_checker);
    stripes = make_texture(GL_RGB, 3, paint_stripes);
    spark = make_texture(GL_ALPHA, 1, paint_spark);
}

/* --- The window --- */

static _Noreturn void fail(const char *reason)
{
    fprintf(stderr, "fixed: %s\n", reason);
    exit(2);
}

static EGLSurface open_window(EGLDisplay *display)
{
    static const EGLint list[] = {EGL_RENDERABLE_TYPE,
                                  EGL_OPENGL_ES_BIT,
                                  EGL_RED_SIZE,
                                  8,
                                  EGL_GREEN_SIZE,
                                  8,
                                  EGL_BLUE_SIZE,
                                  8,
                                  EGL_DEPTH_SIZE,
                                  24,
                                  EGL_NONE},
                        version[] = {EGL_CONTEXT_CLIENT_VERSION, 1, EGL_NONE};
    EGLConfig config;
    EGLint count = 0;
    Display *x11 = XOpenDisplay(NULL);
    if (!x11)
        fail("no X server");
    *display = eglGetDisplay((EGLNativeDisplayType)x11);
    if (!eglInitialize(*display, NULL, NULL) || !eglChooseConfig(*display, list, &config, 1, &count) ||
        !count)
        fail("no config with windows, OpenGL ES 1.1 and depth");
    const Window window =
        XCreateSimpleWindow(x11, DefaultRootWindow(x11), 0, 0, (unsigned)width, (unsigned)height, 0, 0, 0);
    XMapWindow(x11, window);
    XSync(x11, False);
    EGLSurface surface = eglCreateWindowSurface(*display, config, (EGLNativeWindowType)window, NULL);
    EGLContext context = eglCreateContext(*display, config, EGL_NO_CONTEXT, version);
    if (!eglMakeCurrent(*display, surface, surface, context))
        fail("the context cannot be current");
    return surface;
}

int main(int count, char **arguments)
{
    EGLDisplay display;
    if (count > 2) {
        width = atoi(arguments[1]);
        height = atoi(arguments[2]);
    }
    EGLSurface surface = open_window(&display);
    set_state();
    for (int frame = 0;; frame++) {
        draw(frame);
        if (!eglSwapBuffers(display, surface))
            fail("the window has ended");
    }
}
