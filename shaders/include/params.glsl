// A pass's parameter block, which C reads as a struct of the same members (src/passes/params.h): scalars of four bytes, ivec2, vec4 and
// arrays of vec4, ordered so that std140 needs no padding.
#define PARAMS(name) layout(std140, binding = PARAMS_BINDING) uniform ParamsBlock
#define END_PARAMS(name) params;

// The block of the frame, which all passes read.
#define FRAME_BLOCK layout(std140, binding = FRAME_BINDING) uniform Frame
#define END_FRAME_BLOCK frame;
