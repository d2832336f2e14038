#include "bench/clients/record.h"
#include "bench/clients/filter/convert_text.h"

KERNEL_RECORDS(convert_record, convert_text, struct convert_choice)
