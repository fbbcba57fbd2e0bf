// The bench: every method at several budgets on every scene, its error against two references and its time beside a yardstick.
//
// Error figures depend only on the scenes, the shaders and this code: nothing here looks at a clock to decide what to compute.
// Times are CPU and wall time of the GL work (passes until glFinish, without upload and read-back), medians over interleaved
// rounds. Paths are relative to the project's top folder, where `make bench` runs it.
#ifndef SSDO_TESTS_BENCH_H
#define SSDO_TESTS_BENCH_H

#include "method_reference.h"
#include "passes/method.h"
#include "rig.h"
#include "sample.h"
#include "scene_picture.h"
#include "truth.h"

enum { BENCH_ROUNDS = 9, BENCH_SCENES = 24, BENCH_ROWS = 256, BENCH_PIXELS = 4096, BENCH_VPL_PIXELS = 256, BENCH_LONG = 256 };

// ---- scenes (scenes.c, generated.c)

typedef struct bench_scene {
    sample s; // name, size, depth, and the truth in renders A and B
    gbuffer gb;
    double radius;
    bool generated;
    environment env; // empty (level_count 0) until opened
    gpu_image env_image;
    pass_sunless *sunless; // the environment's own; made by the first run that needs it
    layer layer;           // reference A
    pixel *pixels;
    int pixel_count;
    char mesh[256];             // the scene's own surfaces, an OBJ file; empty: none
    struct bench_scene *middle; // the middle third of the picture, for the rows of --proxies; NULL: none
    proxy_set proxies;          // what stands beside that
} bench_scene;

// The rendered samples of a folder (samples/render.py), and the scenes that C makes; each returns how many, 0 with the error
// filled. `cache` is the folder for truth that takes long; `sky` a map for the light of the generated scenes.
// `meshes` holds a NAME.obj for each rendered scene; NULL or without the file: rows that need it stay empty.
int bench_samples(const char *dir, const char *meshes, rig *r, bench_scene *list, int max, error *e);
int bench_generated(const char *sky, const char *cache, rig *r, bench_scene *list, int max, error *e);
void bench_scene_free(bench_scene *b);
// For programs that need no more than a folder's rendered samples: opens the rig and loads them, BENCH_SCENES at most; returns
// how many, 0 with the error filled. bench_close frees both.
int bench_open(const char *dir, rig *r, bench_scene *list, error *e);
void bench_close(rig *r, bench_scene *list, int count);
// The exit code of a program; says what went wrong.
int bench_end(const char *program, bool ok, const error *e);
// Loads a sky into the scene and onto the GPU.
bool bench_light(bench_scene *b, const char *path, double rotate, rig *r, error *e);
// The middle third, if DIR/proxies/NAME.json says what stands beside it (middle.c).
bool bench_middle(bench_scene *b, const char *dir, error *e);
void bench_middle_free(bench_scene *b);
// The layer and the stratified pixels of reference A; the gbuffer must be there.
bool bench_prepare(bench_scene *b, error *e);

// An Embree 3 tracer over a scene's shapes (embree.c), for scenes with meshes. Planes end 1000 units from their point, so the
// scene's own size should be of the order of 1. NULL if Embree refuses.
typedef struct embree embree;
embree *embree_open(const scene *s, error *e);
tracer embree_tracer(const embree *m);
void embree_close(embree *m);

// ---- rows (rows.c)

typedef enum row_kind { ROW_METHOD, ROW_OPEN, ROW_CONSTANT, ROW_IRRADIANCE, ROW_TRUE_AO } row_kind;

typedef struct bench_row {
    row_kind kind;
    char name[64]; // method, with what sets it apart from the method's own row
    const method *m;
    int samples, blur;      // blur in pixels, 0 none
    double thickness;       // share of the radius; < 0 as the method's row has it
    double scale, contrast; // 1
    bool no_planes, half;   // --planes off, --resolution half
    int sh_bands;           // of s3ho; 0 as 2
    double sh_sigma;        // of s3ho
    bool relit;             // --from-sh: the coefficients are there, as half
    double radius;          // 0: the scene's
    unsigned extra;         // layers that are made and timed besides
    const char *bounce;     // NULL: the method's own
    int lights;             // of the bounce vpl
    bool middle, proxies;   // only the middle third of the picture; with spheres for what stands beside it
    int trace;              // raytrace: its back end
    bool once;              // timed in the first round only
    int seed;               // of the noise
    bool standard;          // the method's own defaults: a row of the short table
} bench_row;

// Estimates the whole picture from its surfaces: comparable in error and time with the others.
static inline bool bench_competes(const bench_row *r) { return r->kind == ROW_METHOD && !r->relit && !r->middle; }

// Share and contrast of Alchemy with the lowest root mean square over the scenes, by a fixed grid.
bool bench_fit_alchemy(rig *r, const bench_scene *scenes, int count, double *scale, double *contrast, error *e);
int bench_rows(bench_row *rows, int max, double alchemy_scale, double alchemy_contrast);

