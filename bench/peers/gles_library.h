/* EGL and GLES2 of a folder, or the system's: which of them is decided when the process runs, so nothing is linked. */
#ifndef PEERS_GLES_LIBRARY_H
#define PEERS_GLES_LIBRARY_H

#define EGL_EGLEXT_PROTOTYPES
#define GL_GLEXT_PROTOTYPES
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES2/gl2.h>

#define EGL_FUNCTIONS(_)                                                                                                \
    _(GetDisplay) _(Initialize) _(ChooseConfig) _(BindAPI) _(CreateContext) _(CreatePbufferSurface) _(MakeCurrent)     \
    _(GetProcAddress) _(GetError)
#define GL_FUNCTIONS(_)                                                                                                 \
    _(ActiveTexture) _(AttachShader) _(BindAttribLocation) _(BindBuffer) _(BindTexture) _(BlendFunc) _(BufferData)     \
    _(Clear) _(ClearColor) _(ClearDepthf) _(CompileShader) _(CreateProgram) _(CreateShader) _(CullFace)                \
    _(DeleteBuffers) _(DeleteProgram) _(DeleteShader) _(DeleteTextures) _(DepthFunc) _(DepthMask) _(Disable)           \
    _(DisableVertexAttribArray) _(DrawArrays) _(DrawElements) _(Enable) _(EnableVertexAttribArray) _(Finish)           \
    _(FrontFace) _(GenBuffers) _(GenTextures) _(GetError) _(GetProgramInfoLog) _(GetProgramiv) _(GetShaderInfoLog)     \
    _(GetString) _(GetUniformLocation) _(LinkProgram) _(PixelStorei) _(ReadPixels) _(Scissor) _(ShaderSource)          \
    _(TexImage2D) _(TexParameteri) _(Uniform1i) _(Uniform3fv) _(Uniform4f) _(Uniform4fv) _(UseProgram)                 \
    _(VertexAttribPointer) _(Viewport)

struct gles {
#define FUNCTION(name) __typeof__(egl##name) *egl##name;
    EGL_FUNCTIONS(FUNCTION)
#undef FUNCTION
#define FUNCTION(name) __typeof__(gl##name) *name;
    GL_FUNCTIONS(FUNCTION)
#undef FUNCTION
};

extern struct gles gl;

/* Loads the libraries of `folder`, ANGLE's, or with null the system's, and makes a context with a surface of that side and
 * RGBA8 + depth 24 current. Returns a reason, or null. */
const char *gles_start(const char *folder, int side);

#endif
