#include "tests/support/front/caller.h"
#include "front/d3d9/dispatch.h"
#include "front/d3d9/memory.h"
#include "front/d3d9/remote/known.h"
#include "tests/support/front/factory.h"
#include "tests/support/front/values.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

enum {
    MOST_BYTES = 1 << 22, /* of an argument; programs do not have the memory for more */
    MOST_DEVICES = 3,
    XYZRHW_COLOR = 0x44,
    USER_BYTES = 8 << 20, /* of a texture in the program's memory */
    CONSTANTS = 64,       /* words of 16 integers */
    PATTERN = 0xcd
};

/* Not an array: every program that links this file would have it, and the leak checker would read it. */
static uint8_t *user_memory(void)
{
    static uint8_t *memory;
    if (!memory)
        memory = calloc(1, USER_BYTES);
    TEST_ASSERT_NOT_NULL(memory);
    return memory;
}

/* --- Memory of the front end --- */

enum { MOST_MEMORY = 256 << 20 };

static size_t allocated; /* blocks */

static void *allocate(size_t bytes)
{
    void *memory = bytes > MOST_MEMORY ? NULL : aligned_alloc(64, (bytes + 63) / 64 * 64 + 64);
    if (!memory)
        return NULL;
    memset(memory, 0, (bytes + 63) / 64 * 64 + 64);
    allocated++;
    return memory;
}

static void release_memory(void *memory)
{
    allocated -= memory != NULL;
    free(memory);
}

/* --- Objects --- */

static int find(const struct caller *caller, const struct d3d9_object *object)
{
    for (unsigned i = 0; i < caller->count; i++)
        if (caller->held[i].object == object)
            return (int)i;
    return -1;
}

static void hold(struct caller *caller, struct d3d9_object *object)
{
    int i = find(caller, object);
    if (i < 0) {
        TEST_ASSERT_LESS_THAN_UINT(CALLER_OBJECTS, caller->count);
        i = (int)caller->count++;
        caller->held[i].object = object;
        caller->held[i].references = 0;
    }
    caller->held[i].references++;
}

static void drop(struct caller *caller, const struct d3d9_object *object)
{
    int i = find(caller, object);
    TEST_ASSERT_GREATER_OR_EQUAL_INT(0, i);
    if (!--caller->held[i].references)
        caller->held[i] = caller->held[--caller->count];
}

static unsigned count_of(const struct caller *caller, enum d3d9_interface interface)
{
    unsigned count = 0;
    for (unsigned i = 0; i < caller->count; i++)
        count += d3d9_object_interface_is(caller->held[i].object->interface, interface);
    return count;
}

/* Returns one of the objects for which `fits` is true; null if there is none. */
static struct d3d9_object *choose(struct caller *caller, const void *context,
                                  bool (*fits)(const void *context, enum d3d9_interface))
{
    struct d3d9_object *chosen = NULL;
    uint32_t found = 0;
    for (unsigned i = 0; i < caller->count; i++)
        if (fits(context, caller->held[i].object->interface) && values_once_in(&caller->seed, ++found))
            chosen = caller->held[i].object;
    return chosen;
}

static bool has_method(const void *code, enum d3d9_interface interface)
{
    return d3d9_form_is_method_of(*(const enum d3d9_code *)code, interface);
}

static bool is_argument(const void *argument, enum d3d9_interface interface)
{
    return d3d9_object_interface_is(interface, ((const struct d3d9_argument *)argument)->interface);
}

/* --- Arguments --- */

static void *keep(struct caller *caller, void *memory)
{
    TEST_ASSERT_NOT_NULL(memory);
    caller->memory[caller->memories++] = memory;
    return memory;
}

static void *make_memory(struct caller *caller, size_t bytes)
{
    void *memory = keep(caller, malloc(bytes ? bytes : 1));
    memset(memory, PATTERN, bytes ? bytes : 1);
    return memory;
}

static void put(uint8_t *block, const struct d3d9_argument *argument, uint64_t value)
{
    memcpy(block + argument->offset, &value, argument->bytes);
}

