// A headless OpenGL 4.5 core context and the few things the passes need of it: programs, images, buffers, timing.
//
// Everything here is called from the thread that created the context. One `gpu` serves a whole batch of frames. Functions that
// can fail fill an error with ERR_GL (ERR_MEMORY when GL ran out of memory).
#ifndef SSDO_GPU_GPU_H
#define SSDO_GPU_GPU_H

#include <epoxy/gl.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>

#include "base/error.h"
#include "base/log.h"
#include "gpu/habits.h"

typedef struct gpu_program gpu_program;
typedef struct gpu_pixel_buffer gpu_pixel_buffer; // gpu/transfer.h

// What was asked of GL. Uniform blocks, of a few hundred bytes, are not counted.
typedef struct gpu_counts {
    long long dispatches, draws, barriers;
    long long uploads, read_backs; // calls that move pictures or buffers
    long long bytes_up, bytes_down;
} gpu_counts;

enum { GPU_UP_BUFFERS = 3, GPU_BAND_BYTES = 128 << 20 };

typedef struct gpu {
    void *display, *context; // EGLDisplay, EGLContext
    log_t *log;              // borrowed; may be NULL
    char renderer[160], version[96], platform[48];
    char device[160];                // the renderer's name alone: results are the same bytes on the same device
    bool software;                   // a software rasteriser
    char why_software[320];          // why it was taken; "" for hardware
    bool debug;                      // a debug context: the driver's messages go to the log
    const char *group;               // of gpu_group_begin, for messages; may be NULL
    const char *const *source_files; // of the shader that is being compiled, for messages
    int source_count;
    int max_size;                     // largest texture side
    bool robust;                      // the context reports resets
    GLuint framebuffer, vertex_array; // of gpu_draw_tiles; 0 before the first
    bool mapped;       // pictures travel through mapped buffers (gpu/transfer.h): where it is no software renderer,
                       // or as SSDO_TRANSFER=mapped|direct says, for tests
    size_t band_bytes; // of a picture that travels, at most
    int threads;       // that copy what is sent up
    gpu_pixel_buffer *down, *up[GPU_UP_BUFFERS];
    int next_up;
    gpu_habits habits;
    gpu_limits limits;
    gpu_program **programs; // owned
    int program_count;
    atomic_int programs_compiled, programs_cached; // reports read them beside the GL thread. Of program_count: made from source,
                                                   // or taken from the cache of an earlier run
    gpu_counts counts;                             // since the context was opened
} gpu;

// One EGL device as --list-devices shows it.
typedef struct gpu_device {
    char description[256];
    bool software, usable;
} gpu_device;

// What changes the environment of the process (Mesa's cache folder): before the first thread starts. gpu_open makes up for it.
void gpu_set_up(void);

typedef struct gpu_request {
    int device;    // -1: the first usable one
    bool hardware; // a software device is an error that says why there is no other
    bool debug;
    bool hosted; // the process is another program's: its environment variables stay as they are
} gpu_request;

// Opens device number `device` (as listed), or with -1 the first usable one in the order of gpu/choose.h, falling back to the
// surfaceless platform. Says on the log which one, and warns when a software device is taken where an NVIDIA GPU lacks its
// driver.
// `*g` stays where it is: a debug context's messages find it. `log` is borrowed until gpu_close.
bool gpu_open_as(gpu *g, gpu_request request, log_t *log, error *e);
bool gpu_open(gpu *g, int device, log_t *log, error *e); // of any kind
void gpu_close(gpu *g);

// Fills up to `max` devices, returns how many there are. Each is initialised and tried.
int gpu_list_devices(gpu_device *list, int max);

// Why an NVIDIA GPU of this machine is not among the devices, or NULL (gpu/choose.h).
const char *gpu_missing_device(void);
// Why no device is hardware, supposing that none is.
const char *gpu_missing_hardware(void);

// Debuggers and the driver's messages show what lies between as a group; names are literals or outlive it. They do not nest.
void gpu_group_begin(gpu *g, const char *name);
void gpu_group_end(gpu *g);
// Names a GL object in a debug context; `kind` is GL_PROGRAM, GL_TEXTURE or GL_BUFFER.
void gpu_label(const gpu *g, GLenum kind, GLuint id, const char *name);

// ---- programs
// ---------------------------------------------------------------------------------------------------------------------
typedef enum gpu_slot_kind { SLOT_TEXTURE, SLOT_IMAGE, SLOT_BUFFER, SLOT_OUTPUT } gpu_slot_kind;

// Where a program takes a picture (as texture or as image), a storage buffer, or draws an output, by the name it has in the
// shader.
typedef struct gpu_slot {
    char name[32];
    gpu_slot_kind kind;
    int unit; // texture unit, image unit, buffer binding or location
} gpu_slot;

enum { GPU_MAX_SLOTS = 24 };

struct gpu_program {
    char *key; // file, form and defines
    GLuint id;
    bool drawn;
    gpu_slot slots[GPU_MAX_SLOTS];
    int slot_count;
};

// The program of shaders/<name> with "#define"s put before it ("LIGHT 1\nSAMPLES 4\n": one a line, without the word): a compute
// program, or if `drawn` the program that draws with it (FRAGMENT is then defined). Compiled once per name, form and defines,
// kept until gpu_close. NULL on failure; the message names the file and line of the source.
const gpu_program *gpu_program_get(gpu *g, const char *name, const char *defines, bool drawn, error *e);

// The text that the driver gets for it, to be freed. Needs no context; for tests and tools.
char *gpu_program_source(gpu_habits habits, const char *name, const char *defines, bool drawn, error *e);

