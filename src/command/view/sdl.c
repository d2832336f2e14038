#include "command/view/sdl.h"

#include <dlfcn.h>
#include <stddef.h>
#include <string.h>

static const char library_name[] = "libSDL2-2.0.so.0";

/* ISO C has no conversion from an object's address to a function's. */
static int find(const struct sdl *sdl, const char *name, void *function, struct error *error)
{
    void *address = dlsym(sdl->library, name);
    memcpy(function, &address, sizeof address);
    return address ? 0 : error_set(error, "%s has no %s, expected SDL 2.0.5 or later", library_name, name);
}

int sdl_load(struct sdl *sdl, struct error *error)
{
    *sdl = (struct sdl){.library = dlopen(library_name, RTLD_NOW | RTLD_LOCAL)};
    if (!sdl->library)
        return error_set(error, "%s cannot be loaded, expected SDL 2 (the Debian package libsdl2-2.0-0): %s",
                         library_name, dlerror());
    int result = 0;
#define SDL(type, name, parameters)                                                                          \
    if (!result)                                                                                             \
        result = find(sdl, "SDL_" #name, &sdl->name, error);
#include "command/view/sdl.def"
#undef SDL
    if (result)
        sdl_unload(sdl);
    return result;
}

void sdl_unload(struct sdl *sdl)
{
    if (sdl->library)
        dlclose(sdl->library);
    *sdl = (struct sdl){0};
}
