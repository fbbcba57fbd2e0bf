#include "cli/options_table.h"

#include <math.h>

#include "cli/options.h"

#define FIELD(name) offsetof(options, name)
#define WORDS(...)                                                                                                               \
    (const option_word[])                                                                                                        \
    {                                                                                                                            \
        __VA_ARGS__, { NULL, 0 }                                                                                                 \
    }

// gbuffer/resolve.h's roles, which this room may not include; tests/unit/test_cli_parse.c holds both against each other.
enum { POSITION, NORMAL, DEPTH, ALBEDO, BEAUTY, ALPHA, ROUGHNESS, METALLIC, EMISSION };

// OPT_ENUM writes an int.
_Static_assert(sizeof(compose_mode) == sizeof(int) && sizeof(radius_unit) == sizeof(int) && sizeof(progress_form) == sizeof(int),
               "enums are as wide as int");

// clang-format off
const option_row option_rows[] = {
    {.group = GROUP_OUTPUT, .name = "output", .letter = 'o', .argument = "FILE", .kind = OPT_PATH, .offset = FIELD(output),
     .help = "The EXR file to write. It is written whole or not at all, and may not be the input."},
    {.group = GROUP_OUTPUT, .name = "layers", .argument = "LIST", .kind = OPT_TEXT, .offset = FIELD(layers), .pixels = true,
     .fallback = "occlusion,radiance,indirect,composite",
     .help = "Layers to write, separated by commas. A layer named here that cannot be made is an error; a default one is left out with a warning."},
    {.group = GROUP_OUTPUT, .name = "keep", .argument = "all|none", .kind = OPT_SWITCH, .offset = FIELD(keep_none),
     .words = WORDS({"all", 0}, {"none", 1}), .fallback = "all",
     .help = "Whether the channels of the input are passed through, untouched."},
    {.group = GROUP_OUTPUT, .name = "layout", .argument = "single|multipart", .kind = OPT_SWITCH, .offset = FIELD(multipart),
     .words = WORDS({"single", 0}, {"multipart", 1}), .fallback = "single",
     .help = "With multipart the input is copied without decoding and the new layers go into a second part, named ssdo: faster, but read by fewer programs."},
    {.group = GROUP_OUTPUT, .name = "prefix", .argument = "P", .kind = OPT_TEXT, .offset = FIELD(prefix), .may_be_empty = true,
     .help = "Text put before the names of the new layers, for inputs that already have layers of those names."},
    {.group = GROUP_OUTPUT, .name = "compression", .argument = "none|rle|zips|zip|piz", .kind = OPT_CHOICE,
     .offset = FIELD(compression), .words = WORDS({"none", 0}, {"rle", 0}, {"zips", 0}, {"zip", 0}, {"piz", 0}),
     .fallback = "as the input, zip where that is lossy", .help = "Compression of the output."},
    {.group = GROUP_OUTPUT, .name = "float", .kind = OPT_FLAG, .offset = FIELD(output_float), .pixels = true,
     .help = "Write the new layers as 32-bit float instead of half."},

    {.group = GROUP_ESTIMATOR, .name = "method", .argument = "NAME", .kind = OPT_TEXT, .offset = FIELD(method), .pixels = true,
     .fallback = "arc", .help = "How visibility is estimated; the manual has a table of the methods."},
    {.group = GROUP_ESTIMATOR, .name = "preset", .argument = "scene|closeup", .kind = OPT_CHOICE, .offset = FIELD(preset),
     .words = WORDS({"scene", 0}, {"closeup", 0}), // not recorded: its values are
     .help = "A set of values for options that are not given: \"scene\" is alchemy with radius 0.05, scale 2 and contrast 3, for a room in metres; \"closeup\" is alchemy with radius 0.08, scale 1.7 and contrast 2.2."},
    {.group = GROUP_ESTIMATOR, .name = "radius", .argument = "R|Npx|auto", .kind = OPT_RADIUS, .offset = FIELD(radius),
     .words = WORDS({"auto", 0}), .pixels = true, .fallback = "auto",
     .help = "Reach of the occlusion in scene units, or in pixels with px. With auto it is measured from the visible surfaces."},
    {.group = GROUP_ESTIMATOR, .name = "quality", .argument = "draft|standard|high", .kind = OPT_ENUM, .offset = FIELD(quality),
     .words = WORDS({"draft", -1}, {"standard", 0}, {"high", 1}), .pixels = true, .fallback = "standard",
     .help = "The number of samples: a quarter of the method's own, as many, or four times as many. With --samples it has no effect."},
    {.group = GROUP_ESTIMATOR, .name = "samples", .argument = "N", .kind = OPT_INT, .offset = FIELD(samples), .min = 1,
     .max = 65536, .pixels = true, .fallback = "by --quality",
     .help = "Samples per pixel. For arc, gtao and bitmask these are slices times two sides times steps, with about twice as many steps as slices."},
    {.group = GROUP_ESTIMATOR, .name = "thickness", .argument = "auto|inf|F", .kind = OPT_REAL, .offset = FIELD(thickness),
     .words = WORDS({"auto", -1}, {"inf", INFINITY}), .min = 0, .max = INFINITY, .open = true, .pixels = true, .fallback = "auto",
     .help = "How far a surface is taken to reach behind what the camera sees, as a share of the radius."},
    {.group = GROUP_ESTIMATOR, .name = "planes", .argument = "on|off", .kind = OPT_SWITCH, .offset = FIELD(no_planes),
     .words = WORDS({"on", 0}, {"off", 1}), .pixels = true, .fallback = "on",
     .help = "Whether arc lets the large planes of the picture stand in for their hidden and off-screen parts."},
    {.group = GROUP_ESTIMATOR, .name = "angle-bias", .argument = "DEG", .kind = OPT_REAL, .offset = FIELD(angle_bias), .min = 0,
     .max = 90, .pixels = true, .fallback = "0",
     .help = "For hbao: angle above the tangent plane below which nothing occludes. 10 to 30 hides the facets of coarse models, and all shallow occlusion with them."},
    {.group = GROUP_ESTIMATOR, .name = "sh-sigma", .argument = "S", .kind = OPT_REAL, .offset = FIELD(sh_sigma), .min = 0, .max = 4,
     .pixels = true, .fallback = "0",
     .help = "For s3ho: width in radians of a Gaussian that smooths the visibility over directions. 0.2 to 0.5 takes away ringing under a small bright light, and direction with it."},
    {.group = GROUP_ESTIMATOR, .name = "from-sh", .kind = OPT_FLAG, .offset = FIELD(from_sh), .pixels = true,
     .help = "Relight: take the layers sh_0, sh_1 and sh_2 that an earlier run with --method s3ho left in the input, instead of estimating visibility. The input must still hold its G-buffer."},
    {.group = GROUP_ESTIMATOR, .name = "blur", .argument = "N|none", .kind = OPT_INT, .offset = FIELD(blur),
     .words = WORDS({"none", 0}), .min = 0, .max = 64, .pixels = true, .fallback = "the method's own",
     .help = "Radius in pixels of the edge-aware blur that removes sampling noise."},
    {.group = GROUP_ESTIMATOR, .name = "scale", .argument = "S", .kind = OPT_REAL, .offset = FIELD(scale), .min = 0,
     .max = INFINITY, .pixels = true, .fallback = "1",
     .help = "Multiplies the blocked share of the hemisphere. With anything but 1 the occlusion layer no longer keeps its contract."},
    {.group = GROUP_ESTIMATOR, .name = "contrast", .argument = "K", .kind = OPT_REAL, .offset = FIELD(contrast), .min = 0,
     .max = INFINITY, .pixels = true, .fallback = "1",
     .help = "Exponent of the occlusion, applied after the blur. With anything but 1 the occlusion layer no longer keeps its contract."},

    {.group = GROUP_BOUNCE, .name = "bounce", .argument = "none|arc|ssdo|vpl", .kind = OPT_CHOICE, .offset = FIELD(bounce),
     .words = WORDS({"none", 0}, {"arc", 0}, {"ssdo", 0}, {"vpl", 0}), .pixels = true, .fallback = "the method's own where it has one",
     .help = "How one diffuse bounce is estimated: arc from the blocked sectors of its slices, at any distance, ssdo from the blockers within the radius, vpl from lights chosen all over the picture, at any distance. It needs an albedo."},
    {.group = GROUP_BOUNCE, .name = "bounce-strength", .argument = "S", .kind = OPT_REAL, .offset = FIELD(bounce_strength),
     .min = 0, .max = INFINITY, .pixels = true, .fallback = "1", .help = "Multiplies the bounce; 1 is the physical amount."},
    {.group = GROUP_BOUNCE, .name = "vpl-count", .argument = "N", .kind = OPT_INT, .offset = FIELD(vpl_count), .min = 1, .max = 4096,
     .pixels = true, .fallback = "512", .help = "Lights of --bounce vpl. Few of them show as blotches near the surfaces that send."},

    {.group = GROUP_ENVIRONMENT, .name = "env", .argument = "FILE", .kind = OPT_PATH, .offset = FIELD(env), .pixels = true,
     .fallback = "white, of radiance 1",
     .help = "Lat-long environment map, linear: EXR, or any format OpenImageIO reads."},
    {.group = GROUP_ENVIRONMENT, .name = "env-up", .argument = "y|z", .kind = OPT_ENUM, .offset = FIELD(env_up),
     .words = WORDS({"y", 'y'}, {"z", 'z'}), .pixels = true, .fallback = "z for files from Blender, else y",
     .help = "Axis that points to the top of the map. With z the mapping is Blender's equirectangular one, with y OpenEXR's latlong."},
    {.group = GROUP_ENVIRONMENT, .name = "env-rotate", .argument = "DEG", .kind = OPT_REAL, .offset = FIELD(env_rotate),
     .min = -INFINITY, .max = INFINITY, .pixels = true, .fallback = "0",
     .help = "Turns the environment about the up axis, counter-clockwise seen from above."},
    {.group = GROUP_ENVIRONMENT, .name = "env-scale", .argument = "S", .kind = OPT_REAL, .offset = FIELD(env_scale), .min = 0,
     .max = INFINITY, .pixels = true, .fallback = "1", .help = "Multiplies the environment's radiance."},
    {.group = GROUP_ENVIRONMENT, .name = "env-colorspace", .argument = "C", .kind = OPT_TEXT, .offset = FIELD(env_colorspace),
     .pixels = true, .fallback = "linear already",
     .help = "Colour space of the environment map, converted to the scene_linear role of an OpenColorIO config."},
    {.group = GROUP_ENVIRONMENT, .name = "ocio", .argument = "FILE", .kind = OPT_PATH, .offset = FIELD(ocio), .pixels = true,
     .fallback = "the config that $OCIO names", .help = "OpenColorIO config for colour spaces named on the command line."},
    {.group = GROUP_ENVIRONMENT, .name = "env-frame", .argument = "world|camera", .kind = OPT_CHOICE, .offset = FIELD(env_frame),
     .words = WORDS({"world", 0}, {"camera", 0}), .pixels = true, .fallback = "world",
     .help = "What the environment is fixed to. The world needs a camera whose rotation is known."},
    {.group = GROUP_ENVIRONMENT, .name = "env-lod", .argument = "L|auto", .kind = OPT_REAL, .offset = FIELD(env_lod),
     .words = WORDS({"auto", -1}), .min = 0, .max = 16, .pixels = true, .fallback = "auto",
     .help = "Mip level at which directions look the environment up, 0 being the sharpest. With auto it matches the solid angle of a sample."},

    {.group = GROUP_COMPOSITE, .name = "mode", .argument = "radiance|visibility", .kind = OPT_ENUM, .offset = FIELD(mode),
     .words = WORDS({"radiance", MODE_RADIANCE}, {"visibility", MODE_VISIBILITY}), .pixels = true, .fallback = "radiance",
     .help = "Light of the composite with an environment: the radiance layer, or the unoccluded irradiance times the visibility."},
    {.group = GROUP_COMPOSITE, .name = "amount", .argument = "F", .kind = OPT_REAL, .offset = FIELD(amount), .min = 0, .max = 1,
     .pixels = true, .fallback = "1",
     .help = "Share of the occlusion multiplied onto a beauty pass. 0 without a bounce gives the beauty back bit for bit."},

    {.group = GROUP_COMPOSITE, .name = "multiply", .argument = "diffuse|all", .kind = OPT_CHOICE, .offset = FIELD(multiply),
     .words = WORDS({"diffuse", 0}, {"all", 0}), .pixels = true, .fallback = "diffuse",
     .help = "What the occlusion is multiplied onto: diffuse light, or specular light and all of a beauty pass too."},
    {.group = GROUP_COMPOSITE, .name = "depthmask-strength", .argument = "S", .kind = OPT_REAL, .offset = FIELD(depthmask_strength),
     .min = 0, .max = INFINITY, .pixels = true, .fallback = "0",
     .help = "Darkens the composite behind the edges of nearer objects: it is multiplied by 1 + S times the depthmask layer, at least 0."},

    {.group = GROUP_CHANNELS, .name = "position", .argument = "C", .kind = OPT_TEXT, .offset = FIELD(role_names[POSITION]),
     .pixels = true, .help = "Layer or channels of the position pass."},
    {.group = GROUP_CHANNELS, .name = "normal", .argument = "C", .kind = OPT_TEXT, .offset = FIELD(role_names[NORMAL]),
     .pixels = true, .help = "Layer or channels of the normal pass."},
    {.group = GROUP_CHANNELS, .name = "depth", .argument = "C", .kind = OPT_TEXT, .offset = FIELD(role_names[DEPTH]),
     .pixels = true, .help = "Channel of the depth pass."},
    {.group = GROUP_CHANNELS, .name = "albedo", .argument = "C", .kind = OPT_TEXT, .offset = FIELD(role_names[ALBEDO]),
     .pixels = true, .help = "Layer or channels of the albedo pass."},
    {.group = GROUP_CHANNELS, .name = "beauty", .argument = "C", .kind = OPT_TEXT, .offset = FIELD(role_names[BEAUTY]),
     .pixels = true, .help = "Layer or channels of the lit picture."},
    {.group = GROUP_CHANNELS, .name = "roughness", .argument = "C", .kind = OPT_TEXT, .offset = FIELD(role_names[ROUGHNESS]),
     .pixels = true, .help = "Channel of the roughness pass."},
    {.group = GROUP_CHANNELS, .name = "metallic", .argument = "C", .kind = OPT_TEXT, .offset = FIELD(role_names[METALLIC]),
     .pixels = true, .help = "Channel of the metallic pass."},
    {.group = GROUP_CHANNELS, .name = "emission", .argument = "C", .kind = OPT_TEXT, .offset = FIELD(role_names[EMISSION]),
     .pixels = true, .help = "Layer or channels of the emission pass."},
    {.group = GROUP_CHANNELS, .name = "view-layer", .argument = "NAME", .kind = OPT_TEXT, .offset = FIELD(view_layer),
     .pixels = true, .fallback = "the only one", .help = "Which set of passes to use where the file has several."},
    {.group = GROUP_CHANNELS, .name = "depth-kind", .argument = "planar|radial", .kind = OPT_CHOICE, .offset = FIELD(depth_kind),
     .words = WORDS({"planar", 0}, {"radial", 0}), .pixels = true, .fallback = "measured, or by renderer",
     .help = "Whether depth is measured along the camera's axis or along the ray of the pixel."},
    {.group = GROUP_CHANNELS, .name = "albedo-kind", .argument = "base|diffuse", .kind = OPT_CHOICE, .offset = FIELD(albedo_kind),
     .words = WORDS({"base", 0}, {"diffuse", 0}), .pixels = true, .fallback = "by renderer",
     .help = "Whether the albedo is the base colour or is already free of metal, as Blender's DiffCol."},

    {.group = GROUP_CAMERA, .name = "fov", .argument = "DEG", .kind = OPT_REAL, .offset = FIELD(fov), .min = 0, .max = 180,
     .open = true, .pixels = true, .fallback = "found from the position pass or the header",
     .help = "Horizontal field of view of a perspective camera, over the display window."},
    {.group = GROUP_CAMERA, .name = "ortho", .argument = "WIDTH", .kind = OPT_REAL, .offset = FIELD(ortho), .min = 0,
     .max = INFINITY, .open = true, .pixels = true,
     .help = "Width of the display window in scene units, for an orthographic camera. Not together with --fov."},
    {.group = GROUP_CAMERA, .name = "camera", .argument = "FILE.json", .kind = OPT_PATH, .offset = FIELD(camera_file),
     .help = "Camera as a JSON file with fov, focal_px or ortho_width, and optionally principal and world_from_camera."},

    {.group = GROUP_RUN, .name = "preview", .argument = "FILE.png", .kind = OPT_PATH, .offset = FIELD(preview),
     .help = "Also write an 8-bit picture of the result."},
    {.group = GROUP_RUN, .name = "frames", .argument = "RANGE", .kind = OPT_TEXT, .offset = FIELD(frames),
     .fallback = "every existing file of the input pattern",
     .help = "Frames of a sequence: 1-100, 1-100x2, 1-10:4, 1,5,7-9. Input and output then hold a place for the frame: ####, %04d or $F4."},
    {.group = GROUP_RUN, .name = "missing", .argument = "error|skip", .kind = OPT_SWITCH, .offset = FIELD(missing_skip),
     .words = WORDS({"error", 0}, {"skip", 1}), .fallback = "error", .help = "What an input frame that does not exist is."},
    {.group = GROUP_RUN, .name = "skip-existing", .kind = OPT_FLAG, .offset = FIELD(skip_existing),
     .help = "Leave out frames whose output is complete and was made by this version with the same settings."},
    {.group = GROUP_RUN, .name = "keep-going", .kind = OPT_FLAG, .offset = FIELD(keep_going),
     .help = "Go on with the next frame when one fails. The exit status is 1 in the end, and the frames that failed are listed."},
    {.group = GROUP_RUN, .name = "radius-from", .argument = "FRAME", .kind = OPT_INT, .offset = FIELD(radius_from),
     .min = -1e8, .max = 1e8, .pixels = true, .fallback = "the lowest-numbered existing file",
     .help = "Frame of the sequence on which the automatic radius is measured, so that all frames have the same."},
    {.group = GROUP_RUN, .name = "progress", .argument = "auto|plain|alf|openjd|none", .kind = OPT_ENUM, .offset = FIELD(progress),
     .words = WORDS({"auto", PROGRESS_AUTO}, {"plain", PROGRESS_PLAIN}, {"alf", PROGRESS_ALF}, {"openjd", PROGRESS_OPENJD}, {"none", PROGRESS_NONE}),
     .fallback = "auto",
     .help = "How progress is told: auto is a bar at a terminal and percent lines elsewhere, alf prints ALF_PROGRESS for Tractor, openjd prints openjd_progress, openjd_status and openjd_fail for Open Job Description."},
    {.group = GROUP_RUN, .name = "report", .argument = "FILE.json", .kind = OPT_PATH, .offset = FIELD(report),
     .help = "Also write what was concluded, what ran, why the rest did not, and the times."},
    {.group = GROUP_RUN, .name = "device", .argument = "N", .kind = OPT_INT, .offset = FIELD(device), .min = 0, .max = 255,
     .fallback = "the first usable one", .help = "EGL device to run on, a number from --list-devices."},
    {.group = GROUP_RUN, .name = "list-devices", .kind = OPT_FLAG, .offset = FIELD(list_devices),
     .help = "List the EGL devices and exit."},
    {.group = GROUP_RUN, .name = "threads", .argument = "N", .kind = OPT_INT, .offset = FIELD(threads), .min = 1, .max = 1024,
     .fallback = "the CPUs this process may use", .help = "Threads for reading, writing and preparing. The result does not depend on it."},
    {.group = GROUP_RUN, .name = "verbose", .letter = 'v', .kind = OPT_FLAG, .offset = FIELD(verbose),
     .help = "Say what was concluded from the input and what ran."},
    {.group = GROUP_RUN, .name = "quiet", .letter = 'q', .kind = OPT_FLAG, .offset = FIELD(quiet),
     .help = "Say nothing but errors."},
    {.group = GROUP_RUN, .name = "help", .letter = 'h', .kind = OPT_FLAG, .offset = FIELD(help), .help = "Print this list and exit."},
    {.group = GROUP_RUN, .name = "version", .kind = OPT_FLAG, .offset = FIELD(version), .help = "Print the version and exit."},
};
// clang-format on

const int option_row_count = (int)(sizeof option_rows / sizeof *option_rows);

const char *option_group_title(option_group g)
{
    static const char *const titles[GROUP_COUNT] = {
        [GROUP_OUTPUT] = "Output",
        [GROUP_ESTIMATOR] = "Estimator",
        [GROUP_BOUNCE] = "Bounce",
        [GROUP_ENVIRONMENT] = "Environment",
        [GROUP_COMPOSITE] = "Composite",
        [GROUP_CHANNELS] = "Input channels (found by name and measurement)",
        [GROUP_CAMERA] = "Camera (found from the position pass)",
        [GROUP_RUN] = "Run",
    };
    return titles[g];
}
