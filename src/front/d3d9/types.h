/* Direct3D 9's structures as Windows lays them out in a 64-bit process. pe/layout.c compares them with
 * Windows' headers. Enumerations are uint32_t, because programs also pass other numbers.
 *
 * call.h maps the names in the folder calls to these types. */
#ifndef D3D9_TYPES_H
#define D3D9_TYPES_H

#include "guid.h"
#include "result.h"
#include <stdint.h>

struct d3d9_rect {
    int32_t left, top, right, bottom;
};

struct d3d9_point {
    int32_t x, y;
};

struct d3d9_box {
    uint32_t left, top, right, bottom, front, back;
};

struct d3d9_luid {
    uint32_t low;
    int32_t high;
};

struct d3d9_locked_rect {
    int32_t pitch;
    void *bits;
};

struct d3d9_locked_box {
    int32_t row_pitch, slice_pitch;
    void *bits;
};

/* A clip region: `count` rectangles follow the header. */
struct d3d9_region {
    uint32_t header_bytes, type, count, bytes; /* `bytes` of rectangles */
    struct d3d9_rect bounds;
    struct d3d9_rect rectangles[];
};

struct d3d9_color_value {
    float r, g, b, a;
};

struct d3d9_vector {
    float x, y, z;
};

struct d3d9_matrix {
    float m[4][4];
};

struct d3d9_viewport {
    uint32_t x, y, width, height;
    float min_z, max_z;
};

struct d3d9_material {
    struct d3d9_color_value diffuse, ambient, specular, emissive;
    float power;
};

struct d3d9_light {
    uint32_t type;
    struct d3d9_color_value diffuse, specular, ambient;
    struct d3d9_vector position, direction;
    float range, falloff, attenuation0, attenuation1, attenuation2, theta, phi;
};

struct d3d9_clip_status {
    uint32_t clip_union, clip_intersection;
};

struct d3d9_palette_entry {
    uint8_t red, green, blue, flags;
};

struct d3d9_gamma_ramp {
    uint16_t red[256], green[256], blue[256];
};

struct d3d9_raster_status {
    int32_t in_vblank;
    uint32_t scan_line;
};

struct d3d9_vertex_element {
    uint16_t stream, offset;
    uint8_t type, method, usage, usage_index;
};

struct d3d9_surface_desc {
    uint32_t format, type, usage, pool, multi_sample_type, multi_sample_quality, width, height;
};

struct d3d9_volume_desc {
    uint32_t format, type, usage, pool, width, height, depth;
};

struct d3d9_vertex_buffer_desc {
    uint32_t format, type, usage, pool, size, fvf;
};

struct d3d9_index_buffer_desc {
    uint32_t format, type, usage, pool, size;
};

struct d3d9_rect_patch_info {
    uint32_t start_vertex_offset_width, start_vertex_offset_height, width, height, stride, basis, degree;
};

struct d3d9_tri_patch_info {
    uint32_t start_vertex_offset, num_vertices, basis, degree;
};

struct d3d9_display_mode {
    uint32_t width, height, refresh_rate, format;
};

struct d3d9_display_mode_ex {
    uint32_t size, width, height, refresh_rate, format, scan_line_ordering;
};

struct d3d9_display_mode_filter {
    uint32_t size, format, scan_line_ordering;
};

struct d3d9_present_parameters {
    uint32_t back_buffer_width, back_buffer_height, back_buffer_format, back_buffer_count;
    uint32_t multi_sample_type, multi_sample_quality, swap_effect;
    uint64_t device_window;
    int32_t windowed, enable_auto_depth_stencil;
    uint32_t auto_depth_stencil_format, flags, full_screen_refresh_rate, presentation_interval;
};

struct d3d9_present_stats {
    uint32_t present_count, present_refresh_count, sync_refresh_count;
    int64_t sync_qpc_time, sync_gpu_time;
};

struct d3d9_creation_parameters {
    uint32_t adapter, device_type;
    uint64_t focus_window;
    uint32_t behavior_flags;
};

struct d3d9_adapter_identifier {
    char driver[512], description[512], device_name[32];
    int64_t driver_version;
    uint32_t vendor_id, device_id, sub_sys_id, revision;
    struct d3d9_guid device_identifier;
    uint32_t whql_level;
};

struct d3d9_vertex_shader_caps {
    uint32_t caps;
    int32_t dynamic_flow_control_depth, num_temps, static_flow_control_depth;
};

struct d3d9_pixel_shader_caps {
    uint32_t caps;
    int32_t dynamic_flow_control_depth, num_temps, static_flow_control_depth, num_instruction_slots;
};

struct d3d9_caps {
    uint32_t device_type, adapter_ordinal;
    uint32_t caps, caps2, caps3, presentation_intervals, cursor_caps, dev_caps, primitive_misc_caps;
    uint32_t raster_caps, z_cmp_caps, src_blend_caps, dest_blend_caps, alpha_cmp_caps, shade_caps;
    uint32_t texture_caps, texture_filter_caps, cube_texture_filter_caps, volume_texture_filter_caps;
    uint32_t texture_address_caps, volume_texture_address_caps, line_caps;
    uint32_t max_texture_width, max_texture_height, max_volume_extent, max_texture_repeat;
    uint32_t max_texture_aspect_ratio, max_anisotropy;
    float max_vertex_w, guard_band_left, guard_band_top, guard_band_right, guard_band_bottom, extents_adjust;
    uint32_t stencil_caps, fvf_caps, texture_op_caps, max_texture_blend_stages, max_simultaneous_textures;
    uint32_t vertex_processing_caps, max_active_lights, max_user_clip_planes, max_vertex_blend_matrices;
    uint32_t max_vertex_blend_matrix_index;
    float max_point_size;
    uint32_t max_primitive_count, max_vertex_index, max_streams, max_stream_stride;
    uint32_t vertex_shader_version, max_vertex_shader_const, pixel_shader_version;
    float pixel_shader_1x_max_value;
    uint32_t dev_caps2;
    float max_npatch_tessellation_level;
    uint32_t reserved5, master_adapter_ordinal, adapter_ordinal_in_group, number_of_adapters_in_group;
    uint32_t decl_types, num_simultaneous_rts, stretch_rect_filter_caps;
    struct d3d9_vertex_shader_caps vs20_caps;
    struct d3d9_pixel_shader_caps ps20_caps;
    uint32_t vertex_texture_filter_caps, max_vshader_instructions_executed;
    uint32_t max_pshader_instructions_executed, max_vertex_shader30_instruction_slots;
    uint32_t max_pixel_shader30_instruction_slots;
};

#endif
