/* The base of every object that a program reaches through a COM interface.
 *
 * An object's address is its COM pointer: its first word is the address of the vtable that the host has
 * registered for its interface. Objects have two counts:
 * - references: those of the program, which AddRef and Release change and return. While there is at least
 *   one, the object holds itself and references its parent. The parent of a device is its factory; the
 *   parent of everything else is its device.
 * - holds: those of other objects, such as of the device on a bound texture. The program does not notice
 *   them.
 * An object is freed when it has no holds. There are three sorts of objects:
 * - ordinary ones are created with one reference,
 * - implicit ones with no reference and one hold of their creator, which frees them by dropping it: back
 *   buffers and what else a device creates for itself. They reference the device when the program
 *   references them, and can be referenced again after the last Release.
 * - parts: surfaces and volumes of a texture. Their counts are those of their owner, which frees them.
 *
 * Private data of the program belongs to the object. It can contain an interface of the program. Only the
 * host can call such an interface: it adds the reference before the call that stores it, and releases the
 * interfaces that d3d9_foreign_take returns. */
#ifndef D3D9_OBJECT_H
#define D3D9_OBJECT_H

#include "guid.h"
#include "memory.h"
#include "result.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum d3d9_interface {
#define INTERFACE(NAME, ...) D3D9_INTERFACE_##NAME,
#include "interface.def"
#undef INTERFACE
    D3D9_INTERFACE_COUNT
};

struct d3d9_private_data;

struct d3d9_object {
    uint64_t face; /* the address of the vtable; the low half in a process with 32-bit pointers */
    uint64_t host; /* data of the Windows side */
    uint32_t references;
    uint32_t draws;
    struct d3d9_object *parent; /* referenced by an object with references; null for a factory */
    /* All above are struct d3d9_head (host.h). */
    enum d3d9_interface interface;
    uint32_t holds;
    struct d3d9_object *owner;     /* of a part; otherwise null */
    struct d3d9_object *container; /* the result of GetContainer; null: none */
    void (*destroy)(struct d3d9_object *);
    struct d3d9_private_data *private_data;
};

/* Registers the vtable of an interface, at the start of the process. */
void d3d9_object_set_face(enum d3d9_interface, uint64_t face);
/* For tests: the name in Direct3D's headers, which a failure shows. */
const char *d3d9_object_interface_name(enum d3d9_interface);
/* Returns true if an interface is `base` or extends it. */
bool d3d9_object_interface_is(enum d3d9_interface, enum d3d9_interface base);

/* Return an object of `bytes` zero bytes after its base, whose size `bytes` includes; null without memory.
 * `destroy`, which may be null, frees what the object has; the base and its memory are freed after it. */
void *d3d9_object_make(size_t bytes, enum d3d9_interface, struct d3d9_object *parent,
                       void (*destroy)(struct d3d9_object *));
void *d3d9_object_make_implicit(size_t bytes, enum d3d9_interface, struct d3d9_object *parent,
                                void (*destroy)(struct d3d9_object *));
void *d3d9_object_make_part(size_t bytes, enum d3d9_interface, struct d3d9_object *owner);
/* Frees a part, whatever its counts. Null is allowed. */
void d3d9_object_free_part(struct d3d9_object *part);

/* AddRef and Release: return the new number of references. Release of an object without references returns
 * 0 and changes nothing. */
uint32_t d3d9_object_add_ref(struct d3d9_object *);
uint32_t d3d9_object_release(struct d3d9_object *);
/* Holds of other objects. Null is allowed. */
void d3d9_object_hold(struct d3d9_object *);
void d3d9_object_drop(struct d3d9_object *);
/* Replaces an object that another object holds: holds `with`, then drops the old one. */
void d3d9_object_exchange(struct d3d9_object **slot, struct d3d9_object *with);

/* QueryInterface: *out is the object, with one more reference; null and D3D9_NO_INTERFACE if it has no such
 * interface. */
int32_t d3d9_object_query_interface(struct d3d9_object *, const struct d3d9_guid *, void **out);
/* GetContainer: the container's QueryInterface. */
int32_t d3d9_object_query_container(struct d3d9_object *, const struct d3d9_guid *, void **out);

/* D3DSPD_IUNKNOWN: `data` is the address of a uint64_t with the interface, in a 32-bit program too. */
enum { D3D9_PRIVATE_INTERFACE = 1 };

/* Replaces the data with this identifier. A failure keeps the old data. */
int32_t d3d9_object_set_private_data(struct d3d9_object *, const struct d3d9_guid *, const void *data,
                                     uint32_t bytes, uint32_t flags);
/* Copies data. *bytes is the size of the array, then of the data. A null array only returns the size. If
 * the array is too small, the result is D3D9_MORE_DATA. */
int32_t d3d9_object_get_private_data(struct d3d9_object *, const struct d3d9_guid *, void *data,
                                     uint32_t *bytes);
int32_t d3d9_object_free_private_data(struct d3d9_object *, const struct d3d9_guid *);
/* Returns true if the data with this identifier is an interface, so the host adds a reference to what
 * d3d9_object_get_private_data has copied. */
int32_t d3d9_object_private_data_is_interface(struct d3d9_object *, const struct d3d9_guid *);

/* Interfaces of the program that private data contained and no longer contains. Moves at most `room` of
 * them to the array, and returns their number. */
uint32_t d3d9_foreign_take(uint64_t *interfaces, uint32_t room);
/* Returns true if there is one to take. */
bool d3d9_foreign_waits(void);

#endif
