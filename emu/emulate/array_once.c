/* The form files=array:decode=once. */
#define FORM       emulate_array_once
#define FORM_ARRAY 1
#define FORM_ONCE  1
#include "emu/emulate/form.h"
