#include "front/glsl/context.h"

const struct glsl_extension_row glsl_extensions[] = {
#define GLSL_EXTENSION(id, name, stages) {name, stages},
#include "front/glsl/extension.def"
#undef GLSL_EXTENSION
};

bool glsl_extension_is_here(const struct glsl_context *context, unsigned i)
{
    return glsl_extensions[i].stages >> context->stage & 1;
}

bool glsl_extension_enabled(struct glsl_context *context, enum glsl_extension extension,
                            struct glsl_place place)
{
    if (context->behavior[extension] == GLSL_WARNED)
        glsl_warning(context, place, "found a use of the extension %s", glsl_extensions[extension].name);
    return context->behavior[extension] != GLSL_DISABLED;
}
