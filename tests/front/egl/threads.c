/* Two threads with contexts of one share group: both upload, draw, delete, change what is current, and wait
 * for fences of the other one. ThreadSanitizer finds races. */
#include "display.h"

#include "front/gl/types.h"
#include <pthread.h>
#include <stdbool.h>

enum { ROUNDS = 40, SIDE = 8, THREADS = 2, SECOND_NS = 1000000000 };

/* The commands that are called, found before the threads begin. */
#define COMMANDS(COMMAND)                                                                                    \
    COMMAND(ActiveTexture, ACTIVETEXTURE)                                                                    \
    COMMAND(AttachShader, ATTACHSHADER)                                                                      \
    COMMAND(BindAttribLocation, BINDATTRIBLOCATION)                                                          \
    COMMAND(BindBuffer, BINDBUFFER)                                                                          \
    COMMAND(BindFramebuffer, BINDFRAMEBUFFER)                                                                \
    COMMAND(BindTexture, BINDTEXTURE)                                                                        \
    COMMAND(BufferData, BUFFERDATA)                                                                          \
    COMMAND(BufferSubData, BUFFERSUBDATA)                                                                    \
    COMMAND(Clear, CLEAR)                                                                                    \
    COMMAND(ClearColor, CLEARCOLOR)                                                                          \
    COMMAND(CompileShader, COMPILESHADER)                                                                    \
    COMMAND(CreateProgram, CREATEPROGRAM)                                                                    \
    COMMAND(CreateShader, CREATESHADER)                                                                      \
    COMMAND(DeleteBuffers, DELETEBUFFERS)                                                                    \
    COMMAND(DeleteFramebuffers, DELETEFRAMEBUFFERS)                                                          \
    COMMAND(DeleteProgram, DELETEPROGRAM)                                                                    \
    COMMAND(DeleteTextures, DELETETEXTURES)                                                                  \
    COMMAND(DrawArrays, DRAWARRAYS)                                                                          \
    COMMAND(EnableVertexAttribArray, ENABLEVERTEXATTRIBARRAY)                                                \
    COMMAND(Flush, FLUSH)                                                                                    \
    COMMAND(FramebufferTexture2D, FRAMEBUFFERTEXTURE2D)                                                      \
    COMMAND(GenBuffers, GENBUFFERS)                                                                          \
    COMMAND(GenFramebuffers, GENFRAMEBUFFERS)                                                                \
    COMMAND(GenTextures, GENTEXTURES)                                                                        \
    COMMAND(GetError, GETERROR)                                                                              \
    COMMAND(LinkProgram, LINKPROGRAM)                                                                        \
    COMMAND(ReadPixels, READPIXELS)                                                                          \
    COMMAND(ShaderSource, SHADERSOURCE)                                                                      \
    COMMAND(TexImage2D, TEXIMAGE2D)                                                                          \
    COMMAND(TexParameteri, TEXPARAMETERI)                                                                    \
    COMMAND(TexSubImage2D, TEXSUBIMAGE2D)                                                                    \
    COMMAND(UseProgram, USEPROGRAM)                                                                          \
    COMMAND(VertexAttribPointer, VERTEXATTRIBPOINTER)

static struct {
#define MEMBER(name, type) PFNGL##type##PROC name;
    COMMANDS(MEMBER)
#undef MEMBER
} gl;

static EGLConfig config;

/* A thread: its context, its surface, and what it has found. */
struct worker {
    unsigned number;
    EGLContext context;
    EGLSurface surface;
    unsigned wrong; /* pixels, errors and failed calls */
};

static struct worker workers[THREADS];
static GLuint shared_program, shared_texture, shared_buffer;

static const GLfloat corners[4][2] = {{-1, -1}, {1, -1}, {-1, 1}, {1, 1}};

static void count(struct worker *worker, bool good)
{
    worker->wrong += !good;
}

static void make_current(struct worker *worker)
{
    count(worker, egl_MakeCurrent(dpy, worker->surface, worker->surface, worker->context));
}

static GLuint compile(GLenum type, const char *source)
{
    GLuint shader = gl.CreateShader(type);
    gl.ShaderSource(shader, 1, &source, NULL);
    gl.CompileShader(shader);
    return shader;
}

/* Samples the middle of a texture. */
static GLuint make_program(void)
{
    GLuint program = gl.CreateProgram();
    gl.AttachShader(program,
                    compile(GL_VERTEX_SHADER, "attribute vec2 position;"
                                              "void main() { gl_Position = vec4(position, 0, 1); }"));
    gl.AttachShader(program, compile(GL_FRAGMENT_SHADER,
                                     "precision mediump float; uniform sampler2D image;"
                                     "void main() { gl_FragColor = texture2D(image, vec2(0.5)); }"));
    gl.BindAttribLocation(program, 0, "position");
    gl.LinkProgram(program);
    return program;
}

static void make_texture(uint32_t color)
{
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, 1, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE, &color);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
}

/* Draws the bound texture everywhere, from the shared buffer. */
static void draw(void)
{
    gl.UseProgram(shared_program);
    gl.BindBuffer(GL_ARRAY_BUFFER, shared_buffer);
    gl.VertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, NULL);
    gl.EnableVertexAttribArray(0);
    gl.DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