static uint64_t get(const uint8_t *block, size_t offset, size_t bytes)
{
    uint64_t value = 0;
    memcpy(&value, block + offset, bytes);
    return value;
}

static void fill_window(struct caller *caller, struct d3d9_host_window *window)
{
    *window = factory_window();
    if (values_once_in(&caller->seed, 10))
        *window = (struct d3d9_host_window){.window = 0};
    window->minimized = values_once_in(&caller->seed, 20);
}

static void fill_picture(struct caller *caller, struct d3d9_host_picture *picture)
{
    uint32_t side = values_below(&caller->seed, 4) * 32;
    *picture = (struct d3d9_host_picture){.pitch = 4 * side, .room_width = side, .room_height = side};
    if (side)
        picture->bits = (uintptr_t)make_memory(caller, (size_t)picture->pitch * side);
}

static void fill_host(struct caller *caller, const struct d3d9_argument *argument, void *memory, size_t bytes)
{
    memset(memory, 0, bytes);
    if (!strcmp(argument->type, "host_window"))
        fill_window(caller, memory);
    if (!strcmp(argument->type, "host_picture"))
        fill_picture(caller, memory);
}

static void fill_objects(struct caller *caller, const struct d3d9_argument *argument, void **objects,
                         uint64_t count)
{
    for (uint64_t i = 0; i < count; i++)
        objects[i] = choose(caller, argument, is_argument);
}

static uint64_t make_array(struct caller *caller, const struct d3d9_argument *argument, uint64_t count)
{
    bool is_host = argument->kind >= D3D9_ARGUMENT_HOST_READS;
    /* Programs do not have the memory; calls with constants read at most CONSTANTS words. */
    if (count > MOST_BYTES / (argument->element ? argument->element : 1))
        count = strcmp(argument->name, "values") ? 0 : CONSTANTS;
    if (!is_host && (!count || values_once_in(&caller->seed, 30)))
        return 0;
    size_t bytes = (size_t)count * argument->element;
    void *memory = make_memory(caller, bytes);
    if (is_host)
        fill_host(caller, argument, memory, bytes);
    else if (argument->kind == D3D9_ARGUMENT_OBJECTS)
        fill_objects(caller, argument, memory, count);
    else if (argument->kind == D3D9_ARGUMENT_READS || argument->kind == D3D9_ARGUMENT_CHANGES)
        values_fill(&caller->seed, argument->type, memory, bytes);
    if (!strcmp(argument->type, "HANDLE") && values_once_in(&caller->seed, 2))
        *(uint64_t *)memory = (uintptr_t)user_memory();
    if (!strcmp(argument->type, "HANDLE") && !values_once_in(&caller->seed, 10))
        return 0;
    return (uintptr_t)memory;
}

/* Arguments whose contents give their size. Returns false for all others. */
static bool make_sized(struct caller *caller, const struct d3d9_form *form,
                       const struct d3d9_argument *argument, uint8_t *block)
{
    void *memory;
    if (argument->kind != D3D9_ARGUMENT_READS)
        return false;
    if (!strcmp(argument->name, "code"))
        memory = values_code(&caller->seed, strstr(form->name, "pixel"));
    else if (!strcmp(argument->type, "D3DVERTEXELEMENT9"))
        memory = values_elements(&caller->seed);
    else if (!strcmp(argument->type, "RGNDATA"))
        memory = values_region(&caller->seed);
    else
        return false;
    put(block, argument, values_once_in(&caller->seed, 60) ? 0 : (uintptr_t)keep(caller, memory));
    if (!get(block, argument->offset, argument->bytes))
        free(memory);
    return true;
}

static uint64_t make_number(struct caller *caller, const struct d3d9_form *form,
                            const struct d3d9_argument *argument)
{
    bool needed = !form->is_method;
    if (argument->kind == D3D9_ARGUMENT_HANDLE)
        return values_below(&caller->seed, 2) * FACTORY_WINDOW;
    if (argument->kind == D3D9_ARGUMENT_OBJECT)
        return !needed && values_once_in(&caller->seed, 6) ? 0
                                                           : (uintptr_t)choose(caller, argument, is_argument);
    return values_number(&caller->seed, argument->type, argument->name);
}

