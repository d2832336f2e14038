/* Syncs: fences of a context, and reusable syncs between threads. */
#include "display.h"

#include <pthread.h>

enum { SECOND_NS = 1000000000 };

void setUp(void)
{
    begin_display();
}

void tearDown(void)
{
    end_display();
}

static void make_current(void)
{
    EGLContext context = context_of(EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT);
    TEST_ASSERT_TRUE(egl_MakeCurrent(dpy, EGL_NO_SURFACE, EGL_NO_SURFACE, context));
}

static EGLAttrib get(EGLSync sync, EGLint name)
{
    EGLAttrib value = -1;
    TEST_ASSERT_TRUE(egl_GetSyncAttrib(dpy, sync, name, &value));
    return value;
}

static void a_fence_is_signaled_after_a_wait(void)
{
    make_current();
    EGLSync sync = egl_CreateSync(dpy, EGL_SYNC_FENCE, NULL);
    TEST_ASSERT_NOT_NULL(sync);
    TEST_ASSERT_EQUAL_HEX(EGL_SYNC_FENCE, get(sync, EGL_SYNC_TYPE));
    TEST_ASSERT_EQUAL_HEX(EGL_SYNC_PRIOR_COMMANDS_COMPLETE, get(sync, EGL_SYNC_CONDITION));
    TEST_ASSERT_TRUE(egl_WaitSync(dpy, sync, 0));
    TEST_ASSERT_EQUAL_HEX(EGL_CONDITION_SATISFIED, egl_ClientWaitSync(dpy, sync, 0, EGL_FOREVER));
    TEST_ASSERT_EQUAL_HEX(EGL_SIGNALED, get(sync, EGL_SYNC_STATUS));
    TEST_ASSERT_TRUE(egl_DestroySync(dpy, sync));
    FAILS(EGL_BAD_PARAMETER, egl_DestroySync(dpy, sync));
}

static void a_wait_with_a_limit_finds_a_fence_signaled(void)
{
    make_current();
    EGLSync sync = egl_CreateSync(dpy, EGL_SYNC_FENCE, NULL);
    TEST_ASSERT_EQUAL_HEX(EGL_CONDITION_SATISFIED, egl_ClientWaitSync(dpy, sync, 0, 5ull * SECOND_NS));
}

static void fences_need_a_context(void)
{
    FAILS(EGL_BAD_MATCH, egl_CreateSync(dpy, EGL_SYNC_FENCE, NULL));
    FAILS(EGL_BAD_PARAMETER, egl_CreateSync(dpy, EGL_NONE, NULL));
    FAILS(EGL_BAD_ATTRIBUTE, egl_CreateSyncKHR(dpy, EGL_NONE, NULL));
    make_current();
    FAILS(EGL_BAD_ATTRIBUTE, egl_CreateSync(dpy, EGL_SYNC_FENCE, (EGLAttrib[]){EGL_WIDTH, 1, EGL_NONE}));
}

static void a_reusable_sync_times_out_until_it_is_signaled(void)
{
    EGLSync sync = egl_CreateSyncKHR(dpy, EGL_SYNC_REUSABLE_KHR, NULL);
    EGLAttrib value;
    TEST_ASSERT_NOT_NULL(sync);
    TEST_ASSERT_EQUAL_HEX(EGL_UNSIGNALED, get(sync, EGL_SYNC_STATUS));
    TEST_ASSERT_EQUAL_HEX(EGL_TIMEOUT_EXPIRED, egl_ClientWaitSync(dpy, sync, 0, 0));
    TEST_ASSERT_EQUAL_HEX(EGL_TIMEOUT_EXPIRED, egl_ClientWaitSync(dpy, sync, 0, 1000000));
    TEST_ASSERT_TRUE(egl_SignalSyncKHR(dpy, sync, EGL_SIGNALED));
    TEST_ASSERT_EQUAL_HEX(EGL_CONDITION_SATISFIED, egl_ClientWaitSync(dpy, sync, 0, EGL_FOREVER));
    TEST_ASSERT_TRUE(egl_SignalSyncKHR(dpy, sync, EGL_UNSIGNALED));
    TEST_ASSERT_EQUAL_HEX(EGL_UNSIGNALED, get(sync, EGL_SYNC_STATUS));
    FAILS(EGL_BAD_PARAMETER, egl_SignalSyncKHR(dpy, sync, EGL_WIDTH));
    FAILS(EGL_BAD_ATTRIBUTE, egl_GetSyncAttrib(dpy, sync, EGL_SYNC_CONDITION, &value));
}

static void *signal_sync(void *sync)
{
    egl_SignalSyncKHR(dpy, sync, EGL_SIGNALED);
    return NULL;
}

static void *destroy_sync(void *sync)
{
    egl_DestroySync(dpy, sync);
    return NULL;
}

static void wait_while(void *(*other)(void *))
{
    EGLSync sync = egl_CreateSyncKHR(dpy, EGL_SYNC_REUSABLE_KHR, NULL);
    pthread_t thread;
    pthread_create(&thread, NULL, other, sync);
    EGLint result = egl_ClientWaitSync(dpy, sync, 0, 10ull * SECOND_NS);
    pthread_join(thread, NULL);
    /* The sync can be destroyed before the wait begins. */
    TEST_ASSERT_TRUE(result == EGL_CONDITION_SATISFIED || (other == destroy_sync && result == EGL_FALSE));
}

static void another_thread_ends_a_wait(void)
{
    wait_while(signal_sync);
    wait_while(destroy_sync);
}

static void only_fences_can_be_waited_for_by_a_context(void)
{
    EGLSync sync = egl_CreateSyncKHR(dpy, EGL_SYNC_REUSABLE_KHR, NULL);
    FAILS(EGL_BAD_MATCH, egl_WaitSync(dpy, sync, 0));
    FAILS(EGL_BAD_PARAMETER, egl_WaitSync(dpy, sync, 1));
    FAILS(EGL_BAD_PARAMETER, egl_WaitSync(dpy, dpy, 0));
    FAILS(EGL_BAD_PARAMETER, egl_ClientWaitSync(dpy, dpy, 0, 0));
    make_current();
    EGLSync fence = egl_CreateSync(dpy, EGL_SYNC_FENCE, NULL);
    FAILS(EGL_BAD_MATCH, egl_SignalSyncKHR(dpy, fence, EGL_SIGNALED));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_fence_is_signaled_after_a_wait);
    RUN_TEST(a_wait_with_a_limit_finds_a_fence_signaled);
    RUN_TEST(fences_need_a_context);
    RUN_TEST(a_reusable_sync_times_out_until_it_is_signaled);
    RUN_TEST(another_thread_ends_a_wait);
    RUN_TEST(only_fences_can_be_waited_for_by_a_context);
    return UNITY_END();
}
