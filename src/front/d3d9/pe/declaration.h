/* GetDeclaration: the call copies `count` elements, a number that a program does not have to set. The
 * function has the type of that of call.h. */
#ifndef D3D9_PE_DECLARATION_H
#define D3D9_PE_DECLARATION_H

#include "front/d3d9/call.h"

int32_t declaration_get(struct d3d9_declaration *, struct d3d9_vertex_element *elements, uint32_t *count);

#endif
