// The bodies of the generated loader, compiled once.
#define GLAD_GL_IMPLEMENTATION
#include <glad/gl.h>
