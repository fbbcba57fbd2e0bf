#include "passes/arc.h"
#include "passes/method.h"

static bool run(pass_context *c, error *e) { return arc_run_occlusion(c, "HORIZON", e); }

static const variant_row variants[] = {{.program = "arc_occlusion", .pattern = ARC_OCCLUSION("HORIZON")}, {0}};

const method method_gtao = {
    .name = "gtao",
    .summary = "horizons in slices around the view vector (Jimenez et al. 2016)",
    .weighting = "cosine, in slices as arc",
    .reaches = "surfaces within the radius",
    .blind = "gaps: all beyond a horizon is blocked; the rest as alchemy",
    .light = "SH irradiance times occlusion",
    .choose = "to compare with a game engine's horizon occlusion",
    .options = "error",
    .samples = 256,
    .blur = 2,
    .thickness = 0.0,
    .makes = MAKES_BENT | MAKES_ERROR,
    .source = SEES_PICTURE,
    .weight = WEIGHS_COSINE,
    .reach = REACH_SURFACES,
    .variants = variants,
    .run = run,
};
