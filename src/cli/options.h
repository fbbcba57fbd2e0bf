// The command line: one table of options that makes the parser, --help, the man page's option list and the header record.
#ifndef SSDO_CLI_OPTIONS_H
#define SSDO_CLI_OPTIONS_H

#include <stdbool.h>
#include <stdio.h>

#include "base/digest.h"
#include "base/error.h"
#include "base/words.h"

enum { OPT_MAX_INPUTS = 32 };

typedef enum radius_unit { RADIUS_AUTO, RADIUS_WORLD, RADIUS_PIXELS } radius_unit;
typedef enum progress_form {
    PROGRESS_AUTO,
    PROGRESS_PLAIN,
    PROGRESS_ALF,
    PROGRESS_OPENJD,
    PROGRESS_NONE,
    PROGRESS_BAR // what auto becomes at a terminal; no word of the option
} progress_form;
typedef enum compose_mode { MODE_RADIANCE, MODE_VISIBILITY } compose_mode;
typedef enum environment_frame { FRAME_WORLD, FRAME_CAMERA } environment_frame; // what the environment is fixed to
typedef enum multiply_onto { MULTIPLY_DIFFUSE, MULTIPLY_ALL } multiply_onto;
typedef enum surround_source { SURROUND_NONE, SURROUND_SHOT } surround_source; // of further G-buffers, beside --also
typedef enum preset { PRESET_NONE, PRESET_SCENE, PRESET_CLOSEUP } preset;
typedef enum output_compression {
    COMPRESS_AS_INPUT,
    COMPRESS_NONE,
    COMPRESS_RLE,
    COMPRESS_ZIPS,
    COMPRESS_ZIP,
    COMPRESS_PIZ
} output_compression;
typedef enum completion_part {
    COMPLETE_NOTHING,
    COMPLETE_BASH,
    COMPLETE_ZSH,
    COMPLETE_METHODS_MAN,
    COMPLETE_METHODS_MARKDOWN
} completion_part;

// Open share of the unseen outside of a covered place: light comes in through windows and doors that the frame does not show. In
// eight covered scenes (tests/bench/RESULTS.md, Covered places) an outside that is all open is 4.8 to 36 times too bright.
#define OUTSIDE_COVERED 0.08

// The files of an option that may be given several times.
enum { OPT_MOST_PATHS = 16 };
typedef struct path_list {
    const char *path[OPT_MOST_PATHS];
    int count;
} path_list;

// What the user asked for. Strings point into argv or to constants; NULL means "not given". Defaults: options_defaults().
// At which size what is estimated.
typedef enum estimate_resolution {
    RESOLUTION_BY_QUALITY = -1,
    RESOLUTION_FULL,
    RESOLUTION_LIGHT, // light and bounce at half the size
    RESOLUTION_HALF,
} estimate_resolution;

typedef struct options {
    const char *inputs[OPT_MAX_INPUTS];
    int input_count;
    bool literal; // not an option: the inputs are files of exactly these names (cli/names.h)
    bool hosted;  // not an option: the process is another program's, whose environment variables stay as they are
    const char *output;

    const char *layers; // NULL = the default four
    const char *method;
    radius_unit radius_unit;
    double radius;
    int quality;       // -1 draft, 0 standard, 1 high: of the method's own number of samples
    bool no_planes;    // --planes off
    double outside;    // open share of the unseen outside, 0 .. 1; < 0 auto
    int samples;       // 0 = the method's default at that quality
    double error;      // > 0: sample until the standard error is below it, `samples` at most
    double thickness;  // share of the radius; < 0 auto, INFINITY for inf
    double angle_bias; // degrees
    int sh_bands;      // highest l
    double sh_sigma;   // radians
    bool from_sh;
    int blur; // radius in pixels; 0 none; -1 the method's default
    double scale, contrast;
    estimate_resolution resolution;

    const char *mesh; // of --method raytrace
    int trace;        // passes/trace.h's backend: 0 auto, 1 embree, 2 gpu
    int mesh_axes;    // -1 auto, 0 same, 1 y-up, 2 z-up

    const char *bounce; // none, or a name of passes/method.h; NULL = the method's own where it has one
    double bounce_strength;
    int vpl_count;
    const char *beauty_env; // that lit the beauty
    double beauty_env_rotate, beauty_env_scale;
    path_list also; // further G-buffers
    surround_source surround;
    const char *proxies; // spheres the camera does not see; may be a pattern

    const char *env;
    int env_up;        // 0 by renderer, 'y', 'z'
    double env_rotate; // degrees
    double env_scale;
    const char *env_colorspace, *albedo_colorspace, *ocio;
    environment_frame env_frame;
    double env_lod; // < 0 auto
    compose_mode mode;
    double amount;
    double depthmask_strength;
    multiply_onto multiply;
    preset preset;

    const char *role_names[16]; // --position ... --emission, indexed by gbuffer/resolve.h's role
    const char *view_layer;
    depth_kind depth_kind; // of this and the next three auto or unknown: to be found
    albedo_kind albedo_kind;
    pass_space normal_space;
    normal_encoding normal_encoding;
    double depth_range[2]; // near, far; far 0 = not given
    double fov, ortho;     // 0 = not given
    const char *camera_file;

    bool keep_none;
    bool multipart;      // --layout: the input's parts as they are stored, ours in a part of their own
    bool main_composite; // --main: R G B are the composite
    const char *prefix;  // "" by default; put before our layer names
    output_compression compression;
    bool output_float;

    const char *frames; // --frames; NULL = every existing file of the pattern
    bool missing_skip, keep_going;
    bool skip_existing, skip_exact; // --skip-existing, --skip-existing=exact
    int radius_from;                // frame that the automatic radius of a sequence is measured on; INT_MIN = the lowest existing

    const char *preview, *report;
    const char *display, *view; // of the config, for previews; NULL = its defaults
    int preview_every;          // sequences: frames whose number is a multiple of it have a preview
    progress_form progress;
    int device; // -1 = first usable
    bool list_devices, require_gpu, gpu_debug;
    int threads;                // 0 = default
    bool explain, explain_json; // --explain, --explain=json
    bool strict, verify;
    bool verbose, quiet, help, version;
    completion_part completion; // to be printed instead
} options;

// In parse.c.
void options_defaults(options *o);

// Fills *o from argv. ERR_USAGE names the offending option and how to get help. Numbers are read in the C locale.
bool options_parse(int argc, char **argv, options *o, error *e);

// In options_print.c. The OPTIONS section of the man page in mdoc(7)/man(7) source; man/ssdo-filter.1 holds its output between
// markers, a test compares.
void options_print_man(FILE *to);

// In options_record.c. The settings that change pixels, as they would be typed ("--method ssdo --samples 64"), options at their
// default left out: the header attribute ssdo/args. Before them, as a shell takes them, the environment variables that can change
// pixels (base/knobs.h). No paths but base names, no frames, threads, device, host or time. To be freed; NULL with ERR_MEMORY.
char *options_record(const options *o, error *e);

// Adds every setting that decides the bytes of the output, by name and value: those of the record, and how the file is laid out.
// What a path names is no part of it.
bool options_digest(const options *o, digester *d, error *e);

#endif
