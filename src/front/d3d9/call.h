/* The functions of the Linux side, one for each row of calls/calls.def, such as
 *
 *     int32_t d3d9_device_clear(struct d3d9_device *self, uint32_t count, const struct d3d9_rect *rectangles,
 *                               uint32_t flags, uint32_t color, float z, uint32_t stencil);
 *
 * Arguments are as the program passed them: pointers may be null, numbers may be anything. Addresses that are
 * neither null nor valid are not found out. Calls come one at a time (dispatch.h). */
#ifndef D3D9_CALL_H
#define D3D9_CALL_H

#include "each.h"
#include "host.h"

struct d3d9_object;
struct d3d9_factory;
struct d3d9_device;
struct d3d9_swapchain;
struct d3d9_surface;
struct d3d9_base_texture;
struct d3d9_texture;
struct d3d9_cube;
struct d3d9_volume_texture;
struct d3d9_volume;
struct d3d9_vertex_buffer;
struct d3d9_index_buffer;
struct d3d9_declaration;
struct d3d9_vertex_shader;
struct d3d9_pixel_shader;
struct d3d9_state_block;
struct d3d9_query;

/* Windows' names of types. */
typedef void d3d9_type_void;
typedef float d3d9_type_float;
typedef int32_t d3d9_type_HRESULT, d3d9_type_INT, d3d9_type_BOOL;
typedef uint32_t d3d9_type_UINT, d3d9_type_UINT32, d3d9_type_DWORD, d3d9_type_ULONG, d3d9_type_D3DCOLOR;
typedef uint32_t d3d9_type_D3DFORMAT, d3d9_type_D3DPOOL, d3d9_type_D3DDEVTYPE, d3d9_type_D3DRESOURCETYPE;
typedef uint32_t d3d9_type_D3DMULTISAMPLE_TYPE, d3d9_type_D3DBACKBUFFER_TYPE, d3d9_type_D3DCUBEMAP_FACES;
typedef uint32_t d3d9_type_D3DTEXTUREFILTERTYPE, d3d9_type_D3DTRANSFORMSTATETYPE, d3d9_type_D3DQUERYTYPE;
typedef uint32_t d3d9_type_D3DRENDERSTATETYPE, d3d9_type_D3DTEXTURESTAGESTATETYPE;
typedef uint32_t d3d9_type_D3DSAMPLERSTATETYPE, d3d9_type_D3DSTATEBLOCKTYPE, d3d9_type_D3DPRIMITIVETYPE;
typedef uint32_t d3d9_type_D3DCOMPOSERECTSOP, d3d9_type_D3DDISPLAYROTATION;
typedef uint64_t d3d9_type_HWND, d3d9_type_HANDLE;
typedef struct d3d9_guid d3d9_type_GUID;
typedef struct d3d9_luid d3d9_type_LUID;
typedef struct d3d9_rect d3d9_type_RECT, d3d9_type_D3DRECT;
typedef struct d3d9_point d3d9_type_POINT;
typedef struct d3d9_region d3d9_type_RGNDATA;
typedef struct d3d9_palette_entry d3d9_type_PALETTEENTRY;
typedef struct d3d9_box d3d9_type_D3DBOX;
typedef struct d3d9_locked_rect d3d9_type_D3DLOCKED_RECT;
typedef struct d3d9_locked_box d3d9_type_D3DLOCKED_BOX;
typedef struct d3d9_matrix d3d9_type_D3DMATRIX;
typedef struct d3d9_viewport d3d9_type_D3DVIEWPORT9;
typedef struct d3d9_material d3d9_type_D3DMATERIAL9;
typedef struct d3d9_light d3d9_type_D3DLIGHT9;
typedef struct d3d9_clip_status d3d9_type_D3DCLIPSTATUS9;
typedef struct d3d9_gamma_ramp d3d9_type_D3DGAMMARAMP;
typedef struct d3d9_raster_status d3d9_type_D3DRASTER_STATUS;
typedef struct d3d9_vertex_element d3d9_type_D3DVERTEXELEMENT9;
typedef struct d3d9_surface_desc d3d9_type_D3DSURFACE_DESC;
typedef struct d3d9_volume_desc d3d9_type_D3DVOLUME_DESC;
typedef struct d3d9_vertex_buffer_desc d3d9_type_D3DVERTEXBUFFER_DESC;
typedef struct d3d9_index_buffer_desc d3d9_type_D3DINDEXBUFFER_DESC;
typedef struct d3d9_rect_patch_info d3d9_type_D3DRECTPATCH_INFO;
typedef struct d3d9_tri_patch_info d3d9_type_D3DTRIPATCH_INFO;
typedef struct d3d9_display_mode d3d9_type_D3DDISPLAYMODE;
typedef struct d3d9_display_mode_ex d3d9_type_D3DDISPLAYMODEEX;
typedef struct d3d9_display_mode_filter d3d9_type_D3DDISPLAYMODEFILTER;
typedef struct d3d9_present_parameters d3d9_type_D3DPRESENT_PARAMETERS;
typedef struct d3d9_present_stats d3d9_type_D3DPRESENTSTATS;
typedef struct d3d9_creation_parameters d3d9_type_D3DDEVICE_CREATION_PARAMETERS;
typedef struct d3d9_adapter_identifier d3d9_type_D3DADAPTER_IDENTIFIER9;
typedef struct d3d9_caps d3d9_type_D3DCAPS9;

