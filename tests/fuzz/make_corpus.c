// make_corpus FOLDER: small, whole EXR files for fuzz_exr to start from: every compression that is read, both naming conventions,
// half positions, averaged edges, orthographic and depth-only frames, two parts, two eyes.
#include <stdio.h>
#include <string.h>

#include <openexr.h>

#include "exr/write.h"
#include "scene_picture.h"

static const int kinds[] = {EXR_COMPRESSION_NONE, EXR_COMPRESSION_RLE,   EXR_COMPRESSION_ZIPS, EXR_COMPRESSION_ZIP,
                            EXR_COMPRESSION_PIZ,  EXR_COMPRESSION_PXR24, EXR_COMPRESSION_B44,  EXR_COMPRESSION_B44A};
enum { KINDS = sizeof kinds / sizeof *kinds };

static bool one(const char *folder, const char *name, bool orthographic, const scene_exr_options *o, error *e)
{
    char path[4096];
    scene s;
    scene_clutter(&s);
    view v = orthographic ? view_orthographic(12, 8, 8.0, 1.0) : view_perspective(12, 8, 50.0, 1.0);
    view_scene(&v, &s);
    snprintf(path, sizeof path, "%s/%s.exr", folder, name);
    return scene_write(&s, &v, o, path, e);
}

static bool two_parts(const char *folder, error *e)
{
    char path[4096];
    static float values[5][12 * 8];
    exrio_out_channel beauty[] = {{"R", SAMPLE_FLOAT, values[0]}, {"G", SAMPLE_FLOAT, values[0]}, {"B", SAMPLE_FLOAT, values[0]}};
    exrio_out_channel data[] = {{"Z", SAMPLE_FLOAT, values[1]},
                                {"N.X", SAMPLE_FLOAT, values[2]},
                                {"N.Y", SAMPLE_FLOAT, values[3]},
                                {"N.Z", SAMPLE_FLOAT, values[4]}};
    for (int i = 0; i < 12 * 8; i++) values[1][i] = 2.0f + 0.1f * (float)(i % 12), values[4][i] = 1.0f;
    exrio_out_part parts[2] = {{.name = "beauty", .channels = beauty, .channel_count = 3},
                               {.name = "depth", .channels = data, .channel_count = 4}};
    for (int i = 0; i < 2; i++) {
        parts[i].data_window = parts[i].display_window = (box2){0, 0, 11, 7};
        parts[i].pixel_aspect = 1.0f;
        parts[i].compression = EXR_COMPRESSION_ZIP;
    }
    snprintf(path, sizeof path, "%s/parts.exr", folder);
    return exrio_write(path, parts, 2, 1, e);
}

static bool two_eyes(const char *folder, error *e)
{
    char path[4096];
    static float depth[12 * 8];
    static const char *const names[] = {"Z.left.V", "Z.right.V", "right.N.X", "N.Y", "R", "right.R"};
    exrio_out_channel channels[6];
    exrio_out_attr views = {.name = "multiView", .kind = EXRIO_OUT_STRINGS, .strings = {"left", "right"}, .string_count = 2};
    exrio_out_part part = {.data_window = {0, 0, 11, 7},
                           .display_window = {0, 0, 11, 7},
                           .pixel_aspect = 1.0f,
                           .compression = EXR_COMPRESSION_ZIP,
                           .channels = channels,
                           .channel_count = 6,
                           .attributes = &views,
                           .attribute_count = 1};
    for (int i = 0; i < 12 * 8; i++) depth[i] = 2.0f + 0.1f * (float)(i % 12);
    for (int i = 0; i < 6; i++) channels[i] = (exrio_out_channel){names[i], SAMPLE_FLOAT, depth};
    snprintf(path, sizeof path, "%s/eyes.exr", folder);
    return exrio_write(path, &part, 1, 1, e);
}

int main(int argc, char **argv)
{
    error e = {0};
    bool ok = argc == 2;
    for (int k = 0; ok && k < KINDS; k++) {
        char name[32];
        snprintf(name, sizeof name, "kind%d", k);
        ok = one(argv[1], name, false, &(scene_exr_options){.convention = k % 2 ? "plain" : "blender", .compression = kinds[k]},
                 &e);
    }
    const int zip = EXR_COMPRESSION_ZIP;
    ok = ok && one(argv[1], "half", false, &(scene_exr_options){.half_position = true, .compression = zip}, &e) &&
         one(argv[1], "edges", false, &(scene_exr_options){.edge_samples = 4, .compression = zip}, &e) &&
         one(argv[1], "ortho", true, &(scene_exr_options){.compression = zip}, &e) &&
         one(argv[1], "camera", false, &(scene_exr_options){.convention = "plain", .camera_space = true, .compression = zip},
             &e) &&
         one(argv[1], "depth", false, &(scene_exr_options){.no_position = true, .radial_depth = true, .compression = zip}, &e) &&
         one(argv[1], "position", false, &(scene_exr_options){.no_depth = true, .no_normal = true, .no_albedo = true}, &e) &&
         two_parts(argv[1], &e) && two_eyes(argv[1], &e);
    if (!ok) fprintf(stderr, "make_corpus: %s\n", argc == 2 ? e.message : "usage: make_corpus FOLDER");
    return !ok;
}
