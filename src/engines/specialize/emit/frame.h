/* The general-purpose registers of routines (frame.c), for the code of the loops around their bodies. */
#ifndef ENGINES_SPECIALIZE_EMIT_FRAME_H
#define ENGINES_SPECIALIZE_EMIT_FRAME_H

#define CALL       X86_RDI
#define JOB        X86_R8
#define INPUT      X86_RSI
#define OUTPUT     X86_RDX
#define VERTICES   X86_RCX
#define ENTRY      X86_RSI
#define TRIANGLE   X86_RDX
#define LANES      X86_RCX
#define COLOR      X86_R9
#define DEPTH      X86_R10
#define NEXT_ENTRY X86_RBX /* of the second of two blocks, whose routines have no windows */
#define NEXT_COLOR X86_R9  /* from NEXT_BLOCK on, as NEXT_DEPTH */
#define NEXT_DEPTH X86_R10
#define NEXT_BLOCK X86_R15 /* bytes from the first of two blocks to the second */
#define CONSTANT   X86_R14
#define LIMIT      X86_R11 /* end of the input */
#define ROW        X86_R11 /* of the span reading, whose end of the input is in the frame */
#define AHEAD      X86_RBX /* coverage of the chunks that are still ahead */
#define STRETCHED  X86_R10 /* of the span reading: an entry of a stretched row, in the loop that stores it */
#define COLUMN     X86_RBX /* of the span reading, which has no other coverage than that of whole blocks */

#endif
