/* Two functions for each row of the table of calls. Arguments of the row are local variables in them, so that
 * counts, which are expressions of arguments, can be computed. Memory that a call writes is copied in
 * both directions: then it is unchanged where the call does not write. */
#include "packing.h"
#include "front/d3d9/size.h"
#include "narrow.h"

#include <string.h>

enum { ALIGNMENT = 16 };

uint64_t d3d9_packing_take(struct d3d9_packing *packing, uint64_t bytes)
{
    uint64_t room = (uint64_t)(packing->end - packing->at);
    uint64_t whole = (bytes + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
    if (whole < bytes || whole > room) {
        packing->full = true;
        return 0;
    }
    uint8_t *at = packing->at;
    packing->at += whole;
    return (uintptr_t)at;
}

/* --- Arrays --- */

static void *pointer(uint64_t address)
{
    return (void *)(uintptr_t)address;
}

static void widen(const struct d3d9_narrow *type, uint64_t from, uint64_t to, uint64_t count)
{
    if (!type->widen)
        memcpy(pointer(to), pointer(from), count * type->wide);
    for (uint64_t i = 0; i < count && type->widen; i++)
        type->widen(pointer(from + i * type->narrow), pointer(to + i * type->wide));
}

static void shorten(const struct d3d9_narrow *type, uint64_t from, uint64_t to, uint64_t count)
{
    if (!type->shorten)
        memcpy(pointer(to), pointer(from), count * type->wide);
    for (uint64_t i = 0; i < count && type->shorten; i++)
        type->shorten(pointer(from + i * type->wide), pointer(to + i * type->narrow));
}

/* Returns the address of the copy; 0 for a null pointer. */
static uint64_t pack_array(struct d3d9_packing *packing, const struct d3d9_narrow *type, uint64_t address,
                           uint64_t count)
{
    if (!address)
        return 0;
    if (count > SIZE_MAX / type->wide) {
        packing->full = true;
        return 0;
    }
    uint64_t copy = d3d9_packing_take(packing, count * type->wide);
    if (copy)
        widen(type, address, copy, count);
    for (uint64_t i = 0; copy && type->attach && i < count; i++)
        type->attach(packing, pointer(copy + i * type->wide));
    return copy;
}

static void unpack_array(const struct d3d9_narrow *type, uint64_t shared, uint64_t address, uint64_t count)
{
    if (!address)
        return;
    for (uint64_t i = 0; type->detach && i < count; i++)
        type->detach(pointer(address + i * type->narrow), pointer(shared + i * type->wide));
    shorten(type, shared, address, count);
}

/* The layout of the elements that a pointer refers to. Regions are counted in bytes. */
#define SAME(bytes) (&(const struct d3d9_narrow){bytes, bytes, NULL, NULL, NULL, NULL})
#define LAYOUT(type, pointer)                                                                                \
    _Generic((d3d9_type_##type *)0,                                                                          \
        uint64_t *: &d3d9_narrow_address,                                                                    \
        struct d3d9_locked_rect *: &d3d9_narrow_locked_rect,                                                 \
        struct d3d9_locked_box *: &d3d9_narrow_locked_box,                                                   \
        struct d3d9_present_parameters *: &d3d9_narrow_present_parameters,                                   \
        struct d3d9_creation_parameters *: &d3d9_narrow_creation_parameters,                                 \
        struct d3d9_present_stats *: &d3d9_narrow_present_stats,                                           \
        struct d3d9_adapter_identifier *: &d3d9_narrow_adapter_identifier,                                   \
        struct d3d9_region *: SAME(1),                                                                       \
        void *: SAME(1),                                                                                     \
        default: SAME(sizeof *(pointer)))
#define HOST_LAYOUT(type, pointer)                                                                           \
    _Generic((struct d3d9_##type *)0, struct d3d9_host_picture *                                             \
             : &d3d9_narrow_picture, default                                                                 \
             : SAME(sizeof *(pointer)))

/* --- The arguments as local variables --- */

#define NAME(kind, ...) NAME_##kind(__VA_ARGS__)
#define NAME_NUMBER(type, name)                                                                              \
    const type name = b->name;                                                                               \
    (void)name;
#define NAME_ARRAY(type, name)                                                                               \
    type *const name = pointer(b->name);                                                                     \
    (void)name;
#define NAME_VALUE(type, name)               NAME_NUMBER(d3d9_type_##type, name)
#define NAME_HANDLE(type, name)              NAME_NUMBER(uint64_t, name)
#define NAME_POINTER(type, name)             NAME_NUMBER(uint64_t, name)
#define NAME_OBJECT(type, name)              NAME_NUMBER(uint64_t, name)
#define NAME_OBJECTS(type, name, count)      NAME_NUMBER(uint64_t, name)
#define NAME_NEW(type, name)                 NAME_NUMBER(uint64_t, name)
#define NAME_READS(type, name, count)        NAME_ARRAY(d3d9_type_##type, name)
#define NAME_WRITES(type, name, count)       NAME_ARRAY(d3d9_type_##type, name)
#define NAME_CHANGES(type, name, count)      NAME_ARRAY(d3d9_type_##type, name)
#define NAME_HOST_READS(type, name, count)   NAME_ARRAY(struct d3d9_##type, name)
#define NAME_HOST_WRITES(type, name, count)  NAME_ARRAY(struct d3d9_##type, name)
#define NAME_HOST_CHANGES(type, name, count) NAME_ARRAY(struct d3d9_##type, name)

/* --- Before the call --- */

#define PACK(kind, ...) PACK_##kind(__VA_ARGS__)
#define PACK_VALUE(type, name)
#define PACK_HANDLE(type, name)
#define PACK_POINTER(type, name)
#define PACK_OBJECT(type, name)
#define PACK_ARRAY(layout, name, count)      to->name = pack_array(packing, layout, b->name, count);
#define PACK_OBJECTS(type, name, count)      PACK_ARRAY(&d3d9_narrow_address, name, count)
#define PACK_NEW(type, name)                 PACK_ARRAY(&d3d9_narrow_address, name, 1)
#define PACK_READS(type, name, count)        PACK_ARRAY(LAYOUT(type, name), name, count)
#define PACK_WRITES(type, name, count)       PACK_ARRAY(LAYOUT(type, name), name, count)
#define PACK_CHANGES(type, name, count)      PACK_ARRAY(LAYOUT(type, name), name, count)
#define PACK_HOST_READS(type, name, count)   PACK_ARRAY(HOST_LAYOUT(type, name), name, count)
#define PACK_HOST_WRITES(type, name, count)  PACK_ARRAY(HOST_LAYOUT(type, name), name, count)
#define PACK_HOST_CHANGES(type, name, count) PACK_ARRAY(HOST_LAYOUT(type, name), name, count)

#define METHOD(class, method, name, type, ...)                                                               \
    static void pack_##class##_##name(struct d3d9_packing *packing, const void *block, void *shared)         \
    {                                                                                                        \
        const struct d3d9_block_##class##_##name *b = block;                                                 \
        struct d3d9_block_##class##_##name *to = shared;                                                     \
        (void)b, (void)to, (void)packing;                                                                    \
        {                                                                                                    \
            D3D9_EACH(NAME, __VA_ARGS__) D3D9_EACH(PACK, __VA_ARGS__)                                        \
        }                                                                                                    \
    }
#define HOSTED                              METHOD
#define PROCEDURE(class, method, name, ...) METHOD(class, method, name, void, __VA_ARGS__)
#define LOCAL(class, method)
#define FUNCTION(class, name, type, ...) METHOD(class, name, name, type, __VA_ARGS__)
#include "front/d3d9/calls/calls.def"
#undef METHOD
#undef PROCEDURE
#undef FUNCTION

/* --- After it --- */

#define UNPACK(kind, ...) UNPACK_##kind(__VA_ARGS__)
#define UNPACK_VALUE(type, name)
#define UNPACK_HANDLE(type, name)
#define UNPACK_POINTER(type, name)
#define UNPACK_OBJECT(type, name)
#define UNPACK_OBJECTS(type, name, count)
#define UNPACK_READS(type, name, count)
#define UNPACK_HOST_READS(type, name, count)
#define UNPACK_ARRAY(layout, name, count)      unpack_array(layout, from->name, b->name, count);
#define UNPACK_NEW(type, name)                 UNPACK_ARRAY(&d3d9_narrow_address, name, 1)
#define UNPACK_WRITES(type, name, count)       UNPACK_ARRAY(LAYOUT(type, name), name, count)
#define UNPACK_CHANGES(type, name, count)      UNPACK_ARRAY(LAYOUT(type, name), name, count)
#define UNPACK_HOST_WRITES(type, name, count)  UNPACK_ARRAY(HOST_LAYOUT(type, name), name, count)
#define UNPACK_HOST_CHANGES(type, name, count) UNPACK_ARRAY(HOST_LAYOUT(type, name), name, count)

#define PROCEDURE(class, method, name, ...)                                                                  \
    static void unpack_##class##_##name(void *block, void *shared)                                           \
    {                                                                                                        \
        struct d3d9_block_##class##_##name *b = block, *from = shared;                                       \
        (void)b, (void)from;                                                                                 \
        {                                                                                                    \
            D3D9_EACH(NAME, __VA_ARGS__) D3D9_EACH(UNPACK, __VA_ARGS__)                                      \
        }                                                                                                    \
    }
#define METHOD(class, method, name, type, ...)                                                               \
    static void unpack_##class##_##name(void *block, void *shared)                                           \
    {                                                                                                        \
        struct d3d9_block_##class##_##name *b = block, *from = shared;                                       \
        {D3D9_EACH(NAME, __VA_ARGS__) D3D9_EACH(UNPACK, __VA_ARGS__)} b->result = from->result;              \
    }
#define FUNCTION(class, name, type, ...) METHOD(class, name, name, type, __VA_ARGS__)
#include "front/d3d9/calls/calls.def"
#undef METHOD
#undef PROCEDURE
#undef FUNCTION

/* --- All calls --- */

struct form {
    size_t bytes;  /* of the block */
    size_t result; /* where its result is */
    bool can_fail; /* the result is a HRESULT */
    void (*pack)(struct d3d9_packing *, const void *block, void *shared);
    void (*unpack)(void *block, void *shared);
};

/* The types of results: whether they can report that a call has failed. */
enum {
    CAN_FAIL_HRESULT = 1,
    CAN_FAIL_UINT = 0,
    CAN_FAIL_BOOL = 0,
    CAN_FAIL_DWORD = 0,
    CAN_FAIL_ULONG = 0,
    CAN_FAIL_float = 0,
    CAN_FAIL_D3DRESOURCETYPE = 0,
    CAN_FAIL_D3DQUERYTYPE = 0,
    CAN_FAIL_D3DTEXTUREFILTERTYPE = 0
};

#define FORM(class, name, result, can_fail)                                                                  \
    [D3D9_CODE_##class##_##name] = {sizeof(struct d3d9_block_##class##_##name), result, can_fail,            \
                                    pack_##class##_##name, unpack_##class##_##name},

static const struct form forms[D3D9_CODE_COUNT] = {
#define METHOD(class, method, name, type, ...)                                                               \
    FORM(class, name, offsetof(struct d3d9_block_##class##_##name, result), CAN_FAIL_##type)
#define PROCEDURE(class, method, name, ...)                                                                  \
    FORM(class, name, sizeof(struct d3d9_block_##class##_##name), false)
#define FUNCTION(class, name, type, ...) METHOD(class, name, name, type, __VA_ARGS__)
#include "front/d3d9/calls/calls.def"
};

void *d3d9_pack(struct d3d9_packing *packing, unsigned code, const void *block)
{
    if (code >= D3D9_CODE_COUNT)
        return NULL;
    void *shared = pointer(d3d9_packing_take(packing, forms[code].bytes));
    if (!shared)
        return NULL;
    memcpy(shared, block, forms[code].bytes);
    forms[code].pack(packing, block, shared);
    return packing->full ? NULL : shared;
}

void d3d9_unpack(unsigned code, void *block, void *shared)
{
    forms[code].unpack(block, shared);
}

void d3d9_pack_result(unsigned code, void *block, int32_t result)
{
    const struct form *form = &forms[code];
    int32_t failure = form->can_fail ? result : 0;
    if (form->result + sizeof failure <= form->bytes)
        memcpy((uint8_t *)block + form->result, &failure, sizeof failure);
}
