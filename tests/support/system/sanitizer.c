/* The options of AddressSanitizer in every instrumented program; ASAN_OPTIONS overrides each of them. */

const char *__asan_default_options(void);

/* A check of undefined behaviour that fails executes an illegal instruction (Makefile), so SIGILL has a
 * report with the line of the source. Freed memory is kept apart until it is 16 MB, so that an access to it
 * is found. The default is 256 MB: the kernel must clear each page of it, which takes a seventh of the time
 * of the programs. */
const char *__asan_default_options(void)
{
    return "handle_sigill=1:quarantine_size_mb=16";
}
