// The scene's own surfaces, for the ray-traced reference: triangles read from a Wavefront OBJ file.
//
// Positions are the file's, in double, in whatever axes and unit the file has; nothing is turned, scaled or welded. Surfaces are
// two-sided. Each triangle has one albedo: the mean of its corners' colours ("v x y z r g b"), else its material's Kd (from the
// .mtl files named by mtllib), else MESH_GREY. Colours are linear and bounded to 0..1.
// Read are v, f, usemtl, mtllib, and newmtl and Kd in the material file; everything else (texture coordinates, normals, groups,
// lines, curves, map_Kd) is passed over. Polygons may be concave. Triangles without area are dropped.
#ifndef SSDO_GBUFFER_MESH_H
#define SSDO_GBUFFER_MESH_H

#include <stddef.h>

#include "base/error.h"
#include "base/log.h"
#include "base/vec.h"

#define MESH_GREY 0.8f // Wavefront's own default

typedef struct obj_mesh {
    vec3 *vertices;
    size_t vertex_count;
    unsigned (*triangles)[3]; // indices into vertices
    float (*albedo)[3];       // of each triangle
    size_t triangle_count;
    bool coloured; // the files name at least one colour
} obj_mesh;

// Reads the file. ERR_INPUT names file and line of what cannot be understood: a number that is none or not finite, an index that
// is out of range, a face of fewer than three corners, a file without a face. A .mtl file that cannot be read, and textures, are
// warnings.
bool mesh_read_obj(const char *path, obj_mesh *out, log_t *log, error *e);
void mesh_free(obj_mesh *m);

// Cuts a polygon of n >= 3 corners (indices into `vertices`) into n - 2 triangles of the same orientation, clipping ears. out has
// room for n - 2. A polygon that crosses itself gives n - 2 triangles too, but not a meaningful area. False with ERR_MEMORY, or
// with no error for a polygon so tangled that it would take longer than some thousand steps a corner.
bool mesh_cut_polygon(const vec3 *vertices, unsigned *corners, size_t n, unsigned (*out)[3], error *e);

// A material file's colours, read into *table, which grows; used by mesh_read_obj.
typedef struct mesh_material {
    char *name;
    float kd[3];
} mesh_material;
typedef struct mesh_materials {
    mesh_material *list;
    size_t count;
    bool textured; // a map_Kd was passed over
} mesh_materials;
bool mesh_read_mtl(const char *path, mesh_materials *table, error *e);
void mesh_materials_free(mesh_materials *table);

// The path of a material file that the mesh names: it lies beside the mesh.
void mesh_library_path(const char *mesh, const char *name, char *path, size_t size);
// The paths of all material files that the mesh names, a list to be freed with its strings.
bool mesh_list_libraries(const char *mesh, char ***list, int *count, error *e);

// One line at a time out of a text in memory, which is cut in place: comments, trailing blanks and "\" at line ends are gone.
// NULL at the end. *number counts the file's lines.
typedef struct mesh_lines {
    char *at;
    size_t number;
} mesh_lines;
char *mesh_next_line(mesh_lines *l);
// A whole file as a string. NULL with ERR_INPUT.
char *mesh_read_text(const char *path, error *e);
// If the line begins with this word: what follows it; else NULL.
char *mesh_after_word(char *line, const char *word);

#endif
