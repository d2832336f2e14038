/* The raster of a display, by the clock. Windows' displays have one, and programs wait until it is in the
 * vertical blank or out of it. Its period is that of the refresh rate. The last twentieth of the period
 * is blank. */
#include "base/clock.h"
#include "front/d3d9/call.h"
#include "swapchain.h"

enum { SECOND = 1000000000, USUAL_RATE = 60, BLANK = 20 };

int32_t d3d9_swapchain_get_raster_status(struct d3d9_swapchain *chain, struct d3d9_raster_status *status)
{
    struct d3d9_display_mode mode;
    if (!status)
        return D3D9_INVALID_CALL;
    int32_t result = d3d9_swapchain_get_display_mode(chain, &mode);
    if (result < 0)
        return result;
    const uint64_t period = SECOND / (mode.refresh_rate ? mode.refresh_rate : USUAL_RATE);
    const uint64_t lines = mode.height + mode.height / BLANK + 1;
    const uint64_t line = clock_ns() % period * lines / period;
    status->in_vblank = line >= mode.height;
    status->scan_line = status->in_vblank ? 0 : (uint32_t)line;
    return D3D9_OK;
}