static uint32_t pixel(int x, int y)
{
    uint32_t word = 0;
    gl.ReadPixels(x, y, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, &word);
    return word;
}

void setUp(void)
{
    begin_display();
    config = config_with(EGL_ALPHA_SIZE, 8);
#define FIND(name, type) gl.name = (PFNGL##type##PROC)egl_function_find("gl" #name);
    COMMANDS(FIND)
#undef FIND
    for (unsigned i = 0; i < THREADS; i++)
        workers[i] = (struct worker){.number = i,
                                     .context = context_of(config, i ? workers[0].context : EGL_NO_CONTEXT),
                                     .surface = pbuffer_of(config, SIDE, SIDE)};
    make_current(&workers[0]);
    shared_program = make_program();
    gl.GenTextures(1, &shared_texture);
    gl.BindTexture(GL_TEXTURE_2D, shared_texture);
    make_texture(0);
    gl.GenBuffers(1, &shared_buffer);
    gl.BindBuffer(GL_ARRAY_BUFFER, shared_buffer);
    gl.BufferData(GL_ARRAY_BUFFER, sizeof corners, corners, GL_STATIC_DRAW);
    TEST_ASSERT_EQUAL_HEX(GL_NO_ERROR, gl.GetError());
    egl_ReleaseThread();
}

void tearDown(void)
{
    end_display();
}

static void run_both(void *(*first)(void *), void *(*second)(void *))
{
    pthread_t thread[THREADS];
    void *(*const work[THREADS])(void *) = {first, second};
    for (unsigned i = 0; i < THREADS; i++)
        TEST_ASSERT_EQUAL_INT(0, pthread_create(&thread[i], NULL, work[i], &workers[i]));
    for (unsigned i = 0; i < THREADS; i++)
        pthread_join(thread[i], NULL);
    for (unsigned i = 0; i < THREADS; i++)
        TEST_ASSERT_EQUAL_UINT_MESSAGE(0, workers[i].wrong, i ? "the second thread" : "the first thread");
}

/* --- Objects --- */

/* A texture of the thread, and uploads to the shared texture and the shared buffer. */
static void draw_round(struct worker *worker, uint32_t color)
{
    GLuint own;
    gl.BindTexture(GL_TEXTURE_2D, shared_texture);
    gl.TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, &color);
    gl.BindBuffer(GL_ARRAY_BUFFER, shared_buffer);
    gl.BufferSubData(GL_ARRAY_BUFFER, 0, sizeof corners, corners);
    draw();
    gl.GenTextures(1, &own);
    gl.BindTexture(GL_TEXTURE_2D, own);
    make_texture(color);
    draw();
    count(worker, pixel(SIDE / 2, SIDE / 2) == color);
    gl.DeleteTextures(1, &own);
    count(worker, egl_SwapBuffers(dpy, worker->surface) && gl.GetError() == GL_NO_ERROR);
}

static void *draw_rounds(void *data)
{
    struct worker *worker = data;
    make_current(worker);
    for (uint32_t i = 0; i < ROUNDS; i++)
        draw_round(worker, 0xff000000 | i << 8 | worker->number);
    egl_ReleaseThread();
    return NULL;
}

static void threads_draw_with_shared_objects(void)
{
    run_both(draw_rounds, draw_rounds);
}

/* --- Surfaces and contexts --- */

/* New surfaces and contexts in each round; the old ones are destroyed while they are current. */
static void *change_rounds(void *data)
{
    struct worker *worker = data;
    for (uint32_t i = 0; i < ROUNDS / 2; i++) {
        const EGLint sizes[] = {EGL_WIDTH, 1 + (EGLint)(i % SIDE), EGL_HEIGHT, SIDE, EGL_NONE};
        const EGLint version[] = {EGL_CONTEXT_CLIENT_VERSION, 2, EGL_NONE};
        EGLSurface surface = egl_CreatePbufferSurface(dpy, config, sizes);
        EGLContext context = egl_CreateContext(dpy, config, worker->context, version);
        count(worker, egl_MakeCurrent(dpy, surface, surface, context));
        egl_DestroyContext(dpy, context);
        egl_DestroySurface(dpy, surface);
        gl.BindTexture(GL_TEXTURE_2D, shared_texture);
        draw();
        gl.ClearColor(0, 1, 0, 1);
        gl.Clear(GL_COLOR_BUFFER_BIT);
        count(worker, pixel(0, 0) == 0xff00ff00);
        make_current(worker);
        draw_round(worker, 0xff0000ff);
    }
    egl_ReleaseThread();
    return NULL;
}

static void threads_change_what_is_current(void)
{
    run_both(change_rounds, change_rounds);
}

/* --- Deletion --- */

