#define COBJMACROS
#include <windows.h>
#include <d3d9.h>
#include "private_data.h"

int32_t private_data_set(struct d3d9_object *object, const struct d3d9_guid *tag, const void *data,
                         uint32_t bytes, uint32_t flags)
{
    /* The program's object is referenced before the old data are released, which may be the same. */
    IUnknown *program = flags & D3DSPD_IUNKNOWN && bytes == sizeof program ? (IUnknown *)data : NULL;
    if (program)
        IUnknown_AddRef(program);
    int32_t result = d3d9_object_set_private_data(object, tag, data, bytes, flags);
    if (FAILED(result) && program)
        IUnknown_Release(program);
    return result;
}

int32_t private_data_get(struct d3d9_object *object, const struct d3d9_guid *tag, void *data, uint32_t *bytes)
{
    int32_t result = d3d9_object_get_private_data(object, tag, data, bytes);
    if (result == D3D_OK && data && d3d9_object_private_data_is_interface(object, tag))
        IUnknown_AddRef(*(IUnknown **)data);
    return result;
}
