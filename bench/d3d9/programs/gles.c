/* A GLES2 program on ANGLE's Direct3D 9 renderer (libEGL.dll and libGLESv2.dll of kivy-deps.angle): lit,
 * textured tori by shaders, a picture drawn to a framebuffer object, mip levels, blending, stencil and
 * scissor. frames.h defines the arguments. */
#include "frames.h"
#include <math.h>
#define EGL_EGLEXT_PROTOTYPES
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES2/gl2.h>

enum { WIDTH = 800, HEIGHT = 600, TARGET = 256, TEXTURE = 128, RINGS = 48, SIDES = 24 };
/* ANGLE's extensions EGL_ANGLE_platform_angle and EGL_ANGLE_platform_angle_d3d. */
enum { PLATFORM_ANGLE = 0x3202, PLATFORM_ANGLE_TYPE = 0x3203, PLATFORM_ANGLE_TYPE_D3D9 = 0x3207 };

static const char vertex_text[] =
    "attribute vec3 position; attribute vec3 normal; attribute vec2 texcoord;"
    "uniform mat4 model; uniform mat4 projection; varying vec3 n; varying vec3 p; varying vec2 uv;"
    "void main() { vec4 world = model * vec4(position, 1.0); p = world.xyz; n = mat3(model) * normal; uv = "
    "texcoord;"
    "  gl_Position = projection * world; }";
static const char lit_text[] =
    "precision highp float; uniform sampler2D picture; uniform vec4 color; uniform vec3 light;"
    "varying vec3 n; varying vec3 p; varying vec2 uv;"
    "void main() { vec3 normal = normalize(n), l = normalize(light - p), r = reflect(-l, normal);"
    "  float d = max(dot(normal, l), 0.0), s = pow(max(dot(r, normalize(-p)), 0.0), 24.0);"
    "  vec4 base = texture2D(picture, uv) * color;"
    "  gl_FragColor = vec4(base.rgb * (0.2 + 0.8 * d) + vec3(0.6 * s), base.a); }";
static const char swirl_text[] =
    "precision highp float; uniform sampler2D picture; uniform vec4 color; uniform vec3 light;"
    "varying vec3 n; varying vec3 p; varying vec2 uv;"
    "void main() { vec2 c = uv - 0.5; float r = length(c), a = light.x * (0.5 - min(r, 0.5)) * 4.0;"
    "  vec2 q = mat2(cos(a), sin(a), -sin(a), cos(a)) * c + 0.5; vec4 sum = vec4(0.0);"
    "  for (int i = -2; i <= 2; i++) sum += texture2D(picture, q + vec2(float(i) * 0.01, 0.0));"
    "  if (r > 0.48) discard;"
    "  gl_FragColor = sum * 0.2 * color; }";

struct program {
    GLuint name;
    GLint model, projection, color, light;
};

struct scene {
    EGLDisplay display;
    EGLSurface surface;
    struct program lit, swirl;
    GLuint torus, torus_indices, square, checker, target, framebuffer, depth;
};

static void fail(const char *what)
{
    fprintf(stderr, "gles: %s (EGL 0x%x)\n", what, eglGetError());
    exit(1);
}

static LRESULT CALLBACK window_procedure(HWND window, UINT message, WPARAM wide, LPARAM parameter)
{
    return DefWindowProcA(window, message, wide, parameter);
}

static HWND open_window(void)
{
    const WNDCLASSA class = {.lpfnWndProc = window_procedure, .lpszClassName = "gles"};
    RegisterClassA(&class);
    return CreateWindowA("gles", "gles", WS_POPUP | WS_VISIBLE, 0, 0, WIDTH, HEIGHT, NULL, NULL, NULL, NULL);
}

static void open_context(struct scene *scene)
{
    static const EGLint platform[] = {PLATFORM_ANGLE_TYPE, PLATFORM_ANGLE_TYPE_D3D9, EGL_NONE};
    static const EGLint wanted[] = {EGL_RED_SIZE,   8, EGL_GREEN_SIZE, 8,  EGL_BLUE_SIZE,    8,
                                    EGL_ALPHA_SIZE, 8, EGL_DEPTH_SIZE, 24, EGL_STENCIL_SIZE, 8,
                                    EGL_NONE};
    static const EGLint version[] = {EGL_CONTEXT_CLIENT_VERSION, 2, EGL_NONE};
    const PFNEGLGETPLATFORMDISPLAYEXTPROC get_display =
        (PFNEGLGETPLATFORMDISPLAYEXTPROC)(void *)eglGetProcAddress("eglGetPlatformDisplayEXT");
    EGLConfig config;
    EGLint count;
    scene->display = get_display(PLATFORM_ANGLE, EGL_DEFAULT_DISPLAY, platform);
    if (!eglInitialize(scene->display, NULL, NULL))
        fail("no display");
    if (!eglChooseConfig(scene->display, wanted, &config, 1, &count) || !count)
        fail("no configuration");
    scene->surface = eglCreateWindowSurface(scene->display, config, open_window(), NULL);
    const EGLContext context = eglCreateContext(scene->display, config, EGL_NO_CONTEXT, version);
    if (!eglMakeCurrent(scene->display, scene->surface, scene->surface, context))
        fail("no context");
    eglSwapInterval(scene->display, 0);
    printf("renderer %s\n", (const char *)glGetString(GL_RENDERER));
}

