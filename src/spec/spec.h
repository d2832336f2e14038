/* The pipeline, in the order of its parts: include this after a binding (docs/staging.md).
 *
 * A binding provides: the lane types flt, itg, fix and msk; struct env; E, which is the env at the current
 * source line; every operation of def/op.def; lit_f lit_i lit_x lit_m; load_, store_, uniform_, gather_ and
 * scatter_ for _f and _i; WHEN. None of these files has an include guard and none includes anything: they are
 * read once per engine, each time in another sense. */
#include "spec/fetch.h"
#include "spec/transcendental.h"
#include "spec/transform.h"
#include "spec/light.h"
#include "spec/clip.h"
#include "spec/vertex.h"
#include "spec/setup.h"
#include "spec/color.h"
#include "spec/float_color.h"
#include "spec/interpolate.h"
#include "spec/sample.h"
#include "spec/stage.h"
#include "spec/float_stage.h"
#include "spec/compare.h"
#include "spec/depth.h"
#include "spec/fog.h"
#include "spec/stencil.h"
#include "spec/alpha.h"
#include "spec/blend.h"
#include "spec/float_blend.h"
#include "spec/srgb.h"
#include "spec/write.h"
#include "spec/target.h"
#include "spec/float_target.h"
#include "spec/pixel.h"
#include "spec/float_pixel.h"
