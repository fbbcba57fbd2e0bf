// A digest of the shaders and of the code that decides pixels, made by decides.sh from all of it, comments and blanks left out.
#ifndef SSDO_PIPELINE_DECIDES_H
#define SSDO_PIPELINE_DECIDES_H

extern const char ssdo_decides[];

#endif
