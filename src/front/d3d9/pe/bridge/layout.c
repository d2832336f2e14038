/* Compares the structures of types.h with those of Windows' headers: sizes, and the offsets of all members.
 * */
#include <windows.h>
#include <d3d9.h>
#include "front/d3d9/remote/narrow.h"
#include "front/d3d9/types.h"
#include <stddef.h>

#define SAME_SIZE(theirs, ours) _Static_assert(sizeof(theirs) == sizeof(struct ours), #theirs)
#define SAME(theirs, their, ours, our)                                                                       \
    _Static_assert(offsetof(theirs, their) == offsetof(struct ours, our) &&                                  \
                       sizeof(((theirs *)0)->their) == sizeof(((struct ours *)0)->our),                      \
                   #theirs "." #their)

SAME_SIZE(GUID, d3d9_guid);
SAME_SIZE(LUID, d3d9_luid);
SAME_SIZE(RECT, d3d9_rect);
SAME_SIZE(D3DRECT, d3d9_rect);
SAME(D3DRECT, x2, d3d9_rect, right);
SAME_SIZE(POINT, d3d9_point);
SAME_SIZE(D3DBOX, d3d9_box);
SAME(D3DBOX, Right, d3d9_box, right);
SAME(D3DBOX, Front, d3d9_box, front);
SAME_SIZE(RGNDATAHEADER, d3d9_region);
SAME(RGNDATA, rdh.nCount, d3d9_region, count);
SAME(RGNDATA, rdh.rcBound, d3d9_region, bounds);
SAME_SIZE(PALETTEENTRY, d3d9_palette_entry);
SAME_SIZE(D3DMATRIX, d3d9_matrix);
SAME_SIZE(D3DVIEWPORT9, d3d9_viewport);
SAME(D3DVIEWPORT9, MinZ, d3d9_viewport, min_z);
SAME_SIZE(D3DMATERIAL9, d3d9_material);
SAME(D3DMATERIAL9, Specular, d3d9_material, specular);
SAME(D3DMATERIAL9, Power, d3d9_material, power);
SAME_SIZE(D3DLIGHT9, d3d9_light);
SAME(D3DLIGHT9, Specular, d3d9_light, specular);
SAME(D3DLIGHT9, Position, d3d9_light, position);
SAME(D3DLIGHT9, Falloff, d3d9_light, falloff);
SAME(D3DLIGHT9, Attenuation0, d3d9_light, attenuation0);
SAME(D3DLIGHT9, Theta, d3d9_light, theta);
SAME_SIZE(D3DCLIPSTATUS9, d3d9_clip_status);
SAME_SIZE(D3DGAMMARAMP, d3d9_gamma_ramp);
SAME_SIZE(D3DRASTER_STATUS, d3d9_raster_status);
SAME_SIZE(D3DVERTEXELEMENT9, d3d9_vertex_element);
SAME(D3DVERTEXELEMENT9, Usage, d3d9_vertex_element, usage);
SAME_SIZE(D3DSURFACE_DESC, d3d9_surface_desc);
SAME(D3DSURFACE_DESC, Pool, d3d9_surface_desc, pool);
SAME(D3DSURFACE_DESC, Height, d3d9_surface_desc, height);
SAME_SIZE(D3DVOLUME_DESC, d3d9_volume_desc);
SAME(D3DVOLUME_DESC, Depth, d3d9_volume_desc, depth);
SAME_SIZE(D3DVERTEXBUFFER_DESC, d3d9_vertex_buffer_desc);
SAME(D3DVERTEXBUFFER_DESC, Size, d3d9_vertex_buffer_desc, size);
SAME_SIZE(D3DINDEXBUFFER_DESC, d3d9_index_buffer_desc);
SAME(D3DINDEXBUFFER_DESC, Size, d3d9_index_buffer_desc, size);
SAME_SIZE(D3DRECTPATCH_INFO, d3d9_rect_patch_info);
SAME_SIZE(D3DTRIPATCH_INFO, d3d9_tri_patch_info);
SAME_SIZE(D3DDISPLAYMODE, d3d9_display_mode);
SAME(D3DDISPLAYMODE, Format, d3d9_display_mode, format);
SAME_SIZE(D3DDISPLAYMODEEX, d3d9_display_mode_ex);
SAME(D3DDISPLAYMODEEX, ScanLineOrdering, d3d9_display_mode_ex, scan_line_ordering);
SAME_SIZE(D3DDISPLAYMODEFILTER, d3d9_display_mode_filter);
SAME(D3DADAPTER_IDENTIFIER9, DriverVersion, d3d9_adapter_identifier, driver_version);
SAME(D3DADAPTER_IDENTIFIER9, DeviceIdentifier, d3d9_adapter_identifier, device_identifier);
SAME(D3DADAPTER_IDENTIFIER9, WHQLLevel, d3d9_adapter_identifier, whql_level);
SAME_SIZE(D3DCAPS9, d3d9_caps);
SAME(D3DCAPS9, LineCaps, d3d9_caps, line_caps);
SAME(D3DCAPS9, MaxVertexW, d3d9_caps, max_vertex_w);
SAME(D3DCAPS9, StencilCaps, d3d9_caps, stencil_caps);
SAME(D3DCAPS9, MaxPointSize, d3d9_caps, max_point_size);
SAME(D3DCAPS9, PixelShaderVersion, d3d9_caps, pixel_shader_version);
SAME(D3DCAPS9, DeclTypes, d3d9_caps, decl_types);
SAME(D3DCAPS9, PS20Caps, d3d9_caps, ps20_caps);
SAME(D3DCAPS9, MaxPixelShader30InstructionSlots, d3d9_caps, max_pixel_shader30_instruction_slots);

/* Structures with addresses, handles or 64-bit numbers have another layout in 32-bit programs
 * (remote/narrow.h). */
#ifdef _WIN64
SAME_SIZE(D3DLOCKED_RECT, d3d9_locked_rect);
SAME(D3DLOCKED_RECT, pBits, d3d9_locked_rect, bits);
SAME_SIZE(D3DLOCKED_BOX, d3d9_locked_box);
SAME(D3DLOCKED_BOX, pBits, d3d9_locked_box, bits);
SAME_SIZE(D3DPRESENT_PARAMETERS, d3d9_present_parameters);
SAME(D3DPRESENT_PARAMETERS, hDeviceWindow, d3d9_present_parameters, device_window);
SAME(D3DPRESENT_PARAMETERS, Windowed, d3d9_present_parameters, windowed);
SAME(D3DPRESENT_PARAMETERS, PresentationInterval, d3d9_present_parameters, presentation_interval);
SAME_SIZE(D3DDEVICE_CREATION_PARAMETERS, d3d9_creation_parameters);
SAME(D3DDEVICE_CREATION_PARAMETERS, hFocusWindow, d3d9_creation_parameters, focus_window);
SAME_SIZE(D3DPRESENTSTATS, d3d9_present_stats);
SAME(D3DPRESENTSTATS, SyncQPCTime, d3d9_present_stats, sync_qpc_time);
SAME_SIZE(D3DADAPTER_IDENTIFIER9, d3d9_adapter_identifier);
#else
SAME_SIZE(D3DPRESENTSTATS, d3d9_narrow_present_stats);
SAME_SIZE(D3DADAPTER_IDENTIFIER9, d3d9_narrow_adapter_identifier);
SAME_SIZE(D3DLOCKED_RECT, d3d9_narrow_locked_rect);
SAME(D3DLOCKED_RECT, pBits, d3d9_narrow_locked_rect, bits);
SAME_SIZE(D3DLOCKED_BOX, d3d9_narrow_locked_box);
SAME(D3DLOCKED_BOX, pBits, d3d9_narrow_locked_box, bits);
SAME_SIZE(D3DPRESENT_PARAMETERS, d3d9_narrow_present_parameters);
SAME(D3DPRESENT_PARAMETERS, hDeviceWindow, d3d9_narrow_present_parameters, device_window);
SAME_SIZE(D3DDEVICE_CREATION_PARAMETERS, d3d9_narrow_creation_parameters);
SAME(D3DDEVICE_CREATION_PARAMETERS, hFocusWindow, d3d9_narrow_creation_parameters, focus_window);
#endif
