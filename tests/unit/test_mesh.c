// The OBJ reader, and the cutting of polygons.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "gbuffer/mesh.h"
#include "must.h"
#include "near.h"

static char folder[64], obj[96], mtl[96];

static void put(const char *path, const char *text)
{
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fputs(text, f);
    fclose(f);
}

static obj_mesh read_text(const char *text)
{
    obj_mesh m;
    error e = {0};
    put(obj, text);
    must(mesh_read_obj(obj, &m, NULL, &e), &e);
    return m;
}

static int make_folder(void **state)
{
    (void)state;
    snprintf(folder, sizeof folder, "/tmp/ssdo_mesh_%d", (int)getpid());
    snprintf(obj, sizeof obj, "%s/a mesh.obj", folder);
    snprintf(mtl, sizeof mtl, "%s/paint.mtl", folder);
    char command[160];
    snprintf(command, sizeof command, "mkdir -p '%s'", folder);
    return system(command);
}

static int remove_folder(void **state)
{
    (void)state;
    remove(obj);
    remove(mtl);
    return rmdir(folder);
}

static double area_of(const obj_mesh *m, size_t t)
{
    const vec3 *v = m->vertices;
    const unsigned *c = m->triangles[t];
    return 0.5 * v3_length(v3_cross(v3_sub(v[c[1]], v[c[0]]), v3_sub(v[c[2]], v[c[0]])));
}

static double whole_area(const obj_mesh *m)
{
    double sum = 0.0;
    for (size_t t = 0; t < m->triangle_count; t++) sum += area_of(m, t);
    return sum;
}

// All forms of an index, a face over two lines, comments, and what is passed over.
static void reads_the_forms(void **state)
{
    (void)state;
    obj_mesh m = read_text("# a comment\r\no thing\ng part\ns off\n"
                           "v 0 0 0\nv 2 0 0 1.0\r\nv  2\t3 0 # a corner\nv 0 3 0\nvt 0 0\nvn 0 0 1\nvp 1 1\n"
                           "f 1/1/1 2//1 \\\n 3/1\nf -4 -2 -1\nl 1 2\n\nv 9 9 9");
    assert_int_equal(m.vertex_count, 5);
    assert_int_equal(m.triangle_count, 2);
    assert_false(m.coloured);
    const unsigned wanted[2][3] = {{0, 1, 2}, {0, 2, 3}};
    assert_memory_equal(m.triangles, wanted, sizeof wanted);
    assert_near(m.vertices[2].y, 3.0, 0.0);
    assert_near(whole_area(&m), 6.0, 1e-12);
    for (int k = 0; k < 3; k++) assert_near((double)m.albedo[1][k], 0.8, 1e-6);
    mesh_free(&m);
}

static void colours_come_from_vertices_or_materials(void **state)
{
    (void)state;
    put(mtl, "newmtl rot#1\nKa 1 1 1\nKd 0.5 0.25 7\nmap_Kd wood.png\nnewmtl dark\n  Kd 0.125\n");
    obj_mesh m = read_text("mtllib paint.mtl\nmtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nusemtl rot#1\nf 1 2 3\n"
                           "usemtl dark\nf 1 2 3\nusemtl none\nf 1 2 3\n"
                           "v 0 0 0 0 0.5 1\nv 1 0 0 0.3 0.5 -1\nv 0 1 0 1 0.6 0.5 9\nf 4 5 6\nusemtl dark\nf 4 5 3");
    static const double wanted[6][3] = {{0.8, 0.8, 0.8}, {0.5, 0.25, 1.0},      {0.125, 0.125, 0.125},
                                        {0.8, 0.8, 0.8}, {0.3, 0.5, 2.0 / 3.0}, {0.125, 0.125, 0.125}};
    assert_true(m.coloured);
    assert_int_equal(m.triangle_count, 6);
    for (int t = 0; t < 6; t++)
        for (int k = 0; k < 3; k++) assert_near((double)m.albedo[t][k], wanted[t][k], 1e-6);
    mesh_free(&m);
}

static void expect_error(const char *text, const char *wanted)
{
    obj_mesh m;
    error e = {0};
    put(obj, text);
    assert_false(mesh_read_obj(obj, &m, NULL, &e));
    assert_int_equal(e.code, ERR_INPUT);
    assert_string_equal(e.file, obj);
    if (!strstr(e.message, wanted)) fail_msg("'%s' does not say '%s'", e.message, wanted);
    assert_null(m.vertices);
}