/* Numbers, then what contains its own size, then what others may count with, then the rest. */
static void make_arguments(struct caller *caller, const struct d3d9_form *form, uint8_t *block)
{
    uint64_t counts[D3D9_FORM_ARGUMENTS];
    bool made[D3D9_FORM_ARGUMENTS] = {false};
    const struct d3d9_argument *argument = form->argument;
    for (unsigned i = 0; argument[i].name; i++) {
        made[i] = argument[i].kind <= D3D9_ARGUMENT_OBJECT;
        if (made[i])
            put(block, argument + i, make_number(caller, form, argument + i));
        else
            made[i] = make_sized(caller, form, argument + i, block);
    }
    for (int pass = 0; pass < 2; pass++) {
        form->count(block, counts);
        for (unsigned i = 0; argument[i].name; i++) {
            if (made[i] || (!pass && argument[i].kind != D3D9_ARGUMENT_CHANGES))
                continue;
            put(block, argument + i, make_array(caller, argument + i, counts[i]));
            made[i] = true;
        }
    }
}

/* --- Results --- */

static void digest(struct caller *caller, const void *bytes, size_t count)
{
    const uint8_t *byte = bytes;
    for (size_t i = 0; i < count; i++)
        caller->digest = (caller->digest ^ byte[i]) * 0x100000001b3;
}

static bool is_timed(const struct d3d9_form *form)
{
    return strstr(form->name, "raster_status") || !strcmp(form->name, "get_data") ||
           strstr(form->name, "present_stats") || strstr(form->name, "texture_mem");
}

static void digest_picture(struct caller *caller, const struct d3d9_host_picture *picture)
{
    for (uint32_t y = 0; picture->filled && y < picture->height; y++)
        digest(caller, (const uint8_t *)(uintptr_t)picture->bits + (size_t)y * picture->pitch,
               4 * (size_t)picture->width);
}

/* Results are those of result.h. */
static void check_result(const struct caller *caller, int32_t result)
{
    uint32_t facility = (uint32_t)result >> 16;
    char text[120];
    snprintf(text, sizeof text, "call %u, %s_%s: %08x", caller->calls, caller->class, caller->name,
             (unsigned)result);
    TEST_ASSERT_TRUE_MESSAGE(result == D3D9_OK || result == D3D9_FALSE || facility == 0x8876 ||
                                 facility == 0x0876 || facility == 0x8000 || facility == 0x8007,
                             text);
}

/* Results that are certain before a call are right (front/d3d9/remote/known.def). */
static void check_known(const struct caller *caller, const struct d3d9_form *form, const uint8_t *block,
                        bool known)
{
    char text[120];
    int32_t result = (int32_t)get(block, form->result, sizeof result);
    snprintf(text, sizeof text, "call %u, %s_%s", caller->calls, caller->class, caller->name);
    if (known)
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(D3D9_OK, result, text);
}

/* Writes to the first row of a level that is locked as a whole. */
static void write_level(struct caller *caller, const struct d3d9_form *form, const uint8_t *block)
{
    const struct d3d9_locked_rect *rectangle = NULL;
    const struct d3d9_locked_box *box = NULL;
    bool whole = true;
    for (const struct d3d9_argument *a = form->argument; a->name; a++) {
        const void *pointer =
            a->kind >= D3D9_ARGUMENT_READS ? (void *)(uintptr_t)get(block, a->offset, 8) : NULL;
        if (!strcmp(a->name, "locked") && !strcmp(a->type, "D3DLOCKED_RECT"))
            rectangle = pointer;
        else if (!strcmp(a->name, "locked"))
            box = pointer;
        else if (pointer)
            whole = false;
    }
    if (rectangle && whole)
        values_fill(&caller->seed, "bytes", rectangle->bits, (size_t)rectangle->pitch);
    if (box && whole)
        values_fill(&caller->seed, "bytes", box->bits, (size_t)box->row_pitch);
}

