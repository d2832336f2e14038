/* The form files=array:decode=each. */
#define FORM       emulate_array_each
#define FORM_ARRAY 1
#define FORM_ONCE  0
#include "emu/emulate/form.h"
