#include "declaration.h"
#include <windows.h>
#include <d3d9.h>

int32_t declaration_get(struct d3d9_declaration *self, struct d3d9_vertex_element *elements, uint32_t *count)
{
    uint32_t actual = 0;
    int32_t result = d3d9_declaration_get_declaration(self, NULL, count ? &actual : NULL);
    if (count)
        *count = actual;
    return SUCCEEDED(result) && elements ? d3d9_declaration_get_declaration(self, elements, &actual) : result;
}
