// The pictures of a frame, one row each: IMAGE for what only passes see, LAYER for what can be written, and PASS_LAYER for a
// layer with a pass of its own that runs when the layer is asked for. Fields are those of image_row (passes/images.h).
//
// Whoever makes something of every row includes this with the three macros defined. The layers' order is that of previews and
// reports; where images are brought to another size or filled together, they go in this order too.

// ---- what the file brings
IMAGE(DEPTH, .name = "depth", .format = GL_R32F, .given = true, .pixels = offsetof(gbuffer, depth))
IMAGE(NORMAL, .name = "normal", .format = GL_RGBA32F, .given = true, .pixels = offsetof(gbuffer, normal))
IMAGE(ALBEDO, .name = "albedo", .format = GL_RGBA32F, .given = true, .pixels = offsetof(gbuffer, albedo))
IMAGE(BEAUTY, .name = "beauty", .format = GL_RGBA32F, .given = true, .pixels = offsetof(gbuffer, beauty))
IMAGE(MATERIAL, .name = "material", .format = GL_RG32F, .given = true, .pixels = offsetof(gbuffer, material))
IMAGE(EMISSION, .name = "emission", .format = GL_RGBA32F, .given = true, .pixels = offsetof(gbuffer, emission))
IMAGE(DIFFUSE_DIRECT, .name = "diffuse direct", .format = GL_RGBA32F, .given = true, .pixels = offsetof(gbuffer, diffuse_direct))
IMAGE(COVERAGE, .name = "coverage", .format = GL_R32F, .given = true, .pixels = offsetof(gbuffer, coverage))

// ---- what is made of it
LAYER(OCCLUSION, .name = "occlusion", .format = GL_R32F, .neutral = 1.0f, .resampled = AS_SCALAR,
      .groups = IMAGE_FILLED | IMAGE_BLOCKED, .word = "OCCLUSION", .slot = "occlusion_image", .channels = "R",
      .range = RANGE_SHARE, .display = DISPLAY_SHARE, .by_default = true)
LAYER(RADIANCE, .name = "radiance", .format = GL_RGBA32F, .resampled = AS_OPEN_LIGHT, .groups = IMAGE_FILLED | IMAGE_BLOCKED,
      .word = "RADIANCE", .slot = "radiance_image", .channels = "RGB", .range = RANGE_LIGHT, .display = DISPLAY_LIGHT,
      .by_default = true)
LAYER(INDIRECT, .name = "indirect", .format = GL_RGBA32F, .resampled = AS_COLOUR, .groups = IMAGE_FILLED, .word = "INDIRECT",
      .slot = "indirect_image", .channels = "RGB", .range = RANGE_LIGHT, .display = DISPLAY_LIGHT, .by_default = true)
LAYER(COMPOSITE, .name = "composite", .format = GL_RGBA32F, .channels = "RGB", .range = RANGE_ANY, .display = DISPLAY_PICTURE,
      .by_default = true)
// A method that makes no light of its own makes no visibility either: its occlusion is what there is.
LAYER(VISIBILITY, .name = "visibility", .format = GL_R32F, .neutral = 1.0f, .resampled = AS_SCALAR,
      .groups = IMAGE_FILLED | IMAGE_BLOCKED, .word = "VISIBILITY", .slot = "visibility_image", .otherwise = IMAGE_OCCLUSION,
      .channels = "R", .range = RANGE_SHARE, .display = DISPLAY_SHARE)
LAYER(SPECULAR, .name = "specular", .format = GL_RGBA32F, .channels = "RGB", .range = RANGE_LIGHT, .display = DISPLAY_LIGHT)
LAYER(DIFFUSE, .name = "diffuse", .format = GL_RGBA32F, .channels = "RGB", .range = RANGE_ANY, .display = DISPLAY_LIGHT)
PASS_LAYER(DEPTHMASK, pass_depthmask, .name = "depthmask", .format = GL_R32F, .channels = "R", .range = RANGE_ANY,
           .display = DISPLAY_DARKENING)
