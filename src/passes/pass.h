// What the passes share: the frame on the GPU, the settings, the layers as they come to be.
//
// A pass is one function that reads some images of the context and fills others. Images it needs are made by pass_make_image
// (once a frame, by its image_id). Passes run in the order of pipeline/plan.c; nothing here decides what runs.
#ifndef SSDO_PASSES_PASS_H
#define SSDO_PASSES_PASS_H

#include "base/error.h"
#include "base/log.h"
#include "gbuffer/gbuffer.h"
#include "gbuffer/half_size.h"
#include "gbuffer/world_view.h"
#include "gpu/gpu.h"
#include "light/environment.h"
#include "light/proxies.h"
#include "light/sun.h"
#include "passes/hidden.h"
#include "passes/images.h"
#include "passes/openness.h"
#include "passes/planes.h"
#include "passes/variants.h"

enum { PASS_MAX_TIMINGS = 48, PASS_MAX_UPLOADS = 12 };

typedef struct pass_timing {
    const char *name;
    double wall_ms, cpu_ms;
    int tiles; // dispatched; 0 for what is no pass
} pass_timing;

// One picture that was sent to the GPU for a frame.
typedef struct pass_upload {
    const char *name; // "depth", "normal", "albedo", ...
    size_t bytes;
} pass_upload;

// At which size a frame is estimated.
typedef enum estimate_size {
    SIZE_FULL,
    SIZE_LIGHT, // light and bounce on a frame of half the size, if the method can make them apart from occlusion
    SIZE_HALF,  // method and bounce on a frame of half the size
} estimate_size;

// Settings of one frame, all resolved: no "auto" is left.
typedef struct pass_settings {
    double radius;        // scene units
    double thickness;     // scene units; INFINITY allowed
    bool thickness_fixed; // asked for by the user: no method may find a better one
    int samples;
    double target_error; // > 0: sample in rounds until the standard error of the occlusion is below this
    int most_samples;    // limit for those rounds
    int blur;            // pixels, 0 none
    int sh_bands;        // s3ho: highest l, 2 (0 too) or 3
    double sh_sigma;     // s3ho: radians of the low-pass
    double angle_bias;   // hbao: degrees above the tangent where occlusion begins
    double scale, contrast;
    double env_level; // < 0: by solid angle
    double bounce_strength;
    int vpl_count;
    mat3 world_from_camera;   // to the world that the environment is fixed to
    mat3 upright_from_camera; // to the axes of `outside` (passes/openness.h),
    vec3 upright_eye;         // and the eye there
    int seed;
    openness outside;
    bool planes; // let large planes stand in for what the camera does not see
    estimate_size size;
    double amount;
    const char *mesh;          // raytrace: the scene's surfaces, an OBJ file; borrowed
    int trace;                 // trace_backend of passes/trace.h
    int mesh_axes;             // < 0 by trial, 0 the world's, 1 y up where the world has z up, 2 the other way round
    double depthmask_strength; // 0: the composite is left alone
    bool multiply_all;         // occlusion is multiplied onto everything, not onto diffuse light only
    bool visibility_mode;
    bool base_albedo;     // albedo is a base colour: metals have one
    bool averaged_albedo; // albedo, emission are stored multiplied by coverage
    int background;       // composite.comp's BACKGROUND
    bool relight;         // the composite is lit by us; otherwise it is the beauty, occluded
    bool bounce_in_composite;
} pass_settings;

// The environment without its suns, made by the first frame that needs it and kept for the batch.
typedef struct pass_sunless {
    bool ready;
    sun_set suns;
    double rest[9][3]; // radiance coefficients of what is left
    gpu_image map;     // id 0: there are no suns, the whole map serves
} pass_sunless;

// What further G-buffers show around their eyes, on the device: made by the first frame that looks there and kept for the batch
// (passes/surround_image.h).
typedef struct pass_surround {
    bool ready;
    mat3 map_from_world; // that the maps were made with
    int count;           // of maps, one below the other in each picture
    vec3 eye[MAX_FURTHER];
    double known[MAX_FURTHER]; // the share of all directions
    float *seen;               // of each map a coarse copy of its distances, for the choice; owned
    gpu_image shell, albedo;
    gpu_image light; // that what they show sends: id 0 until it is made
    double lit_open; // how open what they do not show was then
} pass_surround;

enum { ROUNDS_LEAST_SAMPLES = 64, ROUNDS_MOST_SAMPLES = 2048 }; // of the first round; of all where nobody says

// What --error has come to.
typedef struct adaptive_sampling {
    int count;           // rounds that were run; 0: none, the number of samples was given
    gpu_tiles tiles;     // of GPU_TILE pixels, whatever the passes' own
    unsigned char *last; // of each tile, index of its last round
    int above;           // tiles that ran out of samples
    int most_samples;    // that a pixel had
    double mean_samples; // a pixel of the occupied tiles
} adaptive_sampling;

