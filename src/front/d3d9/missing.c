/* Bodies of the methods that are not written yet. A weak function gives way to the real one.
 * tests/front/missing.sh lists those that are left. */
#include "call.h"
#pragma GCC diagnostic ignored "-Wunused-parameter"

#define NOTHING_HRESULT              D3D9_NOT_IMPLEMENTED
#define NOTHING_UINT                 0
#define NOTHING_DWORD                0
#define NOTHING_ULONG                0
#define NOTHING_BOOL                 0
#define NOTHING_float                0
#define NOTHING_D3DRESOURCETYPE      0
#define NOTHING_D3DTEXTUREFILTERTYPE 0
#define NOTHING_D3DQUERYTYPE         0

#define METHOD(class, method, name, type, ...)                                                               \
    __attribute__((weak))                                                                                    \
    d3d9_type_##type d3d9_##class##_##name(struct d3d9_##class *self D3D9_EACH(D3D9_PARAMETER, __VA_ARGS__)) \
    {                                                                                                        \
        return NOTHING_##type;                                                                               \
    }
#define HOSTED METHOD
#define PROCEDURE(class, method, name, ...)                                                                  \
    __attribute__((weak)) void d3d9_##class##_##name(                                                        \
        struct d3d9_##class *self D3D9_EACH(D3D9_PARAMETER, __VA_ARGS__))                                    \
    {                                                                                                        \
    }
#define LOCAL(class, method)
#define FUNCTION(class, name, type, ...)                                                                     \
    __attribute__((weak))                                                                                    \
    d3d9_type_##type d3d9_##class##_##name(D3D9_WITHOUT_COMMA(D3D9_EACH(D3D9_PARAMETER, __VA_ARGS__)))       \
    {                                                                                                        \
        return NOTHING_##type;                                                                               \
    }
#include "calls/calls.def"
