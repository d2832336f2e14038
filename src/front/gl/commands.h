/* The functions that implement commands: gl_NAME(context, arguments of the command). The rows of calls/ whose
 * state is `own` have one, which is declared here. */
#ifndef GL_COMMANDS_H
#define GL_COMMANDS_H

#include "context.h"

#define GL_WITH_CONTEXT(...)                      (struct gl_context * context __VA_OPT__(, ) __VA_ARGS__)
#define GL_DECLARE_own(result, maker, parameters) result gl_##maker GL_WITH_CONTEXT parameters;
#define GL_DECLARE_none(result, maker, parameters)
#define GL_COMMAND(state, interfaces, result, name, maker, parameters, arguments)                            \
    GL_DECLARE_##state(result, maker, parameters)
#include "calls/core.def"
#include "calls/extension.def"
#undef GL_COMMAND
#undef GL_DECLARE_own
#undef GL_DECLARE_none
#undef GL_WITH_CONTEXT

#endif
