/* A Direct3D factory and device with an adapter and a window, both without Windows. */
#ifndef TESTS_SUPPORT_FRONT_FACTORY_H
#define TESTS_SUPPORT_FRONT_FACTORY_H

#include "front/d3d9/call.h"
#include "front/d3d9/device.h"

enum { FACTORY_WINDOW = 0x1234, FACTORY_WIDTH = 64, FACTORY_HEIGHT = 48 };

/* Registers an adapter with the modes 640x480 and 800x600 in two formats, the first one current. Makes a
 * factory. */
struct d3d9_factory *factory_make(bool extended);
/* Parameters of a window of FACTORY_WIDTH x FACTORY_HEIGHT pixels, and the window. */
struct d3d9_present_parameters factory_parameters(void);
struct d3d9_host_window factory_window(void);
/* Makes a device with these parameters on the emulator, and releases the factory, so that only the device
 * references it. */
struct d3d9_device *factory_device(bool extended, struct d3d9_present_parameters);
/* Releases a device. The test fails if objects still reference it. */
void factory_device_free(struct d3d9_device *);

#endif
