/* The names of constants, for messages. */
#ifndef GL_CONSTANT_H
#define GL_CONSTANT_H

/* "GL_TEXTURE_2D" of 0x0DE1; a hexadecimal number if there is none. The text is valid until the thread's next
 * call. */
const char *gl_constant_name(unsigned value);

#endif
