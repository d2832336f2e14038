#define COBJMACROS
#define CINTERFACE
#include <windows.h>
#include <d3d9.h>
#include "vtable.h"
#include "front/d3d9/call.h"
#include "window/hosted.h"
#include "declaration.h"
#include "private_data.h"
#undef interface
#include "front/d3d9/object.h"

/* Private data can be the program's own interfaces, which the Linux side cannot count. */
#define d3d9_object_set_private_data     private_data_set
#define d3d9_object_get_private_data     private_data_get
#define d3d9_declaration_get_declaration declaration_get

#define JOIN(a, b)    JOIN_(a, b)
#define JOIN_(a, b)   a##b
#define THUNK(method) JOIN(JOIN(CLASS, _), method)
#define VTABLE_TYPE   JOIN(COM, Vtbl)
#define VTABLE_NAME   JOIN(CLASS, _vtable)

/* The parameters of a thunk, with the types of Windows' headers. */
#define EACH_COM(...)                  D3D9_EACH(COM_PARAMETER, __VA_ARGS__)
#define COM_PARAMETER(kind, ...)       COM_##kind(__VA_ARGS__)
#define COM_VALUE(type, name)          , type name
#define COM_HANDLE(type, name)         , type name
#define COM_POINTER(type, name)        , type *name
#define COM_OBJECT(type, name)         , type *name
#define COM_OBJECTS(type, name, count) , type **name
#define COM_NEW(type, name)            , type **name
#define COM_READS(type, name, count)   , const type *name
#define COM_WRITES(type, name, count)  , type *name
#define COM_CHANGES(type, name, count) , type *name

/* The arguments that it passes on. */
#define PASS(kind, ...)                 PASS_##kind(__VA_ARGS__)
#define PASS_VALUE(type, name)          , name
#define PASS_HANDLE(type, name)         , (uintptr_t)name
#define PASS_POINTER(type, name)        , name
#define PASS_OBJECT(type, name)         , (void *)name
#define PASS_OBJECTS(type, name, count) , (void *)name
#define PASS_NEW(type, name)            , (void *)name
#define PASS_READS(type, name, count)   , (const void *)name
#define PASS_WRITES(type, name, count)  , (void *)name
#define PASS_CHANGES(type, name, count) , (void *)name

#define COM   IDirect3D9Ex
#define CLASS factory
#define OWN   "front/d3d9/calls/factory.def"
#include "interface.inc"

#define COM   IDirect3DDevice9Ex
#define CLASS device
#define OWN   "front/d3d9/calls/device.def"
#include "interface.inc"

#define HAS_DEVICE
#define COM   IDirect3DSwapChain9Ex
#define CLASS swapchain
#define OWN   "front/d3d9/calls/swapchain.def"
#include "interface.inc"

#define HAS_DEVICE
#define COM   IDirect3DVertexDeclaration9
#define CLASS declaration
#define OWN   "front/d3d9/calls/declaration.def"
#include "interface.inc"

#define HAS_DEVICE
#define COM   IDirect3DVertexShader9
#define CLASS vertex_shader
#define OWN   "front/d3d9/calls/vertex_shader.def"
#include "interface.inc"

#define HAS_DEVICE
#define COM   IDirect3DPixelShader9
#define CLASS pixel_shader
#define OWN   "front/d3d9/calls/pixel_shader.def"
#include "interface.inc"

#define HAS_DEVICE
#define COM   IDirect3DStateBlock9
#define CLASS state_block
#define OWN   "front/d3d9/calls/state_block.def"
#include "interface.inc"

#define HAS_DEVICE
#define COM   IDirect3DQuery9
#define CLASS query
#define OWN   "front/d3d9/calls/query.def"
#include "interface.inc"

#define HAS_DEVICE
#define HAS_PRIVATE_DATA
#define COM   IDirect3DVolume9
#define CLASS volume
#define OWN   "front/d3d9/calls/volume.def"
#include "interface.inc"

#define HAS_DEVICE
#define HAS_PRIVATE_DATA
#define HAS_PRIORITY
#define COM   IDirect3DSurface9
#define CLASS surface
#define OWN   "front/d3d9/calls/surface.def"
#include "interface.inc"

#define HAS_DEVICE
#define HAS_PRIVATE_DATA
#define HAS_PRIORITY
#define COM   IDirect3DVertexBuffer9
#define CLASS vertex_buffer
#define OWN   "front/d3d9/calls/vertex_buffer.def"
#include "interface.inc"

#define HAS_DEVICE
#define HAS_PRIVATE_DATA
#define HAS_PRIORITY
#define COM   IDirect3DIndexBuffer9
#define CLASS index_buffer
#define OWN   "front/d3d9/calls/index_buffer.def"
#include "interface.inc"

#define HAS_DEVICE
#define HAS_PRIVATE_DATA
#define HAS_PRIORITY
#define HAS_LEVELS
#define COM   IDirect3DTexture9
#define CLASS texture
#define OWN   "front/d3d9/calls/texture.def"
#include "interface.inc"

#define HAS_DEVICE
#define HAS_PRIVATE_DATA
#define HAS_PRIORITY
#define HAS_LEVELS
#define COM   IDirect3DCubeTexture9
#define CLASS cube
#define OWN   "front/d3d9/calls/cube.def"
#include "interface.inc"

#define HAS_DEVICE
#define HAS_PRIVATE_DATA
#define HAS_PRIORITY
#define HAS_LEVELS
#define COM   IDirect3DVolumeTexture9
#define CLASS volume_texture
#define OWN   "front/d3d9/calls/volume_texture.def"
#include "interface.inc"

/* The interfaces without Ex have the same vtables: theirs are the beginning. */
static const struct {
    UINT interface;
    const void *vtable;
} vtables[] = {
    {D3D9_INTERFACE_FACTORY, &factory_vtable},
    {D3D9_INTERFACE_FACTORY_EX, &factory_vtable},
    {D3D9_INTERFACE_DEVICE, &device_vtable},
    {D3D9_INTERFACE_DEVICE_EX, &device_vtable},
    {D3D9_INTERFACE_SWAPCHAIN, &swapchain_vtable},
    {D3D9_INTERFACE_SWAPCHAIN_EX, &swapchain_vtable},
    {D3D9_INTERFACE_SURFACE, &surface_vtable},
    {D3D9_INTERFACE_VOLUME, &volume_vtable},
    {D3D9_INTERFACE_TEXTURE, &texture_vtable},
    {D3D9_INTERFACE_CUBE, &cube_vtable},
    {D3D9_INTERFACE_VOLUME_TEXTURE, &volume_texture_vtable},
    {D3D9_INTERFACE_VERTEX_BUFFER, &vertex_buffer_vtable},
    {D3D9_INTERFACE_INDEX_BUFFER, &index_buffer_vtable},
    {D3D9_INTERFACE_DECLARATION, &declaration_vtable},
    {D3D9_INTERFACE_VERTEX_SHADER, &vertex_shader_vtable},
    {D3D9_INTERFACE_PIXEL_SHADER, &pixel_shader_vtable},
    {D3D9_INTERFACE_STATE_BLOCK, &state_block_vtable},
    {D3D9_INTERFACE_QUERY, &query_vtable},
};

void vtable_register(void)
{
    struct d3d9_host_face faces[ARRAYSIZE(vtables)];
    for (UINT i = 0; i < ARRAYSIZE(vtables); i++)
        faces[i] = (struct d3d9_host_face){vtables[i].interface, 0, (uintptr_t)vtables[i].vtable};
    d3d9_host_start(faces, ARRAYSIZE(faces));
}