static GLuint compile(GLenum kind, const char *text)
{
    const GLuint shader = glCreateShader(kind);
    GLint done;
    glShaderSource(shader, 1, &text, NULL);
    glCompileShader(shader);
    glGetShaderiv(shader, GL_COMPILE_STATUS, &done);
    if (!done) {
        char log[2048];
        glGetShaderInfoLog(shader, sizeof log, NULL, log);
        fail(log);
    }
    return shader;
}

static struct program make_program(const char *pixel)
{
    struct program program = {.name = glCreateProgram()};
    GLint done;
    glAttachShader(program.name, compile(GL_VERTEX_SHADER, vertex_text));
    glAttachShader(program.name, compile(GL_FRAGMENT_SHADER, pixel));
    glBindAttribLocation(program.name, 0, "position");
    glBindAttribLocation(program.name, 1, "normal");
    glBindAttribLocation(program.name, 2, "texcoord");
    glLinkProgram(program.name);
    glGetProgramiv(program.name, GL_LINK_STATUS, &done);
    if (!done)
        fail("a program does not link");
    program.model = glGetUniformLocation(program.name, "model");
    program.projection = glGetUniformLocation(program.name, "projection");
    program.color = glGetUniformLocation(program.name, "color");
    program.light = glGetUniformLocation(program.name, "light");
    return program;
}

static GLuint make_buffer(GLenum kind, const void *data, size_t bytes)
{
    GLuint buffer;
    glGenBuffers(1, &buffer);
    glBindBuffer(kind, buffer);
    glBufferData(kind, (GLsizeiptr)bytes, data, GL_STATIC_DRAW);
    return buffer;
}

static void make_torus(struct scene *scene)
{
    static float vertices[(RINGS + 1) * (SIDES + 1)][8];
    static GLushort indices[RINGS * SIDES * 6];
    for (int i = 0; i <= RINGS; i++)
        for (int j = 0; j <= SIDES; j++) {
            const float a = 6.2831853f * (float)i / RINGS, b = 6.2831853f * (float)j / SIDES;
            const float x = cosf(b) * cosf(a), y = cosf(b) * sinf(a), z = sinf(b);
            const float vertex[8] = {cosf(a) + 0.4f * x,      sinf(a) + 0.4f * y,     0.4f * z, x, y, z,
                                     6.0f * (float)i / RINGS, 2.0f * (float)j / SIDES};
            memcpy(vertices[i * (SIDES + 1) + j], vertex, sizeof vertex);
        }
    for (int i = 0; i < RINGS * SIDES; i++) {
        const int first = i / SIDES * (SIDES + 1) + i % SIDES, second = first + SIDES + 1;
        const int corners[6] = {first, second, first + 1, first + 1, second, second + 1};
        for (int corner = 0; corner < 6; corner++)
            indices[6 * i + corner] = (GLushort)corners[corner];
    }
    scene->torus = make_buffer(GL_ARRAY_BUFFER, vertices, sizeof vertices);
    scene->torus_indices = make_buffer(GL_ELEMENT_ARRAY_BUFFER, indices, sizeof indices);
}

static void make_square(struct scene *scene)
{
    static const float corners[4][8] = {{-1, -1, 0, 0, 0, 1, 0, 0},
                                        {1, -1, 0, 0, 0, 1, 1, 0},
                                        {-1, 1, 0, 0, 0, 1, 0, 1},
                                        {1, 1, 0, 0, 0, 1, 1, 1}};
    scene->square = make_buffer(GL_ARRAY_BUFFER, corners, sizeof corners);
}

static GLuint make_texture(int size, const void *texels, GLint minification)
{
    GLuint texture;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, size, size, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, minification);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    return texture;
}

static void make_textures(struct scene *scene)
{
    static unsigned char texels[TEXTURE][TEXTURE][4];
    for (int y = 0; y < TEXTURE; y++)
        for (int x = 0; x < TEXTURE; x++) {
            const int dark = (x / 16 + y / 16) % 2;
            const unsigned char texel[4] = {(unsigned char)(dark ? 60 : 230), (unsigned char)(2 * y),
                                            (unsigned char)(dark ? 200 : 90), 255};
            memcpy(texels[y][x], texel, 4);
        }
    scene->checker = make_texture(TEXTURE, texels, GL_LINEAR_MIPMAP_LINEAR);
    glGenerateMipmap(GL_TEXTURE_2D);
    scene->target = make_texture(TARGET, NULL, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glGenRenderbuffers(1, &scene->depth);
    glBindRenderbuffer(GL_RENDERBUFFER, scene->depth);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT16, TARGET, TARGET);
    glGenFramebuffers(1, &scene->framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, scene->framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, scene->target, 0);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, scene->depth);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        fail("the framebuffer is not complete");
}

