#include "bench/clients/record.h"
#include "bench/clients/matcher/matcher_text.h"

KERNEL_RECORDS(matcher_record, matcher_text, struct automaton)
