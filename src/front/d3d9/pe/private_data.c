#define COBJMACROS
#include <windows.h>
#include <d3d9.h>
#include "private_data.h"

int32_t private_data_set(struct d3d9_object *object, const struct d3d9_guid *tag, const void *data,
                         uint32_t bytes, uint32_t flags)
{
    if (!(flags & D3DSPD_IUNKNOWN))
        return d3d9_object_set_private_data(object, tag, data, bytes, flags);
    if (bytes != sizeof(IUnknown *) || !data)
        return D3DERR_INVALIDCALL;
    /* The new one is referenced before the old data are released, which may be the same. */
    IUnknown *program = (IUnknown *)data;
    uint64_t number = (uintptr_t)program;
    IUnknown_AddRef(program);
    int32_t result = d3d9_object_set_private_data(object, tag, &number, sizeof number, flags);
    if (FAILED(result))
        IUnknown_Release(program);
    return result;
}

/* The Linux side has interfaces as uint64_t. */
static int32_t get_interface(struct d3d9_object *object, const struct d3d9_guid *tag, IUnknown **data,
                             uint32_t *bytes)
{
    uint64_t found;
    uint32_t size = sizeof found, room = *bytes;
    *bytes = sizeof *data;
    if (!data)
        return D3D_OK;
    if (room < sizeof *data)
        return D3DERR_MOREDATA;
    int32_t result = d3d9_object_get_private_data(object, tag, &found, &size);
    if (FAILED(result))
        return result;
    *data = (IUnknown *)(uintptr_t)found;
    IUnknown_AddRef(*data);
    return result;
}

int32_t private_data_get(struct d3d9_object *object, const struct d3d9_guid *tag, void *data, uint32_t *bytes)
{
    if (bytes && d3d9_object_private_data_is_interface(object, tag))
        return get_interface(object, tag, data, bytes);
    return d3d9_object_get_private_data(object, tag, data, bytes);
}