// Where there is no surface nothing is guessed.
PASS_LAYER(CONFIDENCE, pass_confidence, .name = "confidence", .format = GL_R32F, .neutral = 1.0f, .channels = "R",
           .range = RANGE_SHARE, .display = DISPLAY_SHARE)
// The mean open direction of the cosine-weighted hemisphere, camera space: 2/3 long where all is open.
LAYER(BENT, .name = "bent", .format = GL_RGBA32F, .resampled = AS_COLOUR, .groups = IMAGE_FILLED | IMAGE_BLOCKED, .word = "BENT",
      .slot = "bent_image", .channels = "XYZ", .range = RANGE_DIRECTION, .display = DISPLAY_SIGNED)
// The SH vector of cosine-weighted visibility, coefficients 0 1 2 | 3 4 5 | 6 7 8 and, with four bands, 9 10 11 12 | 13 14 15.
LAYER(SH_0, .name = "sh_0", .format = GL_RGBA32F, .resampled = AS_COLOUR, .groups = IMAGE_VECTOR, .word = "SH",
      .slot = "sh0_image", .channels = "RGB", .range = RANGE_ANY, .display = DISPLAY_SIGNED)
LAYER(SH_1, .name = "sh_1", .format = GL_RGBA32F, .resampled = AS_COLOUR, .groups = IMAGE_VECTOR, .slot = "sh1_image",
      .channels = "RGB", .range = RANGE_ANY, .display = DISPLAY_SIGNED)
LAYER(SH_2, .name = "sh_2", .format = GL_RGBA32F, .resampled = AS_COLOUR, .groups = IMAGE_VECTOR, .slot = "sh2_image",
      .channels = "RGB", .range = RANGE_ANY, .display = DISPLAY_SIGNED)
LAYER(SH_3, .name = "sh_3", .format = GL_RGBA32F, .resampled = AS_COLOUR, .groups = IMAGE_VECTOR, .word = "BANDS3",
      .slot = "sh3_image", .channels = "HIJKLMN", .range = RANGE_ANY, .display = DISPLAY_SIGNED)
IMAGE(SH_4, .name = "the end of sh_3", .format = GL_RGBA32F, .resampled = AS_COLOUR, .groups = IMAGE_VECTOR, .slot = "sh4_image")
LAYER(ERROR, .name = "error", .format = GL_R32F, .channels = "R", .range = RANGE_LIGHT, .display = DISPLAY_ERROR)

// ---- what passes hand to each other
// How much of the light a surface does not reflect at once is diffuse.
IMAGE(DIFFUSE_SHARE, .name = "diffuse share", .format = GL_RGBA32F, .neutral = 1.0f)
// How much the second half of a method's slices moved the occlusion; for pass_denoise.
IMAGE(HALF_DIFFERENCE, .name = "half-difference", .format = GL_R32F)
// The planes, for the shader: of a size of its own.
IMAGE(PLANES, .name = "planes", .format = GL_RGBA32F)
// Depth and normal in one texel, for the slice marches.
IMAGE(SURFACE, .name = "surface", .format = GL_RG32UI)
// The depth of the opening that a pixel shows the outdoors through; 0: it does not (openings.h).
IMAGE(RIM, .name = "rim of openings", .format = GL_R32F)
// The same with the light that surfaces send, for a bounce.
IMAGE(SENDERS, .name = "senders", .format = GL_RGBA32UI)
// The suns' light alone, and the share of it that arrives (suns.comp).
IMAGE(SUNS, .name = "light of the suns", .format = GL_RGBA32F)
// What is known of the radiance before it is made, for a march that makes it and its bounce at once (first_light.c).
IMAGE(FIRST_LIGHT, .name = "first light", .format = GL_RGBA32F)
// The light that surfaces outside the frame are taken to send, and the mean albedo: two texels.
IMAGE(OUTSIDE_LIGHT, .name = "light of the outside", .format = GL_RGBA32F)
