/* The functions of call.h for the Windows side: the arguments become a block, the Linux side's function of
 * the same name is called, and its result is returned. */
#include "bridge.h"

#define SET(kind, ...)                      SET_##kind(__VA_ARGS__)
#define SET_VALUE(type, name)               .name = name,
#define SET_HANDLE(type, name)              .name = name,
#define SET_POINTER(type, name)             .name = (uintptr_t)name,
#define SET_OBJECT(type, name)              .name = (uintptr_t)name,
#define SET_OBJECTS(type, name, count)      .name = (uintptr_t)name,
#define SET_NEW(type, name)                 .name = (uintptr_t)name,
#define SET_READS(type, name, count)        .name = (uintptr_t)name,
#define SET_WRITES(type, name, count)       .name = (uintptr_t)name,
#define SET_CHANGES(type, name, count)      .name = (uintptr_t)name,
#define SET_HOST_READS(type, name, count)   .name = (uintptr_t)name,
#define SET_HOST_WRITES(type, name, count)  .name = (uintptr_t)name,
#define SET_HOST_CHANGES(type, name, count) .name = (uintptr_t)name,

#define METHOD(class, method, name, type, ...)                                                               \
    d3d9_type_##type d3d9_##class##_##name(struct d3d9_##class *self D3D9_EACH(D3D9_PARAMETER, __VA_ARGS__)) \
    {                                                                                                        \
        struct d3d9_block_##class##_##name block = {.self = (uintptr_t)self, D3D9_EACH(SET, __VA_ARGS__)};   \
        bridge_call(D3D9_CODE_##class##_##name, &block);                                                     \
        return block.result;                                                                                 \
    }
#define HOSTED METHOD
#define PROCEDURE(class, method, name, ...)                                                                  \
    void d3d9_##class##_##name(struct d3d9_##class *self D3D9_EACH(D3D9_PARAMETER, __VA_ARGS__))             \
    {                                                                                                        \
        struct d3d9_block_##class##_##name block = {.self = (uintptr_t)self, D3D9_EACH(SET, __VA_ARGS__)};   \
        bridge_call(D3D9_CODE_##class##_##name, &block);                                                     \
    }
#define LOCAL(class, method)
#define FUNCTION(class, name, type, ...)                                                                     \
    d3d9_type_##type d3d9_##class##_##name(D3D9_WITHOUT_COMMA(D3D9_EACH(D3D9_PARAMETER, __VA_ARGS__)))       \
    {                                                                                                        \
        struct d3d9_block_##class##_##name block = {D3D9_EACH(SET, __VA_ARGS__)};                            \
        bridge_call(D3D9_CODE_##class##_##name, &block);                                                     \
        return block.result;                                                                                 \
    }
#include "front/d3d9/calls/calls.def"
