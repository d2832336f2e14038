/* The data that the two sides of the front end exchange besides Direct3D's own structures. The Windows side
 * (pe) has the vtables, windows and display modes; the Linux side has everything else. Linux never calls
 * Windows. The data that it needs are arguments of the call, or were handed over before it. The work that it
 * leaves for Windows is in the arguments that it fills, or in the list of events.
 *
 * All structures have the same layout in processes with 32- and 64-bit pointers: pointers and handles are
 * uint64_t. */
#ifndef D3D9_HOST_H
#define D3D9_HOST_H

#include "types.h"
#include <stdbool.h>

/* The members of every object that the Windows side reads and writes, which are the first ones. `host` is the
 * Windows side's own data of this object, 0 at first. `references` are those of the program; parts of
 * textures have none of their own (object.h). `draws` is nonzero
 * - for a device: if draws succeed whose arguments are valid,
 * - for a vertex shader: if draws with it do not fail, whatever the device's vertex processing is. */
struct d3d9_head {
    uint64_t face, host;
    uint32_t references, draws;
    uint64_t parent; /* of objects of a device: the device */
};

/* The vtable of an interface; `number` is of enum d3d9_interface. Windows' headers define "interface". */
struct d3d9_host_face {
    uint32_t number, reserved;
    uint64_t vtable;
};

/* A display mode. `format` is a D3DFORMAT. */
struct d3d9_host_mode {
    uint32_t width, height, refresh_rate, format;
    uint32_t rotation; /* D3DDISPLAYROTATION */
};

struct d3d9_host_adapter {
    uint64_t monitor; /* HMONITOR */
    uint64_t luid;
    char name[32];                          /* of the display device, such as \\.\DISPLAY1 */
    struct d3d9_host_mode current, desktop; /* now, and in the registry */
};

/* A window at the time of the call. A window that does not exist has zeros. */
struct d3d9_host_window {
    uint64_t window;
    uint32_t width, height; /* of the client area */
    uint32_t exists, minimized;
};

/* Memory of pixels, rows from the top. `format` is a D3DFORMAT. */
struct d3d9_host_bits {
    uint64_t bits;
    uint32_t pitch, width, height, format;
};

/* A presented back buffer. In: a bitmap of at least the size of the buffer, as D3DFMT_X8R8G8B8 with rows from
 * the top; bits 0: there is none yet. Out: which buffer was presented, and 1 in `filled` if the bitmap was
 * large enough and has its pixels, with the gamma ramp applied in full screen. Where in the window it is
 * drawn is the Windows side's work. */
struct d3d9_host_picture {
    uint64_t bits;
    uint32_t pitch, room_width, room_height, filled;
    uint64_t swapchain, window; /* the window: the argument's, else the swap chain's */
    uint32_t width, height;     /* of the buffer */
    uint32_t swap_effect, interval, windowed;
    uint32_t shown; /* 0: nothing is to be drawn (an error, an occluded window, D3DPRESENT_DONOTFLIP) */
};

/* Work for the Windows side after a call. */
enum d3d9_host_event_kind {
    D3D9_EVENT_RELEASE = 1, /* call Release of the program's COM object `pointer` */
    D3D9_EVENT_FORGET       /* free the Windows side's data `pointer` (struct d3d9_head) */
};
struct d3d9_host_event {
    uint32_t kind, reserved;
    uint64_t pointer;
};

/* --- Of the Linux side ---------------------------------------------------------------------------------- */

enum { D3D9_HOST_ADAPTERS = 16 };

/* The number of adapters, at least 1 after the start. */
uint32_t d3d9_host_adapter_count(void);
/* An adapter; null if there is none with this number. The current mode is that of the last call that depends
 * on it. `modes` gets the address of its modes, which stays valid until the adapters are set again. */
const struct d3d9_host_adapter *d3d9_host_adapter(uint32_t index);
const struct d3d9_host_mode *d3d9_host_modes(uint32_t index, uint32_t *count);

/* Leaves an event. Without memory for it the event is lost and the object leaks. */
void d3d9_host_event(enum d3d9_host_event_kind, uint64_t pointer);
/* Returns true if there are events or interfaces to release. */
bool d3d9_host_has_events(void);

#endif
