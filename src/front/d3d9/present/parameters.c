#include "parameters.h"
#include "front/d3d9/adapter/check.h"

enum { INTERVAL_DEFAULT = 0, INTERVAL_ONE = 1, MOST_BUFFERS_BASE = 3, SIZE_WITHOUT_WINDOW = 8 };

static bool interval_is_valid(uint32_t interval)
{
    const uint32_t immediate = 0x80000000u;
    return interval == INTERVAL_DEFAULT || interval == INTERVAL_ONE || interval == immediate;
}

static bool swap_effect_is_valid(uint32_t effect, bool extended)
{
    if (extended && effect == D3D9_SWAP_FLIP_EX)
        return true;
    return effect >= D3D9_SWAP_DISCARD && effect <= D3D9_SWAP_COPY;
}

static bool counts_are_valid(const struct d3d9_present_parameters *p, bool extended)
{
    uint32_t most = extended ? D3D9_MOST_BACK_BUFFERS : MOST_BUFFERS_BASE;
    if (p->swap_effect == D3D9_SWAP_COPY)
        most = 1;
    return p->back_buffer_count <= most;
}

static bool samples_are_valid(const struct d3d9_present_parameters *p)
{
    uint32_t samples = d3d9_check_samples(p->multi_sample_type, p->multi_sample_quality);
    if (samples <= 1)
        return samples;
    return p->swap_effect == D3D9_SWAP_DISCARD && !(p->flags & D3D9_PRESENT_LOCKABLE);
}

/* The format of the display in full screen, for a format of back buffers. */
static uint32_t display_format(uint32_t back_buffer)
{
    switch (back_buffer) {
    case TRIPTYCH_SURFACE_A8R8G8B8: return TRIPTYCH_SURFACE_X8R8G8B8;
    case TRIPTYCH_SURFACE_A1R5G5B5: return TRIPTYCH_SURFACE_X1R5G5B5;
    default: return back_buffer;
    }
}

static bool is_mode(uint32_t adapter, const struct d3d9_present_parameters *p)
{
    uint32_t count, format = display_format(p->back_buffer_format), rate = p->full_screen_refresh_rate;
    const struct d3d9_host_mode *modes = d3d9_host_modes(adapter, &count);
    for (uint32_t i = 0; i < count; i++)
        if (modes[i].width == p->back_buffer_width && modes[i].height == p->back_buffer_height &&
            modes[i].format == format && (!rate || modes[i].refresh_rate == rate))
            return true;
    return false;
}

static void fill_size(struct d3d9_present_parameters *p, const struct d3d9_host_window *window)
{
    if (!p->back_buffer_width)
        p->back_buffer_width = window->width ? window->width : SIZE_WITHOUT_WINDOW;
    if (!p->back_buffer_height)
        p->back_buffer_height = window->height ? window->height : SIZE_WITHOUT_WINDOW;
}

int32_t d3d9_parameters_complete(struct d3d9_present_parameters *p, uint32_t index,
                                 const struct d3d9_host_window *window, bool extended)
{
    const struct d3d9_host_adapter *adapter = d3d9_host_adapter(index);
    const uint32_t most = TRIPTYCH_TARGET_MAXIMUM;
    if (!adapter || !swap_effect_is_valid(p->swap_effect, extended) || !counts_are_valid(p, extended) ||
        !samples_are_valid(p) || !interval_is_valid(p->presentation_interval))
        return D3D9_INVALID_CALL;
    struct d3d9_present_parameters filled = *p;
    if (!filled.back_buffer_count)
        filled.back_buffer_count = 1;
    if (!filled.back_buffer_format)
        filled.back_buffer_format = adapter->current.format;
    if (filled.windowed)
        fill_size(&filled, window);
    uint32_t display = filled.windowed ? adapter->current.format : display_format(filled.back_buffer_format);
    if (!d3d9_check_back_buffer(display, filled.back_buffer_format, filled.windowed))
        return D3D9_INVALID_CALL;
    if (filled.back_buffer_width > most || filled.back_buffer_height > most)
        return D3D9_INVALID_CALL;
    if (!filled.windowed && !is_mode(index, &filled))
        return D3D9_INVALID_CALL;
    if (filled.enable_auto_depth_stencil &&
        d3d9_check_format(D3D9_USAGE_DEPTH_STENCIL, D3D9_TYPE_SURFACE, filled.auto_depth_stencil_format) < 0)
        return D3D9_INVALID_CALL;
    *p = filled;
    return D3D9_OK;
}

int32_t d3d9_parameters_check_mode(const struct d3d9_present_parameters *p,
                                   const struct d3d9_display_mode_ex *mode)
{
    if (p->windowed)
        return mode ? D3D9_INVALID_CALL : D3D9_OK;
    if (!mode || mode->size != sizeof *mode)
        return D3D9_INVALID_CALL;
    return mode->width == p->back_buffer_width && mode->height == p->back_buffer_height ? D3D9_OK
                                                                                        : D3D9_INVALID_CALL;
}
