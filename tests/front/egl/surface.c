/* Pbuffers: their attributes, errors and end. */
#include "display.h"

#include "front/egl/surface.h"

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

static EGLint query(EGLSurface surface, EGLint name)
{
    EGLint value = -1;
    TEST_ASSERT_TRUE(egl_QuerySurface(dpy, surface, name, &value));
    return value;
}

static void a_pbuffer_has_its_attributes(void)
{
    EGLSurface surface = pbuffer_of(config, 30, 20);
    TEST_ASSERT_EQUAL_INT(30, query(surface, EGL_WIDTH));
    TEST_ASSERT_EQUAL_INT(20, query(surface, EGL_HEIGHT));
    TEST_ASSERT_EQUAL_INT(attribute(config, EGL_CONFIG_ID), query(surface, EGL_CONFIG_ID));
    TEST_ASSERT_EQUAL_INT(EGL_BUFFER_DESTROYED, query(surface, EGL_SWAP_BEHAVIOR));
    TEST_ASSERT_EQUAL_INT(EGL_BACK_BUFFER, query(surface, EGL_RENDER_BUFFER));
    TEST_ASSERT_EQUAL_INT(EGL_NO_TEXTURE, query(surface, EGL_TEXTURE_FORMAT));
    TEST_ASSERT_EQUAL_INT(EGL_FALSE, query(surface, EGL_LARGEST_PBUFFER));
    TEST_ASSERT_EQUAL_INT(EGL_UNKNOWN, query(surface, EGL_HORIZONTAL_RESOLUTION));
    TEST_ASSERT_TRUE(egl_DestroySurface(dpy, surface));
}

static void a_pbuffer_without_attributes_is_empty(void)
{
    EGLSurface surface = egl_CreatePbufferSurface(dpy, config, NULL);
    TEST_ASSERT_NOT_NULL(surface);
    TEST_ASSERT_EQUAL_INT(0, query(surface, EGL_WIDTH));
    TEST_ASSERT_EQUAL_INT(0, query(surface, EGL_HEIGHT));
}

static void a_size_beyond_the_limit_fails_or_becomes_the_largest(void)
{
    const EGLint wide[] = {EGL_WIDTH, 100000, EGL_HEIGHT, 2, EGL_NONE};
    const EGLint largest[] = {EGL_WIDTH, 100000, EGL_HEIGHT, 2, EGL_LARGEST_PBUFFER, EGL_TRUE, EGL_NONE};
    FAILS(EGL_BAD_ALLOC, egl_CreatePbufferSurface(dpy, config, wide));
    EGLSurface surface = egl_CreatePbufferSurface(dpy, config, largest);
    TEST_ASSERT_NOT_NULL(surface);
    TEST_ASSERT_EQUAL_INT(attribute(config, EGL_MAX_PBUFFER_WIDTH), query(surface, EGL_WIDTH));
}

static void wrong_attributes_of_pbuffers_are_errors(void)
{
    static const struct {
        EGLint error, list[5];
    } cases[] = {
        {EGL_BAD_PARAMETER, {EGL_WIDTH, -1, EGL_NONE}},
        {EGL_BAD_ATTRIBUTE, {EGL_RENDER_BUFFER, EGL_BACK_BUFFER, EGL_NONE}},
        {EGL_BAD_ATTRIBUTE, {EGL_LARGEST_PBUFFER, 7, EGL_NONE}},
        {EGL_BAD_MATCH, {EGL_TEXTURE_FORMAT, EGL_TEXTURE_RGB, EGL_NONE}},
        {EGL_BAD_MATCH, {EGL_TEXTURE_TARGET, EGL_TEXTURE_2D, EGL_NONE}},
        {EGL_BAD_MATCH, {EGL_TEXTURE_FORMAT, EGL_TEXTURE_RGB, EGL_TEXTURE_TARGET, EGL_TEXTURE_2D, EGL_NONE}},
        {EGL_BAD_ATTRIBUTE, {EGL_TEXTURE_TARGET, 3, EGL_NONE}},
    };
    for (unsigned i = 0; i < sizeof cases / sizeof *cases; i++)
        FAILS(cases[i].error, egl_CreatePbufferSurface(dpy, config, cases[i].list));
    FAILS(EGL_BAD_CONFIG, egl_CreatePbufferSurface(dpy, dpy, NULL));
}