static void use_program(const struct program *program, float width_of_height)
{
    /* Depth 1 to 40. */
    const float matrix[16] = {
        1.5f / width_of_height, 0, 0, 0, 0, 1.5f, 0, 0, 0, 0, -41.0f / 39, -1, 0, 0, -80.0f / 39, 0};
    glUseProgram(program->name);
    glUniformMatrix4fv(program->projection, 1, GL_FALSE, matrix);
    glUniform3f(program->light, 4, 5, 2);
}

/* A turn about x and then about y, a scale and a place. */
static void place(const struct program *program, float angle, float scale, float x, float y, float z)
{
    const float c = cosf(angle), s = sinf(angle), d = cosf(0.7f * angle), t = sinf(0.7f * angle);
    const float matrix[16] = {scale * d,
                              0,
                              scale * -t,
                              0,
                              scale * s * t,
                              scale * c,
                              scale * s * d,
                              0,
                              scale * c * t,
                              scale * -s,
                              scale * c * d,
                              0,
                              x,
                              y,
                              z,
                              1};
    glUniformMatrix4fv(program->model, 1, GL_FALSE, matrix);
}

static void bind_vertices(GLuint buffer)
{
    static const int sizes[3] = {3, 3, 2}, offsets[3] = {0, 12, 24};
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    for (GLuint i = 0; i < 3; i++) {
        glEnableVertexAttribArray(i);
        glVertexAttribPointer(i, sizes[i], GL_FLOAT, GL_FALSE, 32, (const void *)(size_t)offsets[i]);
    }
}

static void draw_tori(const struct scene *scene, long frame, int count, float aspect)
{
    use_program(&scene->lit, aspect);
    bind_vertices(scene->torus);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, scene->torus_indices);
    for (int i = 0; i < count; i++) {
        const float turn = 0.02f * (float)frame + 0.9f * (float)i;
        place(&scene->lit, turn, 0.8f, 3.2f * sinf(1.3f * (float)i), 2.2f * cosf(2.1f * (float)i),
              -6 - (float)(i % 5));
        glUniform4f(scene->lit.color, 0.5f + 0.5f * sinf((float)i), 0.9f, 0.5f + 0.5f * cosf((float)i), 1);
        glDrawElements(GL_TRIANGLES, RINGS * SIDES * 6, GL_UNSIGNED_SHORT, NULL);
    }
}

static void draw_target(const struct scene *scene, long frame)
{
    glBindFramebuffer(GL_FRAMEBUFFER, scene->framebuffer);
    glViewport(0, 0, TARGET, TARGET);
    glClearColor(0.1f, 0.15f, 0.3f, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    glBindTexture(GL_TEXTURE_2D, scene->checker);
    draw_tori(scene, -frame, 6, 1);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

/* Squares with the drawn picture, blended, only where the stencil of the tori is 0. */
static void draw_squares(const struct scene *scene, long frame)
{
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glStencilFunc(GL_EQUAL, 0, 0xff);
    glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
    use_program(&scene->swirl, (float)WIDTH / HEIGHT);
    glUniform3f(scene->swirl.light, 1.5f * sinf(0.05f * (float)frame), 0, 0);
    bind_vertices(scene->square);
    glBindTexture(GL_TEXTURE_2D, scene->target);
    for (int i = 0; i < 12; i++) {
        place(&scene->swirl, 0.3f * sinf(0.03f * (float)frame + (float)i), 1.6f, -4.5f + 3 * (float)(i % 4),
              -3 + 3 * (float)(i / 4 % 3), -8.5f);
        glUniform4f(scene->swirl.color, 1, 1, 1, i % 2 ? 0.9f : 0.5f);
        glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    }
    glDisable(GL_BLEND);
}

static void draw_frame(const struct scene *scene, long frame)
{
    draw_target(scene, frame);
    glViewport(0, 0, WIDTH, HEIGHT);
    glClearColor(0.25f, 0.3f, 0.35f, 1);
    glClearStencil(0);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    glEnable(GL_SCISSOR_TEST);
    glScissor(0, 0, WIDTH, 80);
    glClearColor(0.05f, 0.2f, 0.1f, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glDisable(GL_SCISSOR_TEST);
    glEnable(GL_STENCIL_TEST);
    glStencilFunc(GL_ALWAYS, 1, 0xff);
    glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
    glBindTexture(GL_TEXTURE_2D, scene->checker);
    draw_tori(scene, frame, 24, (float)WIDTH / HEIGHT);
    draw_squares(scene, frame);
    glDisable(GL_STENCIL_TEST);
    eglSwapBuffers(scene->display, scene->surface);
}

int main(int count, char **arguments)
{
    struct frames frames = frames_begin(count, arguments);
    struct scene scene = {0};
    open_context(&scene);
    scene.lit = make_program(lit_text);
    scene.swirl = make_program(swirl_text);
    make_torus(&scene);
    make_square(&scene);
    make_textures(&scene);
    for (long frame; (frame = frames_next(&frames)) >= 0;) {
        MSG message;
        while (PeekMessageA(&message, NULL, 0, 0, PM_REMOVE))
            DispatchMessageA(&message);
        draw_frame(&scene, frame);
    }
    eglTerminate(scene.display);
    return 0;
}
