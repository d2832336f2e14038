/* The types and constants of OpenGL ES 1.1 and 2.0, from Khronos' headers, without prototypes. */
#ifndef GL_TYPES_H
#define GL_TYPES_H

#define GL_GLES_PROTOTYPES 0
#include <GLES/gl.h>
#include <GLES2/gl2.h>
/* That of ES 1.1 names extensions whose contents only the other one has. */
#include <GLES2/gl2ext.h>
#include <GLES/glext.h>

#endif
