/* Lab 10: the instruction `add` of a shader, with swizzles and a mask, for two layouts of data. */
#ifndef SWIZZLE_H
#define SWIZZLE_H

/* Components are numbered: x 0, y 1, z 2, w 3. */
enum { COMPONENTS = 4, PIXELS = 4, SHADER_REGISTERS = 12 };

/* --- letters.c ---
 *
 * `mask` has one to four different letters in the order x, y, z, w; `swizzle` one to four letters. If the
 * swizzle is shorter than it must be, its last letter is repeated. Sets source[c] to the component that is
 * read for component c of the result, and to -1 if the mask does not contain c. */

/* As in the text of shaders: component c reads letter c of the swizzle. */
void letters_by_position(const char *mask, const char *swizzle, int source[COMPONENTS]);

/* As in HLSL: the first component of the mask reads the first letter, the second the second, and so on. */
void letters_in_order(const char *mask, const char *swizzle, int source[COMPONENTS]);

/* --- What is translated ---
 *
 * Component c of register `result` becomes component left_source[c] of register `left` plus component
 * right_source[c] of register `right`. Where the sources are -1, it keeps its value. Registers are 0 to
 * SHADER_REGISTERS - 1; they may be equal. */
struct shader_add {
    int result, left, right;
    int left_source[COMPONENTS], right_source[COMPONENTS]; /* -1 in the same places */
};

/* --- Machine instructions --- */

enum machine_operation {
    MACHINE_ADD,     /* the four numbers of `left` plus those of `right` */
    MACHINE_MOVE,    /* `left` */
    MACHINE_SHUFFLE, /* number i is number control[i] of `left` */
    MACHINE_BLEND    /* number i is that of `left` if control[i] is 0, that of `right` if it is 1 */
};

struct machine_instruction {
    enum machine_operation operation;
    int result, left, right;
    int control[COMPONENTS];
};

/* --- translate.c ---
 *
 * Both write instructions to `at`, and return how many. */

enum {
    TEMPORARIES = 4,                    /* registers that the translation may use as it likes */
    PIXEL_TEMPORARY = SHADER_REGISTERS, /* the first of them, where a register is a pixel */
    COMPONENT_TEMPORARY = SHADER_REGISTERS * COMPONENTS, /* where a register is a component */
    INSTRUCTIONS_MAXIMUM = 16
};

/* One pixel a register: register r has the four components of shader register r of ONE pixel. The code is
 * executed once for each pixel. At most a shuffle for each operand, an add and a blend; none that is not
 * needed. */
int translate_pixel(const struct shader_add *add, struct machine_instruction *at);

/* One component a register: register COMPONENTS * r + c has component c of shader register r for FOUR pixels.
 * The code is executed once for all four. Uses MACHINE_ADD and MACHINE_MOVE only. An add for each component
 * that is written; moves only where an operand would otherwise be lost before it is read, at most one for
 * each component that is written. */
int translate_component(const struct shader_add *add, struct machine_instruction *at);

#endif
