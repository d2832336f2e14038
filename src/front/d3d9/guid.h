/* Identifiers of COM interfaces and of private data, as Windows lays them out: 16 bytes. */
#ifndef D3D9_GUID_H
#define D3D9_GUID_H

#include <stdint.h>
#include <string.h>

struct d3d9_guid {
    uint32_t data1;
    uint16_t data2, data3;
    uint8_t data4[8];
};

static inline int d3d9_guid_equal(const struct d3d9_guid *a, const struct d3d9_guid *b)
{
    return !memcmp(a, b, sizeof *a);
}

#endif
