/* A loop whose turns do not depend on one another. */
#if defined(__clang__)
#define SIDE_BY_SIDE _Pragma("clang loop vectorize(assume_safety)")
#elif defined(__GNUC__)
#define SIDE_BY_SIDE _Pragma("GCC ivdep")
#else
#define SIDE_BY_SIDE
#endif
/* Clear the wide registers, as code for old ones asks for; compilers forget it at times. */
#ifdef __AVX__
#include <immintrin.h>
#endif
static void leave(void)
{
#ifdef __AVX__
    _mm256_zeroupper();
#endif
}

static inline double larger(double a, double b) { return b > a ? b : a; }

static inline double smaller(double a, double b) { return b < a ? b : a; }

static inline int larger_int(int a, int b) { return b > a ? b : a; }

static inline int smaller_int(int a, int b) { return b < a ? b : a; }

static inline int size_int(int a) { return a < 0 ? -a : a; }

static inline int floor_div(int a, int b)
{
    return a / b - (a % b != 0 && (a < 0) != (b < 0));
}

static inline int floor_mod(int a, int b)
{
    return a % b + (a % b != 0 && (a < 0) != (b < 0) ? b : 0);
}