static void errors_name_the_line(void **state)
{
    (void)state;
    expect_error("v 0 0 0\nv 1 0\n", "line 2: a vertex has fewer than three coordinates");
    expect_error("v 0 0 nan\n", "line 1: a vertex holds what is not a finite number");
    expect_error("v 0 0 1e999\n", "line 1");
    expect_error("v 0 0 x\n", "line 1");
    expect_error("v 0 0 0\nv 1 0 0\nv 0 1 0\n\nf 1 2 4\n", "line 5: a face names vertex 4, and there are 3");
    expect_error("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -4 1 2\n", "vertex -4");
    expect_error("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", "vertex 0");
    expect_error("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 99999999999999999999 1 2\n", "line 4");
    expect_error("v 0 0 0\nv 1 0 0\nf 1 2\n", "line 3: a face has fewer than three corners");
    expect_error("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 three\n", "line 4: a face holds what is not an index");
    expect_error("", "no face");
    expect_error("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "no face with an area");
    obj_mesh m;
    error e = {0};
    assert_false(mesh_read_obj("/nonexistent/mesh.obj", &m, NULL, &e));
    assert_string_equal(e.file, "/nonexistent/mesh.obj");
    e = (error){0};
    assert_false(mesh_read_obj("/tmp", &m, NULL, &e)); // a folder
    assert_int_equal(e.code, ERR_INPUT);
}

// An arrow, a comb and a spiral: the triangles cover the polygon once, in its own orientation, whichever way it faces.
static void polygons_are_cut_into_their_area(void **state)
{
    (void)state;
    static const double arrow[][2] = {{0, 0}, {2, 1}, {0, 2}, {0.5, 1}};
    static const double comb[][2] = {{0, 0}, {5, 0}, {5, 3}, {4, 3}, {4, 1}, {3, 1},
                                     {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}};
    static const double doubled[][2] = {{0, 0}, {1, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}}; // a corner twice, one on a straight edge
    static const struct {
        const double (*at)[2];
        size_t n;
        double area;
    } list[] = {{arrow, 4, 1.5}, {comb, 12, 11.0}, {doubled, 6, 4.0}};
    for (size_t p = 0; p < sizeof list / sizeof *list; p++)
        for (int facing = 0; facing < 6; facing++)
            for (size_t start = 0; start < list[p].n; start++) {
                vec3 v[12];
                unsigned corners[12], out[10][3];
                size_t n = list[p].n;
                for (size_t i = 0; i < n; i++) {
                    size_t k = facing & 1 ? n - 1 - i : i;
                    double a = list[p].at[k][0], b = list[p].at[k][1];
                    v[i] = facing < 2 ? v3(a, b, 1) : facing < 4 ? v3(1, a, b) : v3(b, 1, a);
                    corners[i] = (unsigned)((i + start) % n);
                }
                assert_true(mesh_cut_polygon(v, corners, n, out, NULL));
                vec3 sum = v3(0, 0, 0);
                double absolute = 0.0;
                for (size_t t = 0; t < n - 2; t++) {
                    vec3 c = v3_cross(v3_sub(v[out[t][1]], v[out[t][0]]), v3_sub(v[out[t][2]], v[out[t][0]]));
                    sum = v3_add(sum, c);
                    absolute += v3_length(c);
                }
                assert_near(0.5 * absolute, list[p].area, 1e-12);
                assert_near(sum.x + sum.y + sum.z, (facing & 1 ? -2.0 : 2.0) * list[p].area, 1e-12);
            }
}

// Twice the area by the polygon's edges.
static double area_of_edges(const vec3 *v, size_t n)
{
    double sum = 0.0;
    for (size_t i = 0; i < n; i++) sum += v[i].x * v[(i + 1) % n].y - v[i].y * v[(i + 1) % n].x;
    return sum;
}

enum { MANY = 40000 };

static vec3 outline(int kind, size_t i)
{
    double t = 2.0 * M_PI * (double)i / MANY;
    if (kind == 0) return v3(cos(t), sin(t), 0.5); // a disk
    if (kind == 1) return v3_scale(v3(cos(t), sin(t), 0), i % 2 ? 1.0 : 0.9);
    if (kind == 2) { // a comb
        size_t half = MANY / 2;
        return i < half ? v3((double)i, i % 2 ? 1.0 : 0.0, 0) : v3((double)(MANY - 1 - i), i % 2 ? -2.0 : -2.5, 0);
    }
    // A spiral band of ten turns, out along one edge and back along the other.
    size_t half = MANY / 2, k = i < half ? i : MANY - 1 - i;
    double turns = 20.0 * M_PI * (double)k / (double)half, r = 1.0 + turns + (i < half ? 2.0 : 0.0);
    return v3(r * cos(turns), r * sin(turns), 0);
}

// Outlines of many corners, as text and coastlines have them: cut exactly, and before the alarm that ends the test if the time
// grows with the square of their number (1600 s with the cut of small ones).
static void large_polygons_are_cut(void **state)
{
    (void)state;
    vec3 *v = test_malloc(MANY * sizeof *v);
    unsigned *corners = test_malloc(MANY * sizeof *corners), (*out)[3] = test_malloc(MANY * sizeof *out);
    alarm(60);
    for (int kind = 0; kind < 4; kind++) {
        for (size_t i = 0; i < MANY; i++) v[i] = outline(kind, i), corners[i] = (unsigned)i;
        if (!mesh_cut_polygon(v, corners, MANY, out, NULL)) fail_msg("outline %d is given up", kind);
        double signed_sum = 0.0, absolute = 0.0, wanted = area_of_edges(v, MANY);
        for (size_t t = 0; t < MANY - 2; t++) {
            vec3 c = v3_cross(v3_sub(v[out[t][1]], v[out[t][0]]), v3_sub(v[out[t][2]], v[out[t][0]]));
            signed_sum += c.z;
            absolute += fabs(c.z);
        }
        assert_near(signed_sum / wanted, 1.0, 1e-9);
        assert_near(absolute / fabs(wanted), 1.0, 1e-9);
    }
    // Corners that jump about: cut or given up, but answered.
    unsigned r = 1;
    for (size_t i = 0; i < MANY; i++) {
        r = r * 1664525u + 1013904223u;
        v[i] = v3((double)(r >> 8), (double)(r * 69069u >> 8), 0), corners[i] = (unsigned)i;
    }
    error e = {0};
    (void)mesh_cut_polygon(v, corners, MANY, out, &e);
    assert_int_equal(e.code, ERR_NONE);
    alarm(0);
    test_free(v);
    test_free(corners);
    test_free(out);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(reads_the_forms),
                                       cmocka_unit_test(colours_come_from_vertices_or_materials),
                                       cmocka_unit_test(errors_name_the_line), cmocka_unit_test(polygons_are_cut_into_their_area),
                                       cmocka_unit_test(large_polygons_are_cut)};
    return cmocka_run_group_tests_name("mesh", tests, make_folder, remove_folder);
}
