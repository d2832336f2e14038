#include "factory.h"
#include "caps.h"
#include "check.h"
#include "front/d3d9/call.h"
#include <stdio.h>

enum { DEVICE_HARDWARE = 1 };

int32_t d3d9_factory_create(uint32_t version, int32_t extended, struct d3d9_factory **out)
{
    (void)version;
    enum d3d9_interface interface = extended ? D3D9_INTERFACE_FACTORY_EX : D3D9_INTERFACE_FACTORY;
    *out = d3d9_object_make(sizeof **out, interface, NULL, NULL);
    if (!*out)
        return D3D9_OUT_OF_MEMORY;
    (*out)->extended = extended;
    return D3D9_OK;
}

int32_t d3d9_factory_register_software_device(struct d3d9_factory *self, void *initialize)
{
    (void)self;
    return initialize ? D3D9_OK : D3D9_INVALID_CALL;
}

uint32_t d3d9_factory_get_adapter_count(struct d3d9_factory *self)
{
    (void)self;
    return d3d9_host_adapter_count();
}

int32_t d3d9_factory_get_adapter_identifier(struct d3d9_factory *self, uint32_t index, uint32_t flags,
                                            struct d3d9_adapter_identifier *identifier)
{
    static const struct d3d9_guid device = {
        0x7419f4c9, 0x5a1e, 0x4b3f, {0x9d, 0x20, 0x54, 0x72, 0x69, 0x70, 0x74, 0x39}};
    (void)self, (void)flags;
    const struct d3d9_host_adapter *adapter = d3d9_host_adapter(index);
    if (!adapter || !identifier)
        return D3D9_INVALID_CALL;
    *identifier = (struct d3d9_adapter_identifier){
        .driver_version =
            (int64_t)TRIPTYCH_VERSION_MAJOR << 48 | TRIPTYCH_VERSION_MINOR << 16 | TRIPTYCH_VERSION_PATCH,
        .device_identifier = device,
        .whql_level = 1,
    };
    snprintf(identifier->driver, sizeof identifier->driver, "triptych9.dll");
    snprintf(identifier->description, sizeof identifier->description, "Triptych %s", triptych_version());
    snprintf(identifier->device_name, sizeof identifier->device_name, "%.*s", (int)sizeof adapter->name - 1,
             adapter->name);
    return D3D9_OK;
}

int32_t d3d9_factory_get_device_caps(struct d3d9_factory *self, uint32_t adapter, uint32_t type,
                                     struct d3d9_caps *caps)
{
    if (!caps || adapter >= d3d9_host_adapter_count())
        return D3D9_INVALID_CALL;
    if (type != DEVICE_HARDWARE)
        return D3D9_NOT_AVAILABLE;
    d3d9_caps_fill(adapter, self->extended, caps);
    return D3D9_OK;
}

int32_t d3d9_factory_get_adapter_luid(struct d3d9_factory *self, uint32_t index, struct d3d9_luid *luid)
{
    (void)self;
    const struct d3d9_host_adapter *adapter = d3d9_host_adapter(index);
    if (!adapter || !luid)
        return D3D9_INVALID_CALL;
    *luid = (struct d3d9_luid){(uint32_t)adapter->luid, (int32_t)(adapter->luid >> 32)};
    return D3D9_OK;
}

/* --- Modes --- */

enum { SCAN_LINE_ANY = 0, SCAN_LINE_PROGRESSIVE = 1 };

/* Displays are shown in these formats. */
static bool is_mode_format(uint32_t format)
{
    return format == TRIPTYCH_SURFACE_X8R8G8B8 || format == TRIPTYCH_SURFACE_R5G6B5;
}

static const struct d3d9_host_mode *mode_at(uint32_t adapter, uint32_t format, uint32_t index)
{
    uint32_t count;
    const struct d3d9_host_mode *modes = d3d9_host_modes(adapter, &count);
    for (uint32_t i = 0; i < count; i++)
        if (modes[i].format == format && !index--)
            return &modes[i];
    return NULL;
}

static void write_mode(struct d3d9_display_mode *out, const struct d3d9_host_mode *mode)
{
    *out = (struct d3d9_display_mode){mode->width, mode->height, mode->refresh_rate, mode->format};
}

static void write_mode_ex(struct d3d9_display_mode_ex *out, const struct d3d9_host_mode *mode)
{
    *out = (struct d3d9_display_mode_ex){sizeof *out,        mode->width,  mode->height,
                                         mode->refresh_rate, mode->format, SCAN_LINE_PROGRESSIVE};
}

uint32_t d3d9_factory_get_adapter_mode_count(struct d3d9_factory *self, uint32_t adapter, uint32_t format)
{
    (void)self;
    return is_mode_format(format) ? d3d9_check_mode_count(adapter, format) : 0;
}

int32_t d3d9_factory_enum_adapter_modes(struct d3d9_factory *self, uint32_t adapter, uint32_t format,
                                        uint32_t index, struct d3d9_display_mode *out)
{
    (void)self;
    const struct d3d9_host_mode *mode = is_mode_format(format) ? mode_at(adapter, format, index) : NULL;
    if (!mode || !out)
        return D3D9_INVALID_CALL;
    write_mode(out, mode);
    return D3D9_OK;
}

int32_t d3d9_factory_get_adapter_display_mode(struct d3d9_factory *self, uint32_t index,
                                              struct d3d9_display_mode *out)
{
    (void)self;
    const struct d3d9_host_adapter *adapter = d3d9_host_adapter(index);
    if (!adapter || !out)
        return D3D9_INVALID_CALL;
    write_mode(out, &adapter->current);
    return D3D9_OK;
}

static bool filter_fits(const struct d3d9_display_mode_filter *filter)
{
    return filter && filter->size == sizeof *filter && is_mode_format(filter->format) &&
           filter->scan_line_ordering <= SCAN_LINE_PROGRESSIVE;
}

uint32_t d3d9_factory_get_adapter_mode_count_ex(struct d3d9_factory *self, uint32_t adapter,
                                                const struct d3d9_display_mode_filter *filter)
{
    (void)self;
    return filter_fits(filter) ? d3d9_check_mode_count(adapter, filter->format) : 0;
}

int32_t d3d9_factory_enum_adapter_modes_ex(struct d3d9_factory *self, uint32_t adapter,
                                           const struct d3d9_display_mode_filter *filter, uint32_t index,
                                           struct d3d9_display_mode_ex *out)
{
    (void)self;
    const struct d3d9_host_mode *mode = filter_fits(filter) ? mode_at(adapter, filter->format, index) : NULL;
    if (!mode || !out)
        return D3D9_INVALID_CALL;
    write_mode_ex(out, mode);
    return D3D9_OK;
}

int32_t d3d9_factory_get_adapter_display_mode_ex(struct d3d9_factory *self, uint32_t index,
                                                 struct d3d9_display_mode_ex *out, uint32_t *rotation)
{
    (void)self;
    const struct d3d9_host_adapter *adapter = d3d9_host_adapter(index);
    if (!adapter || !out || out->size != sizeof *out)
        return D3D9_INVALID_CALL;
    write_mode_ex(out, &adapter->current);
    if (rotation)
        *rotation = adapter->current.rotation;
    return D3D9_OK;
}
