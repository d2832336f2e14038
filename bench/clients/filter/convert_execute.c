#include "bench/clients/execute.h"
#include "bench/clients/filter/convert_text.h"

KERNEL_EXECUTES(convert_execute, convert_text, struct convert_choice)
