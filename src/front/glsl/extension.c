#include "front/glsl/context.h"

const char *const glsl_extensions[] = {
#define GLSL_EXTENSION(id, name) name,
#include "front/glsl/extension.def"
#undef GLSL_EXTENSION
};

bool glsl_extension_enabled(struct glsl_context *context, enum glsl_extension extension,
                            struct glsl_place place)
{
    if (context->behavior[extension] == GLSL_WARNED)
        glsl_warning(context, place, "found a use of the extension %s", glsl_extensions[extension]);
    return context->behavior[extension] != GLSL_DISABLED;
}
