/* The values of states as values of key fields: one function for each kind. Values are those that the state
 * can have (def/state/value.def).
 *
 * The switches have no default. A new row of value.def therefore does not compile before it has a meaning
 * here. */
#ifndef RENDER_DERIVE_TRANSLATE_H
#define RENDER_DERIVE_TRANSLATE_H

#include "contract/key.h"
#include "triptych.h"

#include <stdbool.h>
#include <stdint.h>

/* For the end of such a function: the value of a state is one that cannot be set. Ends the process. */
_Noreturn void derive_impossible(const char *kind, uint32_t value);

uint8_t derive_compare(uint32_t value);                /* enum compare */
uint8_t derive_stencil_operation(uint32_t value);      /* enum stencil_operation */
uint8_t derive_blend_operation(uint32_t value);        /* enum blend */
uint8_t derive_logic_operation(uint32_t value);        /* enum logic */
uint8_t derive_factor(uint32_t value);                 /* enum factor; not of the values BOTH... */
uint8_t derive_cull(uint32_t value);                   /* enum cull */
uint8_t derive_mip_filter(uint32_t value);             /* enum mip */
uint8_t derive_filter(uint32_t value);                 /* enum filter */
uint8_t derive_address(uint32_t value, uint32_t size); /* enum address_mode, of an axis of this size */
uint8_t derive_table_fog(uint32_t value);              /* enum fog, by depth z */
uint8_t derive_fog_mode(uint32_t value);               /* enum vertex_fog */

#endif