static uint32_t size_of_buffer(struct d3d9_object *buffer)
{
    struct d3d9_vertex_buffer_desc vertices = {.size = 0};
    struct d3d9_index_buffer_desc indices = {.size = 0};
    if (buffer->interface == D3D9_INTERFACE_VERTEX_BUFFER)
        d3d9_vertex_buffer_get_desc((void *)buffer, &vertices);
    else
        d3d9_index_buffer_get_desc((void *)buffer, &indices);
    return vertices.size + indices.size;
}

static void write_buffer(struct caller *caller, struct d3d9_object *buffer, uint32_t offset, uint32_t bytes,
                         uint8_t *data)
{
    uint32_t size = size_of_buffer(buffer);
    uint32_t rest = offset < size ? size - offset : 0;
    bool indices = buffer->interface == D3D9_INTERFACE_INDEX_BUFFER;
    if (bytes && bytes < rest)
        rest = bytes;
    if (rest > 1 << 16)
        rest = 1 << 16;
    for (uint32_t i = 0; indices && i < rest; i++)
        data[i] = (uint8_t)(i % 2 ? 0 : values_below(&caller->seed, 30));
    if (!indices)
        values_fill(&caller->seed, "float", data, rest);
}

static void take_new(struct caller *caller, const struct d3d9_form *form,
                     const struct d3d9_argument *argument, const uint8_t *block)
{
    void **slot = (void **)(uintptr_t)get(block, argument->offset, 8);
    if (!slot)
        return;
    if (strcmp(argument->name, "data")) {
        if (*slot)
            hold(caller, *slot);
        return;
    }
    const struct d3d9_block_vertex_buffer_lock *lock = (const void *)block;
    (void)form;
    write_buffer(caller, (void *)(uintptr_t)lock->self, lock->offset, lock->bytes, *slot);
}

static void take_events(struct caller *caller)
{
    int more = D3D9_EVENTS;
    while (more == D3D9_EVENTS) {
        struct d3d9_host_event events[4];
        struct d3d9_block_host_take_events take = {(uintptr_t)events, 4, 0};
        more = d3d9_dispatch(D3D9_CODE_host_take_events, &take);
        for (uint32_t i = 0; i < take.result; i++)
            caller->interfaces -= events[i].kind == D3D9_EVENT_RELEASE;
    }
}

static void note_private_data(struct caller *caller, const uint8_t *block)
{
    const struct d3d9_block_object_set_private_data *set = (const void *)block;
    caller->interfaces += set->result == D3D9_OK && set->flags & D3D9_PRIVATE_INTERFACE;
}

static void take_results(struct caller *caller, enum d3d9_code code, const uint8_t *block)
{
    const struct d3d9_form *form = d3d9_form_of(code);
    bool fails = !strcmp(form->result_type, "HRESULT");
    int32_t result = *form->result_type ? (int32_t)get(block, form->result, sizeof result) : 0;
    if (fails)
        check_result(caller, result);
    if (!is_timed(form))
        digest(caller, &result, sizeof result);
    if (code == D3D9_CODE_object_set_private_data)
        note_private_data(caller, block);
    for (const struct d3d9_argument *a = form->argument; a->name; a++) {
        if (!strcmp(a->type, "host_picture"))
            digest_picture(caller, (void *)(uintptr_t)get(block, a->offset, 8));
        if (a->kind == D3D9_ARGUMENT_NEW && (!fails || result >= 0))
            take_new(caller, form, a, block);
    }
    if (result >= 0 && !strncmp(form->name, "lock_", 5))
        write_level(caller, form, block);
}

/* --- Calls --- */

/* The numbers of calls that are made more often than others. */
static unsigned weight_of(enum d3d9_code code)
{
    const char *name = d3d9_form_of(code)->name;
    if (strstr(name, "draw_") == name)
        return 12;
    if (strstr(name, "create_") || strstr(name, "lock"))
        return 4;
    if (!strcmp(name, "begin_scene"))
        return 12;
    if (strstr(name, "set_") == name || strstr(name, "begin_") == name || !strcmp(name, "release"))
        return 3;
    return 1;
}

