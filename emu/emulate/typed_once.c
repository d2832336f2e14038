/* The form files=typed:decode=once. */
#define FORM       emulate_typed_once
#define FORM_ARRAY 0
#define FORM_ONCE  1
#include "emu/emulate/form.h"
