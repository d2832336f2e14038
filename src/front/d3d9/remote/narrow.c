#include "narrow.h"
#include "packing.h"

#include <string.h>

/* The layouts of the server, where types.h has a pointer: this file is compiled for both. */
struct wide_locked_rect {
    int32_t pitch;
    uint64_t bits;
};

struct wide_locked_box {
    int32_t row_pitch, slice_pitch;
    uint64_t bits;
};

static void widen_address(const void *narrow, void *wide)
{
    const uint32_t *from = narrow;
    *(uint64_t *)wide = *from;
}

static void shorten_address(const void *wide, void *narrow)
{
    const uint64_t *from = wide;
    *(uint32_t *)narrow = (uint32_t)*from;
}

static void widen_locked_rect(const void *narrow, void *wide)
{
    const struct d3d9_narrow_locked_rect *from = narrow;
    *(struct wide_locked_rect *)wide = (struct wide_locked_rect){from->pitch, from->bits};
}

static void shorten_locked_rect(const void *wide, void *narrow)
{
    const struct wide_locked_rect *from = wide;
    *(struct d3d9_narrow_locked_rect *)narrow =
        (struct d3d9_narrow_locked_rect){from->pitch, (uint32_t)from->bits};
}

static void widen_locked_box(const void *narrow, void *wide)
{
    const struct d3d9_narrow_locked_box *from = narrow;
    *(struct wide_locked_box *)wide =
        (struct wide_locked_box){from->row_pitch, from->slice_pitch, from->bits};
}

static void shorten_locked_box(const void *wide, void *narrow)
{
    const struct wide_locked_box *from = wide;
    *(struct d3d9_narrow_locked_box *)narrow =
        (struct d3d9_narrow_locked_box){from->row_pitch, from->slice_pitch, (uint32_t)from->bits};
}

/* The members on both sides of the window are the same words. */
static void widen_present_parameters(const void *narrow, void *wide)
{
    const struct d3d9_narrow_present_parameters *from = narrow;
    struct d3d9_present_parameters *to = wide;
    memcpy(to, from->before, sizeof from->before);
    to->device_window = from->device_window;
    memcpy(&to->windowed, from->after, sizeof from->after);
}

static void shorten_present_parameters(const void *wide, void *narrow)
{
    const struct d3d9_present_parameters *from = wide;
    struct d3d9_narrow_present_parameters *to = narrow;
    memcpy(to->before, from, sizeof to->before);
    to->device_window = (uint32_t)from->device_window;
    memcpy(to->after, &from->windowed, sizeof to->after);
}

static void widen_creation_parameters(const void *narrow, void *wide)
{
    const struct d3d9_narrow_creation_parameters *from = narrow;
    *(struct d3d9_creation_parameters *)wide = (struct d3d9_creation_parameters){
        from->adapter, from->device_type, from->focus_window, from->behavior_flags};
}

static void shorten_creation_parameters(const void *wide, void *narrow)
{
    const struct d3d9_creation_parameters *from = wide;
    *(struct d3d9_narrow_creation_parameters *)narrow = (struct d3d9_narrow_creation_parameters){
        from->adapter, from->device_type, (uint32_t)from->focus_window, from->behavior_flags};
}

/* The times follow the counts, after a word of padding in the wide structure. */
static void widen_present_stats(const void *narrow, void *wide)
{
    const struct d3d9_narrow_present_stats *from = narrow;
    struct d3d9_present_stats *to = wide;
    memcpy(&to->present_count, from->counts, sizeof from->counts);
    memcpy(&to->sync_qpc_time, from->times, sizeof from->times);
}

static void shorten_present_stats(const void *wide, void *narrow)
{
    const struct d3d9_present_stats *from = wide;
    struct d3d9_narrow_present_stats *to = narrow;
    memcpy(to->counts, &from->present_count, sizeof to->counts);
    memcpy(to->times, &from->sync_qpc_time, sizeof to->times);
}

/* The wide structure has padding at its end only. */
static void widen_adapter_identifier(const void *narrow, void *wide)
{
    memcpy(wide, narrow, sizeof(struct d3d9_narrow_adapter_identifier));
}

static void shorten_adapter_identifier(const void *wide, void *narrow)
{
    memcpy(narrow, wide, sizeof(struct d3d9_narrow_adapter_identifier));
}

/* --- Presented pictures: the server writes to memory that it shares --- */

static size_t picture_bytes(const struct d3d9_host_picture *picture)
{
    return (size_t)picture->pitch * picture->room_height;
}

static void attach_picture(struct d3d9_packing *packing, void *wide)
{
    struct d3d9_host_picture *picture = wide;
    if (picture->bits)
        picture->bits = d3d9_packing_take(packing, picture_bytes(picture));
}

static void detach_picture(const void *before, void *wide)
{
    const struct d3d9_host_picture *program = before;
    struct d3d9_host_picture *picture = wide;
    if (program->bits && picture->filled)
        memcpy((void *)(uintptr_t)program->bits, (const void *)(uintptr_t)picture->bits,
               picture_bytes(program));
    picture->bits = program->bits;
}

/* --- The types --- */

const struct d3d9_narrow d3d9_narrow_address = {4, 8, widen_address, shorten_address, NULL, NULL};
const struct d3d9_narrow d3d9_narrow_locked_rect = {sizeof(struct d3d9_narrow_locked_rect),
                                                    sizeof(struct wide_locked_rect),
                                                    widen_locked_rect,
                                                    shorten_locked_rect,
                                                    NULL,
                                                    NULL};
const struct d3d9_narrow d3d9_narrow_locked_box = {sizeof(struct d3d9_narrow_locked_box),
                                                   sizeof(struct wide_locked_box),
                                                   widen_locked_box,
                                                   shorten_locked_box,
                                                   NULL,
                                                   NULL};
const struct d3d9_narrow d3d9_narrow_present_parameters = {sizeof(struct d3d9_narrow_present_parameters),
                                                           sizeof(struct d3d9_present_parameters),
                                                           widen_present_parameters,
                                                           shorten_present_parameters,
                                                           NULL,
                                                           NULL};
const struct d3d9_narrow d3d9_narrow_creation_parameters = {sizeof(struct d3d9_narrow_creation_parameters),
                                                            sizeof(struct d3d9_creation_parameters),
                                                            widen_creation_parameters,
                                                            shorten_creation_parameters,
                                                            NULL,
                                                            NULL};
const struct d3d9_narrow d3d9_narrow_picture = {sizeof(struct d3d9_host_picture),
                                                sizeof(struct d3d9_host_picture),
                                                NULL,
                                                NULL,
                                                attach_picture,
                                                detach_picture};
const struct d3d9_narrow d3d9_narrow_present_stats = {sizeof(struct d3d9_narrow_present_stats),
                                                      sizeof(struct d3d9_present_stats),
                                                      widen_present_stats,
                                                      shorten_present_stats,
                                                      NULL,
                                                      NULL};
const struct d3d9_narrow d3d9_narrow_adapter_identifier = {sizeof(struct d3d9_narrow_adapter_identifier),
                                                           sizeof(struct d3d9_adapter_identifier),
                                                           widen_adapter_identifier,
                                                           shorten_adapter_identifier,
                                                           NULL,
                                                           NULL};
