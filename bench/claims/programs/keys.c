/* Counts the space of keys from the table of their fields: bits of all values, bytes of the packed form and
 * of the structures, for each unit. Prints JSON. */
#include "contract/key.h"

#include <math.h>
#include <stdio.h>

#define ADD(unit, field, radix, meaning)             bits += log2(radix), fields++;
#define ADD_MANY(unit, field, count, radix, meaning) bits += (count)*log2(radix), fields += (count);

#define PRINT(TABLE, name, structure, separator)                                                             \
    do {                                                                                                     \
        double bits = 0;                                                                                     \
        int fields = 0;                                                                                      \
        TABLE(ADD, ADD_MANY)                                                                                 \
        printf("{\"unit\": \"%s\", \"fields\": %d, \"bits\": %.2f, \"packed\": %d, \"careless\": %d}%s",     \
               name, fields, bits, 8 * (int)ceil(bits / 64), 4 * fields, separator);                         \
    } while (0)

int main(void)
{
    printf("{\"units\": [");
    PRINT(VERTEX_KEY, "vertex", vertex_key, ", ");
    PRINT(SETUP_KEY, "setup", setup_key, ", ");
    PRINT(PIXEL_KEY, "pixel", pixel_key, "");
    printf("]}\n");
    return 0;
}
