#include <dlfcn.h>
#include <epoxy/egl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/knobs.h"
#include "gpu/cache.h"
#include "gpu/choose.h"
#include "gpu/gpu.h"
#include "gpu/internal.h"

enum { MAX_DEVICES = 32 };

static bool has_token(const char *list, const char *token)
{
    size_t n = strlen(token);
    for (const char *p = list; p && (p = strstr(p, token)); p += n)
        if ((p == list || p[-1] == ' ') && (p[n] == ' ' || p[n] == 0)) return true;
    return false;
}

// libepoxy ends the process when libEGL or the library of OpenGL's functions is missing, so we look first. The handles stay open:
// epoxy uses them in a moment.
static bool have_egl(void) { return dlopen("libEGL.so.1", RTLD_LAZY | RTLD_GLOBAL) != NULL; }

static bool have_gl(void)
{
    return dlopen("libGL.so.1", RTLD_LAZY | RTLD_LOCAL) != NULL || dlopen("libOpenGL.so.0", RTLD_LAZY | RTLD_LOCAL) != NULL;
}

static const char *client_extensions(void)
{
    const char *s = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    return s ? s : "";
}

// Makes a 4.5 core context current on an initialised display, with reset notification where it is offered.
static EGLContext make_context(EGLDisplay display, bool debug, bool *robust)
{
    const char *extensions = eglQueryString(display, EGL_EXTENSIONS);
    if (!has_token(extensions, "EGL_KHR_surfaceless_context") || !has_token(extensions, "EGL_KHR_create_context")) return NULL;
    EGLConfig config = EGL_NO_CONFIG_KHR;
    if (!has_token(extensions, "EGL_KHR_no_config_context") && !has_token(extensions, "EGL_MESA_configless_context")) {
        EGLint count = 0, want[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE};
        if (!eglChooseConfig(display, want, &config, 1, &count) || count < 1) return NULL;
    }
    if (!eglBindAPI(EGL_OPENGL_API)) return NULL;
    EGLint attributes[] = {EGL_CONTEXT_FLAGS_KHR,
                           debug ? EGL_CONTEXT_OPENGL_DEBUG_BIT_KHR : 0,
                           EGL_CONTEXT_MAJOR_VERSION,
                           4,
                           EGL_CONTEXT_MINOR_VERSION,
                           5,
                           EGL_CONTEXT_OPENGL_PROFILE_MASK,
                           EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                           EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY,
                           EGL_LOSE_CONTEXT_ON_RESET,
                           EGL_NONE};
    EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes);
    *robust = context != EGL_NO_CONTEXT;
    if (context == EGL_NO_CONTEXT) {
        attributes[8] = EGL_NONE;
        context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes);
    }
    if (context == EGL_NO_CONTEXT) return NULL;
    if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) return context;
    eglDestroyContext(display, context);
    return NULL;
}

static void query_limits(gpu_limits *l)
{
    GLint compute = 0, fragment = 0;
    GLint64 bytes = 0;
    glGetIntegerv(GL_MAX_IMAGE_UNITS, &l->image_units);
    glGetIntegerv(GL_MAX_COMPUTE_IMAGE_UNIFORMS, &compute);
    glGetIntegerv(GL_MAX_FRAGMENT_IMAGE_UNIFORMS, &fragment);
    glGetIntegerv(GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS, &l->storage_blocks);
    glGetIntegerv(GL_MAX_COMBINED_SHADER_OUTPUT_RESOURCES, &l->outputs);
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &bytes);
    l->images = compute < fragment ? compute : fragment;
    l->storage_bytes = bytes;
}

static bool try_display(gpu *g, EGLDisplay display, const char *platform)
{
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, NULL, NULL)) return false;
    bool robust = false;
    EGLContext context = make_context(display, g->debug, &robust);
    if (!context) {
        eglTerminate(display);
        return false;
    }
    g->display = display;
    g->context = context;
    g->robust = robust;
    snprintf(g->renderer, sizeof g->renderer, "%s", (const char *)glGetString(GL_RENDERER));
    gpu_device_name(g->renderer, g->device, sizeof g->device);
    snprintf(g->version, sizeof g->version, "%s", (const char *)glGetString(GL_VERSION));
    snprintf(g->platform, sizeof g->platform, "%s", platform);
    g->software = strstr(g->renderer, "llvmpipe") || strstr(g->renderer, "softpipe") || strstr(g->renderer, "SWR");
    const char *transfer = knob_value("SSDO_TRANSFER");
    g->mapped = transfer ? strcmp(transfer, "mapped") == 0 : !g->software;
    g->band_bytes = GPU_BAND_BYTES;
    g->threads = 1;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &g->max_size);
    query_limits(&g->limits);
    g->habits = gpu_choose_habits(g->software, g->version, &g->limits, knob_value("SSDO_READ"), knob_value("SSDO_DRAW"));
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    return true;
}

