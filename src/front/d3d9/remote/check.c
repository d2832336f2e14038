#include "check.h"
#include "front/d3d9/host.h"

#include <string.h>

static uint64_t word_at(const uint8_t *block, size_t offset, size_t bytes)
{
    uint64_t word = 0;
    memcpy(&word, block + offset, bytes);
    return word;
}

static bool is_range(const struct d3d9_message_limits *check, uint64_t address, uint64_t bytes)
{
    return address >= check->begin && address <= check->end && bytes <= check->end - address;
}

/* Returns the interface of an object; D3D9_INTERFACE_NONE if there is none at the address. */
static enum d3d9_interface interface_at(const struct d3d9_message_limits *check, uint64_t address)
{
    if (!check->is_allocated(address))
        return D3D9_INTERFACE_NONE;
    enum d3d9_interface interface = ((const struct d3d9_object *)(uintptr_t)address)->interface;
    return interface < D3D9_INTERFACE_COUNT ? interface : D3D9_INTERFACE_NONE;
}

static bool is_object(const struct d3d9_message_limits *check, uint64_t address,
                      enum d3d9_interface interface)
{
    enum d3d9_interface actual = interface_at(check, address);
    return actual != D3D9_INTERFACE_NONE && d3d9_object_interface_is(actual, interface);
}

static bool are_objects(const struct d3d9_message_limits *check, uint64_t address, uint64_t count,
                        enum d3d9_interface interface)
{
    const uint64_t *objects = (const uint64_t *)(uintptr_t)address;
    for (uint64_t i = 0; i < count; i++)
        if (objects[i] && !is_object(check, objects[i], interface))
            return false;
    return true;
}

/* The bitmap that a picture refers to. */
static bool is_picture(const struct d3d9_message_limits *check, const struct d3d9_argument *argument,
                       uint64_t address)
{
    const struct d3d9_host_picture *picture = (const void *)(uintptr_t)address;
    if (strcmp(argument->type, "host_picture") || !picture->bits)
        return true;
    return (uint64_t)picture->room_width * 4 <= picture->pitch &&
           is_range(check, picture->bits, (uint64_t)picture->pitch * picture->room_height);
}

/* Arguments that are followed to count others are checked before. */
static bool is_array(const struct d3d9_message_limits *check, const struct d3d9_form *form,
                     const struct d3d9_argument *argument, uint64_t address, uint64_t count)
{
    bool is_host = argument->kind >= D3D9_ARGUMENT_HOST_READS;
    if (!address)
        return !is_host || !form->is_method || !count;
    if (count > (check->end - check->begin) / argument->element ||
        !is_range(check, address, count * argument->element))
        return false;
    if (argument->kind == D3D9_ARGUMENT_OBJECTS)
        return are_objects(check, address, count, argument->interface);
    return is_picture(check, argument, address);
}

static const char *check_objects(const struct d3d9_message_limits *check, unsigned code, const uint8_t *block)
{
    const struct d3d9_form *form = d3d9_form_of(code);
    if (form->is_method &&
        !d3d9_form_is_method_of(code, interface_at(check, word_at(block, 0, sizeof(uint64_t)))))
        return "not an object with this method";
    for (const struct d3d9_argument *a = form->argument; a->name; a++) {
        uint64_t word = word_at(block, a->offset, a->bytes);
        if (a->kind == D3D9_ARGUMENT_OBJECT &&
            (word ? !is_object(check, word, a->interface) : !form->is_method))
            return "not an object";
    }
    return NULL;
}

/* Pointers must begin in the memory before counts read what they refer to; sizes are checked after that.
 * Counts that follow contents (of shaders, declarations and regions) stop at the end of the memory's mapping,
 * because the arena follows the memory of arguments. */
static const char *check_arrays(const struct d3d9_message_limits *check, unsigned code, const uint8_t *block)
{
    const struct d3d9_form *form = d3d9_form_of(code);
    uint64_t counts[D3D9_FORM_ARGUMENTS];
    for (const struct d3d9_argument *a = form->argument; a->name; a++) {
        uint64_t word = word_at(block, a->offset, a->bytes);
        if (a->kind >= D3D9_ARGUMENT_OBJECTS && word && !is_range(check, word, sizeof(uint32_t)))
            return "an argument outside of the shared memory";
    }
    form->count(block, counts);
    for (unsigned i = 0; form->argument[i].name; i++) {
        const struct d3d9_argument *a = form->argument + i;
        if (a->kind >= D3D9_ARGUMENT_OBJECTS &&
            !is_array(check, form, a, word_at(block, a->offset, a->bytes), counts[i]))
            return "an argument that is too large for the shared memory";
    }
    return NULL;
}

const char *d3d9_message_check(const struct d3d9_message_limits *check, unsigned code, uint64_t address,
                               uint8_t block[D3D9_MESSAGE_BLOCK])
{
    if (code >= D3D9_CODE_COUNT)
        return "a call that does not exist";
    size_t bytes = d3d9_form_of(code)->bytes;
    if (bytes > D3D9_MESSAGE_BLOCK || address % sizeof(uint64_t) || !is_range(check, address, bytes))
        return "a block outside of the shared memory";
    memcpy(block, (const void *)(uintptr_t)address, bytes);
    const char *problem = check_objects(check, code, block);
    return problem ? problem : check_arrays(check, code, block);
}
