/* Functions by name, and the functions of extensions that find the vendor of their display or device. */
#include "front/egl/calls.h"
#include "front/gl/dispatch/dispatch.h"
#include "vendor.h"

#include <string.h>

struct entry {
    const char *name;
    egl_function *function;
};

static const struct entry functions[] = {
#define EGL_CALL(kind, result, name, maker, parameters, arguments, failure)                                  \
    {"egl" #name, (egl_function *)egl_##maker},
#include "front/egl/call.def"
#undef EGL_CALL
};

egl_function *egl_function_find(const char *name)
{
    for (unsigned i = 0; i < sizeof functions / sizeof *functions; i++)
        if (!strcmp(functions[i].name, name))
            return functions[i].function;
    return (egl_function *)gl_dispatch_find(name);
}

/* --- Extensions ---
 *
 * libglvnd gives each of these functions a number. */

enum {
#define NUMBER_CORE(name)
#define NUMBER_EXTENSION(name)                                              NUMBER_##name,
#define NUMBER_DEVICE(name)                                                 NUMBER_##name,
#define EGL_CALL(kind, result, name, maker, parameters, arguments, failure) NUMBER_##kind(name)
#include "front/egl/call.def"
#undef EGL_CALL
    EXTENSIONS
};

static int numbers[EXTENSIONS];

#define DISPATCH_CORE(result, name, parameters, arguments, failure)
#define DISPATCH(find, result, name, parameters, arguments, failure)                                         \
    static result dispatch_##name parameters                                                                 \
    {                                                                                                        \
        result(*function) parameters = (result(*) parameters)(find);                                         \
        return function ? function arguments : failure;                                                      \
    }
#define DISPATCH_EXTENSION(result, name, parameters, arguments, failure)                                     \
    DISPATCH(egl_vendor_function(dpy, numbers[NUMBER_##name]), result, name, parameters, arguments, failure)
#define DISPATCH_DEVICE(result, name, parameters, arguments, failure)                                        \
    DISPATCH(egl_vendor_device_function(device, numbers[NUMBER_##name]), result, name, parameters,           \
             arguments, failure)
#define EGL_CALL(kind, result, name, maker, parameters, arguments, failure)                                  \
    DISPATCH_##kind(result, name, parameters, arguments, failure)
#include "front/egl/call.def"
#undef EGL_CALL

static const struct entry dispatches[EXTENSIONS] = {
#define ENTRY(name)                                                                                          \
    {                                                                                                        \
        "egl" #name, (egl_function *)dispatch_##name                                                         \
    }
#define ENTRY_CORE(name)
#define ENTRY_EXTENSION(name)                                               ENTRY(name),
#define ENTRY_DEVICE(name)                                                  ENTRY(name),
#define EGL_CALL(kind, result, name, maker, parameters, arguments, failure) ENTRY_##kind(name)
#include "front/egl/call.def"
#undef EGL_CALL
};

egl_function *egl_dispatch_find(const char *name)
{
    for (unsigned i = 0; i < EXTENSIONS; i++)
        if (!strcmp(dispatches[i].name, name))
            return dispatches[i].function;
    return NULL;
}

void egl_dispatch_number(const char *name, int number)
{
    for (unsigned i = 0; i < EXTENSIONS; i++)
        if (!strcmp(dispatches[i].name, name))
            numbers[i] = number;
}