// NULL: the program does not use it.
const gpu_slot *gpu_slot_of(const gpu_program *p, const char *name);

// ---- images
// ---------------------------------------------------------------------------------------------------------------------
typedef struct gpu_image {
    GLuint id; // 0: no image
    GLenum format;
    int width, height, levels;
} gpu_image;

bool gpu_image_make(gpu *g, gpu_image *image, GLenum format, int width, int height, int levels, error *e);
void gpu_image_free(gpu_image *image);
size_t gpu_image_row_bytes(const gpu_image *image); // as floats
// Whole level from/to tightly packed floats with as many components as the format has.
void gpu_image_upload(gpu *g, gpu_image *image, int level, const float *pixels);
void gpu_image_download(gpu *g, const gpu_image *image, float *pixels);
// Rows y .. y + rows - 1, of at most 1 GiB.
void gpu_image_download_rows(gpu *g, const gpu_image *image, int y, int rows, float *pixels);
void gpu_image_clear(gpu_image *image, const float value[4]);
// Puts the image's level 0 into a slot for pictures. For a texture, id 0 binds nothing; for an image it is skipped.
void gpu_bind_picture(const gpu_slot *slot, const gpu_image *image);

// ---- uniform buffers
// ------------------------------------------------------------------------------------------------------------
GLuint gpu_uniforms_make(size_t size);
void gpu_uniforms_set(GLuint buffer, int binding, const void *data, size_t size);
void gpu_uniforms_free(GLuint buffer);

// ---- storage buffers
// ------------------------------------------------------------------------------------------------------------
typedef struct gpu_buffer {
    GLuint id; // 0: no buffer
    size_t size;
} gpu_buffer;

// `data` may be NULL: undefined contents. `what` names it in messages ("the mesh").
bool gpu_buffer_make(gpu *g, gpu_buffer *buffer, const void *data, size_t size, const char *what, error *e);
void gpu_buffer_free(gpu_buffer *buffer);
void gpu_buffer_write(gpu *g, gpu_buffer *buffer, const void *data, size_t size); // from its beginning
void gpu_buffer_read(gpu *g, const gpu_buffer *buffer, void *data, size_t size);  // waits for the shaders that write it
// Puts it into a slot for buffers. A buffer with id 0 is skipped.
void gpu_bind_buffer(const gpu_slot *slot, const gpu_buffer *buffer);

// What was counted since `before`, a copy of g->counts.
gpu_counts gpu_counts_since(const gpu *g, const gpu_counts *before);

// Runs the program in use over so many work groups, and orders what follows after its stores (glMemoryBarrier's bits). Every
// dispatch and barrier goes through these, so that they are counted.
void gpu_dispatch(gpu *g, unsigned x, unsigned y, unsigned z);
void gpu_barrier(gpu *g, GLbitfield bits);

// Waits for all work, and turns what GL has to say (errors, lost context, out of memory) into an error.
bool gpu_finish(gpu *g, const char *what, error *e);
// The same of what is known by now, without waiting.
bool gpu_check(gpu *g, const char *what, error *e);

// ---- tiles
// ---------------------------------------------------------------------------------------------------------------------- The
// frame is worked on in square tiles, one dispatch each, so that no dispatch is long enough to trip a driver's watchdog, and a
// tile without any surface is not dispatched at all. Results do not depend on the tile size.
typedef struct gpu_tiles {
    int width, height, size, columns, rows;
    unsigned char *occupied; // columns * rows
    int occupied_count;
    const volatile int *stop; // borrowed, may be NULL: once it is not zero, no further tile is dispatched
} gpu_tiles;

enum { GPU_TILE = 64 };

// A side that suits the device: GPU_TILE for a software renderer, which gains from tiles left out and where a dispatch costs
// nothing; for hardware one that keeps a dispatch of so many samples a pixel short. For tests the environment variable SSDO_TILE
// says it (1 .. 65536 pixels).
int gpu_tile_size(const gpu *g, int samples);

// A tile is occupied if any of its pixels has mask[i] != 0 or (coverage given) coverage[i] > 0.
bool gpu_tiles_make(gpu_tiles *t, int width, int height, int size, const float *mask, const float *coverage, error *e);
// The same from a mask of bytes.
bool gpu_tiles_of(gpu_tiles *t, int width, int height, int size, const unsigned char *mask, error *e);
void gpu_tiles_free(gpu_tiles *t);

// Runs the program in use over every occupied tile (all tiles if `everywhere`), the tile's rectangle in uniform location 0
// (ivec4: x0 y0 x1 y1, end exclusive), with the memory barriers that image reads of the next pass need.
void gpu_dispatch_tiles(gpu *g, const gpu_tiles *t, bool everywhere);

// So many work groups of the program in use, for what is no picture; unless `end` is 0, uniform location 0 holds (first, end, 0,
// 0).
void gpu_dispatch_groups(gpu *g, int columns, int rows, int first, int end);

// The same for a drawn program: draws the tiles into the targets, all of the tiles' size; target i is the shader's output at
// location i. For passes that do little for each pixel: a software renderer stores what is drawn four times faster than what a
// compute shader puts into an image, where every pixel's store is a branch of its own (llvmpipe, 1080p, RGBA32F + R32F copied:
// 31 against 94 ms). What is drawn is in order with image reads that follow. llvmpipe flushes denormal floats to zero here and
// not in compute shaders, so what must pass to the bit is not drawn.
enum { GPU_MAX_TARGETS = 4 };
void gpu_draw_tiles(gpu *g, const gpu_tiles *t, bool everywhere, const gpu_image *const targets[], int target_count);

#endif