// ---- running (run.c)

typedef struct bench_time {
    double cpu, wall; // ms
} bench_time;

typedef struct bench_cell { // a row on a scene
    score occlusion, radiance, indirect;
    bool has_occlusion, has_radiance, has_indirect;
    bool has_a, has_a_radiance, has_a_indirect;
    double a_rmse, a_bias, a_radiance, a_indirect;      // against A; of the light relative to its mean
    int rounds, all_rounds, round[BENCH_ROUNDS];        // in which it was timed
    bench_time direct[BENCH_ROUNDS], all[BENCH_ROUNDS]; // occlusion alone; every layer the method makes (0: not timed)
} bench_cell;

// Whether the scene has what the row needs: a mesh, a middle.
bool bench_runs(const bench_row *row, const bench_scene *b);
pass_settings bench_settings(const bench_row *row, const bench_scene *b);
// The layers a row makes: with more than BENCH_LONG samples occlusion alone.
unsigned bench_layers(const bench_row *row);
// `all`: time of everything; `direct`: of all but the multiplication that makes radiance of a scalar. Both may be NULL.
bool bench_run(rig *r, const bench_scene *b, const bench_row *row, unsigned layers, frame_result *out, bench_time *direct,
               bench_time *all, error *e);
// All error figures of a cell, and the times of that one run.
bool bench_measure(rig *r, const bench_scene *b, const bench_row *row, const char *cache, bench_cell *cell, error *e);

// Reference A of a row on a scene at its pixels, from the cache if it is there (references.c): 4 numbers a pixel, occlusion and
// the radiance of methods that have one. Returns NULL without an error for a row that has none. Free with free().
double *bench_reference(const bench_scene *b, const bench_row *row, const char *cache, error *e);
// Of the bounce vpl: 3 numbers for each of the first BENCH_VPL_PIXELS pixels in steps of pixel_count / BENCH_VPL_PIXELS, for
// senders lit with `radiance` (3 a pixel of the frame).
double *bench_reference_vpl(const bench_scene *b, const float *radiance, const char *cache, error *e);
static inline pixel bench_vpl_pixel(const bench_scene *b, int i)
{
    return b->pixels[(long)i * b->pixel_count / BENCH_VPL_PIXELS];
}

// A cache of blobs by content hash (cache.c): `key` starts with cache_start and grows by what the content depends on.
typedef unsigned long long cache_key;
cache_key cache_start(const char *kind);
cache_key cache_add(cache_key k, const void *data, size_t size);
cache_key cache_add_file(cache_key k, const char *path); // the file's text
bool bench_cache_load(const char *dir, cache_key k, void *data, size_t size);
void bench_cache_store(const char *dir, cache_key k, const void *data, size_t size);

// ---- the yardstick (yardstick.c): a 64-tap (8 x 8) texelFetch box in a fragment shader over an R32F texture of the frame's size

typedef struct yardstick {
    GLuint program, vertices, source, target, framebuffer;
    int width, height;
} yardstick;

bool yardstick_open(yardstick *y, int width, int height, error *e);
bench_time yardstick_run(const yardstick *y);
void yardstick_close(yardstick *y);

// ---- results (table.c, summary.c)

typedef struct bench_results {
    const char *title, *command, *renderer;
    const bench_scene *scenes;
    int scene_count, timed_count; // the first ones are timed
    const bench_row *rows;
    int row_count, rounds;
    const bench_cell *cells;                     // [row * scene_count + scene]
    bench_time yard[BENCH_SCENES][BENCH_ROUNDS]; // [scene][round]
    double alchemy_scale, alchemy_contrast;
    double empty_ratio; // GL time of a frame nine tenths empty, share of the full one's
    double seconds;
} bench_results;

// Of a row over a set of scenes: root mean square of errors, medians of times.
typedef struct bench_summary {
    int scenes;
    double occlusion, radiance, indirect; // rms; relative for the light; NAN where the row makes none
    double a, a_radiance, a_indirect;
    double cpu, wall, all_cpu; // ms per megapixel, means over the scenes
    double yards, all_yards;   // in yardsticks of the same round and scene
    bool front;                // on the Pareto front of occlusion against time
} bench_summary;

enum { SET_SAMPLES, SET_GENERATED };
void bench_summarise(const bench_results *r, int set, bench_summary *out);
double bench_median(const double *values, int count);
double bench_percentile(const double *values, int count, double share);
double bench_megapixels(const bench_scene *b);
// Median over the rounds of cpu, of cpu in yardsticks, and of wall time.
bench_time bench_cell_time(const bench_results *r, int row, int which, bool all);
double bench_cell_yards(const bench_results *r, int row, int which, bool all);

bool bench_write_csv(const bench_results *r, const char *dir, error *e);
bool bench_write_markdown(const bench_results *r, const char *dir, error *e);
bool bench_write_plot(const bench_results *r, const char *dir, error *e);

#endif
