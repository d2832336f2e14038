/* Contexts: their creation, what is current, threads, and pixels. */
#include "display.h"

#include "front/gl/types.h"
#include <pthread.h>

static EGLConfig config;

void setUp(void)
{
    begin_display();
    config = config_with(EGL_ALPHA_SIZE, 8);
}

void tearDown(void)
{
    end_display();
}

static void clear(float red, float green, float blue)
{
    ((PFNGLCLEARCOLORPROC)egl_function_find("glClearColor"))(red, green, blue, 1);
    ((PFNGLCLEARPROC)egl_function_find("glClear"))(GL_COLOR_BUFFER_BIT);
}

static uint32_t pixel(int x, int y)
{
    uint32_t word = 0;
    ((PFNGLREADPIXELSPROC)egl_function_find("glReadPixels"))(x, y, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, &word);
    return word;
}

static void a_clear_reaches_the_pixels_of_the_surface(void)
{
    EGLSurface surface = pbuffer_of(config, 5, 3);
    EGLContext context = context_of(config, EGL_NO_CONTEXT);
    TEST_ASSERT_TRUE(egl_MakeCurrent(dpy, surface, surface, context));
    clear(1, 0, 1);
    TEST_ASSERT_EQUAL_HEX32(0xffff00ff, pixel(4, 2));
    TEST_ASSERT_TRUE(egl_SwapBuffers(dpy, surface));
}

static void a_context_draws_to_the_surface_that_is_bound(void)
{
    EGLSurface one = pbuffer_of(config, 4, 4), two = pbuffer_of(config, 4, 4);
    EGLContext context = context_of(config, EGL_NO_CONTEXT), other = context_of(config, EGL_NO_CONTEXT);
    TEST_ASSERT_TRUE(egl_MakeCurrent(dpy, one, one, context));
    clear(1, 0, 0);
    TEST_ASSERT_TRUE(egl_MakeCurrent(dpy, two, two, other));
    clear(0, 1, 0);
    TEST_ASSERT_EQUAL_HEX32(0xff00ff00, pixel(0, 0));
    TEST_ASSERT_TRUE(egl_MakeCurrent(dpy, two, one, context));
    TEST_ASSERT_EQUAL_HEX32(0xff0000ff, pixel(0, 0));
}

static void what_is_current_can_be_queried(void)
{
    EGLSurface draw = pbuffer_of(config, 4, 4), read = pbuffer_of(config, 4, 4);
    EGLContext context = context_of(config, EGL_NO_CONTEXT);
    EGLint value;
    TEST_ASSERT_NULL(egl_GetCurrentContext());
    TEST_ASSERT_TRUE(egl_MakeCurrent(dpy, draw, read, context));
    TEST_ASSERT_EQUAL_PTR(context, egl_GetCurrentContext());
    TEST_ASSERT_EQUAL_PTR(dpy, egl_GetCurrentDisplay());
    TEST_ASSERT_EQUAL_PTR(draw, egl_GetCurrentSurface(EGL_DRAW));
    TEST_ASSERT_EQUAL_PTR(read, egl_GetCurrentSurface(EGL_READ));
    FAILS(EGL_BAD_PARAMETER, egl_GetCurrentSurface(EGL_WIDTH));
    TEST_ASSERT_TRUE(egl_QueryContext(dpy, context, EGL_RENDER_BUFFER, &value));
    TEST_ASSERT_EQUAL_INT(EGL_BACK_BUFFER, value);
    TEST_ASSERT_TRUE(egl_QueryContext(dpy, context, EGL_CONTEXT_CLIENT_VERSION, &value));
    TEST_ASSERT_EQUAL_INT(2, value);
    TEST_ASSERT_TRUE(egl_ReleaseThread());
    TEST_ASSERT_NULL(egl_GetCurrentContext());
    TEST_ASSERT_TRUE(egl_QueryContext(dpy, context, EGL_RENDER_BUFFER, &value));
    TEST_ASSERT_EQUAL_INT(EGL_NONE, value);
}

static void a_context_without_surfaces_can_be_current(void)
{
    EGLContext context = context_of(EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT);
    EGLint value = -1;
    TEST_ASSERT_TRUE(egl_MakeCurrent(dpy, EGL_NO_SURFACE, EGL_NO_SURFACE, context));
    TEST_ASSERT_NULL(egl_GetCurrentSurface(EGL_DRAW));
    TEST_ASSERT_TRUE(egl_QueryContext(dpy, context, EGL_CONFIG_ID, &value));
    TEST_ASSERT_EQUAL_INT(0, value);
    FAILS(EGL_BAD_SURFACE, egl_SwapInterval(dpy, 1));
}

