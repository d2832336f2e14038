/* The tokens of shaders, 32 bits each.
 *
 *   version      0xfffe (vertex) or 0xffff (pixel), then the model
 *   instruction  15:0 opcode  23:16 control  27:24 tokens that follow (models 2.0 and higher, else 0)
 *                28 predicated  30 issued together with the one before (ps_1_x)
 *   destination  10:0 register  12:11, 30:28 file  13 relative  19:16 mask  23:20 modifiers
 *                27:24 shift, signed  31 set
 *   source       10:0 register  12:11, 30:28 file  13 relative  23:16 swizzle  27:24 modifier  31 set
 *   comment      0xfffe  30:16 tokens that follow
 *   end          0x0000ffff
 *
 * An instruction's tokens: itself, the destination, the predicate (as a source), the sources. A relative
 * operand is followed by a source token for its index register, except in vs_1_1, where that is always a0.x.
 * dcl has a token for the usage (3:0 usage, 19:16 its number, 30:27 kind of texture, 31 set) and the
 * destination. def and defi have the destination and four literals, defb one. In a file's bits, 12:11 are the
 * high two and 30:28 the low three. */
#ifndef SHADER_CODE_TOKEN_H
#define SHADER_CODE_TOKEN_H

#include <stdint.h>

#define TOKEN_VERTEX     0xfffe0000u
#define TOKEN_PIXEL      0xffff0000u
#define TOKEN_SET        0x80000000u
#define TOKEN_RELATIVE   0x00002000u
#define TOKEN_PREDICATED 0x10000000u
#define TOKEN_COISSUE    0x40000000u
#define TOKEN_END        0x0000ffffu

enum {
    TOKEN_COMMENT = 0xfffe,
    TOKEN_REGISTERS = 0x800,   /* register numbers of one file */
    TOKEN_CONSTANTS = 0x2000,  /* of c, in four files */
    TOKEN_TYPE_CONSTANT = 2,   /* c0 to c2047 */
    TOKEN_TYPE_CONTINUED = 11, /* the first of the other three */
    TOKEN_LENGTH_MAXIMUM = 15,
};

#endif
