/* SetPrivateData and GetPrivateData, with the references of the program's own interfaces. The functions have
 * the types of those of call.h. */
#ifndef D3D9_PE_PRIVATE_DATA_H
#define D3D9_PE_PRIVATE_DATA_H

#include "front/d3d9/call.h"

int32_t private_data_set(struct d3d9_object *, const struct d3d9_guid *tag, const void *data, uint32_t bytes,
                         uint32_t flags);
int32_t private_data_get(struct d3d9_object *, const struct d3d9_guid *tag, void *data, uint32_t *bytes);

#endif