/* Both threads draw to a texture that the other one may have deleted: a name belongs to its thread. */
static void *attach_rounds(void *data)
{
    struct worker *worker = data;
    GLuint framebuffer;
    make_current(worker);
    gl.GenFramebuffers(1, &framebuffer);
    for (uint32_t i = 0; i < ROUNDS; i++) {
        GLuint target;
        gl.GenTextures(1, &target);
        gl.BindTexture(GL_TEXTURE_2D, target);
        gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, SIDE, SIDE, 0, GL_RGBA, GL_UNSIGNED_BYTE, NULL);
        gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
        gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target, 0);
        gl.ClearColor(1, 0, 1, 1);
        gl.Clear(GL_COLOR_BUFFER_BIT);
        gl.BindTexture(GL_TEXTURE_2D, shared_texture);
        count(worker, pixel(1, 1) == 0xffff00ff);
        draw();
        gl.DeleteTextures(1, &target);
        gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
    }
    gl.DeleteFramebuffers(1, &framebuffer);
    count(worker, gl.GetError() == GL_NO_ERROR);
    egl_ReleaseThread();
    return NULL;
}

static void threads_draw_to_textures_that_they_delete(void)
{
    run_both(attach_rounds, attach_rounds);
}

/* The first thread deletes all shared objects while the second one draws with them. */
static void *delete_shared(void *data)
{
    struct worker *worker = data;
    make_current(worker);
    for (uint32_t i = 0; i < ROUNDS; i++)
        draw_round(worker, 0xff808080);
    gl.DeleteTextures(1, &shared_texture);
    gl.DeleteBuffers(1, &shared_buffer);
    gl.DeleteProgram(shared_program);
    count(worker, gl.GetError() == GL_NO_ERROR);
    egl_ReleaseThread();
    return NULL;
}

/* Bound objects stay until they are no longer bound. */
static void *draw_bound(void *data)
{
    struct worker *worker = data;
    make_current(worker);
    gl.BindTexture(GL_TEXTURE_2D, shared_texture);
    draw();
    for (uint32_t i = 0; i < 2 * ROUNDS; i++) {
        gl.DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
        if (i % 8 == 0)
            count(worker, egl_SwapBuffers(dpy, worker->surface));
    }
    egl_ReleaseThread();
    return NULL;
}

static void bound_objects_can_be_deleted_by_the_other_thread(void)
{
    run_both(delete_shared, draw_bound);
}

/* --- Fences --- */

/* A round's fence, from the first thread to the second, and the answer. */
static struct {
    pthread_mutex_t lock;
    pthread_cond_t changed;
    EGLSync fence;
    unsigned sent, taken;
} channel = {.lock = PTHREAD_MUTEX_INITIALIZER, .changed = PTHREAD_COND_INITIALIZER};

static void wait_for_change(const unsigned *number, unsigned least)
{
    pthread_mutex_lock(&channel.lock);
    while (*number < least)
        pthread_cond_wait(&channel.changed, &channel.lock);
    pthread_mutex_unlock(&channel.lock);
}

static void change(unsigned *number, EGLSync fence)
{
    pthread_mutex_lock(&channel.lock);
    ++*number;
    channel.fence = fence ? fence : channel.fence;
    pthread_cond_signal(&channel.changed);
    pthread_mutex_unlock(&channel.lock);
}

static uint32_t color_of(unsigned round)
{
    return 0xff000000 | round * 5;
}

static void *send_rounds(void *data)
{
    struct worker *worker = data;
    make_current(worker);
    gl.BindTexture(GL_TEXTURE_2D, shared_texture);
    for (unsigned i = 0; i < ROUNDS; i++) {
        const uint32_t color = color_of(i);
        gl.TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, &color);
        draw();
        change(&channel.sent, egl_CreateSync(dpy, EGL_SYNC_FENCE, NULL));
        wait_for_change(&channel.taken, i + 1);
    }
    egl_ReleaseThread();
    return NULL;
}

static void *take_rounds(void *data)
{
    static const EGLTime limits[] = {EGL_FOREVER, 5ull * SECOND_NS, 0};
    struct worker *worker = data;
    make_current(worker);
    for (unsigned i = 0; i < ROUNDS; i++) {
        wait_for_change(&channel.sent, i + 1);
        EGLint result;
        do
            result = egl_ClientWaitSync(dpy, channel.fence, 0, limits[i % 3]);
        while (result == EGL_TIMEOUT_EXPIRED);
        count(worker, result == EGL_CONDITION_SATISFIED);
        count(worker, egl_WaitSync(dpy, channel.fence, 0) && egl_DestroySync(dpy, channel.fence));
        gl.BindTexture(GL_TEXTURE_2D, shared_texture);
        draw();
        count(worker, pixel(3, 3) == color_of(i));
        change(&channel.taken, NULL);
    }
    egl_ReleaseThread();
    return NULL;
}

static void a_thread_waits_for_fences_of_the_other(void)
{
    channel.sent = channel.taken = 0;
    run_both(send_rounds, take_rounds);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(threads_draw_with_shared_objects);
    RUN_TEST(threads_change_what_is_current);
    RUN_TEST(threads_draw_to_textures_that_they_delete);
    RUN_TEST(bound_objects_can_be_deleted_by_the_other_thread);
    RUN_TEST(a_thread_waits_for_fences_of_the_other);
    return UNITY_END();
}
