/* The table of calls (front/d3d9/calls) at run time: for each call its arguments, the number of elements they
 * refer to, and the interfaces that have it. */
#ifndef D3D9_FORM_H
#define D3D9_FORM_H

#include "front/d3d9/block.h"
#include "front/d3d9/object.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum d3d9_argument_kind {
    D3D9_ARGUMENT_VALUE,
    D3D9_ARGUMENT_HANDLE,
    D3D9_ARGUMENT_POINTER,
    D3D9_ARGUMENT_OBJECT,
    D3D9_ARGUMENT_OBJECTS,
    D3D9_ARGUMENT_NEW,
    D3D9_ARGUMENT_READS,
    D3D9_ARGUMENT_WRITES,
    D3D9_ARGUMENT_CHANGES,
    D3D9_ARGUMENT_HOST_READS,
    D3D9_ARGUMENT_HOST_WRITES,
    D3D9_ARGUMENT_HOST_CHANGES
};

/* An argument: the member `offset` of the block has `bytes` bytes. `element`: the bytes of an element of the
 * array that a pointer refers to, in the process of the Linux side. `interface`: of objects. */
struct d3d9_argument {
    enum d3d9_argument_kind kind;
    const char *type, *name;
    size_t offset, bytes, element;
    enum d3d9_interface interface;
};

enum { D3D9_FORM_ARGUMENTS = 12 };

struct d3d9_form {
    const char *class, *name, *result_type; /* "" for a procedure */
    const struct d3d9_argument *argument;   /* ends with one without a name */
    size_t bytes, result;                   /* of the block; where its result is */
    /* For each argument the number of its elements, from the other ones; 0 for a number and for one object.
     * Arguments that it reads must be valid. */
    void (*count)(const void *block, uint64_t counts[D3D9_FORM_ARGUMENTS]);
    bool is_method;
};

/* `code` is below D3D9_CODE_COUNT. */
const struct d3d9_form *d3d9_form_of(unsigned code);

/* Returns true if objects with this interface have the method. */
bool d3d9_form_is_method_of(unsigned code, enum d3d9_interface interface);

#endif
