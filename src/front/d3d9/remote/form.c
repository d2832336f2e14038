#include "form.h"
#include "front/d3d9/size.h"

#include <string.h>

/* The bytes of an element. Bytes and regions are counted in bytes. */
#define ELEMENT(type)                                                                                        \
    _Generic((d3d9_type_##type *)0, void * : 1, struct d3d9_region * : 1, default : sizeof(d3d9_type_##type))

/* The interfaces by their names in Direct3D's headers. */
enum {
#define INTERFACE(NAME, name, com, ...) INTERFACE_##com = D3D9_INTERFACE_##NAME,
#include "front/d3d9/interface.def"
#undef INTERFACE
    NONE = D3D9_INTERFACE_NONE
};

/* `own` is the block of the call. */
#define LIST(kind, type, name, element, interface)                                                           \
    {D3D9_ARGUMENT_##kind,                                                                                   \
     #type,                                                                                                  \
     #name,                                                                                                  \
     offsetof(own, name),                                                                                    \
     sizeof(((own *)0)->name),                                                                               \
     element,                                                                                                \
     (enum d3d9_interface)(interface)},
#define ROW(kind, ...)                      ROW_##kind(__VA_ARGS__)
#define ROW_VALUE(type, name)               LIST(VALUE, type, name, 0, NONE)
#define ROW_HANDLE(type, name)              LIST(HANDLE, type, name, 0, NONE)
#define ROW_POINTER(type, name)             LIST(POINTER, type, name, 0, NONE)
#define ROW_OBJECT(type, name)              LIST(OBJECT, type, name, 0, INTERFACE_##type)
#define ROW_OBJECTS(type, name, count)      LIST(OBJECTS, type, name, sizeof(void *), INTERFACE_##type)
#define ROW_NEW(type, name)                 LIST(NEW, type, name, sizeof(void *), NONE)
#define ROW_READS(type, name, count)        LIST(READS, type, name, ELEMENT(type), NONE)
#define ROW_WRITES(type, name, count)       LIST(WRITES, type, name, ELEMENT(type), NONE)
#define ROW_CHANGES(type, name, count)      LIST(CHANGES, type, name, ELEMENT(type), NONE)
#define ROW_HOST_READS(type, name, count)   LIST(HOST_READS, type, name, sizeof(struct d3d9_##type), NONE)
#define ROW_HOST_WRITES(type, name, count)  LIST(HOST_WRITES, type, name, sizeof(struct d3d9_##type), NONE)
#define ROW_HOST_CHANGES(type, name, count) LIST(HOST_CHANGES, type, name, sizeof(struct d3d9_##type), NONE)

/* Counts are expressions of the arguments, which are local variables for them. */
#define NAME(kind, ...) NAME_##kind(__VA_ARGS__)
#define NAME_NUMBER(type, name)                                                                              \
    const type name = b->name;                                                                               \
    (void)name;
#define NAME_ARRAY(type, name)                                                                               \
    type *const name = (void *)(uintptr_t)b->name;                                                           \
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
#define NAME_HOST_READS(type, name, count)   NAME_NUMBER(uint64_t, name)
#define NAME_HOST_WRITES(type, name, count)  NAME_NUMBER(uint64_t, name)
#define NAME_HOST_CHANGES(type, name, count) NAME_NUMBER(uint64_t, name)

#define COUNT(kind, ...)                      *to++ = COUNT_##kind(__VA_ARGS__);
#define COUNT_VALUE(type, name)               0
#define COUNT_HANDLE(type, name)              0
#define COUNT_POINTER(type, name)             0
#define COUNT_OBJECT(type, name)              0
#define COUNT_OBJECTS(type, name, count)      (count)
#define COUNT_NEW(type, name)                 1
#define COUNT_READS(type, name, count)        (count)
#define COUNT_WRITES(type, name, count)       (count)
#define COUNT_CHANGES(type, name, count)      (count)
#define COUNT_HOST_READS(type, name, count)   (count)
#define COUNT_HOST_WRITES(type, name, count)  (count)
#define COUNT_HOST_CHANGES(type, name, count) (count)

#define FORM(class, name, result_text, result_offset, is_method, ...)                                        \
    static void count_##class##_##name(const void *block, uint64_t *to)                                      \
    {                                                                                                        \
        const struct d3d9_block_##class##_##name *b = block;                                                 \
        (void)b, (void)to;                                                                                   \
        {                                                                                                    \
            D3D9_EACH(NAME, __VA_ARGS__) D3D9_EACH(COUNT, __VA_ARGS__)                                       \
        }                                                                                                    \
    }                                                                                                        \
    static const struct d3d9_form *form_##class##_##name(void)                                               \
    {                                                                                                        \
        typedef struct d3d9_block_##class##_##name own;                                                      \
        static const struct d3d9_argument arguments[] = {                                                    \
            D3D9_EACH(ROW, __VA_ARGS__){D3D9_ARGUMENT_VALUE, NULL, NULL, 0, 0, 0, D3D9_INTERFACE_NONE}};     \
        static const struct d3d9_form form = {                                                               \
            #class,   #name, result_text, arguments, sizeof(own), result_offset, count_##class##_##name,     \
            is_method};                                                                                      \
        return &form;                                                                                        \
    }
#define METHOD(class, method, name, type, ...)                                                               \
    FORM(class, name, #type, offsetof(own, result), true, __VA_ARGS__)
#define HOSTED                              METHOD
#define PROCEDURE(class, method, name, ...) FORM(class, name, "", 0, true, __VA_ARGS__)
#define LOCAL(class, method)
#define FUNCTION(class, name, type, ...) FORM(class, name, #type, offsetof(own, result), false, __VA_ARGS__)
#include "front/d3d9/calls/calls.def"
#undef METHOD
#undef PROCEDURE
#undef FUNCTION

const struct d3d9_form *d3d9_form_of(unsigned code)
{
    static const struct d3d9_form *(*const forms[D3D9_CODE_COUNT])(void) = {
#define METHOD(class, method, name, ...)    [D3D9_CODE_##class##_##name] = form_##class##_##name,
#define PROCEDURE(class, method, name, ...) [D3D9_CODE_##class##_##name] = form_##class##_##name,
#define FUNCTION(class, name, ...)          [D3D9_CODE_##class##_##name] = form_##class##_##name,
#include "front/d3d9/calls/calls.def"
#undef METHOD
#undef PROCEDURE
#undef FUNCTION
    };
    return forms[code]();
}

/* --- Which interfaces have a method --- */

static bool is_one_of(enum d3d9_interface interface, unsigned count, const enum d3d9_interface *bases)
{
    for (unsigned i = 0; i < count; i++)
        if (d3d9_object_interface_is(interface, bases[i]))
            return true;
    return false;
}

/* The tables that several interfaces include (pe/inherited.inc). */
enum table { TABLE_OWN, TABLE_ALL, TABLE_CHILD, TABLE_PRIVATE, TABLE_RESOURCE };

static enum table table_of(unsigned code)
{
#define PROCEDURE(class, method, name, ...) METHOD(class, method, name, void)
#define METHOD(class, method, name, ...)    [D3D9_CODE_##class##_##name] = TABLE_ALL,
    static const enum table tables[D3D9_CODE_COUNT] = {
#include "front/d3d9/calls/object.def"
#undef METHOD
#define METHOD(class, method, name, ...) [D3D9_CODE_##class##_##name] = TABLE_CHILD,
#include "front/d3d9/calls/child.def"
#undef METHOD
#define METHOD(class, method, name, ...) [D3D9_CODE_##class##_##name] = TABLE_PRIVATE,
#include "front/d3d9/calls/private.def"
#undef METHOD
#define METHOD(class, method, name, ...) [D3D9_CODE_##class##_##name] = TABLE_RESOURCE,
#include "front/d3d9/calls/resource.def"
    };
#undef METHOD
#undef PROCEDURE
    return tables[code];
}

static enum d3d9_interface interface_of(const char *class)
{
    static const struct {
        const char *name;
        enum d3d9_interface interface;
    } classes[] = {
#define INTERFACE(NAME, name, ...) {#name, D3D9_INTERFACE_##NAME},
#include "front/d3d9/interface.def"
#undef INTERFACE
    };
    for (size_t i = 0; i < sizeof classes / sizeof *classes; i++)
        if (!strcmp(classes[i].name, class))
            return classes[i].interface;
    return D3D9_INTERFACE_NONE;
}

static bool has_method(unsigned code, enum d3d9_interface interface)
{
    static const enum d3d9_interface parents[] = {D3D9_INTERFACE_FACTORY, D3D9_INTERFACE_DEVICE};
    static const enum d3d9_interface owners[] = {D3D9_INTERFACE_RESOURCE, D3D9_INTERFACE_VOLUME};
    if (!d3d9_form_of(code)->is_method)
        return false;
    switch (table_of(code)) {
    case TABLE_ALL: return true;
    case TABLE_CHILD: return !is_one_of(interface, 2, parents);
    case TABLE_PRIVATE: return is_one_of(interface, 2, owners);
    case TABLE_RESOURCE: return is_one_of(interface, 1, owners);
    default: return d3d9_object_interface_is(interface, interface_of(d3d9_form_of(code)->class));
    }
}

bool d3d9_form_is_method_of(unsigned code, enum d3d9_interface interface)
{
    static uint32_t interfaces[D3D9_CODE_COUNT]; /* bit i: of interface i */
    uint32_t found = interfaces[code];
    for (unsigned i = 0; !interfaces[code] && i < D3D9_INTERFACE_COUNT; i++)
        found |= (uint32_t)has_method(code, (enum d3d9_interface)i) << i;
    interfaces[code] = found;
    return interface < D3D9_INTERFACE_COUNT && found >> interface & 1;
}
