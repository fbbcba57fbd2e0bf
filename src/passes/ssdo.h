// What the direct pass of SSDO and its bounce share: shaders/params/ssdo.glsl.
#ifndef SSDO_PASSES_SSDO_H
#define SSDO_PASSES_SSDO_H

#include "passes/params.h"
#include "passes/pass.h"

ssdo_params ssdo_params_of(const pass_context *c);

#endif
