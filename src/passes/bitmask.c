#include "passes/arc.h"
#include "passes/method.h"

static bool run(pass_context *c, error *e) { return arc_run_occlusion(c, "BITMASK", e); }

static const variant_row variants[] = {{.program = "arc_occlusion", .pattern = ARC_OCCLUSION("BITMASK")}, {0}};

const method method_bitmask = {
    .name = "bitmask",
    .summary = "a visibility bitmask, every surface of the same thickness (Therrien et al. 2023)",
    .weighting = "cosine, in slices as arc",
    .reaches = "surfaces within the radius",
    .blind = "all surfaces are equally thick (by default 0.3 of the radius); the rest as alchemy",
    .light = "SH irradiance times occlusion",
    .choose = "to compare with a game engine's bitmask occlusion",
    .options = "error thickness",
    .samples = 256,
    .blur = 2,
    .thickness = 0.3,
    .makes = MAKES_BENT | MAKES_ERROR,
    .source = SEES_PICTURE,
    .weight = WEIGHS_COSINE,
    .reach = REACH_SURFACES,
    .variants = variants,
    .run = run,
};
