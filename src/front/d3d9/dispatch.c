#include "dispatch.h"
#include "object.h"
#include <pthread.h>

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

#define ARGUMENT(kind, ...)                      ARGUMENT_##kind(__VA_ARGS__)
#define ARGUMENT_VALUE(type, name)               , b->name
#define ARGUMENT_HANDLE(type, name)              , b->name
#define ARGUMENT_POINTER(type, name)             , (void *)(uintptr_t)b->name
#define ARGUMENT_OBJECT(type, name)              , (void *)(uintptr_t)b->name
#define ARGUMENT_OBJECTS(type, name, count)      , (void *)(uintptr_t)b->name
#define ARGUMENT_NEW(type, name)                 , (void *)(uintptr_t)b->name
#define ARGUMENT_READS(type, name, count)        , (void *)(uintptr_t)b->name
#define ARGUMENT_WRITES(type, name, count)       , (void *)(uintptr_t)b->name
#define ARGUMENT_CHANGES(type, name, count)      , (void *)(uintptr_t)b->name
#define ARGUMENT_HOST_READS(type, name, count)   , (void *)(uintptr_t)b->name
#define ARGUMENT_HOST_WRITES(type, name, count)  , (void *)(uintptr_t)b->name
#define ARGUMENT_HOST_CHANGES(type, name, count) , (void *)(uintptr_t)b->name

/* Methods do not accept objects of another device. All that have objects as arguments return a HRESULT. */
static bool is_foreign(uint64_t self, uint64_t other)
{
    const struct d3d9_object *own = (void *)(uintptr_t)self, *object = (void *)(uintptr_t)other;
    bool is_device = d3d9_object_interface_is(own->interface, D3D9_INTERFACE_DEVICE);
    return object && object->parent != (is_device ? own : own->parent);
}

#define FOREIGN(kind, ...) FOREIGN_##kind(__VA_ARGS__)
#define FOREIGN_VALUE(type, name)
#define FOREIGN_HANDLE(type, name)
#define FOREIGN_POINTER(type, name)
#define FOREIGN_OBJECT(type, name) || is_foreign(b->self, b->name)
#define FOREIGN_OBJECTS(type, name, count)
#define FOREIGN_NEW(type, name)
#define FOREIGN_READS(type, name, count)
#define FOREIGN_WRITES(type, name, count)
#define FOREIGN_CHANGES(type, name, count)
#define FOREIGN_HOST_READS(type, name, count)
#define FOREIGN_HOST_WRITES(type, name, count)
#define FOREIGN_HOST_CHANGES(type, name, count)

#define METHOD(class, method, name, type, ...)                                                               \
    static void run_##class##_##name(void *block)                                                            \
    {                                                                                                        \
        struct d3d9_block_##class##_##name *b = block;                                                       \
        if (false D3D9_EACH(FOREIGN, __VA_ARGS__)) {                                                         \
            b->result = D3D9_INVALID_CALL;                                                                   \
            return;                                                                                          \
        }                                                                                                    \
        b->result = d3d9_##class##_##name((void *)(uintptr_t)b->self D3D9_EACH(ARGUMENT, __VA_ARGS__));      \
    }
#define HOSTED METHOD
#define PROCEDURE(class, method, name, ...)                                                                  \
    static void run_##class##_##name(void *block)                                                            \
    {                                                                                                        \
        struct d3d9_block_##class##_##name *b = block;                                                       \
        d3d9_##class##_##name((void *)(uintptr_t)b->self D3D9_EACH(ARGUMENT, __VA_ARGS__));                  \
    }
#define LOCAL(class, method)
#define FUNCTION(class, name, type, ...)                                                                     \
    static void run_##class##_##name(void *block)                                                            \
    {                                                                                                        \
        struct d3d9_block_##class##_##name *b = block;                                                       \
        b->result = d3d9_##class##_##name(D3D9_WITHOUT_COMMA(D3D9_EACH(ARGUMENT, __VA_ARGS__)));             \
    }
#include "calls/calls.def"
#undef METHOD
#undef PROCEDURE
#undef FUNCTION

static void (*const runs[D3D9_CODE_COUNT])(void *) = {
#define METHOD(class, method, name, type, ...) [D3D9_CODE_##class##_##name] = run_##class##_##name,
#define PROCEDURE(class, method, name, ...)    [D3D9_CODE_##class##_##name] = run_##class##_##name,
#define FUNCTION(class, name, type, ...)       [D3D9_CODE_##class##_##name] = run_##class##_##name,
#include "calls/calls.def"
};

int d3d9_dispatch(unsigned code, void *block)
{
    if (code >= D3D9_CODE_COUNT)
        return D3D9_BAD_CODE;
    /* At the end of a process a thread may have been ended that had the lock. */
    if (code == D3D9_CODE_host_end && pthread_mutex_trylock(&lock))
        return D3D9_DONE;
    if (code != D3D9_CODE_host_end)
        pthread_mutex_lock(&lock);
    runs[code](block);
    int result = d3d9_host_has_events() ? D3D9_EVENTS : D3D9_DONE;
    pthread_mutex_unlock(&lock);
    return result;
}
