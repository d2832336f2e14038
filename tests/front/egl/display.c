/* Displays, devices, strings and functions by name. */
#include "display.h"

#include <string.h>

void setUp(void)
{
    begin_display();
}

void tearDown(void)
{
    end_display();
}

static void a_platform_has_one_display(void)
{
    TEST_ASSERT_EQUAL_PTR(dpy, egl_GetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, NULL, NULL));
    EGLDeviceEXT device;
    EGLint count;
    TEST_ASSERT_TRUE(egl_QueryDevicesEXT(1, &device, &count));
    TEST_ASSERT_EQUAL_INT(1, count);
    EGLDisplay other = egl_GetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, device, NULL);
    TEST_ASSERT_NOT_NULL(other);
    TEST_ASSERT_NOT_EQUAL(dpy, other);
    TEST_ASSERT_EQUAL_PTR(other, egl_GetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, device, NULL));
}

static void wrong_platforms_are_errors(void)
{
    const EGLAttrib list[] = {EGL_WIDTH, 1, EGL_NONE};
    FAILS(EGL_BAD_PARAMETER, egl_GetPlatformDisplay(EGL_PLATFORM_GBM_MESA, NULL, NULL));
    FAILS(EGL_BAD_PARAMETER, egl_GetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, dpy, NULL));
    FAILS(EGL_BAD_ATTRIBUTE, egl_GetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, NULL, list));
}

static void a_display_that_is_not_initialized_is_an_error(void)
{
    EGLint count;
    TEST_ASSERT_TRUE(egl_Terminate(dpy));
    FAILS(EGL_NOT_INITIALIZED, egl_GetConfigs(dpy, NULL, 0, &count));
    FAILS(EGL_NOT_INITIALIZED, egl_QueryString(dpy, EGL_VENDOR));
    FAILS(EGL_BAD_DISPLAY, egl_GetConfigs(&count, NULL, 0, &count));
    FAILS(EGL_BAD_DISPLAY, egl_Initialize(EGL_NO_DISPLAY, NULL, NULL));
    FAILS(EGL_BAD_DISPLAY, egl_Terminate(&count));
    TEST_ASSERT_TRUE(egl_Terminate(dpy));
}

static void a_display_can_be_initialized_again(void)
{
    EGLint major = 0, minor = 0;
    TEST_ASSERT_TRUE(egl_Initialize(dpy, &major, &minor));
    TEST_ASSERT_EQUAL_INT(1, major);
    TEST_ASSERT_EQUAL_INT(5, minor);
    TEST_ASSERT_TRUE(egl_Terminate(dpy));
    TEST_ASSERT_TRUE(egl_Initialize(dpy, NULL, NULL));
    TEST_ASSERT_NOT_NULL(config_with(EGL_LEVEL, 0));
}

static void an_unknown_engine_fails_the_initialization(void)
{
    egl_Terminate(dpy);
    setenv("TRIPTYCH_ENGINE", "steam", 1);
    FAILS(EGL_NOT_INITIALIZED, egl_Initialize(dpy, NULL, NULL));
}

static void strings_name_the_version_and_extensions(void)
{
    TEST_ASSERT_EQUAL_STRING("OpenGL_ES", egl_QueryString(dpy, EGL_CLIENT_APIS));
    TEST_ASSERT_EQUAL_INT(0, strncmp(egl_QueryString(dpy, EGL_VERSION), "1.5 ", 4));
    TEST_ASSERT_NOT_NULL(strstr(egl_QueryString(dpy, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context"));
    TEST_ASSERT_NOT_NULL(strstr(egl_QueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS), "EGL_EXT_platform_base"));
    FAILS(EGL_BAD_PARAMETER, egl_QueryString(dpy, EGL_WIDTH));
    FAILS(EGL_BAD_DISPLAY, egl_QueryString(EGL_NO_DISPLAY, EGL_VENDOR));
}

static void only_implemented_functions_have_an_address(void)
{
    TEST_ASSERT_NOT_NULL(egl_function_find("eglSwapBuffers"));
    TEST_ASSERT_NOT_NULL(egl_function_find("eglCreateSyncKHR"));
    TEST_ASSERT_NOT_NULL(egl_function_find("glClear"));
    TEST_ASSERT_NULL(egl_function_find("glMultiDrawArraysIndirect"));
    TEST_ASSERT_NULL(egl_function_find("eglStreamConsumerAcquireKHR"));
    TEST_ASSERT_NULL(egl_function_find(""));
    TEST_ASSERT_NOT_NULL(egl_dispatch_find("eglCreateSyncKHR"));
    TEST_ASSERT_NULL(egl_dispatch_find("eglSwapBuffers"));
}

static void the_client_interface_is_opengl_es(void)
{
    TEST_ASSERT_EQUAL_HEX(EGL_OPENGL_ES_API, egl_QueryAPI());
    TEST_ASSERT_TRUE(egl_BindAPI(EGL_OPENGL_ES_API));
    FAILS(EGL_BAD_PARAMETER, egl_BindAPI(EGL_OPENGL_API));
    FAILS(EGL_BAD_PARAMETER, egl_BindAPI(EGL_NONE));
}

static void the_device_is_that_of_each_display(void)
{
    EGLDeviceEXT device;
    EGLAttrib value;
    EGLint count;
    egl_QueryDevicesEXT(1, &device, &count);
    TEST_ASSERT_TRUE(egl_QueryDisplayAttribEXT(dpy, EGL_DEVICE_EXT, &value));
    TEST_ASSERT_EQUAL_PTR(device, (void *)value);
    TEST_ASSERT_EQUAL_STRING("EGL_MESA_device_software", egl_QueryDeviceStringEXT(device, EGL_EXTENSIONS));
    FAILS(EGL_BAD_DEVICE_EXT, egl_QueryDeviceStringEXT(NULL, EGL_EXTENSIONS));
    FAILS(EGL_BAD_ATTRIBUTE, egl_QueryDeviceAttribEXT(device, EGL_WIDTH, &value));
    FAILS(EGL_BAD_PARAMETER, egl_QueryDevicesEXT(0, &device, &count));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_platform_has_one_display);
    RUN_TEST(wrong_platforms_are_errors);
    RUN_TEST(a_display_that_is_not_initialized_is_an_error);
    RUN_TEST(a_display_can_be_initialized_again);
    RUN_TEST(an_unknown_engine_fails_the_initialization);
    RUN_TEST(strings_name_the_version_and_extensions);
    RUN_TEST(only_implemented_functions_have_an_address);
    RUN_TEST(the_client_interface_is_opengl_es);
    RUN_TEST(the_device_is_that_of_each_display);
    return UNITY_END();
}
