#include "bench/clients/execute.h"
#include "bench/clients/cipher/chacha_text.h"

KERNEL_EXECUTES(chacha_execute, chacha_text, struct chacha_choice)