typedef struct d3d9_factory d3d9_type_IDirect3D9, d3d9_type_IDirect3D9Ex;
typedef struct d3d9_device d3d9_type_IDirect3DDevice9, d3d9_type_IDirect3DDevice9Ex;
typedef struct d3d9_swapchain d3d9_type_IDirect3DSwapChain9, d3d9_type_IDirect3DSwapChain9Ex;
typedef struct d3d9_object d3d9_type_IUnknown, d3d9_type_IDirect3DResource9;
typedef struct d3d9_surface d3d9_type_IDirect3DSurface9;
typedef struct d3d9_base_texture d3d9_type_IDirect3DBaseTexture9;
typedef struct d3d9_texture d3d9_type_IDirect3DTexture9;
typedef struct d3d9_cube d3d9_type_IDirect3DCubeTexture9;
typedef struct d3d9_volume_texture d3d9_type_IDirect3DVolumeTexture9;
typedef struct d3d9_volume d3d9_type_IDirect3DVolume9;
typedef struct d3d9_vertex_buffer d3d9_type_IDirect3DVertexBuffer9;
typedef struct d3d9_index_buffer d3d9_type_IDirect3DIndexBuffer9;
typedef struct d3d9_declaration d3d9_type_IDirect3DVertexDeclaration9;
typedef struct d3d9_vertex_shader d3d9_type_IDirect3DVertexShader9;
typedef struct d3d9_pixel_shader d3d9_type_IDirect3DPixelShader9;
typedef struct d3d9_state_block d3d9_type_IDirect3DStateBlock9;
typedef struct d3d9_query d3d9_type_IDirect3DQuery9;

/* The parameters of a function. Each begins with a comma, because the object is first. */
#define D3D9_PARAMETER(kind, ...)                      D3D9_PARAMETER_##kind(__VA_ARGS__)
#define D3D9_PARAMETER_VALUE(type, name)               , d3d9_type_##type name
#define D3D9_PARAMETER_HANDLE(type, name)              , uint64_t name
#define D3D9_PARAMETER_POINTER(type, name)             , d3d9_type_##type *name
#define D3D9_PARAMETER_OBJECT(type, name)              , d3d9_type_##type *name
#define D3D9_PARAMETER_OBJECTS(type, name, count)      , d3d9_type_##type **name
#define D3D9_PARAMETER_NEW(type, name)                 , d3d9_type_##type **name
#define D3D9_PARAMETER_READS(type, name, count)        , const d3d9_type_##type *name
#define D3D9_PARAMETER_WRITES(type, name, count)       , d3d9_type_##type *name
#define D3D9_PARAMETER_CHANGES(type, name, count)      , d3d9_type_##type *name
#define D3D9_PARAMETER_HOST_READS(type, name, count)   , const struct d3d9_##type *name
#define D3D9_PARAMETER_HOST_WRITES(type, name, count)  , struct d3d9_##type *name
#define D3D9_PARAMETER_HOST_CHANGES(type, name, count) , struct d3d9_##type *name

/* A function without an object has no parameter before the first comma. */
#define D3D9_WITHOUT_COMMA(...)         D3D9_WITHOUT_COMMA_(__VA_ARGS__)
#define D3D9_WITHOUT_COMMA_(first, ...) __VA_ARGS__

#define METHOD(class, method, name, result, ...)                                                             \
    d3d9_type_##result d3d9_##class##_##name(                                                                \
        struct d3d9_##class *self D3D9_EACH(D3D9_PARAMETER, __VA_ARGS__));
#define HOSTED METHOD
#define PROCEDURE(class, method, name, ...)                                                                  \
    void d3d9_##class##_##name(struct d3d9_##class *self D3D9_EACH(D3D9_PARAMETER, __VA_ARGS__));
#define LOCAL(class, method)
#define FUNCTION(class, name, result, ...)                                                                   \
    d3d9_type_##result d3d9_##class##_##name(D3D9_WITHOUT_COMMA(D3D9_EACH(D3D9_PARAMETER, __VA_ARGS__)));
#include "calls/calls.def"
#undef METHOD
#undef HOSTED
#undef PROCEDURE
#undef LOCAL
#undef FUNCTION

#endif
