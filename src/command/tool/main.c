/* The command `triptych`. */
#include "command/support/interrupt.h"
#include "command/tool/command_line.h"

#include <fcntl.h>
#include <unistd.h>

/* If standard output is closed, the next file to be opened would become standard output and be printed into.
 */
static int open_standard(void)
{
    int descriptor;
    do
        descriptor = open("/dev/null", O_RDONLY);
    while (descriptor >= 0 && descriptor <= STDERR_FILENO);
    return descriptor < 0 ? -1 : close(descriptor);
}

int main(int count, char **arguments)
{
    interrupt_catch();
    open_standard();
    return command_line_run(count, arguments);
}