typedef struct pass_context {
    // Given by the caller before pass_begin.
    gpu *g;
    log_t *log;
    bool timing; // measure: waits for the GPU after every pass
    int threads;
    const volatile int *stop; // borrowed, may be NULL: not zero once the frame will be dropped; then no further tile is begun
    pass_settings set;
    bool want_diffuse; // the composite pass also writes the diffuse layer
    // What the method should make beside occlusion; a step's own while it runs.
    bool want_bent;
    bool want_error;    // the standard error, after rounds
    bool want_indirect; // the method's own loop makes the bounce too, if it can
    bool want_radiance, want_visibility;
    struct pass_context *whole; // borrowed; of a smaller frame: the frame that its marches see, and
    int whole_side;             // how many of that frame's pixels a side one of this frame stands for
    const pixel_list *lone;     // borrowed, may be NULL: of SIZE_LIGHT's whole frame, the pixels the smaller does not show
    bool at_lone;               // light is made of those alone
    const gbuffer *gb;          // borrowed
    const environment *env;     // borrowed; NULL without light
    gpu_image environment;      // borrowed: its texture; id 0 for the white one
    const float *relight_sh[SH_IMAGES]; // --from-sh: 4 a pixel as in sh, borrowed; NULL: s3ho measures
    const world_view *views;            // borrowed: what further G-buffers show
    int view_count;
    gpu_image *further;        // borrowed, lives as long as the batch: further_make's
    const proxy_set *proxies;  // borrowed; NULL or empty: none
    pass_surround *surround;   // borrowed, lives as long as the batch
    pass_sunless *sunless;     // borrowed, lives as long as the batch
    struct trace_scene *trace; // the same; for raytrace

    int width, height;
    gpu_image image[IMAGE_COUNT]; // id 0: the frame has none, or its pass has not run

    bool suns_pending;           // radiance and visibility lack the suns of `sunless`: pass_suns adds them after the filter
    double hidden[HIDDEN_SH][3]; // of planes and environment, if hidden_found
    bool hidden_found;
    plane_set planes; // found by the pass that uses them
    adaptive_sampling adaptive;
    int maps[SURROUND_TRIES], map_count; // of the surround, that the frame's directions are looked up in

    GLuint frame_uniforms, params_uniforms;
    gpu_tiles tiles;
    pass_timing timings[PASS_MAX_TIMINGS];
    int timing_count;
    pass_upload uploads[PASS_MAX_UPLOADS];
    int upload_count;
} pass_context;

// Uploads what the G-buffer holds. On failure there is nothing to end.
bool pass_begin(pass_context *c, error *e);
void pass_end(pass_context *c);

// A context with all that the caller of pass_begin gave to `c`, for another G-buffer and other settings; not begun.
pass_context pass_like(const pass_context *c, const gbuffer *gb, const pass_settings *set);

// The times of `from` belong to `c`.
void pass_take_timings(pass_context *c, const pass_context *from);

// What the G-buffer holds of an image that it gives; NULL: nothing.
const float *pass_pixels(const gbuffer *gb, image_id id);

// The environment's texture, once per batch. The white environment has none: out->id stays 0.
bool pass_upload_environment(gpu *g, const environment *env, gpu_image *out, error *e);

// ---- running a shader

enum { PASS_MOST_READS = 12, PASS_MOST_WRITES = 9, PASS_MOST_BUFFERS = 8 };

// A picture or a buffer by its name in the shader. A NULL name ends a list. A list may hold names that the variant does not use.
// It is an error if a name that the variant uses is missing.
typedef struct pass_picture {
    const char *name;
    const gpu_image *image;
} pass_picture;
typedef struct pass_store {
    const char *name;
    const gpu_buffer *buffer;
} pass_store;

// One run of a shader program.
typedef struct pass_call {
    const char *program;             // shaders/<program>.comp
    const char *variant;             // words of passes/variants.h; NULL: none
    const char *label;               // in the report; NULL: the program's name. Lives as long as the context
    bool untimed;                    // the caller times it together with other runs
    const gpu_tiles *tiles;          // NULL: the frame's
    const struct pass_context *seen; // whose camera, depth and normal the shader has; NULL: the frame's
    bool everywhere;                 // tiles without a surface too
    bool exact;                      // never drawn: drawing may flush denormals
    int groups[2];                   // not 0: so many work groups instead of tiles,
    int range[2];                    // and what the shader's `tile` holds then: first item, end
    const gpu_image *environment;    // NULL: the frame's
    const void *params;              // of passes/params.h; NULL: none
    size_t params_size;
    pass_picture reads[PASS_MOST_READS + 1], writes[PASS_MOST_WRITES + 1]; // depth, normal and environment are always there
    pass_store buffers[PASS_MOST_BUFFERS + 1];
} pass_call;