static void a_destroyed_surface_is_an_error(void)
{
    EGLint value;
    EGLSurface surface = pbuffer_of(config, 2, 2);
    TEST_ASSERT_TRUE(egl_DestroySurface(dpy, surface));
    FAILS(EGL_BAD_SURFACE, egl_DestroySurface(dpy, surface));
    FAILS(EGL_BAD_SURFACE, egl_QuerySurface(dpy, surface, EGL_WIDTH, &value));
    FAILS(EGL_BAD_SURFACE, egl_SwapBuffers(dpy, surface));
}

static void attributes_that_configs_do_not_have_are_refused(void)
{
    EGLSurface surface = pbuffer_of(config, 2, 2);
    EGLint value;
    FAILS(EGL_BAD_MATCH, egl_SurfaceAttrib(dpy, surface, EGL_SWAP_BEHAVIOR, EGL_BUFFER_PRESERVED));
    FAILS(EGL_BAD_PARAMETER, egl_SurfaceAttrib(dpy, surface, EGL_SWAP_BEHAVIOR, 3));
    FAILS(EGL_BAD_MATCH,
          egl_SurfaceAttrib(dpy, surface, EGL_MULTISAMPLE_RESOLVE, EGL_MULTISAMPLE_RESOLVE_BOX));
    FAILS(EGL_BAD_ATTRIBUTE, egl_SurfaceAttrib(dpy, surface, EGL_WIDTH, 3));
    FAILS(EGL_BAD_ATTRIBUTE, egl_QuerySurface(dpy, surface, EGL_RED_SIZE, &value));
    TEST_ASSERT_TRUE(egl_SurfaceAttrib(dpy, surface, EGL_MIPMAP_LEVEL, 2));
    TEST_ASSERT_EQUAL_INT(2, query(surface, EGL_MIPMAP_LEVEL));
    FAILS(EGL_BAD_MATCH, egl_BindTexImage(dpy, surface, EGL_BACK_BUFFER));
    FAILS(EGL_BAD_PARAMETER, egl_ReleaseTexImage(dpy, surface, EGL_WIDTH));
    FAILS(EGL_BAD_MATCH, egl_SetDamageRegionKHR(dpy, surface, NULL, 0));
    FAILS(EGL_BAD_SURFACE, egl_SetDamageRegionKHR(dpy, dpy, NULL, 0));
}

static void windows_need_a_window_system(void)
{
    FAILS(EGL_BAD_NATIVE_WINDOW, egl_CreateWindowSurface(dpy, config, 1, NULL));
    FAILS(EGL_BAD_NATIVE_PIXMAP, egl_CreatePixmapSurface(dpy, config, 1, NULL));
    FAILS(EGL_BAD_PARAMETER, egl_CreatePbufferFromClientBuffer(dpy, EGL_OPENVG_IMAGE, NULL, config, NULL));
}

/* Recorded frames need a target: compositors end frames without a draw. */
static void a_frame_without_a_draw_has_the_surface_as_its_target(void)
{
    EGLSurface surface = pbuffer_of(config, 8, 8);
    EGLContext context = context_of(config, EGL_NO_CONTEXT);
    triptych_device *renderer = ((struct egl_display *)dpy)->device->renderer;
    struct triptych_target_surfaces surfaces;
    TEST_ASSERT_TRUE(egl_MakeCurrent(dpy, surface, surface, context));
    TEST_ASSERT_TRUE(egl_SwapBuffers(dpy, surface));
    TEST_ASSERT_EQUAL(TRIPTYCH_OK, triptych_get_target_surfaces(renderer, &surfaces));
    TEST_ASSERT_EQUAL_PTR(((struct egl_surface *)surface)->gl.color.image, surfaces.color[0].image);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_pbuffer_has_its_attributes);
    RUN_TEST(a_pbuffer_without_attributes_is_empty);
    RUN_TEST(a_size_beyond_the_limit_fails_or_becomes_the_largest);
    RUN_TEST(wrong_attributes_of_pbuffers_are_errors);
    RUN_TEST(a_destroyed_surface_is_an_error);
    RUN_TEST(attributes_that_configs_do_not_have_are_refused);
    RUN_TEST(windows_need_a_window_system);
    RUN_TEST(a_frame_without_a_draw_has_the_surface_as_its_target);
    return UNITY_END();
}
