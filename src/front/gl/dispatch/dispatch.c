#include "dispatch.h"

#include "front/gl/commands.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

struct current {
    struct gl_context *context;
    unsigned interface;
};

/* The library is loaded while the program runs, so that only this model has no call for each access. */
static _Thread_local struct current current __attribute__((tls_model("initial-exec")));

void gl_dispatch_set(struct gl_context *context, enum gl_interface interface)
{
    current = (struct current){context, context ? interface : 0};
}

/* A command runs while its device is locked. */
static inline struct gl_context *enter(unsigned interfaces)
{
    struct gl_context *context = current.interface & interfaces ? current.context : NULL;
    if (context)
        gl_context_enter(context);
    return context;
}

static inline void leave(struct gl_context **context)
{
    if (*context)
        gl_context_leave(*context);
}

#define WITH_CONTEXT(...) (context __VA_OPT__(, ) __VA_ARGS__)
#define STUB_none(...)
#define STUB_own(interfaces, result, name, maker, parameters, arguments)                                     \
    static result GL_APIENTRY command_##name parameters                                                      \
    {                                                                                                        \
        struct gl_context *context __attribute__((cleanup(leave))) = enter(interfaces);                      \
        if (!context)                                                                                        \
            return (result)0;                                                                                \
        return gl_##maker WITH_CONTEXT arguments;                                                            \
    }
#define GL_COMMAND(state, interfaces, result, name, maker, parameters, arguments)                            \
    STUB_##state(interfaces, result, name, maker, parameters, arguments)
#include "front/gl/calls/core.def"
#include "front/gl/calls/extension.def"
#undef GL_COMMAND

struct entry {
    const char *name;
    gl_command *function;
};

#define ENTRY(name)                                                                                          \
    {                                                                                                        \
        "gl" #name, (gl_command *)command_##name                                                             \
    }
#define ENTRY_none(name)
#define ENTRY_own(name)                                                           ENTRY(name),
#define GL_COMMAND(state, interfaces, result, name, maker, parameters, arguments) ENTRY_##state(name)

/* In the order of the tables, then sorted by the first search. The last entry is not a command. */
static struct entry entries[] = {
#include "front/gl/calls/core.def"
#include "front/gl/calls/extension.def"
    {NULL, NULL},
};

static int compare(const void *a, const void *b)
{
    return strcmp(((const struct entry *)a)->name, ((const struct entry *)b)->name);
}

static void sort(void)
{
    qsort(entries, sizeof entries / sizeof *entries - 1, sizeof *entries, compare);
}

gl_command *gl_dispatch_find(const char *name)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    const struct entry key = {.name = name};
    pthread_once(&once, sort);
    const struct entry *found =
        bsearch(&key, entries, sizeof entries / sizeof *entries - 1, sizeof *entries, compare);
    return found ? found->function : NULL;
}

#undef GL_COMMAND
#define MISSING_own(interfaces)  0u
#define MISSING_none(interfaces) (interfaces)
#define GL_COMMAND(state, interfaces, result, name, maker, parameters, arguments)                            \
    | MISSING_##state(interfaces)

unsigned gl_dispatch_interfaces(void)
{
    const unsigned missing = 0u
#include "front/gl/calls/core.def"
        ;
    return (GL_ES1 | GL_ES2) & ~missing;
}