static int query_devices(EGLDeviceEXT *devices)
{
    EGLint count = 0;
    const char *extensions = client_extensions();
    if (!has_token(extensions, "EGL_EXT_device_enumeration") && !has_token(extensions, "EGL_EXT_device_base")) return 0;
    if (!has_token(extensions, "EGL_EXT_platform_device")) return 0;
    return eglQueryDevicesEXT(MAX_DEVICES, devices, &count) ? count : 0;
}

static bool is_software(EGLDeviceEXT device)
{
    return has_token(eglQueryDeviceStringEXT(device, EGL_EXTENSIONS), "EGL_MESA_device_software");
}

// EGL_EXT_device_persistent_id, which libepoxy does not know.
static bool query_uuid(EGLDeviceEXT device, const char *extensions, unsigned char uuid[16])
{
    enum { DEVICE_UUID_EXT = 0x335C };
    typedef EGLBoolean (*query_fn)(EGLDeviceEXT, EGLint, EGLint, void *, EGLint *);
    EGLint size = 0;
    if (!has_token(extensions, "EGL_EXT_device_persistent_id")) return false;
    query_fn query = (query_fn)eglGetProcAddress("eglQueryDeviceBinaryEXT");
    return query && query(device, DEVICE_UUID_EXT, 16, uuid, &size) && size == 16;
}

static gpu_candidate describe(EGLDeviceEXT device)
{
    const char *extensions = eglQueryDeviceStringEXT(device, EGL_EXTENSIONS);
    gpu_candidate c = {.software = is_software(device), .nvidia = has_token(extensions, "EGL_NV_device_cuda"), .cuda = -1};
    EGLAttrib number = 0;
    if (c.nvidia && eglQueryDeviceAttribEXT(device, EGL_CUDA_DEVICE_NV, &number)) c.cuda = (int)number;
    c.has_uuid = query_uuid(device, extensions, c.uuid);
    return c;
}

static gpu_surroundings surroundings_of(EGLDeviceEXT *devices, int count)
{
    gpu_surroundings s = gpu_look_around("");
    for (int i = 0; i < count; i++) s.listed |= describe(devices[i]).nvidia;
    s.hidden = getenv("CUDA_VISIBLE_DEVICES") != NULL;
    return s;
}

static gpu_surroundings surroundings(void)
{
    EGLDeviceEXT devices[MAX_DEVICES];
    return surroundings_of(devices, have_egl() ? query_devices(devices) : 0);
}

const char *gpu_missing_device(void)
{
    gpu_surroundings s = surroundings();
    return gpu_missing_vendor(&s);
}

const char *gpu_missing_hardware(void)
{
    gpu_surroundings s = surroundings();
    return gpu_why_software(&s);
}

static bool open_device(gpu *g, EGLDeviceEXT device)
{
    return try_display(g, eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device, NULL), "EGL device");
}

// The devices in the order of gpu_choose, then the surfaceless platform, which needs no device.
static bool open_first(gpu *g, EGLDeviceEXT *devices, int count)
{
    gpu_candidate list[MAX_DEVICES];
    int order[MAX_DEVICES];
    for (int i = 0; i < count; i++) list[i] = describe(devices[i]);
    int n = gpu_choose(list, count, getenv("CUDA_VISIBLE_DEVICES"), order);
    for (int i = 0; i < n; i++)
        if (open_device(g, devices[order[i]])) return true;
    if (!has_token(client_extensions(), "EGL_MESA_platform_surfaceless")) return false;
    return try_display(g, eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL), "EGL surfaceless");
}

void gpu_set_up(void) { cache_open_mesa(); }

// A software device: why, and whether that will do.
static bool accept_software(gpu *g, gpu_request request, const gpu_surroundings *s, error *e)
{
    char named[64];
    snprintf(named, sizeof named, "--device %d names it", request.device);
    snprintf(g->why_software, sizeof g->why_software, "%s", request.device >= 0 ? named : gpu_why_software(s));
    if (!request.hardware) return true;
    err_set(e, ERR_GL, NULL, NULL, "--require-gpu: only %s is there, which runs on the CPU: %s", g->device, g->why_software);
    gpu_close(g);
    return false;
}