static bool is_left_out(const struct caller *caller, enum d3d9_code code)
{
    const struct d3d9_form *form = d3d9_form_of(code);
    if (!strcmp(form->class, "host") || code == D3D9_CODE_factory_create)
        return true;
    if (!strncmp(form->name, "create_device", 13))
        return count_of(caller, D3D9_INTERFACE_DEVICE) >= MOST_DEVICES;
    return caller->count > CALLER_OBJECTS - 8 && strcmp(form->name, "release");
}

static enum d3d9_code choose_code(struct caller *caller)
{
    unsigned sum = 0;
    for (enum d3d9_code code = 0; code < D3D9_CODE_COUNT; code++)
        sum += weight_of(code);
    for (;;) {
        uint32_t at = values_below(&caller->seed, sum);
        enum d3d9_code code = 0;
        while (at >= weight_of(code))
            at -= weight_of(code++);
        if (!is_left_out(caller, code))
            return code;
    }
}

static void execute(struct caller *caller, enum d3d9_code code, struct d3d9_object *self)
{
    const struct d3d9_form *form = d3d9_form_of(code);
    uint8_t *block = keep(caller, calloc(1, form->bytes));
    caller->class = form->class;
    caller->name = form->name;
    caller->calls++;
    if (self)
        memcpy(block, &(uint64_t){(uintptr_t)self}, sizeof(uint64_t));
    values_begin(&caller->seed);
    make_arguments(caller, form, block);
    if (!form->is_method && form->argument[0].kind == D3D9_ARGUMENT_OBJECT && !get(block, 0, 8))
        return;
    bool known = d3d9_known(code, block);
    int result = d3d9_dispatch(code, block);
    check_known(caller, form, block, known);
    take_results(caller, code, block);
    if (code == D3D9_CODE_object_add_ref)
        hold(caller, self);
    if (code == D3D9_CODE_object_release)
        drop(caller, self);
    if (result == D3D9_EVENTS)
        take_events(caller);
}

static void free_arguments(struct caller *caller)
{
    while (caller->memories)
        free(caller->memory[--caller->memories]);
}

static void make_device(struct caller *caller)
{
    bool extended = values_once_in(&caller->seed, 3);
    uint32_t flags = (uint32_t[]){0x40, 0x40, 0x20, 0x80}[values_below(&caller->seed, 4)];
    struct d3d9_present_parameters parameters = factory_parameters();
    struct d3d9_factory *factory = factory_make(extended);
    struct d3d9_host_window window = factory_window();
    struct d3d9_device *device;
    parameters.enable_auto_depth_stencil = 1;
    parameters.auto_depth_stencil_format = 75;
    parameters.flags = values_below(&caller->seed, 2);
    hold(caller, (struct d3d9_object *)factory);
    TEST_ASSERT_EQUAL_INT32(D3D9_OK, d3d9_factory_create_device(factory, 0, 1, FACTORY_WINDOW, flags,
                                                                &parameters, &device, &window));
    hold(caller, (struct d3d9_object *)device);
    d3d9_device_set_fvf(device, XYZRHW_COLOR);
}

void caller_begin(struct caller *caller, uint64_t seed)
{
    static const struct d3d9_memory_host host = {allocate, release_memory};
    if (!allocated)
        d3d9_memory_set_host(&host);
    *caller = (struct caller){.seed = seed ? seed : 1, .digest = 0xcbf29ce484222325, .class = "", .name = ""};
    make_device(caller);
}

void caller_call(struct caller *caller)
{
    enum d3d9_code code = choose_code(caller);
    const struct d3d9_form *form = d3d9_form_of(code);
    struct d3d9_object *self = form->is_method ? choose(caller, &code, has_method) : NULL;
    if (!count_of(caller, D3D9_INTERFACE_DEVICE))
        make_device(caller);
    else if (self || !form->is_method)
        execute(caller, code, self);
    free_arguments(caller);
}

void caller_end(struct caller *caller)
{
    while (caller->count) {
        struct d3d9_object *object = caller->held[values_below(&caller->seed, caller->count)].object;
        execute(caller, D3D9_CODE_object_release, object);
        free_arguments(caller);
    }
    TEST_ASSERT_EQUAL_UINT64_MESSAGE(0, allocated, "blocks of the front end are in use");
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, caller->interfaces, "interfaces that were not released");
}
