/* The form files=typed:decode=each, the engine's own. */
#define FORM       emulate_typed_each
#define FORM_ARRAY 0
#define FORM_ONCE  0
#include "emu/emulate/form.h"
