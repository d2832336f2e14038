/* The specification of the pipeline: the routines of the units, spec_vertex, spec_setup, spec_pixel and
 * spec_blit.
 * Include it after a binding (contract/language.h).
 *
 * Reading order: math/ has the arithmetic that all parts share; texture/ samples; shader/ executes shaders;
 * vertex/, setup/, pixel/ and blit/ are the units, each ending in the header that is included here. Every
 * header includes those that it uses. */
#ifndef SPEC_SPEC_H
#define SPEC_SPEC_H

#include "spec/blit/blit.h"
#include "spec/pixel/pixel.h"
#include "spec/setup/setup.h"
#include "spec/vertex/vertex.h"

#endif