static void what_does_not_belong_together_is_refused(void)
{
    EGLSurface surface = pbuffer_of(config, 4, 4);
    EGLSurface other = pbuffer_of(config_with(EGL_SAMPLES, 4), 4, 4);
    EGLContext context = context_of(config, EGL_NO_CONTEXT);
    FAILS(EGL_BAD_MATCH, egl_MakeCurrent(dpy, surface, surface, EGL_NO_CONTEXT));
    FAILS(EGL_BAD_MATCH, egl_MakeCurrent(dpy, surface, EGL_NO_SURFACE, context));
    FAILS(EGL_BAD_MATCH, egl_MakeCurrent(dpy, other, other, context));
    FAILS(EGL_BAD_SURFACE, egl_MakeCurrent(dpy, context, context, context));
    FAILS(EGL_BAD_CONTEXT, egl_MakeCurrent(dpy, surface, surface, surface));
    TEST_ASSERT_NULL(egl_GetCurrentContext());
}

static void destroyed_objects_stay_current(void)
{
    EGLSurface surface = pbuffer_of(config, 4, 4);
    EGLContext context = context_of(config, EGL_NO_CONTEXT);
    TEST_ASSERT_TRUE(egl_MakeCurrent(dpy, surface, surface, context));
    TEST_ASSERT_TRUE(egl_DestroySurface(dpy, surface));
    TEST_ASSERT_TRUE(egl_DestroyContext(dpy, context));
    FAILS(EGL_BAD_CONTEXT, egl_DestroyContext(dpy, context));
    clear(0, 0, 1);
    TEST_ASSERT_EQUAL_HEX32(0xffff0000, pixel(1, 1));
    TEST_ASSERT_TRUE(egl_Terminate(dpy));
    TEST_ASSERT_EQUAL_HEX32(0xffff0000, pixel(1, 1));
    TEST_ASSERT_TRUE(egl_MakeCurrent(dpy, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT));
    TEST_ASSERT_EQUAL_HEX32(0, pixel(1, 1));
}

static void contexts_of_version_1_1_are_made(void)
{
    static const EGLint lists[][5] = {{EGL_NONE},
                                      {EGL_CONTEXT_CLIENT_VERSION, 1, EGL_NONE},
                                      {EGL_CONTEXT_MAJOR_VERSION, 1, EGL_CONTEXT_MINOR_VERSION, 1, EGL_NONE}};
    EGLint value;
    TEST_ASSERT_TRUE(egl_GetConfigAttrib(dpy, config, EGL_RENDERABLE_TYPE, &value));
    TEST_ASSERT_EQUAL_HEX32(EGL_OPENGL_ES_BIT | EGL_OPENGL_ES2_BIT, value);
    for (unsigned i = 0; i < sizeof lists / sizeof *lists; i++) {
        EGLContext context = egl_CreateContext(dpy, config, EGL_NO_CONTEXT, lists[i]);
        TEST_ASSERT_NOT_NULL(context);
        TEST_ASSERT_TRUE(egl_QueryContext(dpy, context, EGL_CONTEXT_CLIENT_VERSION, &value));
        TEST_ASSERT_EQUAL_INT(1, value);
        TEST_ASSERT_TRUE(egl_DestroyContext(dpy, context));
    }
}

static void attributes_of_contexts_are_checked(void)
{
    static const struct {
        EGLint error, list[5];
    } cases[] = {
        {EGL_BAD_ATTRIBUTE, {EGL_WIDTH, 1, EGL_NONE}},
        {EGL_BAD_MATCH, {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_NONE}},
        {EGL_BAD_MATCH, {EGL_CONTEXT_MAJOR_VERSION, 1, EGL_CONTEXT_MINOR_VERSION, 2, EGL_NONE}},
        {EGL_BAD_MATCH, {EGL_CONTEXT_MAJOR_VERSION, 2, EGL_CONTEXT_MINOR_VERSION, 1, EGL_NONE}},
        {EGL_BAD_ATTRIBUTE, {EGL_CONTEXT_MAJOR_VERSION, 2, EGL_CONTEXT_FLAGS_KHR, 64, EGL_NONE}},
        {EGL_BAD_ATTRIBUTE, {EGL_CONTEXT_MAJOR_VERSION, 2, EGL_CONTEXT_OPENGL_PROFILE_MASK, 1, EGL_NONE}},
        {EGL_BAD_ATTRIBUTE, {EGL_CONTEXT_OPENGL_DEBUG, 7, EGL_NONE}},
    };
    const EGLint good[] = {EGL_CONTEXT_MAJOR_VERSION,
                           2,
                           EGL_CONTEXT_FLAGS_KHR,
                           EGL_CONTEXT_OPENGL_DEBUG_BIT_KHR,
                           EGL_CONTEXT_OPENGL_ROBUST_ACCESS_EXT,
                           EGL_TRUE,
                           EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY_EXT,
                           EGL_LOSE_CONTEXT_ON_RESET,
                           EGL_NONE};
    for (unsigned i = 0; i < sizeof cases / sizeof *cases; i++)
        FAILS(cases[i].error, egl_CreateContext(dpy, config, EGL_NO_CONTEXT, cases[i].list));
    FAILS(EGL_BAD_CONFIG, egl_CreateContext(dpy, dpy, EGL_NO_CONTEXT, good));
    FAILS(EGL_BAD_CONTEXT, egl_CreateContext(dpy, config, dpy, good));
    EGLContext context = egl_CreateContext(dpy, config, EGL_NO_CONTEXT, good);
    TEST_ASSERT_NOT_NULL(context);
    /* Contexts of a group have the same strategy. */
    FAILS(EGL_BAD_MATCH,
          egl_CreateContext(dpy, config, context, (EGLint[]){EGL_CONTEXT_MAJOR_VERSION, 2, EGL_NONE}));
}