static bool open_requested(gpu *g, gpu_request request, EGLDeviceEXT *devices, int count, const gpu_surroundings *s, error *e)
{
    if (request.device >= count)
        return err_set(e, ERR_GL, NULL, NULL, "there is no device %d; --list-devices shows the %d there are", request.device,
                       count);
    if (request.device >= 0)
        return open_device(g, devices[request.device]) ||
               err_set(e, ERR_GL, NULL, NULL, "EGL device %d gives no OpenGL 4.5 core context; --list-devices shows which do",
                       request.device);
    const char *missing = gpu_missing_vendor(s);
    return open_first(g, devices, count) ||
           err_set(e, ERR_GL, NULL, NULL, "no EGL device or surfaceless platform gives an OpenGL 4.5 core context; %s",
                   missing ? missing : "install a driver (Debian: libegl-mesa0 libgl1-mesa-dri) and see --list-devices");
}

bool gpu_open_as(gpu *g, gpu_request request, log_t *log, error *e)
{
    *g = (gpu){.log = log, .debug = request.debug};
    if (!request.hosted) gpu_set_up();
    if (!have_egl())
        return err_set(e, ERR_GL, NULL, NULL,
                       "libEGL.so.1 cannot be loaded; install a GL driver (Debian: libegl1 libopengl0 libegl-mesa0 "
                       "libgl1-mesa-dri)");
    if (!have_gl())
        return err_set(e, ERR_GL, NULL, NULL,
                       "neither libOpenGL.so.0 nor libGL.so.1 can be loaded; install one (Debian: libopengl0 or libgl1)");
    EGLDeviceEXT devices[MAX_DEVICES];
    int count = query_devices(devices);
    gpu_surroundings s = surroundings_of(devices, count);
    if (!open_requested(g, request, devices, count, &s, e)) return false;
    if (g->software && !accept_software(g, request, &s, e)) return false;
    // Where there is an NVIDIA GPU, it was meant.
    if (g->software && request.device < 0 && (s.node || s.module))
        log_warn(log, "nvidia", "running on the CPU: %s", g->why_software);
    log_info(log, "device: %s, %s (%s%s)", g->renderer, g->version, g->platform, g->software ? ", software" : "");
    if (g->software) log_info(log, "on the CPU: %s", g->why_software);
    if (g->debug) gpu_debug_begin(g);
    return true;
}

bool gpu_open(gpu *g, int device, log_t *log, error *e) { return gpu_open_as(g, (gpu_request){.device = device}, log, e); }

static void close_context(gpu *g)
{
    gpu_programs_free(g);
    gpu_transfers_free(g);
    if (g->framebuffer) glDeleteFramebuffers(1, &g->framebuffer);
    if (g->vertex_array) glDeleteVertexArrays(1, &g->vertex_array);
    eglMakeCurrent(g->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(g->display, g->context);
    eglTerminate(g->display);
}

void gpu_close(gpu *g)
{
    bool stored = g->programs_compiled > 0;
    if (g->context) close_context(g);
    cache_close_mesa();
    if (stored) cache_tidy();
    *g = (gpu){0};
}

int gpu_list_devices(gpu_device *list, int max)
{
    if (!have_egl() || !have_gl()) return 0;
    EGLDeviceEXT devices[MAX_DEVICES];
    int count = query_devices(devices);
    for (int i = 0; i < count && i < max; i++) {
        gpu g = {0};
        gpu_set_up(); // each is closed again
        list[i] = (gpu_device){.software = is_software(devices[i]), .usable = open_device(&g, devices[i])};
        const char *node = has_token(eglQueryDeviceStringEXT(devices[i], EGL_EXTENSIONS), "EGL_EXT_device_drm")
                               ? eglQueryDeviceStringEXT(devices[i], EGL_DRM_DEVICE_FILE_EXT)
                               : NULL;
        snprintf(list[i].description, sizeof list[i].description, "%s%s%s%s",
                 list[i].usable ? g.renderer : "no OpenGL 4.5 core context", list[i].software ? " (software)" : "",
                 node ? " " : "", node ? node : "");
        gpu_close(&g);
    }
    return count < max ? count : max;
}

bool gpu_finish(gpu *g, const char *what, error *e)
{
    glFinish();
    return gpu_check(g, what, e);
}

bool gpu_check(gpu *g, const char *what, error *e)
{
    if (g->robust && glGetGraphicsResetStatus() != GL_NO_ERROR)
        return err_set(e, ERR_GL, NULL, NULL, "the GL context was lost during %s; run the frame again", what);
    GLenum code = glGetError();
    if (code == GL_NO_ERROR) return true;
    while (glGetError() != GL_NO_ERROR) {}
    if (code == GL_OUT_OF_MEMORY) return err_set(e, ERR_MEMORY, NULL, NULL, "the GL device ran out of memory during %s", what);
    return err_set(e, ERR_GL, NULL, NULL, "GL error 0x%04x during %s", code, what);
}
