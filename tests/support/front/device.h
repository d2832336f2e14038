/* A Direct3D device without adapter, window and swap chain: values, buffers and draws, on the emulator. */
#ifndef TESTS_SUPPORT_FRONT_DEVICE_H
#define TESTS_SUPPORT_FRONT_DEVICE_H

#include "front/d3d9/call.h"
#include "front/d3d9/device.h"

/* Makes a device. `flags` are D3D9_CREATE_... values. Fails the test if it cannot. */
struct d3d9_device *bare_device_make(uint32_t flags);
/* Releases it. The test fails if objects still reference it. */
void bare_device_free(struct d3d9_device *);

enum { BARE_WIDTH = 8, BARE_HEIGHT = 8 };

/* Gives it a target of A8R8G8B8 and a depth surface of D24S8, begins a scene, and disables lighting, culling
 * and the depth test. */
void bare_device_begin(struct d3d9_device *);
/* The pixel of target 0 as 0xAARRGGBB. */
uint32_t bare_device_pixel(struct d3d9_device *, unsigned x, unsigned y);

#endif
