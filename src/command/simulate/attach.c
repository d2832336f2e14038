#include "command/simulate/attach.h"

#include "render/device/device.h"

void simulate_attach(struct triptych_device *device, struct timeline *timeline)
{
    device->queue->timeline = timeline;
}
