#include "bench/clients/record.h"
#include "bench/clients/cipher/chacha_text.h"

KERNEL_RECORDS(chacha_record, chacha_text, struct chacha_choice)
