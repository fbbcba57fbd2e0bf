// For the archive (oldest.sh): what glibc 2.29 gave a new version of, in the version before. The functions are the same; the
// newer ones no longer call matherr, which nobody defines.
#if defined(__x86_64__) && defined(__linux__)
__asm__(".symver exp, exp@GLIBC_2.2.5");
__asm__(".symver log, log@GLIBC_2.2.5");
__asm__(".symver log2, log2@GLIBC_2.2.5");
__asm__(".symver exp2, exp2@GLIBC_2.2.5");
__asm__(".symver pow, pow@GLIBC_2.2.5");
#endif
