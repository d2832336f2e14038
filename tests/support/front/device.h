/* A Direct3D device without adapter, window and swap chain: values, buffers and draws, on the emulator. */
#ifndef TESTS_SUPPORT_FRONT_DEVICE_H
#define TESTS_SUPPORT_FRONT_DEVICE_H

#include "front/d3d9/call.h"
#include "front/d3d9/device.h"

/* Makes a device. `flags` are D3D9_CREATE_... values. Fails the test if it cannot. */
struct d3d9_device *bare_device_make(uint32_t flags);
/* Releases it. The test fails if objects still reference it. */
void bare_device_free(struct d3d9_device *);

#endif
