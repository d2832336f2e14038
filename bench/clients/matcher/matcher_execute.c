#include "bench/clients/execute.h"
#include "bench/clients/matcher/matcher_text.h"

KERNEL_EXECUTES(matcher_execute, matcher_text, struct automaton)
