/* Calls as data: a code and a block of parameters for each row of calls/calls.def. A block has the same
 * layout in
 * 32- and 64-bit processes: addresses and handles are uint64_t. */
#ifndef D3D9_BLOCK_H
#define D3D9_BLOCK_H

#include "call.h"

#define D3D9_FIELD(kind, ...)                      D3D9_FIELD_##kind(__VA_ARGS__)
#define D3D9_FIELD_VALUE(type, name)               d3d9_type_##type name;
#define D3D9_FIELD_HANDLE(type, name)              uint64_t name;
#define D3D9_FIELD_POINTER(type, name)             uint64_t name;
#define D3D9_FIELD_OBJECT(type, name)              uint64_t name;
#define D3D9_FIELD_OBJECTS(type, name, count)      uint64_t name;
#define D3D9_FIELD_NEW(type, name)                 uint64_t name;
#define D3D9_FIELD_READS(type, name, count)        uint64_t name;
#define D3D9_FIELD_WRITES(type, name, count)       uint64_t name;
#define D3D9_FIELD_CHANGES(type, name, count)      uint64_t name;
#define D3D9_FIELD_HOST_READS(type, name, count)   uint64_t name;
#define D3D9_FIELD_HOST_WRITES(type, name, count)  uint64_t name;
#define D3D9_FIELD_HOST_CHANGES(type, name, count) uint64_t name;

#define METHOD(class, method, name, type, ...)                                                               \
    struct d3d9_block_##class##_##name                                                                       \
    {                                                                                                        \
        uint64_t self;                                                                                       \
        D3D9_EACH(D3D9_FIELD, __VA_ARGS__) d3d9_type_##type result;                                          \
    };
#define HOSTED METHOD
#define PROCEDURE(class, method, name, ...)                                                                  \
    struct d3d9_block_##class##_##name                                                                       \
    {                                                                                                        \
        uint64_t self;                                                                                       \
        D3D9_EACH(D3D9_FIELD, __VA_ARGS__)                                                                   \
    };
#define LOCAL(class, method)
#define FUNCTION(class, name, type, ...)                                                                     \
    struct d3d9_block_##class##_##name                                                                       \
    {                                                                                                        \
        D3D9_EACH(D3D9_FIELD, __VA_ARGS__) d3d9_type_##type result;                                          \
    };
#include "calls/calls.def"
#undef METHOD
#undef PROCEDURE
#undef FUNCTION

enum d3d9_code {
#define METHOD(class, method, name, type, ...) D3D9_CODE_##class##_##name,
#define PROCEDURE(class, method, name, ...)    D3D9_CODE_##class##_##name,
#define FUNCTION(class, name, type, ...)       D3D9_CODE_##class##_##name,
#include "calls/calls.def"
#undef METHOD
#undef HOSTED
#undef PROCEDURE
#undef LOCAL
#undef FUNCTION
    D3D9_CODE_COUNT
};

/* The results of d3d9_dispatch. */
enum { D3D9_DONE, D3D9_EVENTS /* done; d3d9_host_take_events has something to return */, D3D9_BAD_CODE = -1 };

#endif