/* --- Threads --- */

struct work {
    EGLContext context;
    EGLSurface surface;
    EGLint error;
    uint32_t pixel;
};

static void *steal(void *data)
{
    struct work *work = data;
    if (!egl_MakeCurrent(dpy, work->surface, work->surface, work->context))
        work->error = egl_GetError();
    return NULL;
}

static void a_context_is_current_in_one_thread(void)
{
    struct work work = {context_of(config, EGL_NO_CONTEXT), pbuffer_of(config, 4, 4), EGL_SUCCESS, 0};
    pthread_t thread;
    TEST_ASSERT_TRUE(egl_MakeCurrent(dpy, work.surface, work.surface, work.context));
    pthread_create(&thread, NULL, steal, &work);
    pthread_join(thread, NULL);
    TEST_ASSERT_EQUAL_HEX(EGL_BAD_ACCESS, work.error);
    work.context = context_of(config, EGL_NO_CONTEXT);
    pthread_create(&thread, NULL, steal, &work);
    pthread_join(thread, NULL);
    TEST_ASSERT_EQUAL_HEX(EGL_BAD_ACCESS, work.error);
}

static void a_thread_that_ends_releases_its_context(void)
{
    struct work work = {context_of(config, EGL_NO_CONTEXT), pbuffer_of(config, 4, 4), EGL_SUCCESS, 0};
    pthread_t thread;
    pthread_create(&thread, NULL, steal, &work);
    pthread_join(thread, NULL);
    TEST_ASSERT_EQUAL_HEX(EGL_SUCCESS, work.error);
    TEST_ASSERT_TRUE(egl_MakeCurrent(dpy, work.surface, work.surface, work.context));
}

enum { ROUNDS = 50 };

static void *draw(void *data)
{
    struct work *work = data;
    egl_MakeCurrent(dpy, work->surface, work->surface, work->context);
    for (int i = 0; i < ROUNDS; i++) {
        float red = (float)(work->pixel & 255) / 255;
        clear(red, (float)i / ROUNDS, 1);
        clear(red, 1, 0);
        if (pixel(2, 2) != (0xff00ff00 | work->pixel))
            work->error = EGL_BAD_ALLOC;
    }
    egl_ReleaseThread();
    return NULL;
}

static void contexts_of_several_threads_keep_their_states(void)
{
    struct work work[3];
    pthread_t thread[3];
    for (unsigned i = 0; i < 3; i++)
        work[i] = (struct work){context_of(config, i ? work[0].context : EGL_NO_CONTEXT),
                                pbuffer_of(config, 8, 8), EGL_SUCCESS, 51 * i};
    for (unsigned i = 0; i < 3; i++)
        pthread_create(&thread[i], NULL, draw, &work[i]);
    for (unsigned i = 0; i < 3; i++)
        pthread_join(thread[i], NULL);
    for (unsigned i = 0; i < 3; i++)
        TEST_ASSERT_EQUAL_HEX(EGL_SUCCESS, work[i].error);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_clear_reaches_the_pixels_of_the_surface);
    RUN_TEST(a_context_draws_to_the_surface_that_is_bound);
    RUN_TEST(what_is_current_can_be_queried);
    RUN_TEST(a_context_without_surfaces_can_be_current);
    RUN_TEST(what_does_not_belong_together_is_refused);
    RUN_TEST(destroyed_objects_stay_current);
    RUN_TEST(contexts_of_version_1_1_are_made);
    RUN_TEST(attributes_of_contexts_are_checked);
    RUN_TEST(a_context_is_current_in_one_thread);
    RUN_TEST(a_thread_that_ends_releases_its_context);
    RUN_TEST(contexts_of_several_threads_keep_their_states);
    return UNITY_END();
}
