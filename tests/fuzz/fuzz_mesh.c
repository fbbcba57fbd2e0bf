// libFuzzer target: an OBJ mesh and its material file, which is what stands behind a line "%%".
#include <math.h>

#include "fuzz.h"
#include "gbuffer/mesh.h"

static void check_mesh(const obj_mesh *m)
{
    CHECK(m->triangle_count > 0);
    for (size_t i = 0; i < m->vertex_count; i++) CHECK(v3_finite(m->vertices[i]));
    for (size_t i = 0; i < m->triangle_count; i++)
        for (int k = 0; k < 3; k++) {
            CHECK(m->triangles[i][k] < m->vertex_count);
            CHECK(m->albedo[i][k] >= 0.0f && m->albedo[i][k] <= 1.0f);
        }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static int mesh_fd = -1, mtl_fd = -1;
    char mesh_path[64], mtl_path[64], *paint, *text = fuzz_text(data, size, &paint);
    error e = {0};
    obj_mesh m;
    mesh_materials t = {0};
    fuzz_file(&mtl_fd, mtl_path, paint, strlen(paint));
    check_error(mesh_read_mtl(mtl_path, &t, &e), &e);
    mesh_materials_free(&t);
    // The mesh names the material file first, whatever follows.
    size_t capacity = strlen(text) + 128;
    char *with = malloc(capacity);
    CHECK(with);
    int n = snprintf(with, capacity, "mtllib %s\n%s", mtl_path, text);
    fuzz_file(&mesh_fd, mesh_path, with, (size_t)n);
    e = (error){0};
    bool ok = mesh_read_obj(mesh_path, &m, NULL, &e);
    check_error(ok, &e);
    if (ok) check_mesh(&m);
    if (ok) mesh_free(&m);
    free(with);
    free(text);
    return 0;
}
