#include "cli/options_table.h"

#include <math.h>
#include <string.h>

#include "cli/frames.h"
#include "cli/options.h"

#define FIELD(name) offsetof(options, name)
// clang-format off
#define WORDS(...) (const option_word[]){__VA_ARGS__, {NULL, 0}}
// clang-format on

// gbuffer/resolve.h's roles, which this room may not include; tests/unit/test_cli_parse.c holds both against each other.
enum { POSITION, NORMAL, DEPTH, ALBEDO, BEAUTY, ALPHA, ROUGHNESS, METALLIC, EMISSION };

// OPT_ENUM writes an int.
_Static_assert(sizeof(compose_mode) == sizeof(int) && sizeof(radius_unit) == sizeof(int) && sizeof(progress_form) == sizeof(int),
               "enums are as wide as int");

// clang-format off
const option_row option_rows[] = {
    {.group = GROUP_OUTPUT, .name = "output", .letter = 'o', .argument = "FILE", .kind = OPT_PATH, .offset = FIELD(output),
     .help = "The EXR file to write. It is written whole or not at all. Neither it nor the preview or the report may be a file that is read, nor one another. A link is followed; a name that ends as another image format (.png) is refused."},
    {.group = GROUP_OUTPUT, .name = "layers", .argument = "LIST", .kind = OPT_TEXT, .offset = FIELD(layers), .pixels = true,
     .fallback = "occlusion,radiance,indirect,composite",
     .help = "Layers to write, separated by commas. A layer named here that cannot be made is an error; a default one is left out with a warning."},
    {.group = GROUP_OUTPUT, .name = "keep", .kind = OPT_SWITCH, .offset = FIELD(keep_none),
     .words = WORDS({"all", 0}, {"none", 1}), .bytes = true, .fallback = "all",
     .help = "Whether the channels of the input are passed through, untouched."},
    {.group = GROUP_OUTPUT, .name = "layout", .kind = OPT_SWITCH, .offset = FIELD(multipart),
     .words = WORDS({"single", 0}, {"multipart", 1}), .bytes = true, .fallback = "single",
     .help = "With multipart the input is copied without decoding and the new layers go into a second part, named ssdo: faster, but read by fewer programs."},
    {.group = GROUP_OUTPUT, .name = "main", .kind = OPT_SWITCH, .offset = FIELD(main_composite),
     .words = WORDS({"input", 0}, {"composite", 1}), .pixels = true, .fallback = "input",
     .help = "What the nameless R, G, B and A are, which is all that simple viewers show: the input's, if it has them, or a second copy of the composite in their place."},
    {.group = GROUP_OUTPUT, .name = "prefix", .argument = "P", .kind = OPT_TEXT, .offset = FIELD(prefix), .may_be_empty = true,
     .bytes = true,
     .help = "Text put before the names of the new layers, for inputs that already have layers of those names."},
    {.group = GROUP_OUTPUT, .name = "compression", .kind = OPT_ENUM,
     .offset = FIELD(compression), .words = WORDS({"none", COMPRESS_NONE}, {"rle", COMPRESS_RLE}, {"zips", COMPRESS_ZIPS}, {"zip", COMPRESS_ZIP}, {"piz", COMPRESS_PIZ}),
     .bytes = true, .fallback = "as the input, zip where that is none of these", .help = "Compression of the output."},
    {.group = GROUP_OUTPUT, .name = "verify", .kind = OPT_FLAG, .offset = FIELD(verify),
     .help = "Read the written file again, and the input, and compare every channel and attribute that passes through, bit by bit, before the file takes its name. If anything differs the exit status is 4 and no output is kept."},
    {.group = GROUP_OUTPUT, .name = "float", .kind = OPT_FLAG, .offset = FIELD(output_float), .pixels = true,
     .help = "Write the new layers as 32-bit float instead of half."},

    {.group = GROUP_ESTIMATOR, .name = "method", .argument = "NAME", .kind = OPT_TEXT, .offset = FIELD(method), .pixels = true,
     .fallback = "arc", .help = "How visibility is estimated; the manual has a table of what each weighs and cannot see."},
    {.group = GROUP_ESTIMATOR, .name = "preset", .kind = OPT_ENUM, .offset = FIELD(preset),
     .words = WORDS({"scene", PRESET_SCENE}, {"closeup", PRESET_CLOSEUP}), // not recorded: its values are
     .help = "A set of values for options that are not given: \"scene\" is alchemy with radius 0.05, scale 2 and contrast 3, for a room in metres; \"closeup\" is alchemy with radius 0.08, scale 1.7 and contrast 2.2."},
    {.group = GROUP_ESTIMATOR, .name = "radius", .argument = "R|Npx|auto", .kind = OPT_RADIUS, .offset = FIELD(radius),
     .words = WORDS({"auto", 0}), .pixels = true, .fallback = "auto",
     .help = "Reach of the occlusion in scene units, or in pixels with px. With auto it is measured from the visible surfaces."},
    {.group = GROUP_ESTIMATOR, .name = "quality", .kind = OPT_ENUM, .offset = FIELD(quality),
     .words = WORDS({"draft", -1}, {"standard", 0}, {"high", 1}), .pixels = true, .fallback = "standard",
     .help = "The number of samples: a quarter of the method's own and these at half resolution, as many, or four times as many. --samples and --resolution prevail."},
    {.group = GROUP_ESTIMATOR, .name = "samples", .argument = "N", .kind = OPT_INT, .offset = FIELD(samples), .min = 1,
     .max = 65536, .pixels = true, .fallback = "by --quality",
     .help = "Samples per pixel. For arc, gtao and bitmask these are slices times two sides times steps: 1 x 2 x 8 for 16, 2 x 2 x 16 for 64, 16 x 2 x 32 for 1024."},
    {.group = GROUP_ESTIMATOR, .name = "error", .argument = "E", .kind = OPT_REAL, .offset = FIELD(error), .min = 0, .max = 1,
     .open = true, .pixels = true, .fallback = "a fixed number of samples",
     .help = "For arc, gtao and bitmask: sample in rounds, each tile of 64 x 64 pixels until the estimated standard error of its occlusion after the blur is below E, or until a further round would take more than --samples (2048 if not given). Radiance, bent and the bounce of arc follow with as many slices, at full resolution and whatever --quality says. The layer error holds the estimate, which is before --scale, --contrast and --proxies. What 32 steps a side miss (rms .003 on the samples) is not in it."},
    {.group = GROUP_ESTIMATOR, .name = "thickness", .argument = "auto|inf|F", .kind = OPT_REAL, .offset = FIELD(thickness),
     .words = WORDS({"auto", -1}, {"inf", INFINITY}), .min = 0, .max = INFINITY, .open = true, .pixels = true, .fallback = "auto",
     .help = "How far a surface is taken to reach behind what the camera sees, as a share of the radius."},
    {.group = GROUP_ESTIMATOR, .name = "planes", .kind = OPT_SWITCH, .offset = FIELD(no_planes),
     .words = WORDS({"on", 0}, {"off", 1}), .pixels = true, .fallback = "on",
     .help = "Whether arc lets the large planes of the picture stand in for their hidden and off-screen parts, and one uneven ground in light and bounce; never in shadows of suns."},
    {.group = GROUP_ESTIMATOR, .name = "outside", .argument = "auto|open|closed|F", .kind = OPT_REAL, .offset = FIELD(outside),
     .words = WORDS({"auto", -1}, {"open", 1}, {"closed", OUTSIDE_COVERED}), .min = 0, .max = 1, .pixels = true, .fallback = "auto",
     .help = "Share of the unseen directions outside the frame through which arc's radiance and suns come: open is 1, closed is 0.08, as in a room whose windows are not in the picture, and 0 lets nothing in. Directions that pass through an opening behind which the picture shows the background are open whatever is said here. What is closed sends the picture's mean light into the bounce. Auto is open, unless the picture shows a roof over the camera: surfaces that face down, above the eye, not seen to end under the sky; it needs --env and to know which way is up, and is decided once for a sequence. Occlusion does not change."},
    {.group = GROUP_ESTIMATOR, .name = "angle-bias", .argument = "DEG", .kind = OPT_REAL, .offset = FIELD(angle_bias), .min = 0,
     .max = 90, .pixels = true, .fallback = "0",
     .help = "For hbao: angle above the tangent plane below which nothing occludes. 10 to 30 hides the facets of coarse models, and all shallow occlusion with them."},
    {.group = GROUP_ESTIMATOR, .name = "sh-bands", .kind = OPT_ENUM, .offset = FIELD(sh_bands),
     .words = WORDS({"2", 2}, {"3", 3}), .pixels = true, .fallback = "2",
     .help = "For s3ho: highest band of the spherical harmonics, 9 or 16 coefficients. With 3 there is a layer sh_3 too."},
    {.group = GROUP_ESTIMATOR, .name = "sh-sigma", .argument = "S", .kind = OPT_REAL, .offset = FIELD(sh_sigma), .min = 0, .max = 4,
     .pixels = true, .fallback = "0",
     .help = "For s3ho: width in radians of a Gaussian that smooths the visibility over directions. 0.2 to 0.5 takes away ringing under a small bright light, and direction with it."},
    {.group = GROUP_ESTIMATOR, .name = "from-sh", .kind = OPT_FLAG, .offset = FIELD(from_sh), .pixels = true,
     .help = "Relight: take the layers sh_0, sh_1 and sh_2 that an earlier run with --method s3ho left in the input, instead of estimating visibility. The input must still hold its G-buffer."},
    {.group = GROUP_ESTIMATOR, .name = "resolution", .kind = OPT_ENUM, .offset = FIELD(half),
     .words = WORDS({"full", 0}, {"half", 1}), .pixels = true, .fallback = "half with --quality draft, else full",
     .help = "With half, method and bounce run on a quarter of the pixels and their layers are brought back along surfaces: about a quarter of the time, soft detail of one pixel lost. Ignored with --from-sh."},
    {.group = GROUP_ESTIMATOR, .name = "blur", .argument = "N|none", .kind = OPT_INT, .offset = FIELD(blur),
     .words = WORDS({"none", 0}), .min = 0, .max = 64, .pixels = true, .fallback = "the method's own",
     .help = "Radius in pixels of the edge-aware blur that removes sampling noise."},
    {.group = GROUP_ESTIMATOR, .name = "scale", .argument = "S", .kind = OPT_REAL, .offset = FIELD(scale), .min = 0,
     .max = INFINITY, .pixels = true, .fallback = "1",
     .help = "Multiplies the blocked share of the hemisphere. With anything but 1 the occlusion layer no longer keeps its contract."},
    {.group = GROUP_ESTIMATOR, .name = "contrast", .argument = "K", .kind = OPT_REAL, .offset = FIELD(contrast), .min = 0,
     .max = INFINITY, .pixels = true, .fallback = "1",
     .help = "Exponent of the occlusion, applied after the blur. With anything but 1 the occlusion layer no longer keeps its contract."},
    {.group = GROUP_ESTIMATOR, .name = "mesh", .argument = "FILE.obj", .kind = OPT_PATH, .offset = FIELD(mesh), .pixels = true,
     .help = "For raytrace: the scene's surfaces, a Wavefront OBJ mesh in world space and in the unit of the position pass. Vertex colours, or Kd in its .mtl, are the albedo of the bounce."},
    {.group = GROUP_ESTIMATOR, .name = "mesh-axes", .kind = OPT_ENUM, .offset = FIELD(mesh_axes),
     .words = WORDS({"auto", -1}, {"same", 0}, {"y-up", 1}, {"z-up", 2}), .pixels = true, .fallback = "auto",
     .help = "Axes of the mesh: those of the position pass, or turned so that its y (z) is up where the position pass has z (y) up. With auto the one is taken that puts most of the picture's points onto the mesh."},
    {.group = GROUP_ESTIMATOR, .name = "trace", .kind = OPT_ENUM, .offset = FIELD(trace),
     .words = WORDS({"auto", 0}, {"embree", 1}, {"gpu", 2}), .fallback = "auto",
     .help = "What traces the rays of raytrace: Embree on the CPU, or a grid in a shader. Both give the same picture; auto is Embree where its module is installed."},
    {.group = GROUP_ESTIMATOR, .name = "proxies", .argument = "FILE.json", .kind = OPT_PATH, .offset = FIELD(proxies), .pixels = true,
     .help = "Spheres in world space that stand for occluders the camera does not see; with a frame place (####) a file for each frame of a sequence."},

    {.group = GROUP_BOUNCE, .name = "bounce", .argument = "none|NAME", .kind = OPT_TEXT, .offset = FIELD(bounce),
     .pixels = true, .fallback = "the method's own where it has one",
     .help = "How one diffuse bounce is estimated: arc from the blocked sectors of its slices, at any distance, ssdo from the blockers within the radius, vpl from lights chosen all over the picture, at any distance. It needs an albedo."},
    {.group = GROUP_BOUNCE, .name = "bounce-strength", .argument = "S", .kind = OPT_REAL, .offset = FIELD(bounce_strength),
     .min = 0, .max = INFINITY, .pixels = true, .fallback = "1", .help = "Multiplies the bounce; 1 is the physical amount."},
    {.group = GROUP_BOUNCE, .name = "vpl-count", .argument = "N", .kind = OPT_INT, .offset = FIELD(vpl_count), .min = 1, .max = 4096,
     .pixels = true, .fallback = "512", .help = "Lights of --bounce vpl. Few of them show as blotches near the surfaces that send."},

    {.group = GROUP_ENVIRONMENT, .name = "env", .argument = "FILE", .kind = OPT_PATH, .offset = FIELD(env), .pixels = true,
     .fallback = "white, of radiance 1",
     .help = "Lat-long environment map, linear: EXR, or any format OpenImageIO reads."},
    {.group = GROUP_ENVIRONMENT, .name = "env-up", .kind = OPT_ENUM, .offset = FIELD(env_up),
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
    {.group = GROUP_ENVIRONMENT, .name = "env-frame", .kind = OPT_ENUM, .offset = FIELD(env_frame),
     .words = WORDS({"world", FRAME_WORLD}, {"camera", FRAME_CAMERA}), .pixels = true, .fallback = "world",
     .help = "What the environment is fixed to. The world needs a camera whose rotation is known."},
    {.group = GROUP_ENVIRONMENT, .name = "env-lod", .argument = "L|auto", .kind = OPT_REAL, .offset = FIELD(env_lod),
     .words = WORDS({"auto", -1}), .min = 0, .max = 16, .pixels = true, .fallback = "auto",
     .help = "Mip level at which directions look the environment up, 0 being the sharpest. With auto it matches the solid angle of a sample."},

    {.group = GROUP_COMPOSITE, .name = "mode", .kind = OPT_ENUM, .offset = FIELD(mode),
     .words = WORDS({"radiance", MODE_RADIANCE}, {"visibility", MODE_VISIBILITY}), .pixels = true, .fallback = "radiance",
     .help = "Light of the composite with an environment: the radiance layer, or the unoccluded irradiance times the visibility."},
    {.group = GROUP_COMPOSITE, .name = "amount", .argument = "F", .kind = OPT_REAL, .offset = FIELD(amount), .min = 0, .max = 1,
     .pixels = true, .fallback = "1",
     .help = "Share of the occlusion multiplied onto a beauty pass. 0 without a bounce gives the beauty back bit for bit."},

    {.group = GROUP_COMPOSITE, .name = "multiply", .kind = OPT_ENUM, .offset = FIELD(multiply),
     .words = WORDS({"diffuse", MULTIPLY_DIFFUSE}, {"all", MULTIPLY_ALL}), .pixels = true, .fallback = "diffuse",
     .help = "What the occlusion is multiplied onto: diffuse light, or specular light and all of a beauty pass too."},
    {.group = GROUP_COMPOSITE, .name = "depthmask-strength", .argument = "S", .kind = OPT_REAL, .offset = FIELD(depthmask_strength),
     .min = 0, .max = INFINITY, .pixels = true, .fallback = "0",
     .help = "Darkens the composite behind the edges of nearer objects: it is multiplied by 1 + S times the depthmask layer, at least 0."},

    {.group = GROUP_CHANNELS, .name = "position", .argument = "C", .kind = OPT_TEXT, .offset = FIELD(role_names[POSITION]),
     .pixels = true, .help = "Layer or channels of the position pass, as --explain prints them: a layer, PART.LAYER, or three channels with commas between. Here and below, of a stereo file: of the view that is being filtered. A name that several channels have is refused."},
    {.group = GROUP_CHANNELS, .name = "normal", .argument = "C", .kind = OPT_TEXT, .offset = FIELD(role_names[NORMAL]),
     .pixels = true, .help = "Layer or channels of the normal pass."},
    {.group = GROUP_CHANNELS, .name = "depth", .argument = "C", .kind = OPT_TEXT, .offset = FIELD(role_names[DEPTH]),
     .pixels = true, .help = "Channel of the depth pass, as --explain prints it: CHANNEL, or PART.CHANNEL in a file of several parts; or its layer."},
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
    {.group = GROUP_CHANNELS, .name = "depth-kind", .kind = OPT_ENUM, .offset = FIELD(depth_kind),
     .words = depth_kind_words,
     .pixels = true, .fallback = "measured, or by renderer",
     .help = "What depth is: the distance along the camera's axis or along the ray of the pixel; 1 / z with 0 behind everything; 0..1 from near to far, or from far to near; the hyperbolic 0..1 of a z-buffer, or of a reversed one. The last four need --depth-range."},
    {.group = GROUP_CHANNELS, .name = "depth-range", .argument = "NEAR FAR", .kind = OPT_RANGE, .offset = FIELD(depth_range),
     .pixels = true, .fallback = "the header's",
     .help = "Distances in scene units that a depth of 0..1 runs between; also as NEAR,FAR."},
    {.group = GROUP_CHANNELS, .name = "normal-space", .kind = OPT_ENUM, .offset = FIELD(normal_space),
     .words = pass_space_words, .pixels = true, .fallback = "measured, or by renderer",
     .help = "The space of the normals. With world and no camera known, the normals also say how the camera is turned, which --env needs."},
    {.group = GROUP_CHANNELS, .name = "normal-encoding", .kind = OPT_ENUM, .offset = FIELD(normal_encoding),
     .words = normal_encoding_words,
     .pixels = true, .fallback = "measured, or by renderer",
     .help = "How normals are stored: as they are, as (n + 1) / 2, or that through a display curve of gamma 2.2 or sRGB (unorm-gamma, unorm-srgb) or through its inverse (unorm-degamma, unorm-desrgb)."},
    {.group = GROUP_CHANNELS, .name = "albedo-colorspace", .argument = "C", .kind = OPT_TEXT, .offset = FIELD(albedo_colorspace),
     .pixels = true, .fallback = "linear already",
     .help = "Colour space of the albedo, converted to the scene_linear role of an OpenColorIO config (--ocio, $OCIO) for the computation; the channels pass through as they are. Data passes are never converted."},
    {.group = GROUP_CHANNELS, .name = "albedo-kind", .kind = OPT_ENUM, .offset = FIELD(albedo_kind),
     .words = albedo_kind_words, .pixels = true, .fallback = "by renderer",
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
     .help = "Also write a contact sheet of the layers, for the eye: an 8-bit picture with labels, the radius as a bar and a checkerboard where there is no surface."},
    {.group = GROUP_RUN, .name = "preview-every", .argument = "N", .kind = OPT_INT, .offset = FIELD(preview_every), .min = 1,
     .max = FRAMES_MAX, .fallback = "1",
     .help = "For a sequence: write a preview of the frames whose number is a multiple of N, the same ones in every task of a farm. The name of the preview then holds a place for the frame."},
    {.group = GROUP_RUN, .name = "display", .argument = "NAME", .kind = OPT_TEXT, .offset = FIELD(display),
     .fallback = "the OpenColorIO config's default, sRGB without a config",
     .help = "Display of the OpenColorIO config (--ocio, $OCIO) that previews are made for."},
    {.group = GROUP_RUN, .name = "view", .argument = "NAME", .kind = OPT_TEXT, .offset = FIELD(view),
     .fallback = "the display's default", .help = "View of the display for previews."},
    {.group = GROUP_RUN, .name = "frames", .argument = "RANGE", .kind = OPT_TEXT, .offset = FIELD(frames),
     .fallback = "every existing file of the input pattern",
     .help = "Frames of a sequence: 1-100, 1-100x2, 1-10:4, 1,5,7-9. Input and output then hold a place for the frame: ####, %04d or $F4. A file of exactly such a name (shot #1.exr) is read where no file fits the pattern, or the output has no such place."},
    {.group = GROUP_RUN, .name = "missing", .kind = OPT_SWITCH, .offset = FIELD(missing_skip),
     .words = WORDS({"error", 0}, {"skip", 1}), .fallback = "error", .help = "What an input frame that does not exist is."},
    {.group = GROUP_RUN, .name = "skip-existing", .kind = OPT_FLAG, .offset = FIELD(skip_existing),
     .words = WORDS({"exact", 1}), .word_offset = FIELD(skip_exact),
     .help = "Leave out frames that are done: output, preview and report are there and whole, and the output's record says that they were made with the same settings, shaders and inputs. Of input files above 4 MiB their headers and samples of the rest are compared, with --skip-existing=exact all of them."},
    {.group = GROUP_RUN, .name = "keep-going", .kind = OPT_FLAG, .offset = FIELD(keep_going),
     .help = "Go on with the next frame when one fails. The exit status is 1 in the end, and the frames that failed are listed."},
    {.group = GROUP_RUN, .name = "radius-from", .argument = "FRAME", .kind = OPT_INT, .offset = FIELD(radius_from),
     .min = -1e8, .max = 1e8, .pixels = true, .fallback = "the lowest-numbered existing file",
     .help = "Frame of the sequence on which the automatic radius is measured, so that all frames have the same. Where the lowest frame is damaged, --keep-going takes the next that is not; one that the system refuses to read stops the run, for another machine may be allowed to."},
    {.group = GROUP_RUN, .name = "progress", .kind = OPT_ENUM, .offset = FIELD(progress),
     .words = WORDS({"auto", PROGRESS_AUTO}, {"plain", PROGRESS_PLAIN}, {"alf", PROGRESS_ALF}, {"openjd", PROGRESS_OPENJD}, {"none", PROGRESS_NONE}),
     .fallback = "auto",
     .help = "How progress is told: auto is a bar at a terminal and percent lines elsewhere, alf prints ALF_PROGRESS for Tractor, openjd prints openjd_progress, openjd_status and openjd_fail for Open Job Description."},
    {.group = GROUP_RUN, .name = "report", .argument = "FILE.json", .kind = OPT_PATH, .offset = FIELD(report),
     .help = "Also write what was concluded, what ran, why the rest did not, and the times. For a sequence, a file a frame if the name holds a place for it, else one file about all of them."},
    {.group = GROUP_RUN, .name = "device", .argument = "N", .kind = OPT_INT, .offset = FIELD(device), .min = 0, .max = 255,
     .fallback = "the GPU that CUDA_VISIBLE_DEVICES names, else the first that works, hardware before software",
     .help = "EGL device to run on, a number from --list-devices. Where a software device was taken, -v and the report say why."},
    {.group = GROUP_RUN, .name = "require-gpu", .kind = OPT_FLAG, .offset = FIELD(require_gpu),
     .help = "Run on hardware or not at all: where only a software device is to be had, end with exit code 5 and say why."},
    {.group = GROUP_RUN, .name = "gpu-debug", .kind = OPT_FLAG, .offset = FIELD(gpu_debug),
     .help = "Open a debug context and print what the driver says, with the pass and the shader's file and line. Objects have names and passes are groups in GPU debuggers. Slower."},
    {.group = GROUP_RUN, .name = "list-devices", .kind = OPT_FLAG, .offset = FIELD(list_devices),
     .help = "List the EGL devices and exit; where none is hardware, with the likely reason."},
    {.group = GROUP_RUN, .name = "threads", .argument = "N", .kind = OPT_INT, .offset = FIELD(threads), .min = 1, .max = 1024,
     .fallback = "the CPUs this process may use", .help = "Threads for reading, writing and preparing. The result does not depend on it."},
    {.group = GROUP_RUN, .name = "explain", .kind = OPT_FLAG, .offset = FIELD(explain),
     .words = WORDS({"json", 1}), .word_offset = FIELD(explain_json),
     .help = "Print which renderer's conventions the input follows, which channel is taken for what and on what evidence, and what would run; filter and write nothing. Of a sequence, the first frame is explained. With --explain=json the same as JSON, with every reading that was tried and how well it fits."},
    {.group = GROUP_RUN, .name = "strict", .kind = OPT_FLAG, .offset = FIELD(strict),
     .help = "Fail with exit status 7, and write nothing, where it is doubtful what positions, normals or depth mean, instead of warning."},
    {.group = GROUP_RUN, .name = "verbose", .letter = 'v', .kind = OPT_FLAG, .offset = FIELD(verbose),
     .help = "Say what was concluded from the input and what ran."},
    {.group = GROUP_RUN, .name = "quiet", .letter = 'q', .kind = OPT_FLAG, .offset = FIELD(quiet),
     .help = "Say nothing but errors."},
    {.group = GROUP_RUN, .name = "help", .letter = 'h', .kind = OPT_FLAG, .offset = FIELD(help), .help = "Print this list and exit."},
    {.group = GROUP_RUN, .name = "completion", .kind = OPT_ENUM, .offset = FIELD(completion),
     .words = WORDS({"bash", COMPLETE_BASH}, {"zsh", COMPLETE_ZSH}, {"methods.1", COMPLETE_METHODS_MAN}, {"methods.md", COMPLETE_METHODS_MARKDOWN}), .hidden = true,
     .help = "Print the shell's completion script, or the table of methods for the manual or the README, and exit."},
    {.group = GROUP_RUN, .name = "version", .kind = OPT_FLAG, .offset = FIELD(version), .help = "Print the version and exit."},
};
// clang-format on

const option_values *option_values_of(const option_values *v, const char *option)
{
    while (v && v->option && strcmp(v->option, option) != 0) v++;
    return v && v->option ? v : NULL;
}

const char *option_argument(const option_row *row, char *buf, size_t size)
{
    size_t used = 0;
    if (row->argument) return row->argument;
    buf[0] = '\0';
    for (const option_word *w = row->words; row->kind != OPT_FLAG && w && w->text && used < size; w++)
        used += (size_t)snprintf(buf + used, size - used, "%s%s", used ? "|" : "", w->text);
    return buf;
}

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