// The two members of a parameter block.
#define PASS_PARAMS(block) .params = &(block), .params_size = sizeof(block)

// Runs the shader over the tiles. It is dispatched; or drawn, if the shader allows that and the device draws faster. Later calls
// see its result.
bool pass_run(pass_context *c, const pass_call *call, error *e);

// Runs a shader over a list of `count` items that one of its buffers holds, a thread for each; `tile` says which. The caller
// times it.
bool pass_run_list(pass_context *c, size_t count, pass_call call, error *e);

// Times a pass that runs several shaders: pass_clock_stop adds the time since pass_clock to the timings.
pass_timing pass_clock(const pass_context *c, const char *name);
void pass_clock_stop(pass_context *c, pass_timing since);

// Makes an image of the frame, of its size and its row's format, cleared to what is neutral. Nothing if it is there.
bool pass_make_image(pass_context *c, image_id id, error *e);
// The same for one that is a pass's own, cleared to `value` in every component; the pass frees it.
bool pass_make(pass_context *c, gpu_image *image, GLenum format, float value, error *e);

// Adds the images of `group` (IMAGE_FILLED ...) that the frame has to a call's words and to the end of its pictures. False if the
// frame has none.
bool pass_add_group(const pass_context *c, unsigned group, variant *words, pass_picture writes[PASS_MOST_WRITES + 1]);

// ---- the passes that serve every method (passes/method.h), one file and one shader each

bool pass_split_suns(pass_context *c, error *e); // takes the suns out of the environment, once a batch
bool pass_suns(pass_context *c, error *e);       // radiance, visibility: in place, if their suns are apart
// Adds the light of the suns to `light` and, if it is there, `visibility`. Their shadows are found once a frame.
bool pass_add_suns(pass_context *c, gpu_image *light, gpu_image *visibility, error *e);
// pass_denoise filters the occlusion: `half_difference` tells it the noise. pass_blur filters other pictures, whose noise is
// unknown.
typedef struct pass_denoising {
    const gpu_image *moments; // between the directions, rgba32f
    const gpu_image *result;
    const gpu_image *square; // of the error that is left; NULL: not wanted
    const gpu_tiles *tiles;  // NULL: the frame's
} pass_denoising;
bool pass_denoise_across(pass_context *c, const pass_denoising *d, error *e); // one direction of it, then the other
bool pass_denoise_down(pass_context *c, const pass_denoising *d, error *e);
bool pass_denoise(pass_context *c, error *e); // occlusion: in place
// Runs a march at the pixels of a list, then, unless there is no blur, the filter of pass_blur at those pixels of what it `made`:
// radiance, visibility, indirect.
bool pass_at_lone(pass_context *c, const pixel_list *lone, const pass_call *march, image_set made, error *e);
// In place, over `radius` pixels; NULL or an image that is not made = none.
typedef struct pass_blurring {
    int radius;
    bool fitted; // by lines, not means (shaders/include/bilateral_line.glsl); with one scalar at most
    gpu_image *scalars[2], *colours[2];
} pass_blurring;
bool pass_blur(pass_context *c, const pass_blurring *b, error *e);
// Brings layers of a frame of half the size (gbuffer/half_size.h) to the size of `c`: the images of `which` that `small` has and
// `c` lacks.
bool pass_upsample(pass_context *c, const pass_context *small, image_set which, error *e);
// Makes or replaces images of the smaller frame `c`: of each pixel's block the mean over the pixels of `whole` that are on its
// surface. Colours only.
bool pass_downsample(pass_context *c, const pass_context *whole, image_set which, error *e);
// Spheres that the camera does not see. They block before pass_tone runs and add their bounce after the method's own bounce. Both
// passes do nothing without spheres.
bool pass_proxies(pass_context *c, error *e);                 // occlusion, visibility, radiance, bent, sh: in place
bool pass_proxies_bounce(pass_context *c, error *e);          // indirect: in place
bool pass_tone(pass_context *c, gpu_image *scalar, error *e); // scale and contrast, in place
bool pass_irradiance(pass_context *c, error *e);              // occlusion -> radiance
bool pass_mix(pass_context *c, error *e);                     // the layers of gbuffer.mixed, which is not empty: in place
image_set pass_mix_takes(image_set there);                    // those of them that pass_mix mixes
bool pass_edges(pass_context *c, error *e);                   // fills the layers of partly covered pixels
bool pass_specular(pass_context *c, error *e);                // material, albedo -> specular, diffuse_share
bool pass_composite(pass_context *c, error *e);               // layers -> composite

#endif
